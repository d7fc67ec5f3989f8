// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/effects/auto_exposure.hpp>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "auto_exposure/auto_exposure_reference.hpp"
#include "develop/test_sequence.hpp"
#include "image/frame/frame_file.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

using test::developed_sequence;
using test::reference_sequence;
using test::Shot;

const double grey = std::log2(0.18);

test::Fill stack_of(const AutoExposure& exposure) {
    return [exposure](Composer& composer) { composer.add(exposure); };
}
ReferenceImage grey_of(double stops, std::uint32_t width = 8, std::uint32_t height = 8) {
    const double light = 0.18 * std::exp2(stops);
    return test::round_to_float(test::uniform(width, height, {light, light, light, 1}));
}
/// Stops by which the brightest pixel of `picture` was multiplied.
double stops_of(const ReferenceImage& out, const ReferenceImage& picture) {
    const auto brightest = std::ranges::max_element(picture.pixels, {}, &Rgba::g) - picture.pixels.begin();
    const auto i = static_cast<std::size_t>(brightest);
    return std::log2(out.pixels.at(i).g / picture.pixels[i].g);
}
double metered_stops(const ReferenceImage& picture, const AutoExposure& exposure = {.darkest = -16, .brightest = 16}) {
    return -stops_of(developed_sequence(stack_of(exposure), std::vector<Shot>{{.color = picture}})[0], picture);
}
/// By sorting, without bins, in stops from middle grey.
double exact_mean(const ReferenceImage& picture, double low, double high) {
    std::vector<double> all;
    for (const Rgba& pixel : picture.pixels)
        all.push_back(std::log2(std::max(0.2126 * pixel.r + 0.7152 * pixel.g + 0.0722 * pixel.b, 0x1p-16)));
    std::ranges::sort(all);
    const double count = static_cast<double>(all.size());
    double sum = 0, parts = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double before = std::clamp(static_cast<double>(i), low * count, high * count);
        const double part = std::clamp(static_cast<double>(i + 1), low * count, high * count) - before;
        parts += part;
        sum += part * all[i];
    }
    return sum / parts - grey;
}
/// The first picture until it is settled, then another for `frames` frames.
std::vector<Shot> changing(const ReferenceImage& first, const ReferenceImage& then, std::size_t frames,
                           double delta_time) {
    std::vector<Shot> shots{{.color = first, .delta_time = delta_time}};
    shots.insert(shots.end(), frames, {.color = then, .delta_time = delta_time});
    return shots;
}

class EffectAutoExposureData : public WithData {
  protected:
    /// Every third pixel of each environment of the folder.
    [[nodiscard]] std::vector<std::pair<std::string, ReferenceImage>> environments() const {
        std::vector<std::pair<std::string, ReferenceImage>> out;
        for (const auto& entry : std::filesystem::directory_iterator(data_ / "env")) {
            const auto file = read_frame(entry.path());
            EXPECT_TRUE(file) << file.error().text;
            if (!file) continue;
            ReferenceImage picture(file->color.width / 3, file->color.height / 3);
            for (std::uint32_t y = 0; y < picture.height; ++y)
                for (std::uint32_t x = 0; x < picture.width; ++x) {
                    const float* const p = file->color.at(3 * x, 3 * y);
                    picture.at(x, y) = {p[0], p[1], p[2], 1};
                }
            out.emplace_back(entry.path().filename().string(), std::move(picture));
        }
        return out;
    }
};

}  // namespace

TEST(EffectAutoExposure, GpuMatchesReference) {
    Curve curve{.count = 3};
    curve.x = {-6, 0, 7};
    curve.y = {-3, 1, 0.5f};
    const AutoExposure own, bent{.compensation = 0.5f,
                                 .compensation_curve = curve,
                                 .low = 0,
                                 .high = 1,
                                 .darkest = -16,
                                 .brightest = 16,
                                 .center_weight = 0.8f};
    for (const auto& [width, height] : {std::pair{67u, 41u}, {130u, 35u}, {3u, 2u}, {1u, 1u}})
        for (const AutoExposure& exposure : {own, bent}) {
            std::vector<Shot> shots;
            for (std::uint32_t i = 0; i < 4; ++i)
                shots.push_back({.color = test::round_to_float(i % 2 == 0 ? test::random_hdr(width, height, i)
                                                                          : test::random_display(width, height, i)),
                                 .delta_time = 0.1});
            const auto expected = reference_sequence(stack_of(exposure), shots);
            for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster}) {
                const auto out = developed_sequence(stack_of(exposure), shots, kernels);
                for (std::size_t i = 0; i < shots.size(); ++i) {
                    // Half a sixteenth of a bin, and what a group's sum is rounded by.
                    const double stops = stops_of(expected[i], shots[i].color);
                    EXPECT_NEAR(stops_of(out[i], shots[i].color), stops, 1.1 / 256) << width;
                    const double factor = std::exp2(stops_of(out[i], shots[i].color));
                    for (std::size_t p = 0; p < out[i].pixels.size(); ++p) {
                        const Rgba &from = shots[i].color.pixels[p], &to = out[i].pixels[p];
                        EXPECT_NEAR(to.r, from.r * factor, std::abs(to.r) * 1e-6 + 1e-30);
                        EXPECT_EQ(to.a, from.a);
                    }
                }
            }
        }
}

