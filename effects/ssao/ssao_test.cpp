// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <darkroom/composer.hpp>
#include <darkroom/effects/ssao.hpp>
#include <limits>
#include <set>

#include "compose/test_stacks/host.hpp"
#include "ssao/ssao_reference.hpp"
#include "ssao/ssao_scenes.hpp"

namespace darkroom {
namespace {

using test::box;
using test::BoxScene;
using test::BoxView;

constexpr std::array methods{SsaoMethod::Hemisphere, SsaoMethod::GroundTruth};
constexpr std::array resolutions{SsaoResolution::Half, SsaoResolution::Full};

/// A floor that a wall stands on, seen straight on: nothing changes along a row but the view.
BoxScene step_scene() {
    return {.name = "step",
            .boxes = {box(-50, -2, -50, 100, 1, 100), box(-50, -1, -5, 100, 50, 1)},
            .eye = {0, 0, 0},
            .target = {0, -0.4, -2}};
}

TEST(Ssao, TheKernelLiesInTheHalfBallAndIsDenserInside) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{16}, std::size_t{64}}) {
        const auto kernel = ssao_kernel(count);
        EXPECT_EQ(kernel, ssao_kernel(count)) << "the same every time";
        std::array<double, 2> mean_length{};
        for (std::size_t i = 0; i < count; ++i) {
            const double length = std::hypot(kernel[i][0], kernel[i][1], kernel[i][2]);
            const double share = double(i) / double(count);
            EXPECT_GE(kernel[i][2], 0);
            EXPECT_LE(length, 0.1 + 0.9 * share * share + 1e-6) << "point " << i << " of " << count;
            mean_length[i * 2 / count] += length * 2 / double(count);
        }
        if (count > 1) {
            EXPECT_LT(mean_length[0] * 2, mean_length[1]) << count;
        }
    }
}

// The first point by hand: xorshift32 from 0xDEADBEEF, four numbers.
TEST(Ssao, TheKernelIsTheDocumentedOne) {
    std::uint32_t state = 0xDEADBEEF;
    std::array<double, 4> random{};
    for (double& value : random) {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        value = (state & 0xFFFFFF) / 16777216.0;
    }
    const Double3 direction{random[0] * 2 - 1, random[1] * 2 - 1, random[2]};
    const double scale = random[3] * 0.1 / std::hypot(direction[0], direction[1], direction[2]);
    for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(double{ssao_kernel(64)[0][axis]}, direction[axis] * scale, 1e-7);
}

TEST(Ssao, TheNoiseHoldsEveryAngleOnce) {
    std::set<float> numbers;
    for (const auto& texel : ssao_noise()) {
        EXPECT_NEAR(std::hypot(double{texel[0]}, double{texel[1]}), 1, 1e-6);
        numbers.insert(texel[2]);
        EXPECT_GT(texel[3], 0);
        EXPECT_LT(texel[3], 1);
    }
    EXPECT_EQ(numbers.size(), 16u);
}

TEST(Ssao, SlicesTakeNoMoreReadsThanSamples) {
    for (std::int32_t samples = 1; samples <= 64; ++samples) {
        const auto [slices, steps] = ssao_slices(samples);
        EXPECT_GE(slices, 1);
        EXPECT_GE(steps, 1);
        EXPECT_LE(2 * slices * steps, std::max(samples, 2)) << samples;
        EXPECT_GE(2 * slices * steps, samples - 7) << samples;
    }
}

TEST(Ssao, RefusesAFadeThatEndsBeforeItStarts) {
    for (const float end : {10.0f, 20.0f}) {
        const Ssao ssao{.fade_start = 20, .fade_end = end};
        const std::string text = effect_info(ssao).conflict(&ssao);
        EXPECT_NE(text.find("must lie beyond fade_start = 20"), std::string::npos) << text;
    }
    const Ssao fine;
    EXPECT_EQ(effect_info(fine).conflict(&fine), "");
}

