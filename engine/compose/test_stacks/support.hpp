// SPDX-License-Identifier: MIT
#pragma once
// What tests of effects and chains share: pictures to try, a whole develop on the test device, and the measure by which
// GPU and reference are compared. Not part of the library.

#include <array>
#include <darkroom/composer.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/reference.hpp>
#include <functional>
#include <span>

namespace darkroom::test {

/// Random HDR: mid-tones, negative, huge (to 60000), and values that are denormal in half precision. Same bits on every
/// machine for the same number.
[[nodiscard]] ReferenceImage random_hdr(std::uint32_t width, std::uint32_t height, std::uint32_t number);
/// Random colours in [0,1].
[[nodiscard]] ReferenceImage random_display(std::uint32_t width, std::uint32_t height, std::uint32_t number);
[[nodiscard]] ReferenceImage uniform(std::uint32_t width, std::uint32_t height, Rgba color);

struct RunOptions {
    KernelStage kernels = KernelStage::Auto;
    bool fuse = true;
    VkFormat color = VK_FORMAT_R32G32B32A32_SFLOAT;
    VkFormat target = VK_FORMAT_R32G32B32A32_SFLOAT;
    std::optional<Domain> target_domain = Domain::Encoded;  ///< Encoded: nothing is skipped
    bool is_color_associated = false;
    std::optional<ColorState> target_color{};  ///< in place of target_domain
    VkFormat intermediate = VK_FORMAT_R32G32B32A32_SFLOAT;
    double time = 0;
    std::uint64_t frame_index = 0;
    bool wait_for_lean_kernels = true;
    // What scene-aware effects read; the pictures are of the size of the colour, red (or red, green, blue) counts.
    const ReferenceImage* depth = nullptr;
    VkFormat depth_format = VK_FORMAT_R32_SFLOAT;
    bool is_depth_planar = true;
    const ReferenceImage* normals = nullptr;
    const ReferenceImage* ui = nullptr;
    VkFormat ui_format = VK_FORMAT_R8G8B8A8_UNORM;
    Camera camera{.depth = DepthKind::Planar};
    std::span<const ReferenceLight> lights;
};
/// Builds a stack with `fill`, develops `picture` with it on the test device, under validation, and reads the target
/// back. A failure, or a message of the validation layer, fails the test and returns an empty image. The input is
/// rounded to options.color first; round it yourself (round_to_half) before computing a reference.
[[nodiscard]] ReferenceImage develop(const std::function<void(Composer&)>& fill, const ReferenceImage& picture,
                                     const RunOptions& options = {});
/// The reference alone: one effect.
template <class Effect>
[[nodiscard]] ReferenceImage reference_of(const Effect& parameters, const ReferenceImage& picture,
                                          const ReferenceImage* second = nullptr) {
    return effect_info(parameters).reference(&parameters, {.picture = &picture, .source = &picture, .second = second});
}

/// The reference of one effect with what RunOptions brings.
template <class Effect>
[[nodiscard]] ReferenceImage scene_reference_of(const Effect& parameters, const ReferenceImage& picture,
                                                const RunOptions& options) {
    return effect_info(parameters)
        .reference(&parameters, {.picture = &picture,
                                 .source = &picture,
                                 .depth = options.depth,
                                 .normals = options.normals,
                                 .lights = options.lights,
                                 .camera = options.camera,
                                 .time = options.time,
                                 .frame_index = options.frame_index});
}

/// A camera at `eye` looking at `target`, with planar depth: vertical field of view in radians, near 0.1, far 1000.
[[nodiscard]] Camera look_at(const std::array<double, 3>& eye, const std::array<double, 3>& target,
                             double field_of_view_rad, double aspect);

[[nodiscard]] ReferenceImage round_to_half(const ReferenceImage& image);
[[nodiscard]] ReferenceImage round_to_float(const ReferenceImage& image);

/// Largest difference in units in the last place of half precision, taken at max(|reference|, 2^-10), the reference
/// clamped to +-65504; NaN or infinity in `gpu` counts as 1e9. One test for every pointwise effect: <= 2.
[[nodiscard]] double worst_half_ulps(const ReferenceImage& gpu, const ReferenceImage& reference);
/// Largest absolute difference of any channel.
[[nodiscard]] double worst_difference(const ReferenceImage& a, const ReferenceImage& b);
/// The same, beyond what `allowance` has for that channel of that pixel.
[[nodiscard]] double worst_difference(const ReferenceImage& a, const ReferenceImage& b,
                                      const ReferenceImage& allowance);
/// What a fetch that is filtered along both axes may be wrong by on the test device, for each texel of `picture` that
/// it mixes: filter_step (gpu/test_support.hpp) of the span of the texels around, per axis; black on lavapipe. The
/// reference of an effect that is linear in its picture makes of this what the effect's result may be wrong by. With
/// `pixels_beside` the fetch may also be so far beside its place.
[[nodiscard]] ReferenceImage filter_loss(const ReferenceImage& picture, double pixels_beside = 0);

/// GPU against reference on random HDR input, both stages, and both stages against each other bit for bit (software
/// driver; one 8-bit code elsewhere). What every pointwise effect's test calls, for several parameter sets.
template <class Effect>
void expect_gpu_matches_reference(const Effect& parameters, const ReferenceImage& picture, double ulps = 2.0);
void expect_gpu_matches_reference(const EffectInfo& info, const void* parameters, const ReferenceImage& picture,
                                  double ulps);

template <class Effect>
void expect_gpu_matches_reference(const Effect& parameters, const ReferenceImage& picture, double ulps) {
    expect_gpu_matches_reference(effect_info(parameters), &parameters, picture, ulps);
}

}  // namespace darkroom::test
