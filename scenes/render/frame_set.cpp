// SPDX-License-Identifier: MIT
#include "render/frame_set.hpp"

#include <array>

namespace darkroom::render {

Result<gpu::SetLayout> create_frame_layout(gpu::Context& context) {
    std::array<gpu::SetLayout::Binding, frame_bindings> bindings{};
    for (std::size_t i = 0; i < 3; ++i) bindings[i].type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    for (std::size_t i = 3; i < 8; ++i) bindings[i].type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    bindings[8].count = shadow_images;
    return gpu::SetLayout::create(context, bindings);
}

std::vector<gpu::ColorTarget> TargetFormats::colors(const gpu::ColorTarget& color_blend, Layers layers) const {
    std::vector<gpu::ColorTarget> out{color_blend};
    out[0].format = color;
    if (has_layers) {
        const VkColorComponentFlags writes = layers == Layers::Written ? gpu::ColorTarget{}.writes : 0;
        out.push_back({.format = normals, .writes = writes});
        out.push_back({.format = velocity, .writes = writes});
    }
    return out;
}

}  // namespace darkroom::render
