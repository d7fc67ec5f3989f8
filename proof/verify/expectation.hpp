// SPDX-License-Identifier: MIT
#pragma once
// What a subject's picture has to be, by the references in double precision, and how far each number may be from that.
// The bound is no constant of an effect: a device is right if it gives the exact picture of inputs that are moved by
// what it may round. So the references develop moved inputs, too, and where these pictures part, a device's may.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "verify/scene.hpp"
#include "verify/subject.hpp"

namespace darkroom::verify {

/// How precisely a subject's kernels work on a device.
struct Precision {
    /// What is rounded to where a picture goes from kernel to kernel, of a number of size 1: 0 for floats.
    double image_step = 0;
    std::size_t passes = 1;  ///< how often
    double filter_step = 0;  ///< the part of a texel that a linear sampler's places are apart; 0: nothing is filtered
    double place_step = 0;   ///< in texels: what a place is off that goes through an image; 0: none does
    double table_step = 0;   ///< of what an effect changes at most: by a filtered table
    double curve_step = 0;   ///< of an encoded value: what a polynomial is off that stands for a transfer function
    double count_step = 0;   ///< of light: what a mean is off that is counted in bins
};

struct Expectation {
    ReferenceImage picture;    ///< of the last frame
    ReferenceImage allowance;  ///< absolute, of each channel
};

/// How many moved frames are tried: where nothing differs, and before a difference is a finding. An edge that none of
/// the few hits is no fault.
inline constexpr std::size_t few_moved = 6, many_moved = 32;

/// Of frames that go through the stack one after the other. Errors: those of run_reference.
[[nodiscard]] Result<Expectation> expect(const Subject& subject, std::span<const SceneFrame> frames,
                                         const Precision& precision, std::size_t moved_count = few_moved);

/// The number that is farthest beyond its allowance.
struct Difference {
    std::size_t pixels = 0;  ///< that have one beyond it
    std::uint32_t x = 0, y = 0;
    std::uint32_t channel = 0;  ///< red, green, blue, alpha
    double value = 0, expected = 0, allowed = 0;
    double excess = 0;  ///< how many times what is allowed
};
[[nodiscard]] Difference difference(const ReferenceImage& made, const Expectation& expectation);

}  // namespace darkroom::verify