TEST(EffectSsao, APlaneAtAnyAngleIsNotOccluded) {
    for (const double height : {20.0, 0.4}) {
        const BoxScene scene{.name = "plane",
                             .boxes = {box(-900, -1, -900, 1800, 1, 1800)},
                             .eye = {0, height, 0},
                             .target = {1, 0, -3}};
        const BoxView view = test::view_of(scene, 96, 64);
        for (const SsaoMethod method : methods)
            for (const SsaoResolution resolution : resolutions)
                for (const bool has_normals : {true, false}) {
                    const Ssao ssao{.method = method, .resolution = resolution};
                    const ReferenceImage out =
                        test::visibility_of(ssao, has_normals ? view.options() : view.options_without_normals());
                    double lowest = 1;
                    for (const Rgba& pixel : out.pixels) lowest = std::min(lowest, pixel.r);
                    EXPECT_GE(lowest, 0.98) << height << " m, method " << int(method) << ", resolution "
                                            << int(resolution) << ", normals " << has_normals;
                }
    }
}

TEST(EffectSsao, ACornerIsDarkerThanThePlane) {
    const BoxView view = test::view_of(test::corner_scene(), 128, 96);
    for (const SsaoMethod method : methods)
        for (const SsaoResolution resolution : resolutions) {
            const ReferenceImage out =
                test::visibility_of({.method = method, .resolution = resolution}, view.options());
            const ReferenceImage stronger =
                test::visibility_of({.intensity = 2, .method = method, .resolution = resolution}, view.options());
            double corner = 0, open = 0, stronger_corner = 0;
            int corners = 0, opens = 0;
            for (std::uint32_t y = 0; y < 96; ++y)
                for (std::uint32_t x = 0; x < 128; ++x) {
                    const Double3 at = view.point(x, y);
                    if (at[1] < 0.001 && at[0] < -1.85) {
                        corner += out.at(x, y).r;
                        stronger_corner += stronger.at(x, y).r;
                        ++corners;
                    }
                    if (at[1] < 0.001 && at[0] > -0.2 && at[2] > -1) {
                        open += out.at(x, y).r;
                        ++opens;
                    }
                }
            ASSERT_GT(corners, 3);
            ASSERT_GT(opens, 100);
            EXPECT_GT(open / opens, 0.98);
            // A visibility has ten bits, which other drivers than lavapipe may round the other way.
            const double rounding = gpu::test::is_lavapipe() ? 0 : 0.5 / 1023;
            EXPECT_LT(corner / corners, open / opens - 0.05 + rounding) << int(method) << int(resolution);
            EXPECT_LT(stronger_corner, corner - 0.05 * corners);
        }
}

// The wall beside a bright post keeps its value: neither the method, nor the blur, nor the upsampling reaches across.
TEST(EffectSsao, APostBeforeAFarWallHasNoHalo) {
    const BoxScene scene{.name = "post",
                         .boxes = {box(-50, -50, -9, 100, 100, 1), box(-0.3, -50, -3.5, 0.6, 100, 0.5)},
                         .eye = {0.13, 0, 0},
                         .target = {0.13, 0, -1}};
    const BoxView view = test::view_of(scene, 101, 63);
    for (const SsaoMethod method : methods)
        for (const SsaoResolution resolution : resolutions) {
            const ReferenceImage out = test::visibility_of(
                {.intensity = 4, .samples = 32, .method = method, .resolution = resolution}, view.options());
            double lowest = 1;
            for (const Rgba& pixel : out.pixels) lowest = std::min(lowest, pixel.r);
            EXPECT_GE(lowest, 0.98) << int(method) << int(resolution);
        }
}