TEST(EffectAutoExposure, GpuBringsAnyGreyToMiddleGrey) {
    for (const double stops : {-3.9, -0.26, 0.0, 0.7, 5.0, 7.99}) {
        const ReferenceImage picture = grey_of(stops);
        const auto shown = [&](const AutoExposure& exposure) {
            return developed_sequence(stack_of(exposure), std::vector<Shot>{{.color = picture}})[0].at(3, 3).g;
        };
        // Half a sixteenth of a bin.
        EXPECT_NEAR(std::log2(shown({})), grey, 1.01 / 256) << stops;
        EXPECT_NEAR(std::log2(shown({.compensation = 1.5f})), grey + 1.5, 1.01 / 256) << stops;
    }
}

TEST(EffectAutoExposure, GpuGoesNoFartherThanTheRange) {
    const AutoExposure exposure{.darkest = -2, .brightest = 3};
    for (const auto& [stops, expected] : {std::pair{-9.0, 2.0}, {-1.0, 1.0}, {2.0, -2.0}, {6.0, -3.0}}) {
        const ReferenceImage picture = grey_of(stops);
        const auto out = developed_sequence(stack_of(exposure), std::vector<Shot>{{.color = picture}});
        EXPECT_NEAR(stops_of(out[0], picture), expected, 1.01 / 256) << stops;
    }
}

TEST(EffectAutoExposure, GpuCurveAddsStopsByBrightness) {
    AutoExposure exposure{.darkest = -16, .brightest = 16};
    exposure.compensation_curve.count = 2;
    exposure.compensation_curve.x = {-8, 0};
    exposure.compensation_curve.y = {-4, 1};
    for (const auto& [stops, added] : {std::pair{-10.0, -4.0}, {-8.0, -4.0}, {-4.0, -1.5}, {0.0, 1.0}, {5.0, 1.0}}) {
        const ReferenceImage picture = grey_of(stops);
        const auto out = developed_sequence(stack_of(exposure), std::vector<Shot>{{.color = picture}});
        EXPECT_NEAR(stops_of(out[0], picture), added - stops, 0.01) << stops;
    }
}

TEST(EffectAutoExposure, GpuBlackPixelsCount) {
    ReferenceImage picture = grey_of(2, 20, 20);
    for (std::size_t i = 0; i < 120; ++i) picture.pixels[i] = {0, 0, 0, 1};
    const double black = -16 - grey;
    EXPECT_NEAR(metered_stops(picture, {.low = 0, .high = 1, .darkest = -16, .brightest = 16}), 0.3 * black + 0.7 * 2,
                0.01);
    EXPECT_NEAR(metered_stops(picture, {.low = 0.2f, .high = 0.5f, .darkest = -16, .brightest = 16}),
                (0.1 * black + 0.2 * 2) / 0.3, 0.01);
    EXPECT_NEAR(metered_stops(picture, {.low = 0.3f, .high = 1, .darkest = -16, .brightest = 16}), 2, 0.01);
}

TEST(EffectAutoExposure, GpuMetersTheCentreMore) {
    ReferenceImage picture = grey_of(0, 96, 64);
    double inside = 0, all = 0;
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 96; ++x) {
            const double right = (x + 0.5) / 48 - 1, down = (y + 0.5) / 32 - 1;
            const double near = 1 - (right * right + down * down) / 2, weight = near * near;
            all += weight;
            if (right * right + down * down > 0.25) continue;
            inside += weight;
            picture.at(x, y) = {0.18 * 16, 0.18 * 16, 0.18 * 16, 1};
        }
    AutoExposure exposure{.low = 0, .high = 1};
    const double even = metered_stops(picture, exposure);
    exposure.center_weight = 1;
    const double central = metered_stops(picture, exposure);
    EXPECT_NEAR(even, 4 * std::numbers::pi / 16, 0.02) << "the area";
    // Weights of 15 steps.
    EXPECT_NEAR(central, 4 * inside / all, 0.03);
    EXPECT_GT(central, 1.4 * even);
}

