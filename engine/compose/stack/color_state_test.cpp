// SPDX-License-Identifier: MIT
// Patches of known luminance through encode, interface and display controls, fused and not, for displays of standard
// and of high range.
#include <gtest/gtest.h>
#include <darkroom/effects/contrast_gamma.hpp>
#include <darkroom/effects/encode.hpp>
#include <darkroom/effects/tonemap.hpp>
#include <darkroom/effects/ui_composite.hpp>
#include <darkroom/effects/vignette.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "compose/test_stacks/host.hpp"
#include "compose/test_stacks/random_stack.hpp"
#include "compose/test_stacks/support.hpp"
#include "develop/reference_chain.hpp"
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

constexpr ColorState light_709{};
constexpr ColorState light_2020{.primaries = Primaries::Rec2020};

const std::array<ColorState, 7> targets{srgb_color, p3_color, pq_color, hlg_color, scrgb_color, light_709, light_2020};

/// What a stack may hand to the target: 0 is light, 1 an encode that is off, the others code values.
constexpr std::uint32_t encoders = 8;
void add_encoder(Composer& composer, std::uint32_t which) {
    constexpr std::array<TransferFunction, 6> transfers{TransferFunction::Srgb, TransferFunction::Gamma22,
                                                        TransferFunction::Pq,   TransferFunction::Scrgb,
                                                        TransferFunction::Hlg,  TransferFunction::P3};
    if (which == 1) composer.add(Encode{}, {.enabled = false});
    if (which >= 2) composer.add(Encode{.transfer = transfers[which - 2]});
}
bool ends_at_white(std::uint32_t encoder) { return encoder == 2 || encoder == 3 || encoder == 7; }

/// A grey patch a column, in cd/m2.
constexpr std::array<double, 8> patches{0.5, 5, 20, 50, 100, 203, 406, 900};
ReferenceImage picture_of_patches() {
    ReferenceImage out(8, 4);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double light = patches[x] / 203;
            out.at(x, y) = {light, light, light, 1};
        }
    return out;
}

TEST(ComposeColorState, PatchesHaveTheirLuminanceOnEveryTargetWhateverTheStackMakes) {
    const ReferenceImage picture = picture_of_patches();
    for (const ColorState& target : targets) {
        const bool takes_light = target.domain != Domain::Encoded;
        for (std::uint32_t encoder = 0; encoder < encoders; ++encoder) {
            for (const bool is_fused : {true, false}) {
                SCOPED_TRACE(testing::Message() << static_cast<int>(target.transfer) << " of primaries "
                                                << static_cast<int>(target.primaries) << ", encoder " << encoder
                                                << ", fused " << is_fused);
                const ReferenceImage out = test::develop([&](Composer& composer) { add_encoder(composer, encoder); },
                                                         picture, {.fuse = is_fused, .target_color = target});
                ASSERT_EQ(out.pixels.size(), picture.pixels.size());
                for (std::uint32_t x = 0; x < patches.size(); ++x) {
                    double wanted = patches[x];
                    if (!takes_light && (target.peak_nits == 203 || ends_at_white(encoder)))
                        wanted = std::min(wanted, 203.0);
                    const Rgba& p = out.at(x, 2);
                    const std::array<double, 3> light = nits_of({p.r, p.g, p.b}, target);
                    for (const double nits : light) EXPECT_NEAR(nits, wanted, 0.005 * wanted) << wanted;
                }
            }
        }
    }
}

TEST(ComposeColorState, ColoursAreThoseOfTheReferenceOnEveryTarget) {
    ReferenceImage picture = test::round_to_float(test::random_hdr(16, 16, 4));
    for (Rgba& p : picture.pixels) p = {std::min(p.r, 40.0), std::min(p.g, 40.0), std::min(p.b, 40.0), p.a};
    for (const ColorState& target : targets) {
        for (std::uint32_t encoder = 0; encoder < encoders; ++encoder) {
            SCOPED_TRACE(testing::Message() << static_cast<int>(target.transfer) << " of primaries "
                                            << static_cast<int>(target.primaries) << ", encoder " << encoder);
            const auto fill = [&](Composer& composer) { add_encoder(composer, encoder); };
            const ReferenceImage out = test::develop(fill, picture, {.target_color = target});
            Composer composer(test::Host(picture).device);
            fill(composer);
            const auto expected = run_reference(composer, {.color = &picture, .target_color = target});
            ASSERT_TRUE(expected) << expected.error().text;
            // Of a code of 12 bits, or of the light; near black a code of PQ is less than what anybody sees.
            for (std::size_t i = 0; i < out.pixels.size(); ++i) {
                const std::array a{out.pixels[i].r, out.pixels[i].g, out.pixels[i].b};
                const std::array b{expected->picture.pixels[i].r, expected->picture.pixels[i].g,
                                   expected->picture.pixels[i].b};
                for (std::size_t c = 0; c < 3; ++c) {
                    const bool is_black = target.transfer == Transfer::Pq && 10000 * pq_decoded(a[c]) < 1e-3 &&
                                          10000 * pq_decoded(b[c]) < 1e-3;
                    if (!is_black) {
                        EXPECT_NEAR(a[c], b[c], std::max(1.0 / 4095, 1e-3 * std::abs(b[c]))) << i;
                    }
                }
            }
        }
    }
}

