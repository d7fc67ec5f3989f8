// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <darkroom/effects/encode.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "compose/test_stacks/support.hpp"
#include "encode/encode_reference.hpp"

namespace darkroom {
namespace {

Rgba encoded(const Encode& parameters, const Rgba& color) { return encode_reference(color, {}, parameters); }
double encoded_grey(const Encode& parameters, double light) { return encoded(parameters, {light, light, light}).g; }

TEST(EffectEncode, SrgbHasTheStandardsValues) {
    const Encode srgb;
    EXPECT_EQ(std::lround(encoded_grey(srgb, 0.5) * 255.0), 188);
    EXPECT_EQ(std::lround(encoded_grey(srgb, 0.2140411405) * 1e8), 50000000);
    EXPECT_EQ(encoded_grey(srgb, 0.0), 0.0);
    EXPECT_NEAR(encoded_grey(srgb, 1.0), 1.0, 1e-15);
    // The two pieces of the standard meet.
    EXPECT_NEAR(encoded_grey(srgb, 0.0031308), encoded_grey(srgb, std::nextafter(0.0031308, 1.0)), 1e-7);
}

TEST(EffectEncode, SdrCurvesClampAndNeverFall) {
    for (const TransferFunction transfer : {TransferFunction::Srgb, TransferFunction::Gamma22}) {
        EXPECT_EQ(encoded_grey({.transfer = transfer}, -1.0), 0.0);
        EXPECT_NEAR(encoded_grey({.transfer = transfer}, 12.0), 1.0, 1e-15);
        EXPECT_EQ(encoded_grey({.transfer = transfer}, std::numeric_limits<double>::quiet_NaN()), 0.0);
        double before = 0.0;
        for (double light = 1e-5; light < 2.0; light *= 1.01) {
            const double value = encoded_grey({.transfer = transfer}, light);
            EXPECT_GE(value, before) << light;
            before = value;
        }
    }
}

TEST(EffectEncode, PqHasTheStandardsValues) {
    const Encode one_is_peak{.transfer = TransferFunction::Pq, .white_nits = 10000, .peak_nits = 10000};
    EXPECT_NEAR(encoded_grey(one_is_peak, 1.0), 1.0, 1e-6);
    EXPECT_NEAR(encoded_grey(one_is_peak, 0.0), 7.3e-7, 1e-8);
    EXPECT_NEAR(encoded_grey(one_is_peak, 0.1), 0.751827, 1e-6);
    EXPECT_NEAR(encoded_grey(one_is_peak, 0.01), 0.508078, 1e-6);
    // ITU-R BT.2408: reference white is 58 % PQ.
    const Encode defaults{.transfer = TransferFunction::Pq};
    EXPECT_NEAR(encoded_grey(defaults, 1.0), 0.580689, 1e-6);
    EXPECT_NEAR(encoded_grey(defaults, 1e9), 0.751827, 1e-6) << "clipped at peak_nits";
}

// ITU-R BT.2087: red of Rec. 709 lies inside Rec. 2020.
TEST(EffectEncode, PqConvertsPrimaries) {
    const Encode pq{.transfer = TransferFunction::Pq, .white_nits = 10000, .peak_nits = 10000};
    const Rgba red = encoded(pq, {1, 0, 0});
    EXPECT_NEAR(red.r, pq_encoded(0.6274), 1e-4);
    EXPECT_NEAR(red.g, pq_encoded(0.0691), 1e-4);
    EXPECT_NEAR(red.b, pq_encoded(0.0164), 1e-4);
}

TEST(EffectEncode, ScrgbIsLinearAndKeepsNegative) {
    const Encode scrgb{.transfer = TransferFunction::Scrgb};
    EXPECT_NEAR(encoded_grey(scrgb, 1.0), 203.0 / 80.0, 1e-12);
    EXPECT_NEAR(encoded_grey(scrgb, -0.1), -20.3 / 80.0, 1e-12);
    EXPECT_NEAR(encoded_grey(scrgb, 100.0), 1000.0 / 80.0, 1e-12);
    EXPECT_NEAR(encoded_grey({.transfer = TransferFunction::Scrgb, .white_nits = 80}, 0.7), 0.7, 1e-12);
}

TEST(EffectEncode, MakesEncodedUnlessNone) {
    const Encode srgb, none{.transfer = TransferFunction::None};
    const EffectInfo& info = effect_info(srgb);
    EXPECT_EQ(info.makes({.domain = Domain::DisplayLinear}, &srgb).domain, Domain::Encoded);
    EXPECT_EQ(info.makes({.domain = Domain::DisplayLinear}, &none).domain, Domain::DisplayLinear);
    EXPECT_EQ(info.makes({.domain = Domain::SceneLinear}, &none).domain, Domain::SceneLinear);
    EXPECT_TRUE(info.is_identity(&none));
    EXPECT_FALSE(info.is_identity(&srgb));
}

TEST(EffectEncode, GpuLeavesThePictureWithNone) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(32, 32, 5));
    const ReferenceImage out =
        test::develop([](Composer& composer) { composer.add(Encode{.transfer = TransferFunction::None}); }, picture);
    EXPECT_EQ(test::worst_difference(out, picture), 0.0);
}

