// SPDX-License-Identifier: MIT
#pragma once
// What the interface may know of the game: names and values, which the host fills in every frame. Controllers read it
// as `game`, documents bind to it.

#include <functional>
#include <map>
#include <string>
#include <variant>

namespace darkroom {

using GameValue = std::variant<bool, double, std::string>;
using GameTable = std::map<std::string, GameValue, std::less<>>;

}  // namespace darkroom
