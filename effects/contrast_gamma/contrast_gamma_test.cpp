// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/contrast_gamma.hpp>

#include "compose/test_stacks/support.hpp"
#include "contrast_gamma/contrast_gamma_reference.hpp"

namespace darkroom {
namespace {

Rgba applied(double value, const ContrastGamma& parameters) {
    return contrast_gamma_reference({value, value, value, 0.25}, {}, parameters);
}

TEST(EffectContrastGamma, ContrastComesFirstAndGammaIsTheExponent) {
    EXPECT_NEAR(applied(0.25, {.contrast = 2}).g, 0.5, 1e-12);
    EXPECT_NEAR(applied(0.25, {.gamma = 0.5f}).g, 0.5, 1e-12);
    EXPECT_NEAR(applied(0.32, {.contrast = 2, .gamma = 0.5f}).g, 0.8, 1e-12);
    EXPECT_EQ(applied(0.5, {.contrast = 2}).a, 0.25);
    EXPECT_EQ(applied(-0.5, {.gamma = 0.5f}).g, 0) << "the power of a negative number is none";
    EXPECT_TRUE(effect_info(ContrastGamma{}).is_identity(std::array{1.0f, 1.0f}.data()));
    EXPECT_FALSE(effect_info(ContrastGamma{}).is_identity(std::array{1.0f, 0.9f}.data()));
}

// The picture of a stack without encode is encoded for it: a contrast of 2 on the code of one half is not one on light.
TEST(EffectContrastGamma, ActsOnTheEncodedPictureInALinearStack) {
    const ReferenceImage picture = test::uniform(4, 4, {0.1, 0.1, 0.1, 1});
    const ReferenceImage out = test::develop([](Composer& composer) { composer.add(ContrastGamma{.contrast = 2}); },
                                             picture, {.target_domain = Domain::SceneLinear});
    const double code = 2 * (1.055 * std::pow(0.1, 1 / 2.4) - 0.055);
    EXPECT_NEAR(out.at(1, 1).g, std::pow((code + 0.055) / 1.055, 2.4), 1e-4);
}

// What the target encodes is encoded behind it: the reference chain has that, this has the formula alone.
TEST(EffectContrastGamma, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_display(67, 41, 1));
    const auto run = [&](const ContrastGamma& parameters, KernelStage stage) {
        // The interface's image is encoded, as the picture of a whole stack would be.
        return test::develop([&](Composer& composer) { composer.add(parameters, {.input = ui_layer}); }, picture,
                             {.kernels = stage, .ui = &picture, .ui_format = VK_FORMAT_R32G32B32A32_SFLOAT});
    };
    for (const ContrastGamma& parameters :
         {ContrastGamma{.contrast = 1.4f, .gamma = 0.9f}, ContrastGamma{.contrast = 2, .gamma = 4},
          ContrastGamma{.contrast = 1, .gamma = 0.1f}}) {
        const ReferenceImage expected = test::reference_of(parameters, picture);
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster})
            EXPECT_LE(test::worst_half_ulps(run(parameters, stage), expected), 2.0) << parameters.gamma;
    }
}

}  // namespace
}  // namespace darkroom
