// SPDX-License-Identifier: MIT
#pragma once
// A user's own effect in one GLSL file, loaded at run time: it takes its place in a stack, and fuses with its
// neighbours, like those in the library. It is the pointwise (or warp) kind only: passes of its own, histories and a
// CPU reference need an effect's folder.
//
//     // @effect duotone: Maps shadows and highlights to two colours.
//     // @param float amount = 1 in [0, 1] amount: How much of the toned picture is seen.
//     // @param rgb shadow = 0.05, 0.02, 0.12 in [0, 4]: Colour of the shadows.
//     // @param choice mode = luma | red: What decides between the two.
//     // @param toggle is_inverted = off: Exchanges the two.
//
//     vec4 duotone(vec4 color, Pixel pixel, Duotone parameters) { ... }
//
// The lines above the first line of code describe it. A line of @param is KIND NAME = DEFAULT, the interval `in [a, b]`
// where the kind has one (float, int, vec2, vec3, vec4, rgb), then any of a unit (px, cd/m2, m, 1/m, deg, s), `log` (a
// slider in equal ratios) and `amount` (0 switches the effect off), then a colon and a sentence. The first name of a
// choice is the default; in GLSL the names are Duotone_mode_luma and so on. Other lines:
//     // @touch warp              the function is vec4 duotone(Pixel pixel, Duotone parameters) and reads `picture`
//     // @accepts scene_linear display_linear     the domains it is meant for; without it all, encoded too
//     // @needs depth             left out of the plan where the frame has none: depth, normals, velocity, shadows, ui
// What the text defines at file scope begins with the effect's name, so that two entries of it fit one kernel.

#include <darkroom/effect.hpp>
#include <darkroom/result.hpp>
#include <filesystem>
#include <memory>
#include <string_view>

namespace darkroom {

/// Owns all that info() refers to, together with the Composers whose stacks have held it, so it may go before them.
/// Moving it keeps info() where it is.
class CustomEffect {
  public:
    [[nodiscard]] static Result<CustomEffect> load(const std::filesystem::path& file);
    /// `shown_name` stands for the file in errors, which read "name:line: ...". GLSL itself is compiled with the stack.
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
