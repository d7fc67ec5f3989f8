// SPDX-License-Identifier: MIT
#include "image/compare/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>

#include "image/codec/decoder.hpp"
#include "image/compare/flip.hpp"

namespace darkroom {
namespace {

Picture uniform(std::uint32_t width, std::uint32_t height, float value) {
    Picture out(width, height);
    std::fill(out.pixels.begin(), out.pixels.end(), value);
    return out;
}

/// Hashed noise on a gradient: no symmetry, no repetition, values of 0 to 1.
Picture pattern(std::uint32_t width, std::uint32_t height, std::uint32_t seed) {
    Picture out(width, height);
    for (std::uint32_t i = 0; i < out.pixels.size(); ++i) {
        std::uint32_t hash = (i + seed) * 747796405U + 2891336453U;
        hash = ((hash >> ((hash >> 28U) + 4U)) ^ hash) * 277803737U;
        const float noise = static_cast<float>(hash >> 8U) * 0x1p-24f;
        const float gradient = static_cast<float>(i / 4 % width) / static_cast<float>(width);
        out.pixels[i] = 0.5f * noise + 0.5f * gradient;
    }
    return out;
}

Picture crop(const Picture& picture, std::uint32_t left, std::uint32_t top, std::uint32_t width, std::uint32_t height) {
    Picture out(width, height);
    for (std::uint32_t y = 0; y < height; ++y) {
        std::copy_n(picture.at(left, top + y), 4 * width, out.at(0, y));
    }
    return out;
}

Picture transpose(const Picture& picture) {
    Picture out(picture.height, picture.width);
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) std::copy_n(picture.at(y, x), 4, out.at(x, y));
    }
    return out;
}

constexpr FlipDesc scene_linear = {.encoding = PictureEncoding::SceneLinear};

TEST(Compare, IdenticalPicturesDifferByExactlyNothing) {
    const Picture picture = pattern(61, 97, 1);
    for (const PictureEncoding encoding : {PictureEncoding::Display, PictureEncoding::SceneLinear}) {
        const Result<Comparison> result = compare(picture, picture, {.encoding = encoding});
        ASSERT_TRUE(result) << result.error().text;
        EXPECT_EQ(result->max_error, 0.0);
        EXPECT_EQ(result->mean_error, 0.0);
        EXPECT_EQ(result->psnr, std::numeric_limits<double>::infinity());
        EXPECT_EQ(result->flip_mean, 0.0);
        EXPECT_EQ(result->flip_weighted_median, 0.0);
        EXPECT_EQ(result->flip_max, 0.0);
    }
}

TEST(Compare, DifferentSizesAreAnErrorThatNamesBoth) {
    const Result<Comparison> result = compare(uniform(3, 4, 0.0f), uniform(4, 3, 0.0f));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().fault, Fault::User);
    EXPECT_NE(result.error().text.find("3x4"), std::string::npos) << result.error().text;
    EXPECT_NE(result.error().text.find("4x3"), std::string::npos) << result.error().text;
}

TEST(Compare, EmptyPicturesAreAnError) { EXPECT_FALSE(compare(Picture(), Picture())); }

TEST(Compare, NumbersAreThoseOfTheDefinition) {
    const Picture reference = uniform(8, 8, 0.5f);
    Picture test = reference;
    test.at(3, 5)[1] = 0.75f;
    test.at(7, 7)[3] = 0.25f;
    const Result<Comparison> result = compare(reference, test);
    ASSERT_TRUE(result) << result.error().text;
    EXPECT_EQ(result->max_error, 0.25);
    EXPECT_EQ(result->alpha.max_error, 0.25);
    EXPECT_DOUBLE_EQ(result->mean_error, 0.25 / 192.0);
    EXPECT_DOUBLE_EQ(result->psnr, 10.0 * std::log10(192.0 / 0.0625));
    const Result<Comparison> linear = compare(reference, test, scene_linear);
    ASSERT_TRUE(linear) << linear.error().text;
    EXPECT_DOUBLE_EQ(linear->psnr, 10.0 * std::log10(0.25 * 192.0 / 0.0625));
}

