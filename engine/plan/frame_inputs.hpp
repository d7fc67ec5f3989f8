// SPDX-License-Identifier: MIT
#pragma once
// What a frame may bring beside its colour: a row for each, and no other list of them. A further one is a row here, a
// name in FrameImage, and a field each in Frame, in CompileDesc and, for CPU references, in ReferenceInput.

#include <array>
#include <darkroom/composer.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/reference.hpp>
#include <string>
#include <string_view>

#include "plan/text/glsl.hpp"

namespace darkroom::plan {

/// Whose extent an image has.
enum class InputExtent : std::uint8_t { Scene, Interface, Texel };

struct FrameInput {
    FrameImage image{};
    std::string_view name;                                       ///< in needs, plans, errors and files
    std::string_view shown;                                      ///< in sentences
    std::string_view shader_name;                                ///< in custom effects
    ImageRef Frame::*given = nullptr;                            ///< null: it comes with the lights
    ImageUse CompileDesc::*use = nullptr;                        ///< null: CompileDesc::has_shadows tells
    const ReferenceImage* ReferenceInput::*reference = nullptr;  ///< null: references do not read it by itself
    /// Where frames lack it, or nobody makes what is made of it.
    PassVector neutral{};
    bool is_optional = false;  ///< `neutral` stands in; else effects that need it are left out
    InputExtent extent = InputExtent::Scene;
    /// At another extent. These are not interpolated: no value between two distances, directions or motions is true.
    Resampling resampling = Resampling::Nearest;
    VkFormat resampled = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< UNDEFINED: CompileDesc::intermediate
    bool (*can_hold)(VkFormat) = nullptr;                ///< null: any that can be sampled
    std::string_view allowed{};                          ///< behind "allowed", in an error
};

[[nodiscard]] bool can_hold_depth(VkFormat format);
[[nodiscard]] bool can_hold_ui(VkFormat format);

inline constexpr std::array<FrameInput, frame_image_count> frame_inputs{{
    {.image = FrameImage::Depth,
     .name = "depth",
     .shown = "depth",
     .shader_name = "frame_depth",
     .given = &Frame::depth,
     .use = &CompileDesc::depth,
     .reference = &ReferenceInput::depth,
     .neutral = {1e10f, 0, 0, 0},
     .resampling = Resampling::Closest,
     .resampled = VK_FORMAT_R32_SFLOAT,
     .can_hold = can_hold_depth,
     .allowed = "are depth formats, R32_SFLOAT, R16_SFLOAT and R16_UNORM"},
    {.image = FrameImage::Normals,
     .name = "normals",
     .shown = "normals",
     .shader_name = "frame_normals",
     .given = &Frame::normals,
     .use = &CompileDesc::normals,
     .reference = &ReferenceInput::normals},
    {.image = FrameImage::Velocity,
     .name = "velocity",
     .shown = "velocity",
     .shader_name = "frame_velocity",
     .given = &Frame::velocity,
     .use = &CompileDesc::velocity,
     .reference = &ReferenceInput::velocity,
     .resampling = Resampling::Motion},
    {.image = FrameImage::Shadows, .name = "shadows", .shown = "shadows", .shader_name = "frame_shadow"},
    {.image = FrameImage::Ui,
     .name = "ui",
     .shown = "a UI image",
     .shader_name = "frame_ui",
     .given = &Frame::ui,
     .use = &CompileDesc::ui,
     .extent = InputExtent::Interface,
     .resampling = Resampling::Linear,
     .resampled = VK_FORMAT_UNDEFINED,
     .can_hold = can_hold_ui,
     .allowed = "is what has 8 bits of alpha and more"},
    {.image = FrameImage::Reactive,
     .name = "reactive",
     .shown = "a reactive mask",
     .shader_name = "frame_reactive",
     .given = &Frame::reactive,
     .use = &CompileDesc::reactive,
     .reference = &ReferenceInput::reactive,
     .is_optional = true,
     .resampling = Resampling::Linear,
     .resampled = VK_FORMAT_R16_SFLOAT},
    {.image = FrameImage::Transparency,
     .name = "transparency",
     .shown = "the colour before transparency",
     .shader_name = "frame_transparency",
     .given = &Frame::transparency,
     .use = &CompileDesc::transparency,
     .reference = &ReferenceInput::transparency,
     .is_optional = true,
     .resampling = Resampling::Linear,
     .resampled = VK_FORMAT_UNDEFINED},
    {.image = FrameImage::Exposure,
     .name = "exposure",
     .shown = "an exposure",
     .shader_name = "frame_exposure",
     .given = &Frame::exposure,
     .use = &CompileDesc::exposure,
     .reference = &ReferenceInput::exposure,
     .neutral = {1, 0, 0, 0},
     .is_optional = true,
     .extent = InputExtent::Texel},
}};
static_assert([] {
    for (std::size_t i = 0; i < frame_inputs.size(); ++i)
        if (static_cast<std::size_t>(frame_inputs[i].image) != i) return false;
    return true;
}());

[[nodiscard]] constexpr const FrameInput& frame_input(FrameImage image) {
    return frame_inputs[static_cast<std::size_t>(image)];
}
[[nodiscard]] inline bool is_given(const CompileDesc& desc, const FrameInput& input) {
    return input.use != nullptr ? (desc.*input.use).format != VK_FORMAT_UNDEFINED : desc.has_shadows;
}
[[nodiscard]] inline bool is_given(const CompileDesc& desc, FrameImage image) {
    return is_given(desc, frame_input(image));
}
/// Are frames of both alike in what they bring?
[[nodiscard]] bool bring_the_same(const CompileDesc& a, const CompileDesc& b);

/// An image of a frame at another extent, as kernels have it.
[[nodiscard]] ReferenceImage resampled_reference(const ReferenceImage& image, const FrameInput& input,
                                                 std::uint32_t width, std::uint32_t height);

/// Why an effect is left out of a frame whose camera has no perspective (Needs::perspective).
inline constexpr std::string_view lacks_perspective_reason =
    "needs perspective, which the frame's camera does not have";
/// What is needed and not there, as "depth and normals"; empty: nothing.
template <class IsThere>
[[nodiscard]] std::string missing_needs(const Needs& needs, const IsThere& is_there) {
    std::string out;
    for (const FrameInput& input : frame_inputs)
        if (needs.contains(input.image) && !input.is_optional && !is_there(input.image))
            out.append(out.empty() ? "" : " and ").append(input.shown);
    return out;
}

}  // namespace darkroom::plan
