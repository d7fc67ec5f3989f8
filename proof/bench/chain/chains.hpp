// SPDX-License-Identifier: MIT
#pragma once
// The stacks that are measured, as small looks: names of effects and values, found in the registry, so that a build
// without one of them measures the rest.

#include <darkroom/effects.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/measure.hpp"
#include "hand_written.hpp"

namespace darkroom::bench {

/// One entry of a stack; its source is the scene, and so is its second picture where nothing else is said.
struct Step {
    const EffectInfo* effect = nullptr;
    std::vector<std::uint32_t> words;
    bool is_on = true;
    bool joins_scene = false;  ///< its picture is the scene, and its second picture the step before
};
using Stack = std::vector<Step>;

/// Exposure, ACES (Narkowicz), vignette, sRGB, dither. Empty where this build lacks one of them.
[[nodiscard]] Stack tail_stack(const TailValues& values);
/// The effect of the tail that brings the tile of noise.
[[nodiscard]] const EffectInfo* tail_noise_effect();
/// The same with the interface over it, before the dither: its whole chain, neutral, or with warp, chroma and echo on.
[[nodiscard]] Stack ui_tail_stack(const TailValues& values, bool is_neutral);
/// The same with fog at its place in the documented order, after the tone mapping.
[[nodiscard]] Stack foggy_tail_stack(const TailValues& values);
/// The same with a colour table before the encoding, a cube of 33.
[[nodiscard]] Stack graded_tail_stack(const TailValues& values);
/// For a display of high range: exposure, BT.2390 to 1000 cd/m2, vignette; the target makes PQ of its light.
[[nodiscard]] Stack high_range_tail_stack(const TailValues& values);
/// Bloom at five levels.
[[nodiscard]] Stack bloom_stack();
/// A Gaussian blur alone; `resolution`: automatic or full.
[[nodiscard]] Stack gaussian_stack(double radius, const std::string& resolution);
/// The shipped look of bloom in plain steps: high pass, blur, blend, then exposure, tone mapping, encoding.
[[nodiscard]] Stack plain_bloom_stack();
/// Ambient occlusion alone.
[[nodiscard]] Stack ssao_stack(const std::string& method, const std::string& resolution);
/// Motion blur alone.
[[nodiscard]] Stack motion_blur_stack(const std::string& resolution);
[[nodiscard]] Stack depth_of_field_stack(const std::string& resolution);
/// The flat table with nothing written in it, in its documented order; keeps_what_is_off as in ApplyOptions.
[[nodiscard]] Stack flat_stack(bool keeps_what_is_off);
/// The same as looks have it.
[[nodiscard]] Stack default_stack();
/// The same with the vignette on: with the world, ambient occlusion, bloom, exposure, ACES, encode, vignette. Its
/// occlusion is the documented one, unless another method is named.
[[nodiscard]] Stack documented_stack(const std::string& ssao_method = "hemisphere");
/// One effect at its defaults; where these change nothing, at the next values that do.
[[nodiscard]] Stack single_stack(const EffectInfo& effect);

struct ChainDesc {
    KernelStage kernels = KernelStage::Auto;
    bool fuse = true;
    bool has_timers = false;
    WorldUse world = WorldUse::None;
    std::optional<ColorState> target_color{};
};
/// A compiled stack, with its leaner kernels.
struct Chain {
    std::shared_ptr<Composer> composer;
    Plan plan;
    CompileDesc compiled_for;
    WorldUse world = WorldUse::None;
};
[[nodiscard]] Result<Chain> compile_chain(Bed& bed, const Stack& stack, const ChainDesc& desc = {});
[[nodiscard]] Row chain_row(Bed& bed, std::string name, const Chain& chain);
void fill(Composer& composer, const Stack& stack);

}  // namespace darkroom::bench
