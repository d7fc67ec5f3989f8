// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/taa.hpp>
#include <functional>
#include <limits>
#include <vector>

#include "compose/test_stacks/host.hpp"
#include "develop/reference_chain.hpp"
#include "taa/taa_reference.hpp"

namespace darkroom {
namespace {

using test::must;

/// A frame as a renderer would bring it. Layers without pixels are not given.
struct Shot {
    ReferenceImage color, depth{}, velocity{}, reactive{}, transparency{}, exposure{};
    Camera camera{.depth = DepthKind::Planar};
    double delta_time = 1.0 / 60;
};

std::array<float, 2> halton(std::uint32_t frame, std::uint32_t phases) {
    const auto part = [](std::uint32_t index, std::uint32_t base) {
        float out = 0, digit = 1;
        for (; index > 0; index /= base) out += (digit /= static_cast<float>(base)) * static_cast<float>(index % base);
        return out;
    };
    const std::uint32_t index = frame % phases + 1;
    return {part(index, 2) - 0.5f, part(index, 3) - 0.5f};
}

/// What is seen at a place of the output at a time, and how it moves, in pixels of the output.
struct Seen {
    Rgba color;
    double depth = 10;
    std::array<double, 2> velocity{};
};
using World = std::function<Seen(double x, double y, std::uint32_t frame)>;

/// One sample a pixel, where the jitter puts it.
Shot shot_of(const World& world, VkExtent2D in, VkExtent2D output, std::uint32_t frame) {
    Shot shot{.color = ReferenceImage(in.width, in.height),
              .depth = ReferenceImage(in.width, in.height),
              .velocity = ReferenceImage(in.width, in.height)};
    const double x_scale = double{1} * output.width / in.width, y_scale = double{1} * output.height / in.height;
    const auto phases = static_cast<std::uint32_t>(std::lround(8 * x_scale * y_scale));
    shot.camera.jitter = halton(frame, phases);
    if (frame > 0) shot.camera.previous_jitter = halton(frame - 1, phases);
    for (std::uint32_t y = 0; y < in.height; ++y)
        for (std::uint32_t x = 0; x < in.width; ++x) {
            const Seen seen = world((x + 0.5 - double{shot.camera.jitter[0]}) * x_scale,
                                    (y + 0.5 - double{shot.camera.jitter[1]}) * y_scale, frame);
            shot.color.at(x, y) = seen.color;
            shot.depth.at(x, y).r = seen.depth;
            shot.velocity.at(x, y) = {seen.velocity[0] / x_scale, seen.velocity[1] / y_scale, 0, 1};
        }
    return shot;
}
std::vector<Shot> shots_of(const World& world, VkExtent2D in, VkExtent2D output, std::uint32_t frames) {
    std::vector<Shot> shots;
    for (std::uint32_t i = 0; i < frames; ++i) shots.push_back(shot_of(world, in, output, i));
    return shots;
}

/// The mean over a pixel of the output, as a display shows it.
ReferenceImage truth_of(const World& world, VkExtent2D output, std::uint32_t frame) {
    constexpr std::uint32_t steps = 16;
    ReferenceImage out(output.width, output.height);
    for (std::uint32_t y = 0; y < output.height; ++y)
        for (std::uint32_t x = 0; x < output.width; ++x) {
            taa::Toned mean{};
            for (std::uint32_t i = 0; i < steps * steps; ++i)
                mean = taa::sum(
                    mean,
                    taa::toned(world(x + (i % steps + 0.5) / steps, y + (i / steps + 0.5) / steps, frame).color, 1),
                    1.0 / (steps * steps));
            out.at(x, y) = taa::light(taa::shown(mean), 1, 1);
        }
    return out;
}

const ReferenceImage* given(const ReferenceImage& image) { return image.pixels.empty() ? nullptr : &image; }

std::vector<ReferenceImage> by_reference(const Taa& parameters, const std::vector<Shot>& shots, VkExtent2D output) {
    Composer composer(Device::assumed());
    composer.add(parameters);
    ReferenceHistories histories;
    std::vector<ReferenceImage> out;
    for (const Shot& shot : shots)
        out.push_back(must(run_reference(composer, {.color = &shot.color,
                                                    .images = {{FrameImage::Depth, given(shot.depth)},
                                                               {FrameImage::Velocity, given(shot.velocity)},
                                                               {FrameImage::Reactive, given(shot.reactive)},
                                                               {FrameImage::Transparency, given(shot.transparency)},
                                                               {FrameImage::Exposure, given(shot.exposure)}},
                                                    .target_extent = output,
                                                    .camera = shot.camera,
                                                    .delta_time = shot.delta_time,
                                                    .frame_index = out.size(),
                                                    .histories = &histories,
                                                    .target_domain = Domain::SceneLinear}))
                          .picture);
    return out;
}

std::vector<ReferenceImage> on_gpu(const Taa& parameters, const std::vector<Shot>& shots, VkExtent2D output,
                                   KernelStage kernels = KernelStage::Auto) {
    const test::Host host(shots.front().color);
    gpu::Context& context = host.device.context();
    const gpu::test::Picture target = gpu::test::blank(context, output, VK_FORMAT_R32G32B32A32_SFLOAT);
    Composer composer(host.device);
    composer.add(parameters);
    const Shot& first = shots.front();
    CompileDesc desc = host.compile_desc();
    desc.target_domain = Domain::SceneLinear;
    desc.depth = {VK_FORMAT_R32_SFLOAT};
    desc.is_depth_planar = true;
    desc.is_velocity_plain = true;
    if (given(first.velocity) != nullptr) desc.velocity = {VK_FORMAT_R32G32_SFLOAT};
    if (given(first.reactive) != nullptr) desc.reactive = {VK_FORMAT_R32_SFLOAT};
    if (given(first.transparency) != nullptr) desc.transparency = {VK_FORMAT_R32G32B32A32_SFLOAT};
    if (given(first.exposure) != nullptr) desc.exposure = {VK_FORMAT_R32_SFLOAT};
    desc.target_extent = output;
    desc.kernels = kernels;
    must(composer.compile(desc));
    std::vector<ReferenceImage> out;
    for (const Shot& shot : shots) {
        std::vector<gpu::test::Picture> kept;
        const auto lend = [&](const ReferenceImage& image, VkFormat format, ImageRef& to) {
            if (image.pixels.empty()) return;
            kept.push_back(gpu::test::upload(context, test::pixels_of(image), format, VK_IMAGE_LAYOUT_GENERAL));
            to = test::image_ref(kept.back());
        };
        Frame frame{.camera = shot.camera, .delta_time = shot.delta_time, .frame_index = out.size()};
        lend(shot.color, VK_FORMAT_R32G32B32A32_SFLOAT, frame.color);
        lend(shot.depth, VK_FORMAT_R32_SFLOAT, frame.depth);
        lend(shot.velocity, VK_FORMAT_R32G32_SFLOAT, frame.velocity);
        lend(shot.reactive, VK_FORMAT_R32_SFLOAT, frame.reactive);
        lend(shot.transparency, VK_FORMAT_R32G32B32A32_SFLOAT, frame.transparency);
        lend(shot.exposure, VK_FORMAT_R32_SFLOAT, frame.exposure);
        frame.target = test::image_ref(target);
        must(host.record(composer, frame));
        out.push_back(test::image_of(gpu::test::download(context, target)));
    }
    return out;
}

double share_beyond(const ReferenceImage& a, const ReferenceImage& b, double difference) {
    EXPECT_EQ(a.pixels.size(), b.pixels.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        count += !(std::max({std::abs(a.pixels[i].r - b.pixels[i].r), std::abs(a.pixels[i].g - b.pixels[i].g),
                             std::abs(a.pixels[i].b - b.pixels[i].b)}) <= difference);
    return static_cast<double>(count) / static_cast<double>(a.pixels.size());
}
double mean_square(const ReferenceImage& a, const ReferenceImage& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::pow(a.pixels[i].g - b.pixels[i].g, 2);
    return sum / static_cast<double>(a.pixels.size());
}

/// A wall with stripes and, before it, a bright thing with a slanted edge that moves to the right.
Seen wall_and_thing(double x, double y, std::uint32_t frame, double speed) {
    const double left = 12 + speed * frame + 0.3 * y;
    if (x > left && x < left + 16 && y > 5 && y < 30) return {{0.9, 0.3 + 0.02 * (x - left), 0.2, 1}, 5, {-speed, 0}};
    const double wave = 0.3 + 0.2 * std::sin(x * 0.9) + 0.1 * std::sin(y * 0.7);
    return {{wave, wave * 0.8, 0.4, 1}, 20, {0, 0}};
}
World world_at(double speed) {
    return [speed](double x, double y, std::uint32_t frame) { return wall_and_thing(x, y, frame, speed); };
}
constexpr VkExtent2D output{63, 37};

TEST(EffectTaa, GpuMatchesReference) {
    for (const VkExtent2D in : {output, VkExtent2D{42, 25}, VkExtent2D{32, 19}})
        for (const double speed : {0.0, 1.7}) {
            const std::vector<Shot> shots = shots_of(world_at(speed), in, output, 7);
            const std::vector<ReferenceImage> expected = by_reference({}, shots, output);
            for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster}) {
                const std::vector<ReferenceImage> out = on_gpu({}, shots, output, kernels);
                for (std::size_t i = 0; i < shots.size(); ++i) {
                    // Counts of frames are rounded to roots in 8 bits: a tenth of a count below 1.
                    EXPECT_LE(share_beyond(out[i], expected[i], 4e-3), 0.03) << in.width << " " << speed << " " << i;
                    EXPECT_LE(share_beyond(out[i], expected[i], 0.04), 0.001) << in.width << " " << speed << " " << i;
                }
            }
        }
}

TEST(EffectTaa, GpuMatchesReferenceWithMasksAndAnExposure) {
    std::vector<Shot> shots = shots_of(world_at(0.6), {32, 19}, output, 6);
    for (std::size_t i = 0; i < shots.size(); ++i) {
        shots[i].reactive = ReferenceImage(32, 19, {0, 0, 0, 1});
        for (std::uint32_t y = 4; y < 12; ++y)
            for (std::uint32_t x = 3; x < 20; ++x) shots[i].reactive.at(x, y).r = 0.1 * x;
        shots[i].transparency = shots[i].color;
        for (std::uint32_t y = 2; y < 9; ++y)
            for (std::uint32_t x = 8; x < 30; ++x) shots[i].transparency.at(x, y).g *= 0.05 * x;
        shots[i].exposure = ReferenceImage(1, 1, {0.5 + 0.25 * static_cast<double>(i), 0, 0, 1});
    }
    const Taa taa{.sharpness = 0.8f};
    const std::vector<ReferenceImage> expected = by_reference(taa, shots, output), out = on_gpu(taa, shots, output);
    for (std::size_t i = 0; i < shots.size(); ++i) {
        EXPECT_LE(share_beyond(out[i], expected[i], 6e-3), 0.03) << i;
        EXPECT_LE(share_beyond(out[i], expected[i], 0.04), 0.001) << i;
    }
}

TEST(EffectTaa, AStillPictureComesNearTheTruth) {
    for (const VkExtent2D in : {output, VkExtent2D{32, 19}}) {
        const std::vector<Shot> shots = shots_of(world_at(0), in, output, 32);
        const std::vector<ReferenceImage> out = by_reference({}, shots, output);
        const ReferenceImage truth = truth_of(world_at(0), output, 0);
        // 8 dB nearer than a frame by itself, which is filtered already.
        EXPECT_LE(mean_square(out.back(), truth), mean_square(out.front(), truth) / 6.3) << in.width;
    }
}

TEST(EffectTaa, AMovingPictureComesNearTheTruth) {
    const World stripes = [](double x, double y, std::uint32_t frame) {
        const double along = 0.23 * (x - 0.37 * frame) + 0.11 * (y - 0.21 * frame);
        const double light = static_cast<std::int64_t>(std::floor(along)) % 2 == 0 ? 8 : 0.1;
        return Seen{.color = {light, light, light, 1}, .velocity = {-0.37, -0.21}};
    };
    const std::vector<ReferenceImage> out = on_gpu({}, shots_of(stripes, output, output, 24), output);
    const auto shown = [](ReferenceImage picture) {
        for (Rgba& c : picture.pixels) c = {c.r / (1 + c.r), c.g / (1 + c.g), c.b / (1 + c.b), 1};
        return picture;
    };
    // Nearer than a frame by itself, though each frame reads the past between pixels.
    EXPECT_LE(mean_square(shown(out.back()), shown(truth_of(stripes, output, 23))),
              0.8 * mean_square(shown(out.front()), shown(truth_of(stripes, output, 0))));
}

TEST(EffectTaa, AStillPictureHoldsStill) {
    const std::vector<Shot> shots = shots_of(world_at(0), output, output, 80);
    const std::vector<ReferenceImage> out = on_gpu({.stability = 1}, shots, output);
    for (std::size_t i = 64; i < out.size(); ++i) {
        EXPECT_LE(share_beyond(out[i], out[i - 1], 1.5 / 255), 0.001) << i;
        EXPECT_EQ(share_beyond(out[i], out[i - 1], 3.0 / 255), 0) << i;
    }
}

TEST(EffectTaa, AFlatFieldKeepsItsLight) {
    // Where no pass writes codes of 16 bits, halves.
    const bool has_codes =
        gpu::test::context().supports(VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT);
    for (const double value : {0.0, 0.001, 0.37, 12.0, 40000.0}) {
        const World flat = [value](double, double, std::uint32_t) { return Seen{{value, value / 2, value, 1}}; };
        const ReferenceImage out = on_gpu({}, shots_of(flat, {5, 4}, {9, 7}, 40), {9, 7}).back();
        // What is shown is rounded up or down, by what is lost: never twice, and right in the mean. The picture is of
        // halves.
        const double shown = value / (1 + value), of_halves = 0x1p-11 * value / ((1 + value) * (1 + value));
        const double step = has_codes ? 1.0 / 65535 : 0x1p-10 * shown;
        double mean = 0;
        for (const Rgba& pixel : out.pixels) {
            EXPECT_NEAR(pixel.r / (1 + pixel.r), shown, step + of_halves) << value;
            mean += pixel.r / (1 + pixel.r) / static_cast<double>(out.pixels.size());
        }
        EXPECT_NEAR(mean, shown, 0.3 * step + of_halves) << value;
    }
}

TEST(EffectTaa, TheFirstFrameAndTheFirstAfterACutAreThoseOfAFrameByItself) {
    std::vector<Shot> shots = shots_of(world_at(0.4), {42, 25}, output, 4);
    shots[2].camera.is_cut = true;
    for (const auto& run : {by_reference({}, shots, output), on_gpu({}, shots, output)}) {
        Shot alone = shots[2];
        const ReferenceImage expected = by_reference({}, {alone}, output).back();
        EXPECT_LE(test::worst_difference(run[2], expected), 1e-3);
        EXPECT_GT(test::worst_difference(run[3], by_reference({}, {shots[3]}, output).back()), 1e-2);
    }
}

TEST(EffectTaa, WhatWasHiddenShowsNothingOfWhatHidIt) {
    // Blue behind, and red that leaves.
    const World world = [](double x, double, std::uint32_t frame) {
        const double right = 40 - 3.0 * frame;
        return x < right ? Seen{{2, 0, 0, 1}, 4, {3, 0}} : Seen{{0, 0, 0.5, 1}, 20, {0, 0}};
    };
    for (const VkExtent2D in : {output, VkExtent2D{32, 19}}) {
        const std::vector<ReferenceImage> out = on_gpu({}, shots_of(world, in, output, 10), output);
        for (std::uint32_t frame = 5; frame < 10; ++frame)
            for (std::uint32_t y = 0; y < output.height; ++y)
                for (std::uint32_t x = 40 - 3 * (frame - 4); x < output.width; ++x)
                    EXPECT_LE(out[frame].at(x, y).r, 0.02) << frame << ": " << x << "," << y;
    }
}

TEST(EffectTaa, TheMotionOfTheCameraServesWhereNoVelocityIsGiven) {
    // A striped wall 10 m away, seen by a camera that walks along it.
    const auto camera_at = [](double x) { return test::look_at({x, 0, 0}, {x, 0, -5}, 0.9, 63.0 / 37); };
    const double pixels_a_metre = 37 / (2 * std::tan(0.45) * 10);
    std::vector<Shot> with = shots_of(
        [&](double x, double y, std::uint32_t frame) {
            const double at = x + 1.3 * frame;
            return Seen{{0.5 + 0.4 * std::sin(at), 0.3, 0.2 + 0.1 * std::sin(y), 1}, 10, {1.3, 0}};
        },
        output, output, 6);
    for (std::size_t i = 0; i < with.size(); ++i) {
        Shot& shot = with[i];
        const auto jitter = shot.camera.jitter, before = shot.camera.previous_jitter;
        const auto moved = [&](std::size_t frame, const std::array<float, 2>& by) {
            Camera camera = camera_at(1.3 * static_cast<double>(frame) / pixels_a_metre);
            camera.projection[8] -= 2 * by[0] / 63;
            camera.projection[9] -= 2 * by[1] / 37;
            return camera;
        };
        const Camera last = moved(i == 0 ? 0 : i - 1, before);
        shot.camera = moved(i, jitter);
        shot.camera.previous_view = last.view;
        shot.camera.previous_projection = last.projection;
        shot.camera.jitter = jitter;
        shot.camera.previous_jitter = before;
    }
    std::vector<Shot> without = with;
    for (Shot& shot : without) shot.velocity = {};
    const std::vector<ReferenceImage> expected = by_reference({}, with, output);
    EXPECT_LE(share_beyond(by_reference({}, without, output).back(), expected.back(), 1e-3), 0.002);
    EXPECT_LE(share_beyond(on_gpu({}, without, output).back(), expected.back(), 0.01), 0.01);
}

TEST(EffectTaa, AReactiveMaskLetsThePastGo) {
    const World flash = [](double, double, std::uint32_t frame) {
        const double value = frame < 8 ? 0.1 : 0.12;
        return Seen{{value, value, value, 1}};
    };
    std::vector<Shot> shots = shots_of(flash, output, output, 10);
    const double slow = by_reference({}, shots, output).back().at(20, 20).r;
    for (Shot& shot : shots) shot.reactive = ReferenceImage(output.width, output.height, {1, 0, 0, 1});
    const double quick = on_gpu({}, shots, output).back().at(20, 20).r;
    EXPECT_NEAR(quick, 0.12, 0.002);
    EXPECT_LE(slow, quick);
}

/// Embers of three pixels, three pixels a frame to the right, before a wall that stands still.
Seen wall_behind_embers(double x, double y, bool has_embers, std::uint32_t frame) {
    const double along = std::fmod(x - 3.0 * frame + 300, 21), across = std::fmod(y, 9);
    const bool is_ember = has_embers && along < 3 && across < 3;
    const double wall = 0.2 + 0.1 * std::sin(0.8 * x) * std::sin(0.6 * y);
    return {is_ember ? Rgba{3, 1.5, 0.3, 1} : Rgba{wall, wall, wall, 1}};
}

TEST(EffectTaa, NothingTrailsBehindParticlesForMoreThanTwoFrames) {
    const auto world = [](bool has_embers) -> World {
        return [has_embers](double x, double y, std::uint32_t frame) {
            return wall_behind_embers(x, y, has_embers, frame);
        };
    };
    for (const VkExtent2D in : {output, VkExtent2D{32, 19}}) {
        std::vector<Shot> shots = shots_of(world(true), in, output, 24);
        const std::vector<Shot> behind = shots_of(world(false), in, output, 24);
        for (std::size_t i = 0; i < shots.size(); ++i) shots[i].transparency = behind[i].color;
        const ReferenceImage out = on_gpu({}, shots, output).back(), wall = on_gpu({}, behind, output).back();
        double worst = 0;
        for (std::uint32_t y = 0; y < output.height; ++y)
            for (std::uint32_t x = 0; x < output.width; ++x) {
                const double along = std::fmod(x + 0.5 - 3.0 * 23 + 300, 21);
                // Behind the embers of this frame and the two before; before them, the frame's pixels are wide.
                if (along > 21 - 6 || along < 6) continue;
                worst = std::max(worst, std::abs(out.at(x, y).r - wall.at(x, y).r));
            }
        EXPECT_LE(worst, 0.01 * 3) << in.width;
    }
}

/// The soft edge of a shadow that moves by 1.5 pixels a frame over a wall that stands still.
World shadow_on_wall() {
    return [](double x, double, std::uint32_t frame) {
        const double lit = std::clamp((x - 1.5 * frame) / 8, 0.0, 1.0), value = 0.8 - 0.6 * lit;
        return Seen{{value, value, value, 1}};
    };
}

TEST(EffectTaa, WhereLightChangesThePastGoes) {
    const std::vector<Shot> shots = shots_of(shadow_on_wall(), output, output, 24);
    const ReferenceImage made = by_reference({}, shots, output).back(), truth = truth_of(shadow_on_wall(), output, 23);
    double worst = 0, behind = 0;
    for (std::uint32_t x = 4; x < output.width - 4; ++x) {
        const double off = std::abs(made.at(x, 18).g - truth.at(x, 18).g);
        worst = std::max(worst, off);
        if (x + 9 < 1.5 * 23) behind = std::max(behind, off);
    }
    EXPECT_LE(worst, 0.15);
    EXPECT_LE(behind, 0.018) << "of six frames and more before";
}

TEST(EffectTaa, SharpnessMakesEdgesSteeperAndNoHalos) {
    const World edge = [](double x, double, std::uint32_t) {
        const double value = x < 20.3 ? 0.2 : 0.8;
        return Seen{{value, value, value, 1}};
    };
    const std::vector<Shot> shots = shots_of(edge, {32, 19}, output, 16);
    const ReferenceImage soft = on_gpu({}, shots, output).back(),
                         sharp = on_gpu({.sharpness = 1}, shots, output).back();
    const auto steepest = [](const ReferenceImage& image) {
        double most = 0;
        for (std::uint32_t x = 1; x < image.width; ++x)
            most = std::max(most, image.at(x, 18).g - image.at(x - 1, 18).g);
        return most;
    };
    EXPECT_GT(steepest(sharp), steepest(soft) * 1.05);
    for (const Rgba& pixel : sharp.pixels) {
        EXPECT_GE(pixel.g, 0.2 - 1e-3);
        EXPECT_LE(pixel.g, 0.8 + 1e-3);
    }
}

TEST(EffectTaa, NanAndInfinityDoNotComeBack) {
    std::vector<Shot> shots = shots_of(world_at(0), output, output, 12);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    shots[1].color.at(20, 12) = {nan, infinity, -infinity, 1};
    shots[1].velocity.at(30, 12) = {nan, infinity, 0, 1};
    shots[1].depth.at(40, 12).r = nan;
    const std::vector<ReferenceImage> clean = on_gpu({}, shots_of(world_at(0), output, output, 12), output);
    const std::vector<ReferenceImage> out = on_gpu({}, shots, output);
    for (const ReferenceImage& image : out)
        for (const Rgba& pixel : image.pixels)
            EXPECT_TRUE(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b));
    EXPECT_LE(share_beyond(out.back(), clean.back(), 0.05), 0.005);
}

