// SPDX-License-Identifier: MIT
#pragma once
// How far two pictures of one size are apart: by numbers, and by what a viewer would notice (FLIP). It decides nothing:
// which difference is too much is the caller's to say.

#include <array>
#include <cstdint>
#include <darkroom/result.hpp>
#include <span>

#include "image/flip.hpp"
#include "image/picture.hpp"

namespace darkroom {

/// Equal values, equal infinities and two NaNs differ by 0. A NaN or an infinity in one picture only makes max_error
/// and mean_error infinite and psnr minus infinity; what FLIP makes of it is said there.
struct Comparison {
    double max_error = 0.0;        ///< largest absolute difference of red, green or blue
    double max_alpha_error = 0.0;  ///< largest absolute difference of alpha, which counts nowhere else
    double mean_error = 0.0;       ///< mean absolute difference of red, green and blue
    /// In dB, of red, green and blue. The peak is 1 for display-encoded pictures and the reference's largest finite
    /// value for scene-linear ones. Infinite if nothing differs.
    double psnr = 0.0;
    double flip_mean = 0.0;
    double flip_weighted_median = 0.0;
    double flip_max = 0.0;
    Picture flip_map;  ///< the FLIP errors in magma, display-encoded and opaque
};

/// Errors: those of flip().
[[nodiscard]] Result<Comparison> compare(const Picture& reference, const Picture& test, const FlipDesc& desc = {});

/// The colour map "magma" (van der Walt and Smith, 2015) for a value of 0 to 1: sRGB-encoded red, green and blue.
[[nodiscard]] std::array<float, 3> magma(float value);

/// Paints errors of 0 to 1 with magma, as a display-encoded, opaque picture. There are width * height errors.
[[nodiscard]] Picture paint_errors(std::span<const float> errors, std::uint32_t width, std::uint32_t height);

}  // namespace darkroom
