// SPDX-License-Identifier: MIT
#include "plan/frame_inputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gpu/resource/formats.hpp"

namespace darkroom::plan {

bool can_hold_depth(VkFormat format) {
    return gpu::is_depth(format) || format == VK_FORMAT_R32_SFLOAT || format == VK_FORMAT_R16_SFLOAT ||
           format == VK_FORMAT_R16_UNORM;
}

bool can_hold_ui(VkFormat format) {
    return format != VK_FORMAT_A2B10G10R10_UNORM_PACK32 && format != VK_FORMAT_A2R10G10B10_UNORM_PACK32;
}

bool bring_the_same(const CompileDesc& a, const CompileDesc& b) {
    return a.color == b.color && a.has_shadows == b.has_shadows && a.is_depth_planar == b.is_depth_planar &&
           a.is_velocity_plain == b.is_velocity_plain &&
           std::ranges::all_of(frame_inputs, [&](const FrameInput& input) {
               return input.use == nullptr || a.*input.use == b.*input.use;
           });
}

namespace {

/// Along one side: the texel under a pixel's centre, and the two around it with the weight of the second.
struct Around {
    std::int64_t nearest = 0, low = 0, high = 0;
    double weight = 0;
};
Around around(std::int64_t pixel, std::int64_t made, std::int64_t given) {
    const std::int64_t twice = 2 * made, place = (2 * pixel + 1) * given - made;
    const std::int64_t low = (place + twice) / twice - 1, rest = place - low * twice;
    return {(2 * pixel + 1) * given / twice, low, low + (rest != 0 ? 1 : 0),
            static_cast<double>(rest) / static_cast<double>(twice)};
}

}  // namespace

ReferenceImage resampled_reference(const ReferenceImage& image, const FrameInput& input, std::uint32_t width,
                                   std::uint32_t height) {
    ReferenceImage out(width, height);
    // Distances are planar here and motions in pixels, whatever the host's are.
    const double wider = 1.0 * width / image.width, higher = 1.0 * height / image.height;
    for (std::uint32_t j = 0; j < height; ++j)
        for (std::uint32_t i = 0; i < width; ++i) {
            const Around x = around(i, width, image.width), y = around(j, height, image.height);
            const Rgba nearest = image.clamped(x.nearest, y.nearest);
            const std::array four{image.clamped(x.low, y.low), image.clamped(x.high, y.low),
                                  image.clamped(x.low, y.high), image.clamped(x.high, y.high)};
            const auto mixed = [&](double Rgba::*c) {
                const double above = std::lerp(four[0].*c, four[1].*c, x.weight);
                return std::lerp(above, std::lerp(four[2].*c, four[3].*c, x.weight), y.weight);
            };
            Rgba& pixel = out.at(i, j);
            pixel = nearest;
            if (input.resampling == Resampling::Closest) pixel = *std::ranges::min_element(four, {}, &Rgba::r);
            if (input.resampling == Resampling::Motion)
                pixel = {nearest.r * wider, nearest.g * higher, nearest.b, nearest.a};
            if (input.resampling == Resampling::Linear)
                pixel = {mixed(&Rgba::r), mixed(&Rgba::g), mixed(&Rgba::b), mixed(&Rgba::a)};
        }
    return out;
}

namespace {

/// docs/embedding.md quotes how a frame brings them.
[[maybe_unused]] Frame usage_frame_inputs(const ImageRef& hdr, const ImageRef& depth, const ImageRef& velocity,
                                          const ImageRef& target, Camera camera, const Light& sun, double seconds,
                                          std::uint64_t frame_index) {
    camera.depth = darkroom::DepthKind::Reversed;             // 1 near, 0 far
    camera.velocity.unit = darkroom::VelocityKind::Unit::Uv;  // from here to where it was; the picture is 1 wide
    const darkroom::Frame frame{.color = hdr,
                                .depth = depth,
                                .velocity = velocity,
                                .camera = camera,
                                .lights = {&sun, 1},
                                .time = seconds,
                                .frame_index = frame_index,
                                .target = target};
    return frame;
}

}  // namespace

}  // namespace darkroom::plan
