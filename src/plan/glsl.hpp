// SPDX-License-Identifier: MIT
#pragma once
// The GLSL that the planner writes around the effects' own: parameter blocks, structs, one renamed copy of an effect's
// text for every entry, and the body of a fused kernel. Pure text, no device.

#include <array>
#include <darkroom/effect.hpp>
#include <darkroom/result.hpp>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace darkroom::plan {

/// Words of an entry's block on the GPU: three of the entry itself (enabled, opacity, blend), then the parameters in
/// order without resources.
inline constexpr std::uint32_t entry_header_words = 3;
[[nodiscard]] std::uint32_t block_words(const ParamTable& table);
/// Copies the parameter words of a struct to its block.
void write_block(const ParamTable& table, std::span<const std::uint32_t> words, std::span<std::uint32_t> block);

/// "_e3": what every name at file scope of entry 3's effect ends with in a kernel.
[[nodiscard]] std::string entry_suffix(std::uint32_t entry);

/// Members of the constants block: scalars only, so C++ and std430 agree without padding; offsets are explicit.
[[nodiscard]] std::string frame_members();
/// What effects/shared/camera.glsl is made of: five vectors.
using CameraBlock = std::array<float, 28>;
[[nodiscard]] CameraBlock camera_block(const Camera& camera);
inline constexpr std::uint32_t frame_words = 4 + std::tuple_size_v<CameraBlock>;
[[nodiscard]] std::string entry_members(const EffectInfo& info, std::uint32_t entry, std::uint32_t first_word);

/// The struct that a curve is in GLSL.
[[nodiscard]] std::string curve_struct();
/// `struct Bloom { float intensity; ... };` and a constant for every choice: Bloom_mode_additive.
[[nodiscard]] std::string parameter_struct(const ParamTable& table);
/// A choice, toggle or loop count that a lean kernel holds as a literal: the compiler then drops the branches not
/// taken, which some drivers would run on both sides.
struct Baked {
    const ParamInfo* row = nullptr;
    std::uint32_t value = 0;
};
/// `Bloom bloom_parameters_e3() { return Bloom(bloom_e3_intensity, ...); }`
[[nodiscard]] std::string parameter_loader(const EffectInfo& info, std::uint32_t entry,
                                           std::span<const Baked> baked = {});

/// An effect's file with its includes expanded, #line directives set, and its own names (and `also`) given the entry's
/// suffix, so that two entries of one effect fit one kernel.
[[nodiscard]] Result<std::string> instance_text(const EffectInfo& info, std::string_view file, std::uint32_t entry,
                                                std::span<const std::string> also = {});

/// One step of a fused kernel.
struct FusedStep {
    const EffectInfo* info = nullptr;
    std::uint32_t entry = 0;
    std::string name;                ///< of the entry
    std::vector<std::string> sides;  ///< names that the effect's text calls its side images
    bool is_merge = false;           ///< only lays image layer_e<entry> over the picture
    bool has_mask = false;           ///< image mask_e<entry>
    // Of a lean kernel:
    bool is_certain = false;  ///< on: no branch
    bool is_plain = false;    ///< opacity 1, no blending, no mask
    std::vector<Baked> baked;
};
/// What the target's kernel does last. OfFrame: the block's member finish_ says which of the others.
enum class Finish : std::uint8_t { None, EncodeSrgb, DecodeSrgb, OfFrame };
/// The member of the block that Finish::OfFrame reads.
[[nodiscard]] std::string finish_member(std::uint32_t word);
/// How a fused kernel reads a picture that may have another extent than its output.
enum class Resampling : std::uint8_t { None, Linear, Nearest };
/// The body of a fused kernel: reads image `picture`, applies the steps in order, finishes for the target.
[[nodiscard]] Result<std::string> fused_body(std::span<const FusedStep> steps, Finish finish, Resampling resampling);

}  // namespace darkroom::plan
