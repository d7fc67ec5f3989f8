// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/kawase_blur.hpp>
#include <limits>

#include "compose/test_stacks/support.hpp"
#include "gpu/test_support.hpp"
#include "kawase_blur/kawase_blur_reference.hpp"

namespace darkroom {
namespace {

constexpr KawaseBlurMode dual = KawaseBlurMode::Dual, kawase = KawaseBlurMode::Kawase;

ReferenceImage developed(const KawaseBlur& blur, const ReferenceImage& picture,
                         KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(blur); }, picture, {.kernels = kernels});
}

/// What rounding can explain: a write in half precision a pass, which the software driver cuts off toward zero, up to
/// 2^-10 of the value, and of the magnitudes where signs differ; and a tap's place, a float, which across 64 pixels is
/// known to 2^-17 of one, and where it is filtered to filter_step in either direction.
double worst_excess(const KawaseBlur& blur, const ReferenceImage& picture, const ReferenceImage& gpu) {
    const ReferenceImage expected = test::reference_of(blur, picture);
    ReferenceImage magnitude = picture;
    double brightest = 0;
    for (Rgba& color : magnitude.pixels) {
        color = {std::abs(color.r), std::abs(color.g), std::abs(color.b), color.a};
        brightest = std::max({brightest, color.r, color.g, color.b});
    }
    const ReferenceImage size = test::reference_of(blur, magnitude);
    if (gpu.pixels.size() != expected.pixels.size()) return 1e9;
    const double passes = blur.iterations * (blur.mode == dual ? 2.0 : 1.0);
    const double place = 0x1p-17 + 2 * gpu::test::filter_step();
    double worst = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        const Rgba &want = expected.pixels[i], &got = gpu.pixels[i], &of = size.pixels[i];
        const auto check = [&](double w, double g, double m) {
            const double allowed = passes * (m * 0x1p-10 + brightest * place + 0x1p-22);
            worst = std::max(worst, std::isfinite(g) ? std::abs(w - g) / allowed : 1e9);
        };
        check(want.r, got.r, of.r);
        check(want.g, got.g, of.g);
        check(want.b, got.b, of.b);
        if (!(std::abs(want.a - got.a) <= passes * of.a * 0x1p-10)) return 1e9;
    }
    return worst;
}

TEST(EffectKawaseBlur, GpuMatchesReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(61, 44, 41));
    for (const KawaseBlur& blur :
         {KawaseBlur{.mode = dual, .iterations = 1}, KawaseBlur{.mode = dual, .iterations = 3},
          KawaseBlur{.mode = dual, .iterations = 8, .offset = 1.7f}, KawaseBlur{.mode = kawase, .iterations = 1},
          KawaseBlur{.mode = kawase, .iterations = 5}, KawaseBlur{.mode = kawase, .iterations = 2, .offset = 0.3f}})
        for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
            EXPECT_LE(worst_excess(blur, picture, developed(blur, picture, kernels)), 1.0)
                << (blur.mode == dual ? "dual " : "kawase ") << blur.iterations;
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 9u}, {8u, 3u}}) {
        const ReferenceImage small = test::round_to_float(test::random_hdr(width, height, 42));
        for (const KawaseBlurMode mode : {dual, kawase})
            EXPECT_LE(worst_excess({.mode = mode}, small, developed({.mode = mode}, small)), 1.0)
                << width << "x" << height;
    }
}