TEST(EffectTaa, OddSizesAndASinglePixel) {
    for (const auto& [in, to] : {std::pair{VkExtent2D{1, 1}, VkExtent2D{1, 1}},
                                 {VkExtent2D{1, 1}, VkExtent2D{3, 2}},
                                 {VkExtent2D{7, 1}, VkExtent2D{10, 2}},
                                 {VkExtent2D{3, 11}, VkExtent2D{7, 13}}}) {
        const std::vector<Shot> shots = shots_of(world_at(0), in, to, 3);
        EXPECT_LE(test::worst_difference(on_gpu({}, shots, to)[2], by_reference({}, shots, to)[2]), 8e-3)
            << in.width << "x" << in.height;
    }
}

TEST(EffectTaa, AlphaIsThatOfTheFrame) {
    const World world = [](double x, double, std::uint32_t) { return Seen{{0.5, 0.5, 0.5, x < 20 ? 0.25 : 1}}; };
    const ReferenceImage out = on_gpu({}, shots_of(world, output, output, 3), output).back();
    EXPECT_NEAR(out.at(5, 5).a, 0.25, 1e-6);
    EXPECT_NEAR(out.at(50, 5).a, 1, 1e-6);
}

TEST(EffectTaa, StabilityIsHowManyFramesAreGathered) {
    EXPECT_EQ(taa_max_frames({.stability = 0}), 8);
    EXPECT_EQ(taa_max_frames({.stability = 1}), 128);
    EXPECT_LT(taa_pre_roll({.stability = 0}), taa_pre_roll({.stability = 1}));
}

}  // namespace
}  // namespace darkroom
