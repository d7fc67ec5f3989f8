// SPDX-License-Identifier: MIT
#pragma once
// What an effect's `build` declares, without planning it: for who tells people what an effect costs, or writes a wire.

#include <darkroom/effect.hpp>

namespace darkroom::edit {

struct EffectUses {
    bool has_passes = false;    ///< of its own, at its defaults; what is only pointwise has none
    bool reads_source = false;  ///< it works on what the entry's `source` names
};
[[nodiscard]] EffectUses uses_of(const EffectInfo& effect);

}  // namespace darkroom::edit