TEST(EffectKawaseBlur, FourTapsAreTheMeanOfSixteenTexels) {
    // One pass of corners into a picture of half the size: each tap lies on a corner of four texels. Then the doubling
    // with all its taps in one place, which is the bilinear filter.
    EffectInfo info = effect_info(KawaseBlur{});
    info.build = [](PassBuilder& builder) {
        KernelPassDesc pass{.name = "four taps",
                            .shader = "kawase_blur.glsl#corners",
                            .inputs = {{.name = "kawase_blur_input", .image = builder.picture()}},
                            .output = builder.create({.name = "half", .denominator = 2}),
                            .custom_vectors = 1,
                            .constants = [](const void*, const PassContext& context, std::span<PassVector> out) {
                                out[0] = {0.5f / static_cast<float>(context.output_extent.width),
                                          0.5f / static_cast<float>(context.output_extent.height), 0, 0};
                            }};
        pass.inputs[0].image = builder.add(pass);
        pass.shader = "kawase_blur.glsl#double";
        pass.output = builder.create({.name = "full"});
        pass.constants = [](const void*, const PassContext&, std::span<PassVector> out) { out[0] = {}; };
        builder.result(builder.add(pass));
    };
    const ReferenceImage picture = test::round_to_half(test::random_display(32, 24, 5));
    for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster}) {
        const ReferenceImage out = test::develop(
            [&](Composer& composer) { composer.add(info, nullptr, {.name = "four"}); }, picture, {.kernels = kernels});
        ASSERT_EQ(out.pixels.size(), picture.pixels.size());
        ReferenceImage half(16, 12);
        for (std::uint32_t y = 0; y < 12; ++y)
            for (std::uint32_t x = 0; x < 16; ++x)
                for (std::int64_t j = -1; j <= 2; ++j)
                    for (std::int64_t i = -1; i <= 2; ++i)
                        half.at(x, y) =
                            weighed_sum_reference(half.at(x, y), picture.clamped(2 * x + i, 2 * y + j), 1.0 / 16);
        double worst = 0;
        for (std::uint32_t y = 0; y < 24; ++y)
            for (std::uint32_t x = 0; x < 32; ++x) {
                const Rgba expected = sample_reference(half, (x + 0.5) / 32, (y + 0.5) / 24);
                worst = std::max(worst, std::abs(out.at(x, y).r - expected.r));
            }
        // Two writes cut off toward zero in half precision, below 1; and the places of taps.
        EXPECT_LE(worst, 2 * 0x1p-11 + 0x1p-16);
    }
}

TEST(EffectKawaseBlur, FlatFieldsStayAndLightIsKept) {
    const ReferenceImage flat = test::uniform(40, 24, {3, 2, 1, 0.25});
    ReferenceImage spot(256, 256);
    spot.at(120, 131) = {1, 1, 1, 1};
    for (const KawaseBlur& blur : {KawaseBlur{}, KawaseBlur{.mode = kawase, .iterations = 6}}) {
        EXPECT_LT(test::worst_difference(test::reference_of(blur, flat), flat), 1e-12);
        double sum = 0;
        for (const Rgba& color : test::reference_of(blur, spot).pixels) sum += color.r;
        EXPECT_NEAR(sum, 1.0, 1e-12);
    }
}

TEST(EffectKawaseBlur, MoreIterationsAreWider) {
    ReferenceImage spot(256, 256);
    spot.at(128, 128) = {1, 1, 1, 1};
    for (const KawaseBlurMode mode : {dual, kawase}) {
        double before = 0;
        for (std::int32_t iterations = 1; iterations <= 4; ++iterations) {
            const ReferenceImage out = test::reference_of(KawaseBlur{mode, iterations, 1}, spot);
            double variance = 0;
            for (std::uint32_t y = 0; y < 256; ++y)
                for (std::uint32_t x = 0; x < 256; ++x) variance += out.at(x, y).r * (x - 128.0) * (x - 128.0);
            EXPECT_GT(variance, 1.5 * before) << iterations;
            before = variance;
        }
        // What the page says: 15 pixels; and 1/4 of every pass for its bilinear taps beside (i + 1/2)^2.
        EXPECT_NEAR(std::sqrt(before), mode == dual ? 15 : std::sqrt(21 + 4 / 4.0), mode == dual ? 1 : 1e-9);
    }
}

TEST(EffectKawaseBlur, WithoutOffsetKawaseChangesNothing) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(33, 20, 2));
    EXPECT_EQ(test::worst_difference(developed({.mode = kawase, .offset = 0}, picture), picture), 0.0);
}

TEST(EffectKawaseBlur, NanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = test::round_to_float(test::random_display(64, 64, 4)), broken = picture;
    broken.at(30, 30) = {nan, infinity, -infinity, 1};
    for (const KawaseBlur& blur :
         {KawaseBlur{.mode = dual, .iterations = 2}, KawaseBlur{.mode = kawase, .iterations = 3}}) {
        const ReferenceImage clean = developed(blur, picture), out = developed(blur, broken);
        ASSERT_EQ(out.pixels.size(), picture.pixels.size());
        for (std::uint32_t y = 0; y < 64; ++y)
            for (std::uint32_t x = 0; x < 64; ++x) {
                const Rgba& color = out.at(x, y);
                EXPECT_TRUE(std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b))
                    << x << "," << y;
                EXPECT_TRUE(color.r >= 0.0 && color.r <= 1.0) << "NaN counts as black: " << x << "," << y;
                if (std::max(std::abs(int(x) - 30), std::abs(int(y) - 30)) > 16) {
                    EXPECT_EQ(color.r, clean.at(x, y).r);
                }
            }
    }
}

}  // namespace
}  // namespace darkroom