// IEC 61966-2-1: 12.92 times the light up to 0.0031308.
TEST(ComposeColorState, TheCurveOfSrgbIsALineNearBlackAlone) {
    ReferenceImage picture(16, 2);
    for (std::uint32_t x = 0; x < picture.width; ++x)
        for (std::uint32_t y = 0; y < 2; ++y) {
            const double light = 0.0026 + 0.0001 * x;
            picture.at(x, y) = {light, light, light, 1};
        }
    picture = test::round_to_float(picture);
    for (const ColorState& target : {srgb_color, p3_color}) {
        const ReferenceImage codes = test::develop([](Composer&) {}, picture, {.target_color = target});
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const double light = picture.at(x, 0).r;
            EXPECT_NEAR(codes.at(x, 0).r, light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055,
                        5e-6);
        }
    }
}

TEST(ComposeColorState, TheInterfaceHasItsLuminanceWhateverTheTargetsWhite) {
    const ReferenceImage ui = half_covered(1), picture = test::uniform(16, 8, {0.5, 0.5, 0.5, 1});
    for (const ColorState& told : {pq_color, hlg_color, scrgb_color}) {
        for (std::uint32_t encoder = 0; encoder < 2; ++encoder) {
            for (const bool is_fused : {true, false}) {
                ColorState target = told;
                target.white_nits = 300;
                SCOPED_TRACE(testing::Message() << static_cast<int>(target.transfer) << " " << encoder << is_fused);
                const ReferenceImage out = test::develop(
                    [&](Composer& composer) {
                        add_encoder(composer, encoder);
                        composer.add(UiComposite{});
                    },
                    picture, {.fuse = is_fused, .target_color = target, .ui = &ui});
                const auto green = [&](std::uint32_t x) {
                    const Rgba& p = out.at(x, 4);
                    return nits_of({p.r, p.g, p.b}, target)[1];
                };
                EXPECT_NEAR(green(2), 203, 0.005 * 203);
                EXPECT_NEAR(green(12), 150, 0.005 * 150);
            }
        }
    }
}

TEST(ComposeColorState, AnSrgbTargetGetsTheSameBitsWhetherItIsToldOrNot) {
    const ReferenceImage picture = test::round_to_float(test::random_display(64, 64, 3));
    for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB}) {
        for (const std::uint32_t encoder : {0u, 1u, 2u}) {
            for (const bool is_fused : {true, false}) {
                const auto fill = [&](Composer& composer) { add_encoder(composer, encoder); };
                test::RunOptions options{.fuse = is_fused, .target = format};
                const ReferenceImage before = test::develop(fill, picture, options);
                options.target_color = srgb_color;
                const ReferenceImage told = test::develop(fill, picture, options);
                EXPECT_EQ(test::worst_difference(before, told), 0) << format << " " << encoder << is_fused;
            }
        }
    }
}

ReferenceImage multiplied_by_alpha(ReferenceImage picture) {
    for (Rgba& p : picture.pixels) p = {p.r * p.a, p.g * p.a, p.b * p.a, p.a};
    return picture;
}
/// An edge: opaque to the left, a quarter to the right, a half where both meet.
ReferenceImage picture_of_an_edge() {
    ReferenceImage out = test::random_display(24, 8, 5);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            Rgba& p = out.at(x, y);
            p = {4 * p.r, 4 * p.g, 4 * p.b, x < 12 ? 1.0 : x == 12 ? 0.5 : 0.25};
        }
    return test::round_to_float(out);
}

