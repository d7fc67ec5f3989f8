// SPDX-License-Identifier: MIT
#pragma once
// A textual change to a kernel's body, which lets it name images as if GLSL could pass them. It reads tokens, not
// grammar: it changes nothing in comments, and no line number.

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "gpu/shader/glsl_scan.hpp"

namespace darkroom::gpu {

/// sample_linear(scene, uv) becomes sample_linear_scene(uv): calls of one of `functions` whose first argument is
/// nothing but one of `images`.
/// `visit` sees all words of the body on the way, but those images, and what follows each.
using VisitWord = std::function<void(std::string_view word, const GlslScanner& after)>;
[[nodiscard]] std::string rewrite_image_calls(std::string_view body, std::span<const std::string_view> functions,
                                              std::span<const std::string_view> images, const VisitWord& visit = {});

}  // namespace darkroom::gpu
