// SPDX-License-Identifier: MIT
#pragma once

#include <darkroom/effect.hpp>

#include "programs/darkroom/run/json.hpp"

namespace app {

/// What an effect needs, its place and its parameters with their flags, for programs.
[[nodiscard]] Json effect_json(const darkroom::EffectInfo& effect);

}  // namespace app
