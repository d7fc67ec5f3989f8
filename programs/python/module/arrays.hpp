// SPDX-License-Identifier: MIT
#pragma once
// numpy arrays as what the library reads, and pictures as numpy arrays. An array whose rows lie one after the other is
// read where it is; another one is copied first.

#include <pybind11/numpy.h>
#include <vulkan/vulkan.h>

#include <cstdint>
#include <darkroom/resource.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "image/picture/picture.hpp"

namespace darkroom::python {

/// Height x width x channels; of one channel also height x width.
struct Layer {
    pybind11::array array;  ///< keeps what `data` refers to
    VkExtent2D extent{};
    std::uint32_t channels = 0;
    std::uint32_t sample_bytes = 0;  ///< 1: uint8, 2: float16, 4: float32

    [[nodiscard]] std::size_t count() const { return std::size_t{extent.width} * extent.height * channels; }
    /// Empty where its samples are others.
    template <class T>
    [[nodiscard]] std::span<const T> samples() const {
        if (sizeof(T) != sample_bytes) return {};
        return {static_cast<const T*>(array.data()), count()};
    }
};

/// `name` is what errors call it.
struct LayerRules {
    std::string_view name;
    std::uint32_t min_channels = 3, max_channels = 4;
    bool takes_bytes = true, takes_halves = true;
};

[[nodiscard]] Layer read_layer(const pybind11::object& object, const LayerRules& rules);

/// The picture of an array: bytes / 255, floats as they are; alpha is 1 where it has none.
[[nodiscard]] Picture picture_of(const Layer& layer);
[[nodiscard]] ResourceImage image_of(const Layer& layer);

/// Height x width x channels of a picture with four; with four the array owns the vector, with three it is packed.
[[nodiscard]] pybind11::array array_of(std::vector<std::uint8_t> values, VkExtent2D extent, std::uint32_t channels);
[[nodiscard]] pybind11::array array_of(std::vector<float> values, VkExtent2D extent, std::uint32_t channels);
/// Of any shape, row-major: the array owns the vector.
[[nodiscard]] pybind11::array array_of(std::vector<float> values, std::vector<pybind11::ssize_t> shape);

}  // namespace darkroom::python
