// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/ui_composite.hpp>

#include "compose/test_stacks/support.hpp"
#include "ui_composite/ui_composite_reference.hpp"

namespace darkroom {
namespace {

TEST(EffectUiComposite, IsPremultipliedOverAndLightDimmed) {
    const Rgba picture{0.5, 0.4, 0.2, 1}, layer{0.25, 0.1, 0, 0.5};
    const Rgba over = ui_composite_reference(picture, layer, UiComposite{});
    EXPECT_NEAR(over.r, 0.5 * 0.5 + 0.25, 1e-12);
    EXPECT_EQ(over.a, 1);
    const Rgba light = ui_composite_reference(picture, layer, UiComposite{.additive = 1});
    EXPECT_NEAR(light.r, 0.5 + 0.7 * 0.25, 1e-12);
    const Rgba opaque = ui_composite_reference({1e30, 0, 0, 0}, {0.25, 1, 0, 1}, UiComposite{});
    EXPECT_EQ(opaque.r, 0.25);
    EXPECT_EQ(opaque.a, 1);
}

TEST(EffectUiComposite, NeverFadesBelowATenth) {
    const Rgba black{0, 0, 0, 1}, layer{1, 1, 1, 1};
    for (const float opacity : {0.0f, 0.05f, 0.1f})
        EXPECT_NEAR(ui_composite_reference(black, layer, UiComposite{.ui_opacity = opacity}).g, 0.1, 1e-7);
    EXPECT_NEAR(ui_composite_reference(black, layer, UiComposite{.ui_opacity = 0.75f}).g, 0.75, 1e-7);
}

// As its own picture, the interface is encoded already.
TEST(EffectUiComposite, GpuMatchesReference) {
    const ReferenceImage ui = test::round_to_float(test::random_display(67, 41, 4));
    for (const UiComposite& parameters :
         {UiComposite{}, UiComposite{.ui_opacity = 0.4f, .additive = 0.3f}, UiComposite{.additive = 1}}) {
        const ReferenceImage expected = test::reference_of(parameters, ui, &ui);
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const ReferenceImage out =
                test::develop([&](Composer& composer) { composer.add(parameters, {.input = ui_layer}); }, ui,
                              {.kernels = stage, .ui = &ui, .ui_format = VK_FORMAT_R32G32B32A32_SFLOAT});
            EXPECT_LE(test::worst_half_ulps(out, expected), 2.0);
        }
    }
}

}  // namespace
}  // namespace darkroom
