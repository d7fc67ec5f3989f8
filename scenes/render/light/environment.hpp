// SPDX-License-Identifier: MIT
#pragma once
// Light from a skybox: its irradiance as nine spherical harmonics (Ramamoorthi and Hanrahan, "An Efficient
// Representation for Irradiance Environment Maps", 2001), its mirror images by roughness as mip levels, and the
// split-sum table of the BRDF (Karis, "Real Shading in Unreal Engine 4", 2013). Directions map to the picture as
// u = atan2(x, -z) / 2 pi + 0.5, v = 0.5 - asin(y) / pi. Made on the CPU, on several threads, once a skybox.

#include <array>
#include <optional>
#include <vector>

#include "gpu/resource/resources.hpp"
#include "image/picture/picture.hpp"
#include "scene/math.hpp"

namespace darkroom::render {

[[nodiscard]] scene::vec2 direction_to_uv(scene::vec3 direction);
[[nodiscard]] scene::vec3 uv_to_direction(scene::vec2 uv);

/// At another size, every pixel the mean of what it covers on the sphere. A larger one repeats pixels.
[[nodiscard]] Picture resampled(const Picture& sky, std::uint32_t width, std::uint32_t height);

/// Convolved with the clamped cosine and divided by pi, so that a white diffuse surface of normal n shows
/// sum c_i * Y_i(n); order: Y00, Y1-1 (y), Y10 (z), Y11 (x), Y2-2 (xy), Y2-1 (yz), Y20 (3zz - 1), Y21 (xz), Y22 (xx -
/// yy).
[[nodiscard]] std::array<scene::vec3, 9> irradiance_harmonics(const Picture& skybox);

/// Level 0: roughness 0; the last: 1. Each a Picture half as large as the one before. `width`: a power of two. Costs a
/// quarter of a second for (256, 6); more levels or pixels soon cost seconds.
[[nodiscard]] std::vector<Picture> prefilter(const Picture& skybox, std::uint32_t width, std::uint32_t levels);

/// `size` squared, red and green: scale and bias of F0 for n.v (x) and roughness (y), at the centres of texels.
[[nodiscard]] Picture split_sum_table(std::uint32_t size);

/// The three images of set 0 (bindings 9, 10, 11) and the harmonics. Without a skybox: 1x1 black ones.
class GpuEnvironment {
  public:
    GpuEnvironment() = default;
    [[nodiscard]] static Result<GpuEnvironment> create(gpu::Context& context, const std::optional<Picture>& skybox);
    GpuEnvironment(GpuEnvironment&&) noexcept;
    GpuEnvironment& operator=(GpuEnvironment&&) noexcept;
    ~GpuEnvironment();

    gpu::Image prefiltered, skybox, split_sum;  ///< in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
    VkSampler sampler = VK_NULL_HANDLE;         ///< linear, mips linear, repeats u, clamps v
    std::array<scene::vec3, 9> irradiance{};
    std::uint32_t levels = 1;
    bool is_given = false;
    gpu::Context* context = nullptr;
};

}  // namespace darkroom::render
