// SPDX-License-Identifier: MIT
#pragma once
// The document of `darkroom api --json`: docs/bindings.md says what is in it.

#include "c_header.hpp"
#include "programs/darkroom/run/json.hpp"

namespace app {

[[nodiscard]] Json api_json(const CHeader& header);

}  // namespace app
