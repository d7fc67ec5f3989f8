// SPDX-License-Identifier: MIT
#pragma once
// The GLSL that the planner writes around the effects' own: members of blocks, structs, one renamed copy of an effect's
// text for every entry, and the body of a fused kernel. Entries are numbered by their place inside the kernel, so that
// equal kernels have equal text, whatever stack they stand in. Pure text, no device.

#include <array>
#include <darkroom/effect.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/try.hpp"
#include "gpu/kernel/block.hpp"

namespace darkroom::plan {

/// Words of a step in its kernel's block: in a fused kernel those of the entry itself (append_header_members), then the
/// parameters in order without resources.
[[nodiscard]] std::uint32_t parameter_words(const ParamTable& table);
/// Copies the words of a struct, without resources.
void write_parameters(const ParamTable& table, std::span<const std::uint32_t> words, std::span<std::uint32_t> out);

/// "_e3": what every name at file scope of the effect at place 3 of a kernel ends with.
[[nodiscard]] std::string place_suffix(std::uint32_t place);

/// The block of the frame: time and camera.
[[nodiscard]] std::span<const gpu::BlockMember> frame_members();
/// What effects/shared/camera.glsl is made of: five vectors.
using CameraBlock = std::array<float, 28>;
[[nodiscard]] CameraBlock camera_block(const Camera& camera);
/// Do its rays come from one point? frame_ray_flat is 0 then.
[[nodiscard]] bool rays_meet(const Camera& camera);
/// Do things look smaller from farther away? Not to an orthographic camera.
[[nodiscard]] inline bool has_perspective(const Camera& camera) { return camera.projection[11] != 0; }
inline constexpr std::uint32_t frame_words = 4 + std::tuple_size_v<CameraBlock>;

void append_parameter_members(const EffectInfo& info, std::uint32_t place, std::vector<gpu::BlockMember>& out);

/// A choice, toggle or loop count that a lean kernel holds as a literal: the compiler then drops the branches not
/// taken, which some drivers would run on both sides.
struct Baked {
    const ParamInfo* row = nullptr;
    std::uint32_t value = 0;
};

/// An effect's text as one kernel holds it: includes expanded, #line directives set, and its own names (and those of
/// its images) given the suffix of its place, so that two entries of one effect fit one kernel.
struct EffectText {
    std::string glsl;
    std::vector<const ParamInfo*> literal_rows;  ///< that it names and a lean kernel may hold as literals
    bool asks_rays_meet = false;
    bool asks_parameters = false;  ///< calls <effect>_parameters(); a pass that does not has none in its block
};
/// `name`: as own_text of plan/text/effect_files.hpp takes it.
[[nodiscard]] Result<EffectText> effect_text(const EffectInfo& info, std::string_view name, std::uint32_t place,
                                             std::span<const std::string> images);

/// One step of a fused kernel; a pass of an effect has one, itself.
struct FusedStep {
    const EffectInfo* info = nullptr;
    std::uint32_t entry = 0;                 ///< in the stack
    std::uint32_t place = 0;                 ///< in the kernel
    std::string name;                        ///< of the entry
    std::vector<std::string> images;         ///< names that the effect's text calls its images
    std::shared_ptr<const EffectText> text;  ///< none of a merge
    std::string reads;                       ///< of a map or tap: the image that its reading samples
    bool is_layer = false;                   ///< of such: laid over the picture, with opacity, mode and mask
    bool is_second_resampled = false;        ///< its second picture has another size than the kernel's
    bool is_wrapped = false;                 ///< it may get the picture as other numbers: see frame/color.hpp
    bool divides_alpha = false;              ///< it gets the picture's colours without their alpha
    bool is_merge = false;                   ///< only lays image layer_e<place> over the picture
    bool has_mask = false;                   ///< image mask_e<place>
    ConstantsFunction constants = nullptr;   ///< of a pointwise end
    std::uint32_t custom_vectors = 0;
    std::uint32_t first_vector = 0;  ///< of them among the kernel's
    // Of a lean kernel:
    bool is_certain = false;  ///< on: no branch
    bool is_plain = false;    ///< opacity 1, no blending, no mask
    std::vector<Baked> baked;
    std::optional<std::uint32_t> work{};  ///< Work::word
};
/// Of an entry: enabled_, opacity_ and blend_, and those of Work where the step may need it.
void append_header_members(const FusedStep& step, std::vector<gpu::BlockMember>& out);
/// What the target's kernel does last.
enum class Finish : std::uint8_t {
    None,
    EncodeSrgb,
    DecodeSrgb,
    Convert,           ///< from any state of a picture to any other: see Conversion in frame/color.hpp
    OfFrame,           ///< the block's member finish_ says which of the first three
    OfFrameOrConvert,  ///< or which of all
};
/// What it does to the picture's colours before that, and behind it.
struct FinishAlpha {
    bool divides = false, multiplies = false;
    friend bool operator==(const FinishAlpha&, const FinishAlpha&) = default;
};
[[nodiscard]] constexpr bool is_by_frame(Finish finish) { return finish >= Finish::OfFrame; }
/// The members of the block that a finish by the frame reads.
void append_finish_members(Finish finish, std::vector<gpu::BlockMember>& out);
/// How a fused kernel reads a picture that may have another extent than its output.
enum class Resampling : std::uint8_t {
    None,
    Linear,
    Nearest,
    Closest,  ///< of the four texels around, the least red; where custom[0].x is not 0, the most
    Motion,   ///< the nearest, times custom[0]
};
/// The image that a kernel's picture is.
inline constexpr std::string_view picture_name = "picture";
/// Do the first steps read the picture at other places than the pixel's own?
[[nodiscard]] bool is_moved(std::span<const FusedStep> steps);
/// `vec4 NAME(Pixel pixel)`: an image through the maps and taps that read it. `plain`: how it is read where none of
/// them is on, as in the kernel that has none; empty: one always is.
[[nodiscard]] std::string reading_function(std::string_view name, std::string_view image,
                                           std::span<const FusedStep> steps, std::string_view plain);
/// The body of a fused kernel: reads image `picture` (or only its alpha, as a grey picture), applies the steps in
/// order, finishes for the target. `finish_word`: Conversion::word() of a lean kernel.
[[nodiscard]] Result<std::string> fused_body(std::span<const FusedStep> steps, Finish finish, Resampling resampling,
                                             bool is_alpha = false, std::uint32_t finish_word = 0,
                                             FinishAlpha alpha = {});
/// The body of an effect's pass.
[[nodiscard]] std::string pass_body(const FusedStep& step);

}  // namespace darkroom::plan