TEST(Compare, NanInOnePictureIsAnInfiniteError) {
    const Picture reference = pattern(32, 32, 1);
    Picture test = reference;
    test.at(10, 20)[2] = std::numeric_limits<float>::quiet_NaN();
    for (const PictureEncoding encoding : {PictureEncoding::Display, PictureEncoding::SceneLinear}) {
        const Result<Comparison> result = compare(reference, test, {.encoding = encoding});
        ASSERT_TRUE(result) << result.error().text;
        EXPECT_EQ(result->max_error, std::numeric_limits<double>::infinity());
        EXPECT_EQ(result->mean_error, std::numeric_limits<double>::infinity());
        EXPECT_EQ(result->psnr, -std::numeric_limits<double>::infinity());
        EXPECT_EQ(result->flip_max, 1.0);
        EXPECT_LT(result->flip_mean, 0.5);
    }
    const Result<Comparison> same = compare(test, test);
    ASSERT_TRUE(same) << same.error().text;
    EXPECT_EQ(same->max_error, 0.0);
    EXPECT_EQ(same->flip_max, 0.0);
}

TEST(Compare, InfinitiesKeepFlipFinite) {
    const Picture reference = pattern(32, 32, 1);
    Picture test = reference;
    test.at(4, 4)[0] = std::numeric_limits<float>::infinity();
    test.at(9, 9)[0] = -std::numeric_limits<float>::infinity();
    const Result<Comparison> result = compare(reference, test, scene_linear);
    ASSERT_TRUE(result) << result.error().text;
    EXPECT_TRUE(std::isfinite(result->flip_mean));
    EXPECT_GT(flip(reference, test, scene_linear)->errors[4 * 32 + 4], 0.1f);
    EXPECT_EQ(result->max_error, std::numeric_limits<double>::infinity());
}

TEST(Compare, MapIsMagmaOfTheErrors) {
    const Picture reference = pattern(40, 30, 1);
    const Picture test = pattern(40, 30, 2);
    const Result<Comparison> result = compare(reference, test);
    const Result<FlipErrors> errors = flip(reference, test);
    ASSERT_TRUE(result && errors);
    ASSERT_EQ(result->flip_map.width, 40U);
    ASSERT_EQ(result->flip_map.height, 30U);
    const std::array<float, 3> expected = magma(errors->errors[12 * 40 + 7]);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(result->flip_map.at(7, 12)[i], expected[i]);
    EXPECT_EQ(result->flip_map.at(7, 12)[3], 1.0f);
}

TEST(Compare, MagmaIsThePublishedTable) {
    // Entries 0, 60, 131, 204 and 255 of 256; only the first and the last are knots of ours.
    const std::array<std::pair<int, std::array<float, 3>>, 5> entries = {{{0, {0.001462f, 0.000466f, 0.013866f}},
                                                                          {60, {0.291366f, 0.064553f, 0.475462f}},
                                                                          {131, {0.735616f, 0.221713f, 0.469180f}},
                                                                          {204, {0.994738f, 0.624350f, 0.427397f}},
                                                                          {255, {0.987053f, 0.991438f, 0.749504f}}}};
    for (const auto& [index, expected] : entries) {
        const std::array<float, 3> color = magma(static_cast<float>(index) / 255.0f);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(color[i], expected[i], 0.004f) << "entry " << index;
    }
    EXPECT_EQ(magma(std::numeric_limits<float>::quiet_NaN()), magma(0.0f));
    EXPECT_EQ(magma(2.0f), magma(1.0f));
}

// Expected numbers of the next test: test suite of OpenImageIO, "FLIP diff of dark.exr vs light.exr".
TEST(Flip, UniformPicturesGiveThePublishedErrors) {
    const Picture dark = uniform(64, 64, 0.099975586f);
    const Picture light = uniform(64, 64, 0.89990234f);
    const Result<FlipErrors> linear = flip(dark, light, scene_linear);
    ASSERT_TRUE(linear) << linear.error().text;
    // The square root in the feature term turns rounding of 1e-8 into 1e-4, so four printed digits are not all certain.
    EXPECT_NEAR(linear->mean, 0.2045, 1.5e-4);
    EXPECT_NEAR(linear->max, 0.2045, 1.5e-4);
    EXPECT_NEAR(linear->start_exposure, 4.41, 5e-3);
    EXPECT_NEAR(linear->stop_exposure, 4.41, 5e-3);
    EXPECT_EQ(linear->exposures, 2U);
    const auto encode = [](float value) { return 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f; };
    const Result<FlipErrors> display =
        flip(uniform(64, 64, encode(0.099975586f)), uniform(64, 64, encode(0.89990234f)));
    ASSERT_TRUE(display) << display.error().text;
    EXPECT_NEAR(display->mean, 0.9514, 1.5e-4);
    EXPECT_EQ(display->exposures, 0U);
}

