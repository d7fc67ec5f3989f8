// SPDX-License-Identifier: MIT
#include "render/lens.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace darkroom::render {

Aperture aperture_of(const LensDesc& lens, const scene::mat4& projection, float focus_distance) {
    // Of side-by-side rays w does not depend on the place.
    if (lens.f_stop <= 0 || projection[2].w == 0) return {};
    const float focal = lens.sensor_height / 1000 / 2 * std::abs(projection[1].y);
    const float focus = std::max(lens.focus_distance > 0 ? lens.focus_distance : focus_distance, focal * 1.01F);
    // A lens at rest whose picture lies in its focal plane has that of one that was moved away from it by focusing.
    return {.radius = focal / lens.f_stop / 2 * focus / (focus - focal), .focus_distance = focus};
}

scene::vec2 place_in_aperture(std::uint32_t index, std::uint32_t count) {
    // In so many parts of equal area, of which the middle one is round and as large as half of another, so that the
    // mean square of the radii is that of a disc.
    const double radius = count < 2 ? 0 : std::sqrt(index / (count - 1.0));
    const double angle = 2 * std::numbers::pi * std::fmod(index / std::numbers::phi, 1.0);
    return {static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle))};
}

}  // namespace darkroom::render