// Where dark corners end at edges to both sides, the far surface behind that edge stays clear to the last pixel.
TEST(EffectSsao, OcclusionDoesNotLeakAcrossEdges) {
    const BoxScene scene{.name = "ledge",
                         .boxes = {box(-50, -50, -30, 100, 100, 1), box(-50, -50, -3.2, 49.65, 100, 0.2),
                                   box(-50, -50, -3.0, 49.5, 100, 0.6), box(0.37, -50, -3.2, 50, 100, 0.2),
                                   box(0.52, -50, -3.0, 50, 100, 0.6)},
                         .eye = {0, 0, 0},
                         .target = {0, 0, -1}};
    const BoxView view = test::view_of(scene, 128, 64);
    for (const SsaoMethod method : methods)
        for (const SsaoResolution resolution : resolutions) {
            const ReferenceImage out =
                test::visibility_of({.intensity = 8, .method = method, .resolution = resolution}, view.options());
            double near = 1, far = 1;
            for (std::uint32_t y = 0; y < 64; ++y)
                for (std::uint32_t x = 0; x < 128; ++x) {
                    double& lowest = view.depth.at(x, y).r > 20 ? far : near;
                    lowest = std::min(lowest, out.at(x, y).r);
                }
            EXPECT_LT(near, 0.7) << "there is something to leak";
            EXPECT_GE(far, 0.97) << int(method) << int(resolution);
        }
}

// Neighbours in a row differ by the view alone; the tile of noise would show as steps.
TEST(EffectSsao, TheBlurRemovesTheNoise) {
    const BoxView view = test::view_of(step_scene(), 128, 96);
    for (const SsaoMethod method : methods)
        for (const SsaoResolution resolution : resolutions) {
            const ReferenceImage out =
                test::visibility_of({.radius = 1.5f, .method = method, .resolution = resolution}, view.options());
            double worst = 0, lowest = 1;
            for (std::uint32_t y = 10; y < 86; ++y)
                for (std::uint32_t x = 40; x < 88; ++x) {
                    worst = std::max(worst, std::abs(out.at(x, y).r - out.at(x + 1, y).r));
                    lowest = std::min(lowest, out.at(x, y).r);
                }
            EXPECT_LT(lowest, 0.9);
            EXPECT_LT(worst, 0.03) << int(method) << int(resolution);
        }
}

// On planes occlusion changes slowly, however obliquely they are seen: what sets a pixel apart from the mean of the 7x7
// around is noise, but for the last pixels before the corner.
TEST(EffectSsao, BothBlursTakeTheNoiseFromObliquePlanes) {
    const BoxScene scene{.name = "oblique",
                         .boxes = {box(-50, -1, -50, 100, 1, 100), box(-50, 0, -5, 100, 50, 1)},
                         .eye = {-1, 0.8, -2},
                         .target = {1.5, 0.1, -4}};
    const BoxView view = test::view_of(scene, 480, 270);
    const ReferenceImage out = test::visibility_of({}, view.options());
    std::vector<double> deviations;
    double lowest = 1;
    for (std::uint32_t y = 3; y + 3 < 270; ++y)
        for (std::uint32_t x = 3; x + 3 < 480; ++x) {
            double mean = 0;
            int count = 0;
            for (std::uint32_t j = y - 3; j <= y + 3; ++j)
                for (std::uint32_t i = x - 3; i <= x + 3; ++i) {
                    if (view.normals.at(i, j).g != view.normals.at(x, y).g) continue;
                    mean += out.at(i, j).r / 49;
                    ++count;
                }
            if (count < 49) continue;
            lowest = std::min(lowest, out.at(x, y).r);
            deviations.push_back(255 * std::abs(out.at(x, y).r - mean));
        }
    ASSERT_GT(deviations.size(), 100000u);
    EXPECT_LT(lowest, 0.7) << "there is occlusion";
    std::sort(deviations.begin(), deviations.end());
    // In codes of 255. Without the tent it is 2.45, without the mean over the tile 16.6.
    EXPECT_LE(deviations[deviations.size() * 99 / 100], 2);
}

