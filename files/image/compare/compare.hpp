// SPDX-License-Identifier: MIT
#pragma once
// How far two pictures of one size are apart: by numbers, and by what a viewer would notice (FLIP). It decides nothing:
// which difference is too much is the caller's to say.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/try.hpp"
#include "image/compare/flip.hpp"
#include "image/picture/picture.hpp"

namespace darkroom {

/// Some channels of a buffer of samples: `first` to `first + count - 1` of the `stride` that a pixel has.
struct SampleLayout {
    std::uint32_t width = 0;
    std::uint32_t stride = 4, first = 0, count = 3;
};

/// Samples that are no number.
struct NonFinite {
    std::uint64_t nan = 0, infinite = 0;
};

/// How far samples are apart. Equal values, equal infinities and two NaNs differ by 0. A NaN or an infinity in one
/// buffer only makes max_error and mean_error infinite and psnr minus infinity.
struct SampleErrors {
    struct Place {
        std::uint32_t x = 0, y = 0, channel = 0;
        double reference = 0, test = 0;
    };
    double max_error = 0.0;   ///< largest absolute difference
    double mean_error = 0.0;  ///< mean absolute difference
    double psnr = 0.0;        ///< in dB; infinite if nothing differs
    Place worst;              ///< the first place of the largest difference, if it is above 0
    NonFinite reference, test;
    std::uint64_t pixels = 0, differing_pixels = 0;  ///< of which a channel is another
    std::uint64_t non_finite_differences = 0;  ///< samples that are finite in one buffer alone, or of another kind
};

/// Both buffers have one size. `peak` is that of PSNR; not given: the reference's largest finite absolute value.
[[nodiscard]] SampleErrors measure(std::span<const float> reference, std::span<const float> test,
                                   const SampleLayout& layout, std::optional<double> peak = {});
/// Of numbers in all their bits.
[[nodiscard]] SampleErrors measure(std::span<const std::uint32_t> reference, std::span<const std::uint32_t> test,
                                   const SampleLayout& layout);

/// The errors of red, green and blue. The peak of display-encoded pictures is 1. What FLIP
/// makes of NaN is said there.
struct Comparison : SampleErrors {
    SampleErrors alpha;  ///< which counts nowhere else
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
