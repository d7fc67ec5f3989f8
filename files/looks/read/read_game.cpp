// SPDX-License-Identifier: MIT
// What the game says, as TOML.
#include <fmt/format.h>

#include <cmath>

#include "core/text/param_text.hpp"
#include "looks/read/look_reader.hpp"

namespace darkroom {

Result<GameTable> game_values(const toml::node& node) {
    constexpr std::size_t most = 256, longest = 200;
    const toml::table* const values = node.as_table();
    if (values == nullptr || values->size() > most)
        return user_error(
            fmt::format("game = {}: expected a table of at most {} numbers, strings and booleans", show(node), most));
    GameTable out;
    for (const auto& [key, value] : *values) {
        const std::string name(key.str());
        if (const auto* const text = value.as_string(); text != nullptr && text->get().size() <= longest)
            out[name] = text->get();
        else if (const auto* const toggle = value.as_boolean())
            out[name] = toggle->get();
        else if (const auto number = value.value<double>(); value.is_number() && std::isfinite(*number))
            out[name] = *number;
        else
            return user_error(
                fmt::format("game: {} = {}: expected a number, a boolean, or a string of at most {} bytes",
                            printable(name), show(value), longest));
    }
    return out;
}

}  // namespace darkroom
