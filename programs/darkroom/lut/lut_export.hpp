// SPDX-License-Identifier: MIT
#pragma once
// A look as one table: what its effects make of every colour. What depends on more than the colour of the pixel cannot
// be in it.

#include <darkroom/look.hpp>
#include <string>
#include <vector>

#include "tables/cube_file.hpp"

namespace app {

struct ExportedLook {
    /// A cube of 65 behind LogShaper, with comments that state its spaces, its error and what was left out.
    darkroom::TableFile file;
    std::vector<std::string> left_out;  ///< "vignette: depends on the place in the picture"
};

/// By the effects' references. Errors: nothing of the look can be in a table.
[[nodiscard]] darkroom::Result<ExportedLook> export_look(const darkroom::Look& look);

}  // namespace app
