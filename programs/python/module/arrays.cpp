// SPDX-License-Identifier: MIT
#include "arrays.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <memory>
#include <string>

#include "parts.hpp"
#include "plan/text/half.hpp"

namespace darkroom::python {

namespace py = pybind11;

namespace {

std::string shape_text(const py::array& array) {
    const std::vector<py::ssize_t> shape(array.shape(), array.shape() + array.ndim());
    return fmt::format("({})", fmt::join(shape, ", "));
}

std::string allowed_shape(const LayerRules& rules) {
    if (rules.max_channels == 1) return "(height, width)";
    if (rules.min_channels == rules.max_channels) return fmt::format("(height, width, {})", rules.max_channels);
    return fmt::format("(height, width, {} or {})", rules.min_channels, rules.max_channels);
}

const char* shorter_samples(const LayerRules& rules) {
    // Of these the package converts what is missing here.
    if (rules.takes_bytes) return "uint8, uint16, float16, float64 or ";
    return rules.takes_halves ? "float16 or " : "";
}

/// 0: none of those that are allowed.
std::uint32_t sample_bytes(const py::dtype& type, const LayerRules& rules) {
    if (!type.attr("isnative").cast<bool>()) return 0;
    if (type.kind() == 'u' && type.itemsize() == 1 && rules.takes_bytes) return 1;
    if (type.kind() == 'f' && type.itemsize() == 2 && rules.takes_halves) return 2;
    return type.kind() == 'f' && type.itemsize() == 4 ? 4 : 0;
}

template <class T>
py::array owned(std::vector<T> values, const std::vector<py::ssize_t>& shape) {
    auto kept = std::make_unique<std::vector<T>>(std::move(values));
    T* const data = kept->data();
    const py::capsule owner(kept.release(), [](void* vector) { delete static_cast<std::vector<T>*>(vector); });
    return py::array_t<T>(shape, data, owner);
}

template <class T>
py::array picture_array(std::vector<T> values, VkExtent2D extent, std::uint32_t channels) {
    constexpr std::size_t given = 4, opaque = 3;
    const std::size_t pixels = values.size() / given;
    if (channels == opaque) {
        const py::gil_scoped_release others_run;
        T* to = values.data();
        for (const T* from = to; from != values.data() + pixels * given; from += given, to += opaque)
            for (std::size_t c = 0; c < opaque; ++c) to[c] = from[c];
        values.resize(pixels * opaque);
    }
    return owned(std::move(values), {extent.height, extent.width, channels});
}

std::vector<float> four_channels(const Layer& layer) {
    const py::gil_scoped_release others_run;
    const std::size_t pixels = std::size_t{layer.extent.width} * layer.extent.height;
    const auto bytes = layer.samples<std::uint8_t>();
    const auto halves = layer.samples<std::uint16_t>();
    const auto floats = layer.samples<float>();
    const auto sample = [&](std::size_t at) {
        if (!bytes.empty()) return static_cast<float>(bytes[at]) / 255.0F;
        return halves.empty() ? floats[at] : half_to_float(halves[at]);
    };
    std::vector<float> out(pixels * 4, 1.0F);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < layer.channels; ++c) out[i * 4 + c] = sample(i * layer.channels + c);
    return out;
}

}  // namespace

Layer read_layer(const py::object& object, const LayerRules& rules) {
    if (!py::isinstance<py::array>(object))
        raise_user(fmt::format("{}: a {}: allowed is a numpy array, or what exports one (__dlpack__, __array__)",
                               rules.name, std::string(py::str(py::type::of(object).attr("__name__")))));
    auto array = py::reinterpret_borrow<py::array>(object);
    const std::uint32_t bytes = sample_bytes(array.dtype(), rules);
    if (bytes == 0)
        raise_user(fmt::format("{}: dtype {}: allowed is {}float32", rules.name, std::string(py::str(array.dtype())),
                               shorter_samples(rules)));
    const bool is_flat = array.ndim() == 2 && rules.min_channels == 1;
    py::ssize_t channels = is_flat ? 1 : 0;
    if (array.ndim() == 3) channels = array.shape(2);
    if (channels < rules.min_channels || channels > rules.max_channels || array.shape(0) < 1 || array.shape(1) < 1)
        raise_user(fmt::format("{}: shape {}: allowed is {}, none of them 0", rules.name, shape_text(array),
                               allowed_shape(rules)));
    const py::ssize_t longest = std::max(array.shape(0), array.shape(1));
    constexpr py::ssize_t most = 1 << 24;  // far beyond any device's, which says so itself
    if (longest > most)
        raise_user(fmt::format("{}: shape {}: allowed are sides up to {}", rules.name, shape_text(array), most));
    if ((array.flags() & py::array::c_style) == 0) array = py::array::ensure(array, py::array::c_style);
    return {.array = array,
            .extent = {static_cast<std::uint32_t>(array.shape(1)), static_cast<std::uint32_t>(array.shape(0))},
            .channels = static_cast<std::uint32_t>(channels),
            .sample_bytes = bytes};
}

Picture picture_of(const Layer& layer) {
    Picture out;
    out.width = layer.extent.width;
    out.height = layer.extent.height;
    out.pixels = four_channels(layer);
    return out;
}

ResourceImage image_of(const Layer& layer) { return {layer.extent.width, layer.extent.height, four_channels(layer)}; }

py::array array_of(std::vector<std::uint8_t> values, VkExtent2D extent, std::uint32_t channels) {
    return picture_array(std::move(values), extent, channels);
}

py::array array_of(std::vector<float> values, VkExtent2D extent, std::uint32_t channels) {
    return picture_array(std::move(values), extent, channels);
}

py::array array_of(std::vector<float> values, std::vector<py::ssize_t> shape) {
    return owned(std::move(values), shape);
}

}  // namespace darkroom::python
