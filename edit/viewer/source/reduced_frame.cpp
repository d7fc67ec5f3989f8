// SPDX-License-Identifier: MIT
#include "reduced_frame.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace app {

namespace {

std::uint16_t half_of(std::uint16_t number) {
    constexpr unsigned exponent = 0x7c00U, least = 0x0400U, sign = 0x8000U, rest = 0x07ffU;
    const unsigned size = number & exponent;
    if (size == exponent) return number;
    if (size > least) return static_cast<std::uint16_t>(number - least);
    return static_cast<std::uint16_t>((number & sign) | ((number & rest) >> 1U));
}

/// The pixel in the middle of each square.
template <class Number>
std::vector<Number> reduced(std::span<const Number> from, VkExtent2D extent, VkExtent2D small, std::uint32_t divisor) {
    std::vector<Number> out;
    if (from.empty()) return out;
    const std::size_t parts = from.size() / (std::size_t{extent.width} * extent.height);
    out.reserve(parts * small.width * small.height);
    for (std::uint32_t y = 0; y < small.height; ++y)
        for (std::uint32_t x = 0; x < small.width; ++x) {
            const std::size_t row = std::min(y * divisor + divisor / 2, extent.height - 1);
            const std::size_t column = std::min(x * divisor + divisor / 2, extent.width - 1);
            const auto first = from.begin() + static_cast<std::ptrdiff_t>((row * extent.width + column) * parts);
            out.insert(out.end(), first, first + static_cast<std::ptrdiff_t>(parts));
        }
    return out;
}

}  // namespace

ReducedFrame::ReducedFrame(const darkroom::DevelopInput& input, std::uint32_t divisor)
    : input_(input), layers_(darkroom::layers_of(input)) {
    const VkExtent2D full = input.extent;
    input_.extent = {(full.width + divisor - 1) / divisor, (full.height + divisor - 1) / divisor};
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        darkroom::UploadLayer& layer = layers_[i];
        // The exposure is one number, whatever the frame's size.
        if (layer.extent.width != full.width || layer.extent.height != full.height) continue;
        layer.extent = input_.extent;
        Kept& kept = kept_[i];
        kept = {.values = reduced(layer.values, full, input_.extent, divisor),
                .halves = reduced(layer.halves, full, input_.extent, divisor),
                .bytes = reduced(layer.bytes, full, input_.extent, divisor),
                .codes = reduced(layer.codes, full, input_.extent, divisor)};
        // Motion is in pixels.
        if (std::string_view(layer.name) == "velocity") {
            // Numbers that are kept as halves stay some: their least one is 2^-24.
            for (float& number : kept.values)
                number = layer.is_half ? std::round(number / static_cast<float>(divisor) * 0x1p24F) * 0x1p-24F
                                       : number / static_cast<float>(divisor);
            for (std::uint32_t step = divisor; step > 1; step /= 2)
                for (std::uint16_t& number : kept.halves) number = half_of(number);
        }
        layer.values = kept.values;
        layer.halves = kept.halves;
        layer.bytes = kept.bytes;
        layer.codes = kept.codes;
    }
}

}  // namespace app