/// A file's first three channels as they are in it, 0 to 1 for integers.
Picture read_values(const std::filesystem::path& path) {
    auto file = Decoder::open(path);
    if (!file) return {};
    const FilePart& part = file->parts().front();
    Picture out(part.width, part.height);
    const auto take = [&](std::uint32_t row, std::uint32_t rows, std::span<const float> samples) {
        for (std::size_t i = 0; i < std::size_t{rows} * part.width; ++i)
            std::copy_n(&samples[3 * i], 3, out.at(0, row) + 4 * i);
    };
    if (!file->read(0, 0, 3, take)) return {};
    return out;
}

struct Expected {
    const char* reference;
    const char* test;
    PictureEncoding encoding;
    double mean;
    double weighted_median;
    double min;
    double max;
};

// Made with the authors' own program, version 1.6, at its default viewing conditions; it prints six digits.
constexpr std::array<Expected, 8> expected_errors = {{
    {"ldr/reference.png", "ldr/test_blur5.png", PictureEncoding::Display, 0.087236, 0.121401, 0.000030, 0.703288},
    {"ldr/reference.png", "ldr/test_gain1.19.png", PictureEncoding::Display, 0.331334, 0.396693, 0.000784, 0.634032},
    {"ldr/reference.png", "ldr/test_gaussnoise04.png", PictureEncoding::Display, 0.081486, 0.092069, 0.002171,
     0.356077},
    {"ldr/reference.png", "ldr/test_jpeg12.png", PictureEncoding::Display, 0.143353, 0.162214, 0.001404, 0.550702},
    {"ldr/reference.png", "ldr/test_shift1px.png", PictureEncoding::Display, 0.124506, 0.171331, 0.000088, 0.936329},
    {"hdr/reference.exr", "hdr/test_blur5.exr", PictureEncoding::SceneLinear, 0.211083, 0.430883, 0.001935, 0.975845},
    {"hdr/reference.exr", "hdr/test_gain1.25.exr", PictureEncoding::SceneLinear, 0.271130, 0.275148, 0.144769,
     0.426905},
    {"hdr/reference.exr", "hdr/test_fireflies.exr", PictureEncoding::SceneLinear, 0.021833, 0.375835, 0.0, 0.908865},
}};

class FlipData : public testing::Test {
  protected:
    void SetUp() override {
        const char* const data = std::getenv("DARKROOM_TEST_DATA");
        if (data == nullptr) GTEST_SKIP() << "DARKROOM_TEST_DATA is not set";
        folder_ = std::filesystem::path(data) / "flip";
    }
    std::filesystem::path folder_;
};

TEST_F(FlipData, ErrorsAreThoseOfTheAuthorsProgram) {
    for (const Expected& expected : expected_errors) {
        const Picture reference = read_values(folder_ / expected.reference);
        ASSERT_FALSE(reference.empty()) << expected.reference;
        const Result<FlipErrors> result =
            flip(reference, read_values(folder_ / expected.test), {.encoding = expected.encoding});
        ASSERT_TRUE(result) << result.error().text;
        // Both programs compute in 32 bits, in another order.
        EXPECT_NEAR(result->mean, expected.mean, 1e-5) << expected.test;
        EXPECT_NEAR(result->weighted_median, expected.weighted_median, 1e-4) << expected.test;
        EXPECT_NEAR(result->min, expected.min, 1e-4) << expected.test;
        EXPECT_NEAR(result->max, expected.max, 1e-4) << expected.test;
        if (expected.encoding == PictureEncoding::SceneLinear) {
            EXPECT_NEAR(result->start_exposure, -6.5729, 1e-4);
            EXPECT_NEAR(result->stop_exposure, 1.1512, 1e-4);
            EXPECT_EQ(result->exposures, 8U);
        }
    }
}

