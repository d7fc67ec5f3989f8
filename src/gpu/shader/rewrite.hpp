// SPDX-License-Identifier: MIT
#pragma once
// Two textual changes to a kernel's body, which let it name images and arrays of constants as if GLSL could pass the
// one and pack the other. They read tokens, not grammar: they change nothing in comments, and no line number.

#include <span>
#include <string>
#include <string_view>

namespace darkroom::gpu {

/// sample_linear(scene, uv) becomes sample_linear_scene(uv): calls of one of `functions` whose first argument is
/// nothing but one of `images`.
[[nodiscard]] std::string rewrite_image_calls(std::string_view body, std::span<const std::string_view> functions,
                                              std::span<const std::string_view> images);

/// curve[i + 1] becomes curve_at(i + 1), for each of `arrays`.
[[nodiscard]] std::string rewrite_indexing(std::string_view body, std::span<const std::string_view> arrays);

}  // namespace darkroom::gpu
