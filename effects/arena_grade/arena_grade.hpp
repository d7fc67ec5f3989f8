// SPDX-License-Identifier: MIT
#pragma once
// Arena grade: the last pass of a fighting game's picture. Light is brought near sRGB by a power, looked up in a small
// table, brightened, and brought back; alpha says where. For tables of one's own take `lut`, which is more exact.

#include <darkroom/effect.hpp>

namespace darkroom {

/// Tables that are built in. Arena: the game's own, a mild S-curve.
enum class ArenaTable : std::uint32_t { Arena, Identity, Sepia };

struct ArenaGrade {
    Resource table;
    ArenaTable preset = ArenaTable::Arena;
};
inline constexpr auto arena_grade_rows =
    describe(field<&ArenaGrade::table>("A table, read at 16 steps of each channel; without one the preset."),
             field<&ArenaGrade::preset>("Which of the built-in tables.").at_compile());

[[nodiscard]] const EffectInfo& effect_info(const ArenaGrade&);

}  // namespace darkroom
