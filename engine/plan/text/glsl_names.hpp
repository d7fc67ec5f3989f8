// SPDX-License-Identifier: MIT
#pragma once
// Which names GLSL that comes from outside may give to things. It knows words, not grammar: what it lets through may
// still not compile.

#include <string_view>

namespace darkroom::plan {

/// Lower-case letters, digits and single underscores, beginning with a letter and not ending with an underscore: a name
/// in looks, flags and GLSL alike (which keeps two underscores in a row for itself).
[[nodiscard]] bool is_snake_name(std::string_view name);
/// Keywords and reserved words of GLSL 4.60, section 3.6: no member may have such a name.
[[nodiscard]] bool is_glsl_keyword(std::string_view name);
/// Functions and other names at file scope of GLSL and of the kernels around an effect: no effect may have such a name.
[[nodiscard]] bool is_function_name(std::string_view name);
/// Is `name` followed by a parenthesis anywhere outside comments? True of any text that defines the function.
[[nodiscard]] bool calls_name(std::string_view text, std::string_view name);

}  // namespace darkroom::plan
