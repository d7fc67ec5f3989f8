// SPDX-License-Identifier: MIT
// Edges whose sides meet: depth alone does not tell them apart there.
#include <gtest/gtest.h>

#include <darkroom/effects/ssao.hpp>

#include "ssao/ssao_scenes.hpp"

namespace darkroom {
namespace {

/// A low block on a floor. Nothing stands on it, so its top is lit up to the edge; its sides see the floor.
test::BoxScene block_scene() {
    return {.name = "block",
            .boxes = {test::box(-50, -1, -50, 100, 1, 100), test::box(-1, 0, -1, 2, 0.2, 1)},
            .eye = {0.3, 0.9, 2},
            .target = {0, 0.1, -0.3}};
}

TEST(EffectSsao, WhatMeetsInAnEdgeIsKeptApart) {
    const test::BoxView view = test::view_of(block_scene(), 480, 270);
    for (const SsaoResolution resolution : {SsaoResolution::Half, SsaoResolution::Full}) {
        const ReferenceImage out = test::visibility_of({.resolution = resolution}, view.options());
        double lowest_top = 1, lowest_side = 1, sum = 0;
        int tops = 0;
        for (std::uint32_t y = 0; y < 270; ++y)
            for (std::uint32_t x = 0; x < 480; ++x) {
                const Rgba& normal = view.normals.at(x, y);
                if (view.depth.at(x, y).r > 1e6) continue;
                const double height = view.point(x, y)[1];
                if (normal.b > 0.9 && height < 0.2) lowest_side = std::min(lowest_side, out.at(x, y).r);
                if (!(normal.g > 0.9 && height > 0.1)) continue;
                lowest_top = std::min(lowest_top, out.at(x, y).r);
                sum += out.at(x, y).r;
                ++tops;
            }
        ASSERT_GT(tops, 2000);
        EXPECT_LT(lowest_side, 0.7);
        EXPECT_GT(lowest_top, 0.93) << "the side's shade is on the top, size " << int(resolution);
        EXPECT_GT(sum / tops, 0.995);
    }
}

}  // namespace
}  // namespace darkroom
