// SPDX-License-Identifier: MIT
#pragma once
// The values of a look's pulses and layers, each with the row that describes it: one list that panels draw, edits
// change and saving writes.

#include <cstdint>
#include <darkroom/look.hpp>
#include <span>
#include <string>
#include <string_view>
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

/// What a pulse, or a layer, may move, in the look's order.
struct Movable {
    std::string entry;
    const ParamInfo* row = nullptr;
};
[[nodiscard]] std::vector<Movable> movable_values(const Look& look, bool is_layer);
/// Adds a pulse behind the others. An entry whose amount it moves is woken, as by reading. Returns its number. Errors:
/// the event is no name; nothing of this name can be added to; there are as many as there may be.
[[nodiscard]] Result<std::size_t> add_pulse(Look& look, std::string_view event, std::string_view entry,
                                            std::string_view parameter);
/// Adds a layer of one value, its present one, with its whole weight. Errors: as above; another has this name.
[[nodiscard]] Result<std::size_t> add_layer(Look& look, std::string_view name, std::string_view entry,
                                            std::string_view parameter);
/// Adds a layer that is the look of a file, relative to the options' folder, with its whole weight. Errors: as above;
/// those of the file; it has an entry that this look lacks, or differs in nothing.
[[nodiscard]] Result<std::size_t> add_layer_of(Look& look, std::string_view name, const std::string& file,
                                               const LookOptions& options);
/// Lets the camera's distance from a point multiply a layer's weight, or no longer. Errors: the layer is not there.
Result<> set_layer_distance(Look& look, std::size_t layer, bool is_on);
/// Adds a value to a layer: its present one. Errors: as above; the layer has it, or its values are those of a file.
Result<> add_layer_value(Look& look, std::size_t layer, std::string_view entry, std::string_view parameter);
/// Takes the value of this number, as values_of has them, out of a layer. Errors: it is none of its values; it is the
/// only one.
Result<> remove_layer_value(Look& look, std::size_t layer, std::size_t value);
Result<> remove_mover(Look& look, Mover mover);

}  // namespace darkroom::edit
