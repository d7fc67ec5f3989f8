// SPDX-License-Identifier: MIT
#pragma once
// Arena grade: the last pass of a fighting game's picture. Light is brought near sRGB by a power, looked up in a small
// table, brightened, and brought back; alpha says where. For tables of one's own take `lut`, which is more exact.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

/// Tables that are built in. Arena: the game's own, a mild S-curve.
enum class ArenaTable : std::uint32_t { Arena, Identity, Sepia };

struct ArenaGrade {
    /// Table that grades, read at 16 steps of each channel; without one the preset grades.
    Resource table;
    /// Built-in table that is used where no table is given.
    ArenaTable preset = ArenaTable::Arena;
};

[[nodiscard]] const EffectInfo& effect_info(const ArenaGrade&);

}  // namespace darkroom
