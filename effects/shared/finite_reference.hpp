// SPDX-License-Identifier: MIT
#pragma once
// shared/sanitize.glsl in double precision: NaN counts as 0, and no number is beyond what half
// precision holds.

#include <algorithm>
#include <cmath>

namespace darkroom {

inline double finite_reference(double value) { return std::isnan(value) ? 0.0 : std::clamp(value, -65504.0, 65504.0); }
/// The same for light, of which there is none below 0.
inline double finite_light_reference(double value) { return std::max(finite_reference(value), 0.0); }

}  // namespace darkroom
