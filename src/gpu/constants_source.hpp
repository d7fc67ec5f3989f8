// SPDX-License-Identifier: MIT
#pragma once
// Declares the constants of a kernel as a uniform buffer in the layout of std430, which GLSL allows only for storage
// buffers unless the host enabled a feature. Members are scalars, vectors, mat3, mat4, and arrays of scalars and
// vectors, each with `layout(offset = N)` before it if it does not follow its predecessor; structures are not among
// them.

#include <string>
#include <string_view>
#include <vector>

namespace darkroom::gpu {

struct ConstantsSource {
    std::string text;                 ///< the declarations
    std::vector<std::string> arrays;  ///< members that the body reads through NAME_at(index)
};

/// `members` is what would stand in a std430 block. What it cannot read it leaves to the GLSL compiler to refuse.
[[nodiscard]] ConstantsSource constants_source(std::string_view members);

}  // namespace darkroom::gpu