// Finer than 2 units of half precision: the bound that the shader states, and rounding.
TEST(EffectEncode, GpuSrgbKeepsItsStatedError) {
    constexpr std::uint32_t side = 256;
    ReferenceImage ramp(side, side);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const double light = i / double{side * side - 1};
        ramp.pixels[i] = {light, light * 0.0031308 * 2.0, light * light * light, 1.0};
    }
    ramp = test::round_to_float(ramp);
    const ReferenceImage out = test::develop([](Composer& composer) { composer.add(Encode{}); }, ramp);
    const ReferenceImage expected = test::reference_of(Encode{}, ramp);
    ASSERT_EQ(out.pixels.size(), expected.pixels.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const Rgba &a = out.pixels[i], &b = expected.pixels[i];
        for (const auto& [x, y] : {std::array{a.r, b.r}, std::array{a.g, b.g}, std::array{a.b, b.b}})
            if (y > 0.0) worst = std::max(worst, std::abs(x - y) / y);
        EXPECT_GE(a.r, i > 0 ? out.pixels[i - 1].r : 0.0) << i;
    }
    EXPECT_LE(worst, 3.5e-5);
    EXPECT_EQ(out.pixels.back().r, 1.0);
    EXPECT_EQ(out.pixels.front().r, 0.0);
}

TEST(EffectEncode, GpuMatchesReference) {
    const ReferenceImage hdr = test::round_to_float(test::random_hdr(67, 41, 1));
    const ReferenceImage display = test::round_to_float(test::random_display(64, 64, 2));
    for (const TransferFunction transfer :
         {TransferFunction::Srgb, TransferFunction::Gamma22, TransferFunction::Pq, TransferFunction::Scrgb,
          TransferFunction::None, TransferFunction::Hlg, TransferFunction::P3}) {
        SCOPED_TRACE(static_cast<int>(transfer));
        test::expect_gpu_matches_reference(Encode{.transfer = transfer}, hdr);
        test::expect_gpu_matches_reference(Encode{.transfer = transfer, .white_nits = 80, .peak_nits = 10000}, display);
    }
}

// The exponent of the OOTF would be 0 at 1.4 cd/m2 and -0.06 at 1, by the formula for displays of 400 to 2000 cd/m2.
TEST(EffectEncode, HlgIsForDisplaysOfEveryPeak) {
    ReferenceImage picture = test::random_display(64, 64, 3);
    picture.pixels[0] = {0, 0, 0, 1};
    picture.pixels[1] = {1e-6, 0, 1e-6, 1};
    picture = test::round_to_float(picture);
    for (const float peak : {1.0F, 1.38949F, 1.5F, 100.0F, 399.0F, 400.0F, 2000.0F, 2001.0F}) {
        SCOPED_TRACE(peak);
        const Encode hlg{.transfer = TransferFunction::Hlg, .white_nits = peak, .peak_nits = peak};
        EXPECT_EQ(encoded_grey(hlg, 0), 0.0);
        EXPECT_NEAR(encoded_grey(hlg, 1), 1.0, 1e-6);
        double before = 0;
        for (double light = 1e-5; light < 1; light *= 1.01) {
            const double value = encoded_grey(hlg, light);
            EXPECT_GT(value, before) << light;
            before = value;
        }
        test::expect_gpu_matches_reference(hlg, picture);
    }
}

}  // namespace
}  // namespace darkroom
