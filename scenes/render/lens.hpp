// SPDX-License-Identifier: MIT
#pragma once
// A thin lens in place of a pinhole, for pictures whose light is the mean of several draws: each sees the scene from
// another place of the aperture, and what lies at the focus distance stays where it is. The aperture is round, and
// there are no aberrations.

#include <cstdint>

#include "scene/math.hpp"

namespace darkroom::render {

struct LensDesc {
    float f_stop = 0;          ///< focal length divided by the aperture's diameter; 0: a pinhole
    float focus_distance = 0;  ///< along the view axis, metres; 0: that of the camera's target
    float sensor_height = 24;  ///< millimetres; with the field of view it gives the focal length
};

/// What a lens is for one camera, metres.
struct Aperture {
    float radius = 0;          ///< 0: a pinhole
    float focus_distance = 1;  ///< beyond the focal length, since nothing nearer can be sharp
};

/// The circle of a point at infinity is that of Potmesil and Chakravarty, "A Lens and Aperture Camera Model for
/// Synthetic Image Generation" (1981), equation 3, for the field of view that the projection has: focusing does not
/// change it. Rays that run side by side have no lens. `focus_distance`: where the lens says none, metres.
[[nodiscard]] Aperture aperture_of(const LensDesc& lens, const scene::mat4& projection, float focus_distance);

/// Where the index-th of so many draws is seen from, in radii of the aperture, x right and y up; the first from its
/// middle. Evenly spread over its area: Helmut Vogel, "A better way to construct the sunflower head" (1979).
[[nodiscard]] scene::vec2 place_in_aperture(std::uint32_t index, std::uint32_t count);

}  // namespace darkroom::render