TEST(EffectSsao, GivenAndReconstructedNormalsAgreeOnFlatBoxes) {
    const BoxView view = test::view_of(test::stairs_scene(), 160, 90);
    for (const SsaoMethod method : methods)
        for (const SsaoResolution resolution : resolutions) {
            const Ssao ssao{.method = method, .resolution = resolution};
            const ReferenceImage given = test::visibility_of(ssao, view.options());
            const ReferenceImage made = test::visibility_of(ssao, view.options_without_normals());
            double sum = 0;
            std::size_t off = 0;
            for (std::size_t i = 0; i < given.pixels.size(); ++i) {
                const double difference = std::abs(given.pixels[i].r - made.pixels[i].r);
                sum += difference;
                if (difference > 0.1) ++off;
            }
            EXPECT_LT(sum / double(given.pixels.size()), 0.01) << int(method) << int(resolution);
            EXPECT_LT(double(off) / double(given.pixels.size()), 0.02) << int(method) << int(resolution);
        }
}

TEST(EffectSsao, FadesWithDistance) {
    const BoxView view = test::view_of(step_scene(), 64, 48);
    for (const SsaoResolution resolution : resolutions) {
        const auto lowest = [&](float start, float end) {
            double out = 1;
            const Ssao ssao{
                .intensity = 3, .radius = 1.5f, .resolution = resolution, .fade_start = start, .fade_end = end};
            for (const Rgba& pixel : test::visibility_of(ssao, view.options()).pixels) out = std::min(out, pixel.r);
            return out;
        };
        EXPECT_LT(lowest(200, 400), 0.8);
        EXPECT_EQ(lowest(0.1f, 0.2f), 1) << "all lies beyond the end";
        EXPECT_GT(lowest(0, 6), lowest(200, 400) + 0.1);
    }
}

TEST(EffectSsao, WhatHasNoNormalNeitherOccludesNorIsOccluded) {
    BoxView view =
        test::view_of({.name = "post before a wall",
                       .boxes = {test::box(-50, -50, -5, 100, 100, 1), test::box(-0.2, -50, -3.9, 0.4, 100, 0.3)},
                       .eye = {0, 0, 0},
                       .target = {0, 0, -1}},
                      96, 48);
    for (const SsaoMethod method : methods)
        for (const SsaoResolution resolution : resolutions) {
            const Ssao ssao{.intensity = 2, .radius = 1.5f, .method = method, .resolution = resolution};
            BoxView without = view;
            for (std::size_t i = 0; i < view.depth.pixels.size(); ++i)
                if (view.depth.pixels[i].r < 3.9) without.normals.pixels[i] = {};
            const auto darkest = [&](const BoxView& of) {
                double out = 1;
                for (const Rgba& pixel : test::visibility_of(ssao, of.options()).pixels) out = std::min(out, pixel.r);
                return out;
            };
            EXPECT_LT(darkest(view), 0.9) << int(method) << int(resolution);
            // A plane's own steps of depth may darken it by a little.
            EXPECT_GT(darkest(without), 0.995) << int(method) << int(resolution);
        }
}

TEST(EffectSsao, LuminanceSparesBrightPixels) {
    const BoxView view = test::view_of(step_scene(), 64, 48);
    ReferenceImage picture(64, 48);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = i % 2 == 0 ? Rgba{1, 1, 1, 0.5} : Rgba{1e-4, 1e-4, 1e-4, 0.5};
    const auto run = [&](SsaoMerge merge) {
        return test::develop(
            [&](Composer& composer) { composer.add(Ssao{.intensity = 3, .radius = 1.5f, .merge = merge}); }, picture,
            view.options());
    };
    const ReferenceImage multiplied = run(SsaoMerge::Multiply), spared = run(SsaoMerge::Luminance);
    double darkest = 1;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const double visible = multiplied.pixels[i].r / picture.pixels[i].r;
        darkest = std::min(darkest, visible);
        EXPECT_NEAR(spared.pixels[i].r / picture.pixels[i].r, i % 2 == 0 ? 0.5 + 0.5 * visible : visible, 1e-3);
        EXPECT_EQ(spared.pixels[i].a, 0.5);
    }
    EXPECT_LT(darkest, 0.8);
}

