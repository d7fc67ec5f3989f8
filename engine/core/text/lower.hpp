// SPDX-License-Identifier: MIT
#pragma once
// Names that are compared without regard to case.

#include <string>
#include <string_view>

namespace darkroom {

/// Letters of ASCII alone: what else a name holds stays as it is, whatever the locale.
[[nodiscard]] inline std::string lower(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

}  // namespace darkroom
