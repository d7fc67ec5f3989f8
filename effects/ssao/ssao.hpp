// SPDX-License-Identifier: MIT
#pragma once
// Ambient occlusion in screen space: corners and contacts darken, as light from all around reaches them less. It sees
// what the depth buffer holds and no more: what lies off the screen or behind something does not occlude.

#include <array>
#include <darkroom/param.hpp>
#include <span>

namespace darkroom {

struct EffectInfo;

enum class SsaoMethod : std::uint32_t {
    Hemisphere,   ///< points in a half ball over the surface, each behind the depth buffer or not
    GroundTruth,  ///< horizons along slices, and the integral between them
};
enum class SsaoResolution : std::uint32_t { Half, Full };
enum class SsaoMerge : std::uint32_t {
    Multiply,   ///< the picture times the occlusion
    Luminance,  ///< bright pixels, which are lit directly, darken less
};

struct Ssao {
    /// Share of the occlusion that darkens the picture. [0, 8]
    float intensity = 1.0f;
    /// Distance up to which surfaces occlude. [0.001, 1000] m
    float radius = 0.5f;
    /// Distance below which a surface does not occlude; it hides the steps of the depth buffer. [0, 100] m
    float bias = 0.025f;
    /// Depth that surfaces reach behind what is seen of them, for ground_truth; 0 has no end. [0, 1000] m
    float thickness = 0.8f;
    /// Number of depth reads for a pixel. [1, 64]
    std::int32_t samples = 16;
    /// Estimator of the occlusion.
    SsaoMethod method = SsaoMethod::GroundTruth;
    /// Size of the occlusion, as a share of each side; half is brought back to full along depth edges.
    SsaoResolution resolution = SsaoResolution::Half;
    /// Formula that darkens the picture by the occlusion.
    SsaoMerge merge = SsaoMerge::Multiply;
    /// Distance at which occlusion begins to fade. [0, 1000000000] m
    float fade_start = 200.0f;
    /// Distance at which occlusion is gone; it must lie beyond `fade_start`. [0.001, 1000000000] m
    float fade_end = 400.0f;
    /// Changes the noise in each frame while time runs, for filters that average frames.
    Toggle moves = false;
};

/// Points of the unit half ball around +z, denser toward its middle: point i of n lies on a random direction at a
/// random share of 0.1 + 0.9 (i / n)^2 (John Chapman, "SSAO Tutorial", 2013). The same for every run.
[[nodiscard]] std::array<std::array<float, 3>, 64> ssao_kernel(std::size_t count);
/// What differs from pixel to pixel, a tile of 4 x 4, row by row: (cosine, sine of the angle that turns the kernel,
/// number of the first slice's direction among 16, share of a step). Each angle once in the tile, and each share once
/// in a row and once in a column (Jimenez et al., "Practical Realtime Strategies for Accurate Indirect Occlusion",
/// 2016).
[[nodiscard]] std::array<std::array<float, 4>, 16> ssao_noise();
/// Where the tile begins in a frame for the ground-truth method, x + 4 y: while time runs, each pixel meets all its
/// texels within 16 frames, and four that lie far apart within four.
[[nodiscard]] std::uint32_t ssao_tile(double time, std::uint64_t frame_index);
/// Into how many sectors the ground-truth method cuts what one side of a slice sees.
inline constexpr std::int32_t ssao_sectors = 31;
/// A thickness that no radius reaches, in metres.
inline constexpr float ssao_endless = 1e6f;
/// Slices of the ground-truth method, and steps to a side of each, that take `samples` reads or fewer (at least two).
[[nodiscard]] std::array<std::int32_t, 2> ssao_slices(std::int32_t samples);

[[nodiscard]] const EffectInfo& effect_info(const Ssao&);

}  // namespace darkroom