TEST(EffectAutoExposure, GpuAMaskSaysWhatCounts) {
    // 12 columns of 10 pixels: a third of the picture counts, a third by half, a third not.
    ReferenceImage picture(120, 24);
    ResourceImage mask{.width = 12, .height = 1, .rgba = {}};
    for (std::uint32_t x = 0; x < 120; ++x)
        for (std::uint32_t y = 0; y < 24; ++y) {
            const double light = 0.18 * std::exp2(x < 40 ? 2 : x < 80 ? -1 : 6);
            picture.at(x, y) = {light, light, light, 1};
        }
    for (const float weight : {1.0f, 0.5f, 0.0f})
        for (int i = 0; i < 4; ++i) mask.rgba.insert(mask.rgba.end(), {weight, 0.3f, 0.7f, 1});
    picture = test::round_to_float(picture);
    const auto masked = [](const AutoExposure& exposure, const ResourceImage& by) {
        return [=](Composer& composer) {
            AutoExposure own = exposure;
            own.metering_mask = gpu::test::must(composer.define(by));
            composer.add(own);
        };
    };
    const std::vector<Shot> shots{{.color = picture}};
    const AutoExposure all{.low = 0, .high = 1, .darkest = -16, .brightest = 16}, bent{.center_weight = 0.6f};
    const double seen = stops_of(developed_sequence(masked(all, mask), shots)[0], picture);
    // Between the middles of two columns of the mask it is mixed.
    EXPECT_NEAR(-seen, (1.0 * 2 + 0.5 * -1) / 1.5, 0.1);
    for (const AutoExposure& exposure : {all, bent})
        EXPECT_NEAR(stops_of(developed_sequence(masked(exposure, mask), shots)[0], picture),
                    stops_of(reference_sequence(masked(exposure, mask), shots)[0], picture), 0.02);
    const ResourceImage nothing{.width = 1, .height = 1, .rgba = {0, 1, 1, 1}};
    EXPECT_NEAR(stops_of(developed_sequence(masked({.compensation = 1}, nothing), shots)[0], picture), 1, 1e-6);
    const ResourceImage everything{.width = 1, .height = 1, .rgba = {1, 0, 0, 1}};
    EXPECT_EQ(test::worst_difference(developed_sequence(masked({}, everything), shots)[0],
                                     developed_sequence(stack_of({}), shots)[0]),
              0);
}

TEST(EffectAutoExposure, GpuNanAndInfinityAreBlackAndBright) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    ReferenceImage picture = grey_of(1, 16, 16), clean = picture;
    for (std::size_t i = 0; i < 64; ++i) {
        picture.pixels[3 * i] = i % 2 == 0 ? Rgba{nan, 1, 1, 1} : Rgba{infinity, infinity, infinity, 1};
        clean.pixels[3 * i] = i % 2 == 0 ? Rgba{0, 0, 0, 1} : Rgba{65504, 65504, 65504, 1};
    }
    const AutoExposure exposure{.low = 0, .high = 1, .darkest = -16, .brightest = 16};
    const auto shown = [&](const ReferenceImage& shot) {
        return developed_sequence(stack_of(exposure), std::vector<Shot>{{.color = shot}})[0].at(15, 15).g;
    };
    EXPECT_EQ(shown(picture), shown(clean));
}

TEST(EffectAutoExposure, GpuFirstFrameCutAndStandstillAreSettled) {
    const ReferenceImage dark = grey_of(-2), bright = grey_of(3);
    std::vector<Shot> cut = changing(dark, bright, 3, 1.0 / 60), jump = cut, standstill = cut;
    cut[2].camera.is_cut = true;
    jump[2].camera.view[12] = 31;  // metres
    standstill[2].delta_time = -1;
    for (const std::vector<Shot>& shots : {cut, jump, standstill})
        for (const auto& out : {developed_sequence(stack_of({}), shots), reference_sequence(stack_of({}), shots)}) {
            EXPECT_NEAR(stops_of(out[0], dark), 2, 0.01);
            EXPECT_NEAR(stops_of(out[1], bright), 2, 0.01) << "it has not moved yet";
            EXPECT_NEAR(stops_of(out[2], bright), -3, 0.01);
            EXPECT_NEAR(stops_of(out[3], bright), -3, 0.01);
        }
}

