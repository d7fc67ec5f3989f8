// SPDX-License-Identifier: MIT
#pragma once
// For tests only: a map or a tap by itself, on the GPU and by its reference. Not part of the library.

#include <gtest/gtest.h>

#include <initializer_list>

#include "compose/test_stacks/support.hpp"

namespace darkroom::test {

/// What differs is how finely a sampler places texels: 1/256 of one, in each direction.
template <class Effect>
void expect_reading_is_the_reference(std::initializer_list<Effect> all, double tolerance) {
    for (const auto& [width, height] : {std::pair{67u, 41u}, {1u, 1u}, {1u, 7u}, {64u, 36u}}) {
        const ReferenceImage picture = round_to_float(random_display(width, height, 3));
        for (const Effect& parameters : all) {
            const ReferenceImage expected = reference_of(parameters, picture);
            for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
                const ReferenceImage out =
                    develop([&](Composer& composer) { composer.add(parameters); }, picture, {.kernels = stage});
                EXPECT_LE(worst_difference(out, expected), tolerance) << width << "x" << height;
            }
        }
    }
}

}  // namespace darkroom::test
