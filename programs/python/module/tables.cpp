// SPDX-License-Identifier: MIT
// Colour tables: .cube files, arrays, and what a table says of colours.
#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "parts.hpp"
#include "tables/cube_file.hpp"
#include "tables/evaluate.hpp"

namespace darkroom::python {

namespace py = pybind11;

namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Corner = std::array<float, 3>;

const ColorTable& table_of(const PyTable& table) {
    const auto* const found = std::get_if<ColorTable>(table.data.get());
    if (found == nullptr) raise_user("table: a picture: allowed is a table of colours");
    return *found;
}

/// `cube`: edge x edge x edge x 3, blue first, so that red runs fastest.
PyTable make_table(const Floats& cube, const Corner& min, const Corner& max, const std::string& title) {
    const bool is_cube = cube.ndim() == 4 && cube.shape(0) == cube.shape(1) && cube.shape(1) == cube.shape(2) &&
                         cube.shape(3) == 3 && cube.shape(0) >= min_table_size && cube.shape(0) <= max_cube_size;
    if (!is_cube)
        raise_user(
            fmt::format("table: allowed is an array (n, n, n, 3), n in [{}, {}]", min_table_size, max_cube_size));
    for (std::size_t i = 0; i < 3; ++i)
        if (!(min[i] < max[i])) raise_user(fmt::format("table: min {} and max {}: min must lie below", min[i], max[i]));
    ColorTable table{.size = static_cast<std::uint32_t>(cube.shape(0)), .min = min, .max = max};
    table.cube.assign(cube.data(), cube.data() + cube.size());
    return {std::make_shared<const ResourceData>(std::move(table)), title};
}

PyTable read_table(const std::string& path) {
    TableFile file = must(read_cube(path));
    return {std::make_shared<const ResourceData>(std::move(file.table)), file.title};
}

std::string cube_text(const PyTable& table) {
    return must(write_cube({.table = table_of(table), .title = table.title}));
}

Floats colors_of(const PyTable& from, const Floats& colors, bool is_trilinear) {
    const ColorTable& table = table_of(from);
    if (colors.ndim() < 1 || colors.shape(colors.ndim() - 1) != 3)
        raise_user("colors: allowed is an array (..., 3) of red, green and blue");
    Floats out(std::vector<py::ssize_t>(colors.shape(), colors.shape() + colors.ndim()));
    const float* const source = colors.data();
    float* const to = out.mutable_data();
    const auto count = static_cast<std::size_t>(colors.size());
    const auto interpolation = is_trilinear ? TableInterpolation::Trilinear : TableInterpolation::Tetrahedral;
    const py::gil_scoped_release others_run;
    for (std::size_t at = 0; at < count; at += 3) {
        const TableColor color = evaluate(table, {source[at], source[at + 1], source[at + 2]}, interpolation);
        for (std::size_t i = 0; i < 3; ++i) to[at + i] = static_cast<float>(color[i]);
    }
    return out;
}

}  // namespace

void add_tables(py::module_& module) {
    py::class_<PyTable>(module, "Table")
        .def(py::init(&make_table))
        .def_static("read", &read_table)
        .def("text", &cube_text)
        .def("colors", &colors_of)
        .def_readonly("title", &PyTable::title)
        .def_property_readonly("min", [](const PyTable& table) { return table_of(table).min; })
        .def_property_readonly("max", [](const PyTable& table) { return table_of(table).max; })
        .def_property_readonly("cube",
                               [](const PyTable& from) {
                                   const ColorTable& table = table_of(from);
                                   const py::ssize_t edge = table.size;
                                   return array_of(table.cube, {edge, edge, edge, 3});
                               })
        .def_property_readonly("shaper", [](const PyTable& from) {
            const ColorTable& table = table_of(from);
            return array_of(table.shaper, {py::ssize_t{table.shaper_size}, 3});
        });
}

}  // namespace darkroom::python
