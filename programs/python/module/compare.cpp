// SPDX-License-Identifier: MIT
// How far two pictures are apart, as `darkroom compare` measures it.
#include "image/compare/compare.hpp"

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include "arrays.hpp"
#include "parts.hpp"

namespace darkroom::python {

namespace py = pybind11;

namespace {

py::dict compared(const py::object& a, const py::object& b, bool is_linear, double pixels_per_degree) {
    const Picture reference = picture_of(read_layer(a, {.name = "reference"}));
    const Picture test = picture_of(read_layer(b, {.name = "test"}));
    if (reference.width != test.width || reference.height != test.height)
        raise_user(fmt::format("test: {}x{} pixels: allowed is {}x{}, the reference's", test.width, test.height,
                               reference.width, reference.height));
    const FlipDesc desc{.encoding = is_linear ? PictureEncoding::SceneLinear : PictureEncoding::Display,
                        .pixels_per_degree = pixels_per_degree};
    Result<Comparison> made = [&] {
        const py::gil_scoped_release others_run;
        return compare(reference, test, desc);
    }();
    Comparison found = must(std::move(made));
    const VkExtent2D extent{reference.width, reference.height};
    py::dict out;
    out["flip_mean"] = found.flip_mean;
    out["flip_weighted_median"] = found.flip_weighted_median;
    out["flip_max"] = found.flip_max;
    out["psnr"] = found.psnr;
    out["max_error"] = found.max_error;
    out["mean_error"] = found.mean_error;
    out["worst"] = py::make_tuple(found.worst.x, found.worst.y);
    out["non_finite_differences"] = found.non_finite_differences;
    out["flip_map"] = array_of(std::move(found.flip_map.pixels), extent, 3);
    return out;
}

}  // namespace

void add_compare(py::module_& module) { module.def("compare", &compared); }

}  // namespace darkroom::python
