// SPDX-License-Identifier: MIT
#pragma once
// What a camera says of its lens to the looks that are seen through it.

#include <optional>

namespace darkroom {

/// What a scene's camera says of its lens. It stands in for what a look does not say of one.
struct CameraLens {
    std::optional<float> aperture;       ///< f-stop
    std::optional<float> focus;          ///< distance along the view axis, metres
    std::optional<float> sensor_height;  ///< millimetres

    friend bool operator==(const CameraLens&, const CameraLens&) = default;
};

}  // namespace darkroom
