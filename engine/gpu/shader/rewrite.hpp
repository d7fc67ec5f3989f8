// SPDX-License-Identifier: MIT
#pragma once
// A textual change to a kernel's body, which lets it name images as if GLSL could pass them. It reads tokens, not
// grammar: it changes nothing in comments, and no line number.

#include <span>
#include <string>
#include <string_view>

#include "gpu/shader/glsl_scan.hpp"

namespace darkroom::gpu {

/// sample_linear(scene, uv) becomes sample_linear_scene(uv): calls of one of `functions` whose first argument is
/// nothing but one of `images`.
[[nodiscard]] std::string rewrite_image_calls(std::string_view body, std::span<const std::string_view> functions,
                                              std::span<const std::string_view> images);

}  // namespace darkroom::gpu