// Of all effects of a pixel's colour alone: one that forgets to say WorkingSpace::Straight is found, too. The others
// make a multiple of it, or add what they make of pixels around it.
TEST(ComposeColorState, ColoursAreMappedWithoutTheirAlpha) {
    const std::set<std::string_view> others{"anamorphic_streaks", "arena_bloom",    "auto_exposure", "bloom",
                                            "classic_bloom",      "depth_of_field", "dither",        "frame_blend",
                                            "god_rays",           "halation",       "lens_dirt",     "lens_flare",
                                            "motion_blur",        "ssao",           "volumetric"};
    const ReferenceImage straight = picture_of_an_edge(), associated = multiplied_by_alpha(straight);
    std::size_t tried = 0;
    for (const EffectInfo* const info : all_effects()) {
        if (info->touch != Touch::Pointwise || info->has_second() || others.contains(info->name)) continue;
        SCOPED_TRACE(info->name);
        ++tried;
        for (const float opacity : {1.0f, 0.5f}) {
            const auto fill = [&](Composer& composer) {
                std::mt19937 random(3);
                test::set_random(random, composer, composer.add(*info, nullptr, {.opacity = opacity}),
                                 test::Values::Sane);
            };
            const ReferenceImage expected = multiplied_by_alpha(test::develop(fill, straight));
            const ReferenceImage out = test::develop(fill, associated, {.is_color_associated = true});
            const double bound = info->name == "posterize" ? 1e-3 : 2e-5;
            for (std::size_t i = 0; i < out.pixels.size(); ++i) {
                const Rgba &a = out.pixels[i], &b = expected.pixels[i];
                const double most = bound * std::max({std::abs(b.r), std::abs(b.g), std::abs(b.b), 1.0});
                EXPECT_NEAR(a.r, b.r, most) << i;
                EXPECT_NEAR(a.g, b.g, most) << i;
                EXPECT_NEAR(a.b, b.b, most) << i;
                EXPECT_EQ(a.a, b.a);
            }
        }
    }
    EXPECT_GE(tried, 1U);
}

TEST(ComposeColorState, ATargetGetsItsColoursWithOrWithoutAlphaAsItSays) {
    const ReferenceImage straight = picture_of_an_edge(), associated = multiplied_by_alpha(straight);
    for (const ColorState& target : {srgb_color, pq_color, light_709}) {
        for (std::uint32_t encoder = 0; encoder < 3; ++encoder) {
            const auto fill = [&](Composer& composer) {
                composer.add(Tonemap{});
                add_encoder(composer, encoder);
            };
            const auto out = [&](bool is_associated, bool is_wanted, bool is_fused) {
                ColorState told = target;
                told.is_associated = is_wanted;
                return test::develop(fill, is_associated ? associated : straight,
                                     {.fuse = is_fused, .is_color_associated = is_associated, .target_color = told});
            };
            const ReferenceImage expected = out(false, false, true);
            for (const bool is_associated : {false, true})
                for (const bool is_wanted : {false, true})
                    for (const bool is_fused : {true, false}) {
                        SCOPED_TRACE(testing::Message() << encoder << is_associated << is_wanted << is_fused);
                        const ReferenceImage made = out(is_associated, is_wanted, is_fused);
                        EXPECT_LE(test::worst_difference(made, is_wanted ? multiplied_by_alpha(expected) : expected),
                                  2e-5);
                        const ReferenceImage& picture = is_associated ? associated : straight;
                        Composer composer(Device::assumed());
                        fill(composer);
                        ColorState told = target;
                        told.is_associated = is_wanted;
                        const auto reference = run_reference(
                            composer, {.color = &picture, .is_color_associated = is_associated, .target_color = told});
                        ASSERT_TRUE(reference) << reference.error().text;
                        EXPECT_LE(test::worst_difference(made, reference->picture), 2e-4);
                    }
        }
    }
}