TEST(EffectSsao, WhatIsNotOccludedKeepsItsBits) {
    BoxView view = test::view_of(test::corner_scene(), 33, 21);
    const ReferenceImage picture = test::round_to_float(test::random_hdr(33, 21, 4));
    const auto run = [&](const Ssao& ssao) {
        return test::develop([&](Composer& composer) { composer.add(ssao); }, picture, view.options());
    };
    EXPECT_EQ(test::worst_difference(run({.intensity = 0}), picture), 0);
    for (Rgba& pixel : view.depth.pixels) pixel.r = 1e10;
    EXPECT_EQ(test::worst_difference(run({.intensity = 8}), picture), 0) << "the sky";
}

/// GPU and reference choose pixels by the same rule, and may round to different ones: a read of one pixel more or less
/// changes a pixel by 1 / samples, and its blurred neighbours by a sixteenth of that. Ten bits hold the visibility.
void expect_like_the_reference(const Ssao& ssao, const ReferenceImage& picture, test::RunOptions options,
                               const std::string& what) {
    const ReferenceImage expected = test::scene_reference_of(ssao, picture, options);
    std::array<ReferenceImage, 2> out;
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        options.kernels = stage;
        ReferenceImage& made = out[stage == KernelStage::Raster ? 1 : 0];
        made = test::develop([&](Composer& composer) { composer.add(ssao); }, picture, options);
        double sum = 0, worst = 0;
        std::size_t where = 0;
        for (std::size_t i = 0; i < made.pixels.size(); ++i) {
            const double difference = std::abs(made.pixels[i].r - expected.pixels[i].r);
            sum += difference;
            if (difference > worst) where = i;
            worst = std::max(worst, difference);
        }
        EXPECT_LT(sum / double(made.pixels.size()), 0.0015) << what;
        EXPECT_LT(worst, 0.05) << what << ", most at " << where % made.width << ", " << where / made.width;
    }
    EXPECT_LE(test::worst_difference(out[0], out[1]), 1 / 255.0) << what << ": the stages differ";
}

TEST(EffectSsao, GpuMatchesReference) {
    const BoxView view = test::view_of(test::stairs_scene(), 83, 47);
    const ReferenceImage picture = test::uniform(83, 47, {1, 0.5, 0.25, 0.75});
    bool has_normals = false;
    for (const SsaoMethod method : methods)
        for (const SsaoResolution resolution : resolutions) {
            for (Ssao ssao : {Ssao{},
                              Ssao{.intensity = 1.7f,
                              .radius = 1.5f,
                              .bias = 0.01f,
                              .samples = 40,
                              .merge = SsaoMerge::Luminance,
                              .fade_start = 2,
                              .fade_end = 6},
                              Ssao{.samples = 5}}) {
                ssao.method = method;
                ssao.resolution = resolution;
                expect_like_the_reference(ssao, picture, has_normals ? view.options() : view.options_without_normals(),
                                          "method " + std::to_string(int(method)) + ", resolution " +
                                              std::to_string(int(resolution)) + ", samples " +
                                              std::to_string(ssao.samples));
                has_normals = !has_normals;
            }
        }
}

