// SPDX-License-Identifier: MIT
#pragma once
// Kernels written by hand, that the composer's are measured against: the calibration pass, and one kernel with the
// arithmetic of the five effects of the tail. Each runs alone between two barriers, and has what the composer's kernels
// have for such a frame: whole images, its workgroup, its formats.

#include <optional>

#include "bench/measure.hpp"
#include "gpu/kernel/kernel.hpp"
#include "plan/program.hpp"

namespace darkroom::bench {

/// 1 c: copies RGBA16F to RGBA8 by imageLoad.
[[nodiscard]] gpu::KernelSpec calibration_spec();

/// The values of the tail, here and in the chain of effects.
struct TailValues {
    float exposure = 1.3f;
    float vignette_intensity = 0.3f;
    float vignette_smoothness = 2.0f;
    float dither_intensity = 2.0f / 255.0f;
};
/// Exposure, ACES (Narkowicz), vignette, sRGB, dither with the 64x64 tile that `dither` uses; empty: there is none.
[[nodiscard]] gpu::KernelSpec tail_spec(const gpu::Context& context);
/// The table of an effect that has exactly one, or nothing.
[[nodiscard]] std::optional<TableDesc> only_table_of(const EffectInfo& effect);

/// What a pass from the scene to the target moves at least.
[[nodiscard]] double one_pass_bytes(const Bed& bed);
/// A row that runs `spec` from the scene to the target. `table` is its second image, if it has one.
[[nodiscard]] Result<Row> kernel_row(Bed& bed, std::string name, const gpu::KernelSpec& spec, gpu::Stage stage,
                                     std::span<const std::uint32_t> words = {}, const TableDesc* table = nullptr);

// Passes as one writes them by hand for one's own engine: plain GLSL and Vulkan, without the library's kernels, their
// blocks or their regions.

enum class PlainPass : std::uint8_t {
    Copy,  ///< what the calibration pass does
    Tail,  ///< what the tail does, for a picture that is finite: without guards against NaN
};

/// A row that runs it from the scene to the target. `tile` is that of the noise, 64x64 of R32G32B32A32_SFLOAT.
[[nodiscard]] Result<Row> plain_row(Bed& bed, std::string name, PlainPass pass, gpu::Stage stage,
                                    const TailValues& values, const TableDesc& tile);

}  // namespace darkroom::bench