// Expected numbers: test suite of OpenImageIO, "reference-crop.exr vs test-crop.exr".
TEST_F(FlipData, SceneLinearCropsGiveThePublishedErrors) {
    const Picture reference = read_values(folder_ / "oiio/reference-crop.exr");
    ASSERT_FALSE(reference.empty());
    const Result<FlipErrors> result = flip(reference, read_values(folder_ / "oiio/test-crop.exr"), scene_linear);
    ASSERT_TRUE(result) << result.error().text;
    EXPECT_NEAR(result->mean, 0.2789, 1e-4);
    EXPECT_NEAR(result->max, 0.8402, 1e-4);
    EXPECT_EQ(result->errors[137 * 160 + 110], static_cast<float>(result->max));
    EXPECT_EQ(result->exposures, 14U);
}

TEST(Flip, GreenAgainstBlueIsTheLargestError) {
    Picture green(24, 24);
    Picture blue(24, 24);
    for (std::size_t i = 0; i < green.pixels.size(); i += 4) green.pixels[i + 1] = blue.pixels[i + 2] = 1.0f;
    const Result<FlipErrors> result = flip(green, blue);
    ASSERT_TRUE(result) << result.error().text;
    EXPECT_NEAR(result->mean, 1.0, 1e-5);
}

TEST(Flip, DoesNotCareWhichPictureIsFirstUnlessExposuresAreChosen) {
    const Picture a = pattern(70, 110, 1);
    const Picture b = pattern(70, 110, 2);
    EXPECT_EQ(flip(a, b)->errors, flip(b, a)->errors);
}

TEST(Flip, TransposedPicturesGiveTransposedErrors) {
    const Picture a = pattern(70, 110, 1);
    const Picture b = pattern(70, 110, 2);
    const Result<FlipErrors> upright = flip(a, b);
    const Result<FlipErrors> lying = flip(transpose(a), transpose(b));
    ASSERT_TRUE(upright && lying);
    EXPECT_GT(upright->mean, 0.05);
    for (std::uint32_t y = 0; y < 110; ++y) {
        for (std::uint32_t x = 0; x < 70; ++x) {
            // Rounding differs with the order of the two passes.
            EXPECT_NEAR(upright->errors[y * 70 + x], lying->errors[x * 110 + y], 1e-4f);
        }
    }
}

TEST(Flip, APixelDependsOnItsSurroundingsOnly) {
    // 10 pixels are the radius of the widest filter; the crop moves the bands the pictures are worked on in.
    const Picture a = pattern(90, 200, 1);
    const Picture b = pattern(90, 200, 2);
    const Result<FlipErrors> whole = flip(a, b);
    const Result<FlipErrors> part = flip(crop(a, 5, 29, 70, 150), crop(b, 5, 29, 70, 150));
    ASSERT_TRUE(whole && part);
    for (std::uint32_t y = 10; y < 140; ++y) {
        for (std::uint32_t x = 10; x < 60; ++x) {
            EXPECT_EQ(whole->errors[(y + 29) * 90 + x + 5], part->errors[y * 70 + x]) << x << ' ' << y;
        }
    }
}

TEST(Flip, SmallerThanTheFiltersWorks) {
    const Result<FlipErrors> result = flip(uniform(1, 1, 0.1f), uniform(1, 1, 0.9f));
    ASSERT_TRUE(result) << result.error().text;
    EXPECT_GT(result->mean, 0.5);
}

TEST(Flip, BlackReferenceIsComparedAtOneExposure) {
    const Result<FlipErrors> result = flip(uniform(8, 8, 0.0f), uniform(8, 8, 0.5f), scene_linear);
    ASSERT_TRUE(result) << result.error().text;
    EXPECT_EQ(result->exposures, 1U);
    EXPECT_GT(result->mean, 0.1);
    EXPECT_LE(result->max, 1.0);
}

TEST(Flip, RefusesAnImpossibleViewer) {
    const Picture picture = uniform(4, 4, 0.5f);
    EXPECT_FALSE(flip(picture, picture, {.pixels_per_degree = 0.5}));
    EXPECT_FALSE(flip(picture, picture, {.pixels_per_degree = std::numeric_limits<double>::quiet_NaN()}));
    EXPECT_TRUE(flip(picture, picture, {.pixels_per_degree = 1.0}));
}

}  // namespace
}  // namespace darkroom
