// SPDX-License-Identifier: MIT
#pragma once
// Text that may be longer than its place.

#include <string>

namespace darkroom::panels {

enum class KeptPart { Start, End };  ///< of names; of files, whose ends tell them apart

/// As much of it as fits into `width` in the present font, with dots for the rest.
[[nodiscard]] std::string fitting(const std::string& text, float width, KeptPart kept);

}  // namespace darkroom::panels
