// SPDX-License-Identifier: MIT
#pragma once
// What an effect's `build` declares, without planning it: for who tells people what an effect costs, or writes a wire.

#include <array>
#include <darkroom/effect.hpp>
#include <string_view>

namespace darkroom::edit {

struct EffectUses {
    bool has_passes = false;    ///< of its own, at its defaults; what is only pointwise has none
    bool reads_source = false;  ///< it works on what the entry's `source` names
};
[[nodiscard]] EffectUses uses_of(const EffectInfo& effect);

/// What people look for an effect by, in the order in which they are offered.
inline constexpr std::array<std::string_view, 7> purposes{"light",  "air",   "lens",     "colour",
                                                          "motion", "style", "interface"};
/// One of these, as the effect's page says it in a line "Purpose: light."; empty: it has no page, or says none.
[[nodiscard]] std::string_view purpose_of(const EffectInfo& effect);

}  // namespace darkroom::edit
