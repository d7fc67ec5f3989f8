// SPDX-License-Identifier: MIT
// The effects of this build as data: what functions, methods, stubs and pages of the Python package are made from.
#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <darkroom/effect.hpp>
#include <darkroom/look.hpp>

#include "core/text/param_text.hpp"
#include "parts.hpp"
#include "plan/frame_inputs.hpp"

namespace darkroom::python {

namespace py = pybind11;

namespace {

/// The shortest number that is this float: 0.04, not 0.03999999910593033.
double as_written(std::uint32_t word) {
    const auto value = std::bit_cast<float>(word);
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    double out = static_cast<double>(value);
    std::from_chars(text.data(), end, out);
    return out;
}

py::tuple floats(std::span<const std::uint32_t> words) {
    py::tuple out(words.size());
    for (std::size_t i = 0; i < words.size(); ++i) out[i] = as_written(words[i]);
    return out;
}

const char* type_of(Kind kind) {
    switch (kind) {
        case Kind::Float:
            return "float";
        case Kind::Int:
            return "int";
        case Kind::Toggle:
            return "bool";
        case Kind::Choice:
            return "choice";
        case Kind::Vec2:
            return "vec2";
        case Kind::Vec3:
            return "vec3";
        case Kind::Vec4:
            return "vec4";
        case Kind::Rgb:
            return "rgb";
        case Kind::Curve:
            return "curve";
        case Kind::Resource:
            return "resource";
    }
    return "";
}

py::dict row_of(const ParamInfo& row, std::span<const std::uint32_t> defaults) {
    py::list choices;
    for (const std::string_view choice : row.choices) choices.append(py::str(choice.data(), choice.size()));
    py::dict out;
    out["name"] = py::str(std::string(row.name));
    out["type"] = type_of(row.kind);
    out["doc"] = full_doc(row);
    out["default"] = value_of(row, defaults);
    out["interval"] = interval(row);
    out["choices"] = choices;
    out["is_picture"] = row.is_picture;
    return out;
}

py::list rows_of(const ParamTable& table) {
    py::list rows;
    for (const ParamInfo& row : table.rows) rows.append(row_of(row, table.defaults));
    return rows;
}

py::dict effect_of(const EffectInfo& effect) {
    py::list needs;
    for (const plan::FrameInput& input : plan::frame_inputs)
        if (effect.needs.contains(input.image)) needs.append(std::string(input.name));
    const std::string page = fmt::format("{}.md", effect.name);
    const auto found = std::ranges::find(effect.files, std::string_view(page), &EffectFile::name);
    py::dict out;
    out["name"] = std::string(effect.name);
    out["doc"] = std::string(effect.doc);
    out["page"] = found == effect.files.end() ? std::string() : std::string(found->text);
    out["needs"] = needs;
    out["has_second"] = effect.has_second();
    out["has_history"] = effect.pre_roll != nullptr;
    out["is_last_step"] = effect.is_last_step;
    out["parameters"] = rows_of(effect.parameters);
    return out;
}

}  // namespace

py::object value_of(const ParamInfo& row, std::span<const std::uint32_t> words) {
    const std::span<const std::uint32_t> own = words.subspan(row.word, row.words);
    switch (row.kind) {
        case Kind::Float:
            return py::float_(as_written(own[0]));
        case Kind::Int:
            return py::int_(std::bit_cast<std::int32_t>(own[0]));
        case Kind::Toggle:
            return py::bool_(own[0] != 0);
        case Kind::Choice:
            return py::str(std::string(row.choices[own[0]]));
        case Kind::Curve: {
            const std::size_t count = own[0];
            py::tuple points(count);
            for (std::size_t i = 0; i < count; ++i)
                points[i] = floats(std::array{own[1 + i], own[1 + Curve::capacity + i]});
            return points;
        }
        case Kind::Resource:
            return py::none();
        default:
            return floats(own);
    }
}

void add_effects(py::module_& module) {
    module.def("effects", [] {
        py::list out;
        for (const EffectInfo* const effect : all_effects()) out.append(effect_of(*effect));
        return out;
    });
    module.def("entry_parameters", [] { return rows_of(entry_rows); });
}

}  // namespace darkroom::python
