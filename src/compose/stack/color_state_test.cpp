// SPDX-License-Identifier: MIT
// Patches of known luminance through encode, interface and display controls, fused and not, for displays of standard
// and of high range.
#include <gtest/gtest.h>
#include <darkroom/effects/contrast_gamma.hpp>
#include <darkroom/effects/encode.hpp>
#include <darkroom/effects/ui_composite.hpp>
#include <darkroom/effects/vignette.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "compose/test_stacks/support.hpp"
#include "shared/color_state_reference.hpp"

namespace darkroom {
namespace {

constexpr std::array<TransferFunction, 3> high_range{TransferFunction::Pq, TransferFunction::Scrgb,
                                                     TransferFunction::Hlg};

/// Luminance of what a grey pixel of the target says.
double nits(const Rgba& pixel, const Encode& encode) {
    return nits_of({pixel.r, pixel.g, pixel.b}, effect_info(encode).makes({}, &encode))[1];
}

// The left half is covered by an opaque interface of one code, the right half by none.
ReferenceImage half_covered(double code) {
    ReferenceImage ui = test::uniform(16, 8, {0, 0, 0, 0});
    for (std::uint32_t y = 0; y < ui.height; ++y)
        for (std::uint32_t x = 0; x < 8; ++x) ui.at(x, y) = {code, code, code, 1};
    return ui;
}

TEST(ComposeColorState, AnInterfaceIsEncodedOnceWhetherEncodeIsOnOrNot) {
    const double code = 128 / 255.0;
    const ReferenceImage ui = half_covered(code), picture = test::uniform(16, 8, {0.5, 0.5, 0.5, 1});
    for (const bool is_fused : {true, false}) {
        for (const int encode : {0, 1, 2}) {
            SCOPED_TRACE(testing::Message() << "fused " << is_fused << ", encode " << encode);
            const auto fill = [&](Composer& composer) {
                if (encode != 0) composer.add(Encode{}, {.enabled = encode == 1});
                composer.add(UiComposite{});
            };
            const ReferenceImage out =
                test::develop(fill, picture, {.fuse = is_fused, .target = VK_FORMAT_R8G8B8A8_UNORM, .ui = &ui});
            EXPECT_NEAR(out.at(2, 4).r, code, 1.0 / 255);
            EXPECT_NEAR(out.at(12, 4).r, srgb_encoded(0.5), 1.0 / 255);
        }
    }
}

TEST(ComposeColorState, TheInterfacesWhiteHasItsLuminanceOnEveryTarget) {
    const ReferenceImage ui = half_covered(1), picture = test::uniform(16, 8, {2, 2, 2, 1});
    for (const TransferFunction transfer : high_range) {
        for (const bool is_fused : {true, false}) {
            for (const float white : {203.0f, 120.0f}) {
                const Encode encode{.transfer = transfer};
                SCOPED_TRACE(testing::Message() << static_cast<int>(transfer) << " " << is_fused << " " << white);
                const auto fill = [&](Composer& composer) {
                    composer.add(encode);
                    composer.add(UiComposite{.ui_white_nits = white});
                };
                const ReferenceImage out = test::develop(fill, picture, {.fuse = is_fused, .ui = &ui});
                EXPECT_NEAR(nits(out.at(2, 4), encode), double{white}, 0.005 * white);
                EXPECT_NEAR(nits(out.at(12, 4), encode), 406, 0.005 * 406);
            }
        }
    }
}

// Both are defined on code values of sRGB: of the light they leave as much, whatever the target's curve.
TEST(ComposeColorState, DisplayControlsTakeTheSameLightOnEveryTarget) {
    for (const double light : {0.05, 0.4, 1.0, 3.0}) {
        const ReferenceImage picture = test::uniform(16, 8, {light, light, light, 1});
        for (const TransferFunction transfer : high_range) {
            for (const bool is_fused : {true, false}) {
                const Encode encode{.transfer = transfer};
                SCOPED_TRACE(testing::Message() << static_cast<int>(transfer) << " " << is_fused << " " << light);
                const ReferenceImage darkened = test::develop(
                    [&](Composer& composer) {
                        composer.add(encode);
                        composer.add(Vignette{.intensity = 0.3f, .smoothness = 2});
                    },
                    picture, {.fuse = is_fused});
                const double u = 15.5 / 16 - 0.5, v = 7.5 / 8 - 0.5, factor = 1 - 0.3 * 2 * (u * u + v * v);
                const double left = 203 * srgb_decoded(factor * srgb_encoded(light));
                EXPECT_NEAR(nits(darkened.at(15, 7), encode), left, 0.005 * left);
                const ReferenceImage flat = test::develop(
                    [&](Composer& composer) {
                        composer.add(encode);
                        composer.add(ContrastGamma{.contrast = 1.2f, .gamma = 0.8f});
                    },
                    picture, {.fuse = is_fused});
                const double raised = std::min(203 * srgb_decoded(std::pow(1.2 * srgb_encoded(light), 0.8)), 1000.0);
                EXPECT_NEAR(nits(flat.at(3, 3), encode), raised, 0.005 * raised);
            }
        }
    }
}

}  // namespace
}  // namespace darkroom
