// SPDX-License-Identifier: MIT
#pragma once
// The first light of the frame that casts shadows, as functions that a file may call: GLSL, and the numbers that it
// reads, which are worked out on the CPU in every frame.

#include <darkroom/effect.hpp>
#include <span>
#include <string>
#include <string_view>

namespace darkroom::custom {

/// Of each cascade three rows that give u, v and depth; the cascades' far distances; direction and number of cascades;
/// colour.
inline constexpr std::uint32_t light_vectors = 3 * Light::max_cascades + 3;
void write_light(const void* parameters, const PassContext& context, std::span<PassVector> out);

/// Does the code call one of the functions?
[[nodiscard]] bool reads_light(std::string_view code, std::string_view effect);
/// Their definitions. `is_pass`: passes read the numbers by another name than ends do.
[[nodiscard]] std::string light_code(std::string_view effect, bool is_pass);

}  // namespace darkroom::custom
