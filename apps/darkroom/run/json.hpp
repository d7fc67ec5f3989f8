// SPDX-License-Identifier: MIT
#pragma once
// What the commands' --json documents have in common.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace app {

using Json = nlohmann::ordered_json;

/// JSON has no infinity and no NaN: "inf", "-inf", "nan".
[[nodiscard]] inline Json json_number(double value) {
    if (std::isfinite(value)) return value;
    return std::isnan(value) ? "nan" : fmt::format("{}", value);
}

}  // namespace app