// A step of five stops: four at constant speed, the last one by e^-wt.
TEST(EffectAutoExposure, GpuFollowsOneCurveAtEveryFrameRate) {
    const ReferenceImage dark = grey_of(-2), bright = grey_of(3);
    const AutoExposure exposure{.speed_up = 8, .speed_down = 4};
    const auto left = [](double way) { return way < 4 ? 5 - way : std::exp(4 - way); };
    for (const double rate : {30.0, 60.0, 144.0, 1000.0}) {
        const auto frames = static_cast<std::size_t>(std::ceil(0.7 * rate));
        const auto up = developed_sequence(stack_of(exposure), changing(dark, bright, frames, 1 / rate)),
                   down = developed_sequence(stack_of(exposure), changing(bright, dark, frames, 1 / rate));
        for (std::size_t i = 1; i <= frames; i += std::max<std::size_t>(1, frames / 16)) {
            const double seconds = static_cast<double>(i - 1) / rate;
            EXPECT_NEAR(stops_of(up[i], bright), -3 + left(8 * seconds), 0.01) << rate << " after " << seconds;
            EXPECT_NEAR(stops_of(down[i], dark), 2 - left(4 * seconds), 0.01) << rate << " after " << seconds;
        }
    }
}

TEST(EffectAutoExposure, GpuSpeedZeroHoldsStill) {
    const ReferenceImage dark = grey_of(-2), bright = grey_of(3);
    const AutoExposure held{.speed_up = 0, .speed_down = 0};
    EXPECT_NEAR(stops_of(developed_sequence(stack_of(held), changing(dark, bright, 8, 1)).back(), bright), 2, 0.01);
    EXPECT_EQ(effect_info(held).pre_roll(&held, 1.0 / 60), 1'000'000'000u);
}

// Behind so many frames a frame is what it is at the end of any run: the worst is a step of the whole range.
TEST(EffectAutoExposure, PreRollIsEnough) {
    const AutoExposure exposure{.darkest = -3, .brightest = 2, .speed_up = 6, .speed_down = 3};
    for (const double delta_time : {1.0 / 24, 1.0 / 60}) {
        const std::uint32_t frames = effect_info(exposure).pre_roll(&exposure, delta_time);
        const auto stops_after = [&](std::size_t count) {
            const auto out =
                reference_sequence(stack_of(exposure), changing(grey_of(9), grey_of(-9), count, delta_time));
            return stops_of(out.back(), grey_of(-9));
        };
        EXPECT_NEAR(stops_after(frames), 3, 0.5 / 80);
        EXPECT_LT(stops_after(frames / 2), 3 - 0.5 / 80) << "and no more than that";
    }
}

TEST(EffectAutoExposure, GpuTellsTheHostAndReadsWhatItsSourceNames) {
    const ReferenceImage picture = grey_of(1.5);
    Composer composer(gpu::test::device(), {.frames_in_flight = 1});
    EntryDesc desc{.name = "darker"};
    const float half = 0.25f;
    const EffectInfo* const scale = find_effect("exposure");
    if (scale == nullptr) GTEST_SKIP() << "this build has no effect exposure";
    composer.add(*scale, &half, desc);
    const AutoExposure exposure{.compensation = 1};
    composer.add(effect_info(exposure), &exposure, {.source = scene_color});
    Developer developer(gpu::test::device(), {.target = DevelopTarget::SceneLinear});
    std::vector<float> color;
    for (const Rgba& pixel : picture.pixels)
        for (const double value : {pixel.r, pixel.g, pixel.b, pixel.a}) color.push_back(static_cast<float>(value));
    for (std::uint64_t i = 0; i < 4; ++i) {
        const DevelopedPicture out = gpu::test::must(
            developer.develop(composer, {.extent = {picture.width, picture.height}, .color = color, .frame_index = i}));
        EXPECT_NEAR(std::log2(out.pixels[1]), grey + 1 - 2, 0.01) << "metered before it was made darker";
    }
    const auto numbers = composer.value("auto_exposure").numbers;
    ASSERT_EQ(numbers.size(), 4u);
    EXPECT_NEAR(numbers[0], std::exp2(-0.5), 0.005) << "multiplier";
    EXPECT_NEAR(numbers[1], -0.5, 0.005) << "its stops";
    EXPECT_NEAR(numbers[2], -0.5, 0.005) << "those that it moves toward";
    EXPECT_NEAR(numbers[3], 1.5, 0.005) << "those that are metered";
}

// Half of the pixels a stop above grey, a quarter three stops below it, a quarter four above it.
TEST(EffectAutoExposure, GpuTellsTheHostTheHistogramAndTheWindow) {
    ReferenceImage picture(64, 32);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = grey_of(i % 4 < 2 ? 1 : i % 4 == 2 ? -3 : 4).pixels[0];
    std::vector<float> color;
    for (const Rgba& pixel : picture.pixels)
        for (const double value : {pixel.r, pixel.g, pixel.b, pixel.a}) color.push_back(static_cast<float>(value));
    Composer composer(gpu::test::device(), {.frames_in_flight = 1});
    composer.add(AutoExposure{.low = 0.5f, .high = 1});
    Developer developer(gpu::test::device(), {.target = DevelopTarget::SceneLinear});
    for (std::uint64_t i = 0; i < 2; ++i)
        gpu::test::must(
            developer.develop(composer, {.extent = {picture.width, picture.height}, .color = color, .frame_index = i}));
    const auto numbers = composer.value("auto_exposure.histogram").numbers;
    ASSERT_EQ(numbers.size(), 262u);
    const AutoExposureBins bins = auto_exposure_reference_bins(picture, 0);
    double all = 0, shares = 0;
    for (const AutoExposureBin& bin : bins) all += bin.count;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        EXPECT_NEAR(numbers[6 + i], bins[i].count / all, 1e-6) << i;
        shares += double{numbers[6 + i]};
    }
    EXPECT_NEAR(shares, 1, 1e-5);
    EXPECT_NEAR(numbers[0], -16 - grey, 1e-5) << "where the bins begin";
    EXPECT_EQ(numbers[1], 0.125f) << "stops of a bin";
    EXPECT_NEAR(numbers[2], 1, 0.125) << "half of those a stop above grey are darker";
    EXPECT_NEAR(numbers[3], 4, 0.125) << "the brightest";
    EXPECT_NEAR(numbers[4], 2.5, 0.005) << "what is metered";
    EXPECT_NEAR(numbers[5], -2.5, 0.005) << "the exposure";
}

