// SPDX-License-Identifier: MIT
#include "small_frame.hpp"

#include <glm/gtc/packing.hpp>
#include <string_view>

namespace app {

namespace {

/// Replaces what is given by the pixels that are kept.
template <class Number>
void keep(std::span<const Number>& of, std::vector<Number>& kept, VkExtent2D whole, VkExtent2D small) {
    if (of.empty()) return;
    const std::size_t parts = of.size() / (std::size_t{whole.width} * whole.height);
    kept.reserve(parts * small.width * small.height);
    for (std::size_t y = 0; y < small.height; ++y)
        for (std::size_t x = 0; x < small.width; ++x) {
            const std::size_t row = (2 * y + 1) * whole.height / (2 * std::size_t{small.height});
            const std::size_t column = (2 * x + 1) * whole.width / (2 * std::size_t{small.width});
            const auto first = of.begin() + static_cast<std::ptrdiff_t>((row * whole.width + column) * parts);
            kept.insert(kept.end(), first, first + static_cast<std::ptrdiff_t>(parts));
        }
    of = kept;
}

}  // namespace

SmallFrame::SmallFrame(const darkroom::DevelopInput& input, VkExtent2D extent)
    : input_(input), layers_(darkroom::layers_of(input)) {
    const VkExtent2D whole = input.extent;
    // Motion and jitter are in pixels.
    const std::array shorter{static_cast<float>(extent.width) / static_cast<float>(whole.width),
                             static_cast<float>(extent.height) / static_cast<float>(whole.height)};
    for (std::size_t axis = 0; axis < shorter.size(); ++axis) {
        input_.camera.jitter[axis] *= shorter[axis];
        input_.camera.previous_jitter[axis] *= shorter[axis];
    }
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        darkroom::UploadLayer& layer = layers_[i];
        Kept& kept = kept_[i];
        // One texel for the whole frame stays.
        if (!layer.is_given() || layer.extent.width != whole.width || layer.extent.height != whole.height) continue;
        layer.extent = extent;
        keep(layer.values, kept.values, whole, extent);
        keep(layer.halves, kept.halves, whole, extent);
        keep(layer.bytes, kept.bytes, whole, extent);
        keep(layer.codes, kept.codes, whole, extent);
        if (std::string_view(layer.name) != "velocity") continue;
        for (std::size_t at = 0; at < kept.values.size(); ++at) kept.values[at] *= shorter[at % 2];
        for (std::size_t at = 0; at < kept.halves.size(); ++at)
            kept.halves[at] = glm::packHalf1x16(glm::unpackHalf1x16(kept.halves[at]) * shorter[at % 2]);
        // What was half before it was scaled may be none now, and the image stays one of halves.
        if (!layer.is_half || kept.values.empty()) continue;
        for (const float number : kept.values) kept.halves.push_back(glm::packHalf1x16(number));
        layer.values = {};
        layer.halves = kept.halves;
    }
    input_.extent = extent;
    const auto& [color, depth, normals, velocity, reactive, transparency, exposure, ui] = layers_;
    input_.color = color.values;
    input_.color_halves = color.halves;
    input_.color_codes = color.codes;
    input_.depth = depth.values;
    input_.normals = normals.values;
    input_.normal_halves = normals.halves;
    input_.velocity = velocity.values;
    input_.velocity_halves = velocity.halves;
    input_.reactive = reactive.values;
    input_.transparency = transparency.values;
    input_.exposure = exposure.values;
    input_.ui = ui.bytes;
}

}  // namespace app
