// SPDX-License-Identifier: MIT
#pragma once
// The values of a look's pulses and layers, each with the row that describes it: one list that panels draw, edits
// change and saving writes.

#include <cstdint>
#include <darkroom/look.hpp>
#include <span>
#include <string>
#include <vector>

namespace darkroom::edit {

/// A pulse, or a layer, by its number in the look.
struct Mover {
    bool is_layer = false;
    std::size_t number = 0;
    bool operator==(const Mover&) const = default;
};

struct MovedValue {
    ParamInfo row;                               ///< of these words alone
    std::vector<std::uint32_t> words, defaults;  ///< of a layer's values, what the entry has without it
    std::string entry;                           ///< of a layer's values: whose it is
    std::string table;                           ///< below the mover's in a file: none, "distance" or "values"
};

/// Of a layer that is a look of its own, those in which that look differs are not among them: they are in its file.
[[nodiscard]] std::vector<MovedValue> values_of(const Look& look, Mover mover);
/// "hit: vignette.intensity", or the layer's name.
[[nodiscard]] std::string name_of(const Look& look, Mover mover);
/// Sets the value of this number. Errors: it is out of range; near is not before far; the mover is not there.
Result<> set_moved(Look& look, Mover mover, std::size_t value, std::span<const std::uint32_t> words);
/// Have both looks the same pulses and layers, of whatever values?
[[nodiscard]] bool has_same_movers(const Look& a, const Look& b);

}  // namespace darkroom::edit