// What an entry made in the frame before is what it was then: code values are not encoded again.
TEST(ComposeColorState, ThePictureOfTheFrameBeforeKeepsItsState) {
    const test::Host host(test::uniform(4, 4, {0.2, 0.2, 0.2, 1}));
    CompileDesc desc = host.compile_desc();
    desc.encodes_target = true;
    const auto shown = [&](auto fill) {
        Composer composer(host.device);
        fill(composer);
        test::must(composer.compile(desc));
        for (int i = 0; i < 4; ++i) test::must(host.record(composer, host.frame()));
        return host.run(composer).at(1, 1).r;
    };
    const double once = shown([](Composer& composer) { composer.add(Encode{}); });
    EXPECT_NEAR(once, 0.4845, 1e-3) << "sRGB's curve of 0.2";
    EXPECT_NEAR(shown([](Composer& composer) {
                    const Handle encode = composer.add(Encode{});
                    composer.add(Vignette{.intensity = 0}, {.input = encode.previous()});
                }),
                once, 1e-5);
    EXPECT_NEAR(shown([](Composer& composer) {
                    const Handle encode = composer.add(Encode{});
                    composer.add(Blend{}, {.input = encode.previous(), .second = encode, .opacity = 0.5f});
                }),
                once, 1e-5);
    // Of an entry that comes later, in a loop of its own.
    EXPECT_NEAR(shown([](Composer& composer) {
                    const Handle copy = composer.add(Vignette{.intensity = 0}, {.input = scene_color});
                    const Handle encode = composer.add(Encode{}, {.input = scene_color});
                    test::must(composer.rewire(copy, {.input = encode.previous()}));
                    composer.add(Blend{.amount = 1}, {.input = encode, .second = copy});
                }),
                once, 1e-5);
}

TEST(ComposeColorState, ATargetThatCannotHoldWhatItSaysIsRefused) {
    test::Host host(test::uniform(4, 4, {1, 1, 1, 1}));
    Composer composer(host.device);
    const auto error = [&](ColorState color, VkFormat format) {
        CompileDesc desc = host.compile_desc();
        desc.target.format = format;
        desc.target_color = color;
        const auto plan = composer.plan(desc);
        return plan ? std::string() : plan.error().text;
    };
    EXPECT_EQ(error(pq_color, VK_FORMAT_A2B10G10R10_UNORM_PACK32), "");
    EXPECT_EQ(error(p3_color, VK_FORMAT_R8G8B8A8_SRGB), "");
    EXPECT_EQ(error(pq_color, VK_FORMAT_R8G8B8A8_SRGB),
              "target_color.transfer: an SRGB format has the curve of sRGB: allowed is Srgb");
    ColorState dark = pq_color;
    dark.peak_nits = 0;
    EXPECT_EQ(error(dark, VK_FORMAT_R16G16B16A16_SFLOAT), "target_color.peak_nits = 0: allowed are 1 to 10000");
    EXPECT_EQ(error({.transfer = Transfer::Pq}, VK_FORMAT_R16G16B16A16_SFLOAT),
              "target_color.transfer: light has none: allowed is Linear");
}

TEST(ComposeColorState, ThePlanRemarksWhatDoesNotFitTheTarget) {
    test::Host host(test::uniform(4, 4, {1, 1, 1, 1}));
    const auto remarks = [&](ColorState target, auto fill) {
        Composer composer(host.device);
        fill(composer);
        CompileDesc desc = host.compile_desc();
        desc.target_color = target;
        const auto plan = composer.plan(desc);
        std::string out;
        for (const std::string& remark : plan->remarks) out += remark + "\n";
        return out;
    };
    const auto curve = [](Tonemap tonemap) { return [tonemap](Composer& composer) { composer.add(tonemap); }; };
    constexpr auto bt2390 = TonemapOperator::Bt2390;
    EXPECT_EQ(remarks(pq_color, curve({})),
              "tonemap ends the picture at 203 cd/m2; the target shows up to 1000 cd/m2.\n");
    EXPECT_EQ(remarks(pq_color, curve({.curve = bt2390, .peak_nits = 1000})), "");
    EXPECT_EQ(remarks(pq_color, curve({.curve = bt2390, .peak_nits = 4000})),
              "tonemap ends the picture at 4000 cd/m2; the target clips it at 1000 cd/m2.\n");
    EXPECT_EQ(remarks(srgb_color, curve({})), "");
    EXPECT_EQ(remarks(pq_color, [](Composer&) {}),
              "the picture is the scene's light, without an end; the target clips it at 1000 cd/m2.\n");
    const std::string turned = remarks(pq_color, [](Composer& composer) {
        composer.add(Tonemap{});
        composer.add(Encode{});
    });
    EXPECT_NE(
        turned.find("encode makes code values, Rec. 709, sRGB, white 203 cd/m2, up to 203 cd/m2; the target takes "
                    "code values, Rec. 2020, PQ, white 203 cd/m2, up to 1000 cd/m2: the last kernel turns one "
                    "into the other.\n"),
        std::string::npos)
        << turned;
}

}  // namespace
}  // namespace darkroom
