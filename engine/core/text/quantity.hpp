// SPDX-License-Identifier: MIT
#pragma once
// Numbers with their units, as people type them: 6500K, 2stops, 300ms.

#include <optional>
#include <string>
#include <string_view>

namespace darkroom {

/// A finite number in this unit (Unit::symbol), with or without a suffix, before which spaces may stand; letters of any
/// case. Multipliers take ev, stop and stops: 2ev is 4. No value: it is none, or the suffix is of another unit.
[[nodiscard]] std::optional<double> parse_quantity(std::string_view text, std::string_view unit);

/// Which suffixes the unit takes beside its own name: "ev, stop or stops"; empty: none.
[[nodiscard]] std::string other_suffixes(std::string_view unit);

}  // namespace darkroom
