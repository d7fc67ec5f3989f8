// SPDX-License-Identifier: MIT
#pragma once
// The document of `darkroom api --json`: docs/bindings.md says what is in it.

#include "apps/darkroom/run/json.hpp"
#include "c_header.hpp"

namespace app {

[[nodiscard]] Json api_json(const CHeader& header);

}  // namespace app