// The kernel of a new count, whose loops hold it as a literal, is made after the first frame with it.
TEST(EffectSsao, GpuHasTheSameBitsWithAnyKernel) {
    const BoxView view = test::view_of(test::stairs_scene(), 64, 48);
    const test::Host host(test::uniform(64, 48, {1, 1, 1, 1}));
    const gpu::test::Picture depth = gpu::test::upload(host.device.context(), test::pixels_of(view.depth),
                                                       VK_FORMAT_R32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
    CompileDesc desc = host.compile_desc();
    desc.depth.format = VK_FORMAT_R32_SFLOAT;
    desc.is_depth_planar = true;
    Frame frame = host.frame();
    frame.depth = test::image_ref(depth);
    frame.camera = view.camera;
    frame.camera.depth = DepthKind::Planar;
    for (const SsaoMethod method : methods) {
        Composer composer(host.device);
        const Handle ssao = composer.add(Ssao{.method = method});
        test::must(composer.compile(desc));
        ReferenceImage before;
        for (const double samples : {16.0, 5.0, 33.0}) {
            test::must(composer.set(ssao, "samples", samples));
            test::must(host.record(composer, frame));
            const ReferenceImage complete = host.read_target();
            composer.wait_for_kernels();
            test::must(host.record(composer, frame));
            EXPECT_EQ(test::worst_difference(host.read_target(), complete), 0) << int(method) << ", " << samples;
            if (!before.pixels.empty()) {
                EXPECT_GT(test::worst_difference(before, complete), 1e-3);
            }
            before = complete;
        }
    }
}

// Orthographic, and with y up in clip space.
TEST(EffectSsao, GpuMatchesReferenceForOtherCameras) {
    BoxView view = test::view_of(test::corner_scene(), 64, 48);
    const ReferenceImage picture = test::uniform(64, 48, {1, 1, 1, 1});
    Camera flipped = view.camera;
    flipped.is_y_down = false;
    flipped.projection[5] = -flipped.projection[5];
    Camera flat = view.camera;
    flat.projection = {0.5f, 0, 0, 0, 0, -0.6f, 0, 0, 0, 0, -0.01f, 0, 0.1f, 0, 0, 1};
    for (const Camera& camera : {flipped, flat})
        for (const SsaoMethod method : methods) {
            view.camera = camera;
            expect_like_the_reference({.method = method}, picture, view.options_without_normals(),
                                      "method " + std::to_string(int(method)));
        }
}

// Device depth becomes the same distances first.
TEST(EffectSsao, GpuReadsDeviceDepth) {
    const BoxView view = test::view_of(test::corner_scene(), 64, 48);
    const ReferenceImage expected = test::visibility_of({}, view.options());
    test::RunOptions options = view.options();
    options.is_depth_planar = false;
    options.camera.depth = DepthKind::Standard;
    ReferenceImage device = view.depth;
    const Matrix& p = options.camera.projection;
    for (Rgba& pixel : device.pixels)
        pixel.r = double{static_cast<float>((-pixel.r * double{p[10]} + double{p[14]}) / pixel.r)};
    options.depth = &device;
    const ReferenceImage out = test::visibility_of({}, options);
    EXPECT_LT(test::worst_difference(out, expected), 0.03);
}

TEST(EffectSsao, HostileValuesAreHarmless) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    struct Extreme {
        float radius;
        std::int32_t samples;
        bool has_normals;
    };
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 5u}, {17u, 9u}}) {
        BoxView view = test::view_of(test::corner_scene(), width, height);
        constexpr std::array values{nan, infinity, -infinity, 0.0, -3.0, 1e-30, 1e30, 65504.0, 1e8};
        for (std::size_t i = 0; i < view.depth.pixels.size(); ++i)
            if (i % 3 != 1) view.depth.pixels[i].r = values[i / 3 % values.size()];
        for (const SsaoMethod method : methods)
            for (const SsaoResolution resolution : resolutions)
                for (const Extreme& extreme : {Extreme{0.001f, 1, true}, Extreme{1000, 64, false}}) {
                    const Ssao ssao{.radius = extreme.radius,
                                    .bias = 0,
                                    .samples = extreme.samples,
                                    .method = method,
                                    .resolution = resolution};
                    const test::RunOptions options =
                        extreme.has_normals ? view.options() : view.options_without_normals();
                    for (const Rgba& pixel : test::visibility_of(ssao, options).pixels)
                        EXPECT_TRUE(pixel.r >= 0 && pixel.r <= 1)
                            << pixel.r << " at " << width << "x" << height << ", method " << int(method);
                }
    }
}

TEST(EffectSsao, WithoutDepthItIsLeftOut) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(8, 8, 1));
    const ReferenceImage out = test::develop([](Composer& composer) { composer.add(Ssao{}); }, picture);
    EXPECT_EQ(test::worst_difference(out, picture), 0);
}

}  // namespace
}  // namespace darkroom