TEST(EffectAutoExposure, SaysWhatDoesNotGoTogether) {
    const auto conflict = [](const AutoExposure& exposure) { return effect_info(exposure).conflict(&exposure); };
    EXPECT_EQ(conflict({}), "");
    EXPECT_EQ(conflict({.low = 0.5f, .high = 0.5f}), "high = 0.5: must lie beyond low = 0.5");
    EXPECT_EQ(conflict({.darkest = 3, .brightest = 2.5f}), "brightest = 2.5: must not lie below darkest = 3 stops");
}

TEST_F(EffectAutoExposureData, GpuMetersEnvironmentsAsExactlyAsBySorting) {
    for (const auto& [name, picture] : environments())
        for (const auto& [low, high] : {std::pair{0.4f, 0.9f}, {0.1f, 0.95f}}) {
            const AutoExposure exposure{.low = low, .high = high, .darkest = -16, .brightest = 16};
            EXPECT_NEAR(metered_stops(picture, exposure), exact_mean(picture, double{low}, double{high}), 0.02)
                << name << " " << low << " " << high;
        }
}

// A disc of 1 % in the upper half. Whatever it hides, pixels of the window move up by a hundredth of all; in a black
// room with lamps the window spans so many stops that this is 0.12 of them, and no window of percentiles holds still.
TEST_F(EffectAutoExposureData, GpuASunMovesItLittle) {
    for (const auto& [name, picture] : environments()) {
        ReferenceImage with_sun = picture;
        const double radius = std::sqrt(0.01 * picture.width * picture.height / std::numbers::pi);
        for (std::uint32_t y = 0; y < picture.height; ++y)
            for (std::uint32_t x = 0; x < picture.width; ++x)
                if (std::hypot(x - picture.width / 2.0, y - picture.height / 4.0) < radius)
                    with_sun.at(x, y) = {60000, 60000, 60000, 1};
        const bool is_indoors = name.starts_with("studio") || name.starts_with("Stage");
        const double moved = metered_stops(with_sun) - metered_stops(picture);
        EXPECT_LT(std::abs(moved), is_indoors ? 0.13 : 0.05) << name;
    }
}

}  // namespace darkroom
