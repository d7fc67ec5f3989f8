// SPDX-License-Identifier: MIT
#pragma once
// A user's own effect in one GLSL file, loaded at run time: it takes its place in a stack, and fuses with its
// neighbours, like those in the library. What a folder of the tree can do in GLSL a file can, passes, images and
// histories among them; a CPU reference and numbers worked out on the CPU need a folder. docs/custom_effects.md is the
// page.
//
//     // @effect duotone: Maps shadows and highlights to two colours.
//     // @param float amount = 1 in [0, 1] amount: How much of the toned picture is seen.
//     // @param rgb shadow = 0.05, 0.02, 0.12 in [0, 4]: Colour of the shadows.
//     // @param choice mode = luma | red: What decides between the two.
//     // @param toggle is_inverted = off: Exchanges the two.
//
//     vec4 duotone(vec4 color, Pixel pixel, Duotone parameters) { ... }
//
// A comment line that begins with @ describes something. Above the first line of code stand:
//     @effect NAME: SENTENCE.     required
//     @param KIND NAME = DEFAULT in [LOWEST, HIGHEST] UNIT log amount: SENTENCE.
//                                 KIND is float, int, vec2, vec3, vec4 or rgb, or without an interval toggle (on, off)
//                                 or choice (the first name is the default; in GLSL Duotone_mode_luma). UNIT is px,
//                                 cd/m2, m, 1/m, deg or s, or missing; `log`: a slider in equal ratios; `amount`: 0
//                                 switches the effect off
//     @touch warp                 the function is vec4 duotone(Pixel pixel, Duotone parameters) and reads `picture`
//     @accepts DOMAIN ...         scene_linear, display_linear, encoded: those it is meant for; without it all
//     @makes DOMAIN               what the picture is behind it; without it what it was
//     @needs NEED ...             without these of the frame it is left out of the plan: depth, normals, velocity,
//                                 shadows, ui; and `second`, the entry's second picture, for the end. Without
//                                 reactive, transparency and exposure it reads what stands in for them
//     @image NAME: RATIO FORMAT   an image for passes, RATIO (1, 1/2, 3/4 ...) of the picture's size; of FORMAT
//                                 rgba16f, rgba32f, rgba8, rg16f, rg32f, rg8, r16f, r32f, r8 or r11f_g11f_b10f
//     @history NAME: RATIO FORMAT an image that outlives the frame: NAME is written, NAME_previous is what the frame
//                                 before wrote; zero after a cut
//     @pre_roll FRAMES            with a history: how many frames before must have been developed for a right picture
//     @table NAME: WIDTHxHEIGHT FORMAT = VALUE, VALUE ...   r32f, rgba32f, and in [0, 1] r8, rgba8; a line that ends in
//                                 a comma goes on in the next comment
//     @buffer NAME: COUNT TYPE    an array of one frame for compute passes, of uint, int, float, vec2, vec4, ivec2,
//                                 ivec4 or uvec4
//     @value NAME: COUNT          floats that outlast the frame, which compute passes write and all functions read, as
//                                 NAME[i]; zero after a cut. Composer::value("duotone.NAME") tells the host
//     @result IMAGE               the effect's picture, where it has no end
// and above functions:
//     @pass NAME: IMAGE ... -> IMAGE    below it, to the next such line, is the pass's code: vec4 duotone_NAME(Pixel
//                                 pixel, Duotone parameters) makes the image behind the arrow of those before it, which
//                                 are `picture`, `source` (what the entry's wire of that name says, else the picture),
//                                 and images of the file. Each is written once, before it is read. With several
//                                 images behind the arrow, four at most and of one size, void duotone_NAME(Pixel
//                                 pixel, Duotone parameters, out vec4 result[COUNT])
//     @compute NAME WORKGROUP GROUPS: IMAGE, BUFFER or VALUE ... -> IMAGE, BUFFER or VALUE ...
//                                 below it is void duotone_NAME(Duotone parameters), a compute shader with `shared`
//                                 variables, barrier() and atomics, that writes images (rgba16f, rgba32f, rgba8, r32f)
//                                 by store(image, texel, color). WORKGROUP as 16x8, 128 together; GROUPS as 4x1, or
//                                 without as many as cover the first image that it writes, or else reads
//     @end IMAGE ...              below it is the end, with the images that it reads: vec4 duotone(vec4 color, Pixel
//                                 pixel, Duotone parameters). In a file without passes all code is the end's
// Code above the first @pass and @end is everyone's. What a function may call: GLSL, `#include "shared/NAME.glsl"`
// (effects/shared), and on images by their names sample_linear(image, uv), load(image, texel), load_clamped,
// gather_red, gather_green and size (engine/gpu/kernel/kernel.hpp). Of the frame it may read frame_time,
// frame_delta_time, frame_index; with shared/camera.glsl its camera; and what @needs names: frame_depth (red: planar
// distance; 1e10 is sky), frame_normals (view space), frame_velocity (red, green: previous minus current position, in
// pixels, y down), frame_ui (sRGB-encoded, premultiplied), frame_reactive (red; else 0), frame_transparency (the colour
// before it; else 0), frame_exposure (red; else 1), and of the first light that casts shadows duotone_lit(vec3 world,
// float planar), 1 where it reaches that place, duotone_light_direction() and duotone_light_color(). Names at file
// scope begin with the effect's name, so that two entries of it fit one kernel.

#include <cstddef>
#include <darkroom/effect.hpp>
#include <darkroom/result.hpp>
#include <memory>
#include <string_view>

namespace darkroom {

/// Owns all that info() refers to, together with the Composers whose stacks have held it, so it may go before them.
/// Moving it keeps info() where it is.
class CustomEffect {
  public:
    static constexpr std::size_t max_bytes = 65536;  ///< of a file

    /// Errors read "name:line: ...".
    [[nodiscard]] static Result<CustomEffect> load(const std::string& file);
    /// `shown_name` stands for the file in errors. GLSL itself is compiled with the stack.
    [[nodiscard]] static Result<CustomEffect> parse(std::string_view text, std::string_view shown_name);

    CustomEffect(CustomEffect&&) noexcept;
    CustomEffect& operator=(CustomEffect&&) noexcept;
    ~CustomEffect();

    /// For Composer::add(info, nullptr), which takes the defaults.
    [[nodiscard]] const EffectInfo& info() const;

  private:
    struct State;
    explicit CustomEffect(std::shared_ptr<const State> state);
    std::shared_ptr<const State> state_;
};

}  // namespace darkroom
