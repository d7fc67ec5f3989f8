// SPDX-License-Identifier: MIT
#pragma once
// The name that an ICC profile gives itself: its tag "desc" (ICC.1:2022, 9.2.41; ICC.1:2001, 6.5.17).

#include <cstddef>
#include <span>
#include <string>

namespace darkroom {

/// In ASCII, other characters as '?'. Empty: it has none, or is not a profile.
[[nodiscard]] std::string profile_description(std::span<const std::byte> profile);

}  // namespace darkroom
