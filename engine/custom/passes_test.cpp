// SPDX-License-Identifier: MIT
// Files with passes, images, histories and tables, and what they read of the frame, run by a Composer.
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/custom_effect.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "compose/test_stacks/host.hpp"
#include "compose/test_stacks/support.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

using gpu::test::must;

const std::filesystem::path examples = std::filesystem::path(test::source_folder) / "examples";

CustomEffect parsed(std::string_view text) {
    auto effect = CustomEffect::parse(text, "my.glsl");
    if (!effect) ADD_FAILURE() << effect.error().text;
    return effect ? std::move(*effect) : must(CustomEffect::parse("// @effect none: None.\nnone(", "none.glsl"));
}

/// Of a value below 1 in half precision; drivers may truncate where they store.
constexpr double half_ulp = 1.0 / 2048;

/// One direction of the Gaussian of examples/two_pass_blur.glsl, from its definition.
ReferenceImage blurred(const ReferenceImage& in, double radius, bool is_across) {
    ReferenceImage out = in;
    const int reach = static_cast<int>(std::ceil(3 * radius));
    for (std::uint32_t y = 0; y < in.height; ++y)
        for (std::uint32_t x = 0; x < in.width; ++x) {
            Rgba sum{0, 0, 0, 0};
            double weights = 0;
            for (int i = -reach; i <= reach; ++i) {
                const double weight = std::exp(-0.5 * i * i / (radius * radius));
                const Rgba& tap = in.clamped(is_across ? std::int64_t{x} + i : x, is_across ? y : std::int64_t{y} + i);
                sum = {sum.r + weight * tap.r, sum.g + weight * tap.g, sum.b + weight * tap.b, sum.a + weight * tap.a};
                weights += weight;
            }
            out.at(x, y) = {sum.r / weights, sum.g / weights, sum.b / weights, sum.a / weights};
        }
    return out;
}

TEST(ComposeCustomPasses, TheBlurIsTheGaussian) {
    const CustomEffect effect = must(CustomEffect::load(examples / "two_pass_blur.glsl"));
    for (const auto& [width, height] : {std::pair{37u, 23u}, {1u, 1u}, {2u, 9u}}) {
        const ReferenceImage picture = test::round_to_float(test::random_display(width, height, 4));
        for (const double radius : {1.5, 6.0}) {
            const ReferenceImage expected = blurred(blurred(picture, radius, true), radius, false);
            for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
                const auto fill = [&](Composer& composer) {
                    must(composer.set(composer.add(effect.info(), nullptr), "radius", radius));
                };
                const ReferenceImage out = test::develop(fill, picture, {.kernels = stage});
                EXPECT_LE(test::worst_difference(out, expected), 2 * half_ulp + 1e-5) << width << " " << radius;
            }
        }
    }
}

TEST(ComposeCustomPasses, WhatIsNoNumberStaysWhereItIs) {
    ReferenceImage picture = test::uniform(40, 3, {0.5, 0.5, 0.5, 1});
    picture.at(4, 1).r = std::nan("");
    picture.at(5, 1).g = HUGE_VAL;
    for (const char* const name : {"two_pass_blur.glsl", "feedback_trail.glsl"}) {
        const CustomEffect effect = must(CustomEffect::load(examples / name));
        const ReferenceImage out =
            test::develop([&](Composer& composer) { composer.add(effect.info(), nullptr); }, picture);
        ASSERT_EQ(out.pixels.size(), picture.pixels.size());
        for (std::uint32_t y = 0; y < 3; ++y)
            for (std::uint32_t x = 0; x < 40; ++x) {
                const Rgba& pixel = out.at(x, y);
                const bool is_finite = std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b);
                EXPECT_TRUE(is_finite || (y == 1 && (x == 4 || x == 5))) << name << " " << x << " " << y;
            }
    }
}

TEST(ComposeCustomPasses, TwoEntriesOfAFileLeaveEachOtherAlone) {
    const CustomEffect effect = must(CustomEffect::load(examples / "two_pass_blur.glsl"));
    const ReferenceImage picture = test::round_to_float(test::random_display(21, 17, 6));
    const auto fill = [&](Composer& composer) {
        for (const double radius : {1.0, 3.0})
            must(composer.set(composer.add(effect.info(), nullptr), "radius", radius));
    };
    ReferenceImage expected = picture;
    for (const double radius : {1.0, 3.0}) expected = blurred(blurred(expected, radius, true), radius, false);
    EXPECT_LE(test::worst_difference(test::develop(fill, picture), expected), 4 * half_ulp + 1e-5);
}

/// A white frame, then black ones: what is left of the trail after `seconds`.
double trail_after(const CustomEffect& effect, double seconds, double frames_per_second, bool is_cut = false) {
    const test::Host host(test::uniform(8, 6, {1, 1, 1, 1}));
    const gpu::test::Picture black =
        gpu::test::upload(host.device.context(), test::pixels_of(test::uniform(8, 6, {0, 0, 0, 1})),
                          VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
    Composer composer(host.device);
    composer.add(effect.info(), nullptr);
    must(composer.compile(host.compile_desc()));
    const auto frames = static_cast<std::uint32_t>(std::lround(seconds * frames_per_second));
    for (std::uint32_t i = 0; i <= frames; ++i) {
        Frame frame = host.frame();
        if (i > 0) frame.color = test::image_ref(black);
        frame.delta_time = 1 / frames_per_second;
        frame.frame_index = i;
        frame.camera.is_cut = is_cut && i == frames;
        must(host.record(composer, frame));
    }
    return host.read_target().at(3, 3).r;
}

TEST(ComposeCustomPasses, ATrailFadesByTimeAndEndsAtACut) {
    const CustomEffect effect = must(CustomEffect::load(examples / "feedback_trail.glsl"));
    for (const double rate : {20.0, 60.0, 120.0})
        EXPECT_NEAR(trail_after(effect, 0.1, rate), 0.8 / 4, 1.0 / 512) << rate;
    EXPECT_EQ(trail_after(effect, 0.1, 60, true), 0);
}

/// What a file's function shows of a frame with depth and normals.
ReferenceImage shown(const std::string& text, const ReferenceImage& picture, const test::RunOptions& options = {}) {
    const CustomEffect effect = parsed(text);
    return test::develop([&](Composer& composer) { composer.add(effect.info(), nullptr); }, picture, options);
}

struct Case {
    ReferenceImage picture = test::round_to_float(test::random_display(13, 7, 3));
    ReferenceImage depth{13, 7}, normals{13, 7};
    Camera camera = test::look_at({1, 3, 2}, {4, 1, -9}, 1.1, 13.0 / 7);
    Case() {
        for (std::uint32_t y = 0; y < 7; ++y)
            for (std::uint32_t x = 0; x < 13; ++x) {
                depth.at(x, y).r = double{static_cast<float>(1 + x * 0.5 + y)};
                normals.at(x, y) = {0, 1, 0, 0};
            }
    }
    [[nodiscard]] test::RunOptions options() const { return {.depth = &depth, .normals = &normals, .camera = camera}; }
};

TEST(ComposeCustomPasses, NeedsBindTheImagesOfTheFrame) {
    const Case data;
    const std::string end = "vec4 mine(vec4 color, Pixel pixel, Mine parameters) { return ";
    const ReferenceImage depth =
        shown("// @effect mine: Mine.\n// @needs depth\n" + end + "vec4(load(frame_depth, pixel.texel).r); }",
              data.picture, data.options());
    const ReferenceImage sampled =
        shown("// @effect mine: Mine.\n// @needs depth\n" + end + "vec4(sample_linear(frame_depth, pixel.uv).r); }",
              data.picture, data.options());
    ASSERT_EQ(depth.pixels.size(), data.depth.pixels.size());
    ASSERT_EQ(sampled.pixels.size(), data.depth.pixels.size());
    for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
        EXPECT_EQ(depth.pixels[i].r, data.depth.pixels[i].r);
        EXPECT_NEAR(sampled.pixels[i].r, data.depth.pixels[i].r, 1e-3);
    }
    // The same as device depth.
    test::RunOptions device = data.options();
    device.camera.depth = DepthKind::Standard;
    device.is_depth_planar = false;
    ReferenceImage stored = data.depth;
    const Matrix& p = device.camera.projection;
    for (Rgba& pixel : stored.pixels) pixel.r = (-pixel.r * double{p[10]} + double{p[14]}) / pixel.r;
    device.depth = &stored;
    EXPECT_LE(test::worst_difference(
                  shown("// @effect mine: Mine.\n// @needs depth\n" + end +
                            "vec4(load(frame_depth, pixel.texel).rrr, "
                            "color.a); }",
                        data.picture, device),
                  [&] {
                      ReferenceImage out = data.depth;
                      for (std::size_t i = 0; i < out.pixels.size(); ++i)
                          out.pixels[i] = {out.pixels[i].r, out.pixels[i].r, out.pixels[i].r, data.picture.pixels[i].a};
                      return out;
                  }()),
              1e-3);
    // Up in the world is up and towards a camera that looks down.
    const ReferenceImage normals =
        shown("// @effect mine: Mine.\n// @needs normals\n" + end + "load(frame_normals, pixel.texel); }", data.picture,
              data.options());
    EXPECT_GT(normals.at(5, 3).g, 0.9);
    EXPECT_GT(normals.at(5, 3).b, 0.1);
}

TEST(ComposeCustomPasses, TheExampleOfThePageIsRight) {
    std::ifstream file(std::filesystem::path(test::source_folder) / "docs/custom_effects.md");
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    const std::size_t begin = page.find("// @effect distance_tint");
    ASSERT_NE(begin, std::string::npos);
    const Case data;
    const ReferenceImage out = shown(page.substr(begin, page.find("```", begin) - begin), data.picture, data.options());
    ASSERT_EQ(out.pixels.size(), data.picture.pixels.size());
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double share = 1 - std::exp2(-data.depth.at(x, y).r / 50), before = data.picture.at(x, y).b;
            EXPECT_NEAR(out.at(x, y).b, before + (0.7 - before) * share, 1e-5);
        }
}

TEST(ComposeCustomPasses, APassReadsDepthAndTheFrameWithoutItLeavesTheEffectOut) {
    const Case data;
    const std::string text =
        "// @effect mine: Mine.\n// @needs depth\n// @image far: 1 r32f\n// @pass one: -> far\n"
        "vec4 mine_one(Pixel pixel, Mine parameters) { return load(frame_depth, pixel.texel) * 2.0; }\n// @end far\n"
        "vec4 mine(vec4 color, Pixel pixel, Mine parameters) { return vec4(load(far, pixel.texel).r); }\n";
    EXPECT_EQ(shown(text, data.picture, data.options()).at(4, 2).r, 2 * data.depth.at(4, 2).r);
    EXPECT_EQ(test::worst_difference(shown(text, data.picture), data.picture), 0);
}

TEST(ComposeCustomPasses, VelocityAndUiAreThoseOfTheFrame) {
    const CustomEffect effect = parsed(
        "// @effect mine: Mine.\n// @needs velocity ui\nvec4 mine(vec4 color, Pixel pixel, Mine parameters) {\n"
        "    return vec4(load(frame_velocity, pixel.texel).rg, load(frame_ui, pixel.texel).ba);\n}\n");
    const test::Host host(test::uniform(4, 3, {0, 0, 0, 1}));
    const auto upload = [&](Rgba color) {
        return gpu::test::upload(host.device.context(), test::pixels_of(test::uniform(4, 3, color)),
                                 VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
    };
    const gpu::test::Picture velocity = upload({0.5, -0.25, 0, 0}), ui = upload({0, 0, 0.75, 0.5});
    CompileDesc desc = host.compile_desc();
    desc.velocity = {velocity.image.info.format, velocity.image.info.usage};
    desc.ui = {ui.image.info.format, ui.image.info.usage};
    Composer composer(host.device);
    composer.add(effect.info(), nullptr);
    must(composer.compile(desc));
    Frame frame = host.frame();
    frame.velocity = test::image_ref(velocity);
    frame.ui = test::image_ref(ui);
    frame.camera.velocity = {.sign = VelocityKind::Sign::CurrentMinusPrevious, .unit = VelocityKind::Unit::Uv};
    must(host.record(composer, frame));
    const Rgba out = host.read_target().at(2, 1);
    EXPECT_NEAR(out.r, -0.5 * 4, 1e-3);
    EXPECT_NEAR(out.g, frame.camera.velocity.is_y_down ? 0.25 * 3 : -0.25 * 3, 1e-3);
    EXPECT_EQ(out.b, 0.75);
    EXPECT_EQ(out.a, 0.5);
}

// The interface has the size of what is shown, which may be more than the scene's: a place of the picture is the same
// place of it.
TEST(ComposeCustomPasses, AnInterfaceOfAnotherSizeLiesOverThePicture) {
    const CustomEffect effect = parsed(
        "// @effect mine: Mine.\n// @needs ui\nvec4 mine(vec4 color, Pixel pixel, Mine parameters) {\n"
        "    return vec4(load(frame_ui, pixel.texel).r, sample_linear(frame_ui, pixel.uv).r, 0, 1);\n}\n");
    const test::Host host(test::uniform(8, 6, {0, 0, 0, 1}));
    const auto upload = [&](const ReferenceImage& image) {
        return gpu::test::upload(host.device.context(), test::pixels_of(image), VK_FORMAT_R32G32B32A32_SFLOAT,
                                 VK_IMAGE_LAYOUT_GENERAL);
    };
    const auto place = [](double u, double v) { return u / 2 + v / 4; };
    ReferenceImage ramp(32, 24);
    for (std::uint32_t y = 0; y < 24; ++y)
        for (std::uint32_t x = 0; x < 32; ++x) ramp.at(x, y) = {place((x + 0.5) / 32, (y + 0.5) / 24), 0, 0, 1};
    const gpu::test::Picture ui = upload(ramp), target = upload(test::uniform(32, 24, {0, 0, 0, 0}));
    CompileDesc desc = host.compile_desc();
    desc.ui = {ui.image.info.format, ui.image.info.usage};
    desc.target_extent = {32, 24};
    Composer composer(host.device);
    composer.add(effect.info(), nullptr);
    must(composer.compile(desc));
    Frame frame = host.frame();
    frame.ui = test::image_ref(ui);
    frame.target = test::image_ref(target);
    must(host.record(composer, frame));
    const ReferenceImage out = test::image_of(gpu::test::download(host.device.context(), target));
    // Where the picture is sampled between its own texels.
    for (std::uint32_t y = 2; y < 22; ++y)
        for (std::uint32_t x = 2; x < 30; ++x) {
            const double expected = place((x + 0.5) / 32, (y + 0.5) / 24);
            EXPECT_NEAR(out.at(x, y).r, expected, 4e-3) << x << ", " << y;
            EXPECT_NEAR(out.at(x, y).g, expected, 4e-3) << x << ", " << y;
        }
}

/// Two cascades of 4 x 4 texels: in the first something stands at depth 0.3 before the left half; the second is empty.
ReferenceLight shadow_light_of_halves() {
    ReferenceLight light{.light = {.direction = {0, 0.5f, 0}, .color = {3, 2, 1}, .splits = {10, 20}},
                         .resolution = 4,
                         .cascades = {std::vector<float>(16, 1.0f), std::vector<float>(16, 1.0f)}};
    for (std::size_t i = 0; i < 16; ++i)
        if (i % 4 < 2) light.cascades[0][i] = 0.3f;
    return light;
}

TEST(ComposeCustomPasses, ShadowsAreThoseOfTheFirstLightThatCastsThem) {
    const std::array lights{shadow_light_of_halves()};
    const ReferenceImage picture = test::uniform(3, 1, {0, 0, 0, 1});
    const std::string head = "// @effect mine: Mine.\n// @needs shadows\n";
    const std::string body =
        "    vec2 place = vec2(pixel.uv.x < 0.3 ? -0.5 : 0.5, 0.0);\n"
        "    float lit = mine_lit(vec3(place, 0.5), 5.0), near = mine_lit(vec3(place, 0.2), 5.0);\n"
        "    float far = mine_lit(vec3(-0.5, 0.0, 0.5), pixel.uv.x < 0.6 ? 15.0 : 25.0);\n"
        "    return vec4(lit, near, far, mine_light_color().r + mine_light_direction().y);\n";
    const ReferenceImage end = shown(head + "vec4 mine(vec4 color, Pixel pixel, Mine parameters) {\n" + body + "}\n",
                                     picture, {.lights = lights});
    const ReferenceImage pass = shown(head + "// @image one: 1 rgba32f\n// @result one\n// @pass one: -> one\n" +
                                          "vec4 mine_one(Pixel pixel, Mine parameters) {\n" + body + "}\n",
                                      picture, {.lights = lights});
    ASSERT_EQ(end.pixels.size(), 3u);
    EXPECT_EQ(test::worst_difference(end, pass), 0);
    EXPECT_EQ(end.at(0, 0).r, 0) << "behind what stands there";
    EXPECT_EQ(end.at(1, 0).r, 1);
    for (const Rgba& pixel : end.pixels) {
        EXPECT_EQ(pixel.g, 1) << "before it";
        EXPECT_EQ(pixel.b, 1) << "in another cascade, and behind all";
        EXPECT_EQ(pixel.a, 3.5);
    }
    EXPECT_EQ(
        test::worst_difference(
            shown(head + "vec4 mine(vec4 color, Pixel pixel, Mine parameters) {\n" + body + "}\n", picture), picture),
        0)
        << "without shadows it is left out";
}

TEST(ComposeCustomPasses, TablesHoldTheirValues) {
    const ReferenceImage picture = test::uniform(3, 2, {0, 0, 0, 1});
    const ReferenceImage out = shown(
        "// @effect mine: Mine.\n// @table one: 3x1 r32f = -1, 2.5,\n//   1e3\n// @table two: 1x2 rgba8 = 1, 0, 0, 1,\n"
        "//  0, 0, 1, 1\n// @end one two\nvec4 mine(vec4 color, Pixel pixel, Mine parameters) {\n"
        "    return vec4(load(one, ivec2(pixel.texel.x, 0)).r, load(two, ivec2(0, pixel.texel.y)).rb,\n"
        "                sample_linear(one, vec2(1.0 / 3.0, 0.5)).r);\n}\n",
        picture);
    ASSERT_EQ(out.pixels.size(), 6u);
    const double expected[] = {-1, 2.5, 1000};
    for (std::uint32_t x = 0; x < 3; ++x) EXPECT_EQ(out.at(x, 0).r, expected[x]);
    EXPECT_EQ(out.at(0, 0).g, 1);
    EXPECT_EQ(out.at(0, 0).b, 0);
    EXPECT_EQ(out.at(0, 1).g, 0);
    EXPECT_EQ(out.at(0, 1).b, 1);
    EXPECT_NEAR(out.at(0, 0).a, 0.75, 0.02);
}

TEST(ComposeCustomPasses, AResultMayBeSmaller) {
    const CustomEffect effect = parsed(
        "// @effect mine: Mine.\n// @image one: 1/2 rgba32f\n// @result one\n// @pass one: source -> one\n"
        "vec4 mine_one(Pixel pixel, Mine parameters) { return load(source, pixel.texel * 2); }\n");
    const ReferenceImage picture = test::round_to_float(test::random_display(16, 8, 9));
    test::Host host(picture);
    host.target = gpu::test::blank(host.device.context(), {8, 4}, VK_FORMAT_R32G32B32A32_SFLOAT);
    Composer composer(host.device);
    composer.add(effect.info(), nullptr);
    must(composer.compile(host.compile_desc()));
    EXPECT_EQ(host.run(composer).at(3, 1).r, picture.at(6, 2).r);
}

TEST(ComposeCustomPasses, AWarpMayHavePasses) {
    const ReferenceImage picture = test::round_to_float(test::random_display(16, 8, 9));
    const ReferenceImage moved = shown(
        "// @effect mine: Mine.\n// @touch warp\n// @image one: 1 r32f\n// @pass one: -> one\n"
        "vec4 mine_one(Pixel pixel, Mine parameters) { return vec4(1.0); }\n// @end one\n"
        "vec4 mine(Pixel pixel, Mine parameters) {\n"
        "    return load_clamped(picture, pixel.texel + int(load(one, pixel.texel).r));\n}\n",
        picture);
    EXPECT_EQ(moved.at(3, 2).g, picture.at(4, 3).g);
}

TEST(ComposeCustomPasses, TheDomainIsWhatTheFileSays) {
    const CustomEffect effect = parsed(
        "// @effect mine: Mine.\n// @makes encoded\n"
        "vec4 mine(vec4 color, Pixel pixel, Mine parameters) { return color; }\n");
    const ReferenceImage picture = test::uniform(2, 2, {0.5, 0.5, 0.5, 1});
    // Nobody encodes what is encoded already.
    const auto run = [&](bool has_it) {
        return test::develop(
                   [&](Composer& composer) {
                       if (has_it) composer.add(effect.info(), nullptr);
                   },
                   picture, {.target = VK_FORMAT_R8G8B8A8_UNORM})
            .at(0, 0)
            .r;
    };
    EXPECT_NEAR(run(true), 0.5, 1.0 / 255);
    EXPECT_NEAR(run(false), 0.735, 2.0 / 255);
}

TEST(ComposeCustomPasses, ASecondPictureIsReadByTheEnd) {
    const CustomEffect effect = parsed(
        "// @effect mine: Mine.\n// @needs second\nvec4 mine(vec4 color, Pixel pixel, Mine parameters) {\n"
        "    return color + 2.0 * load(second, pixel.texel);\n}\n");
    const ReferenceImage picture = test::uniform(2, 2, {0.25, 0.5, 0.125, 1});
    const ReferenceImage out = test::develop(
        [&](Composer& composer) { composer.add(effect.info(), nullptr, {.second = scene_color}); }, picture);
    EXPECT_EQ(out.at(1, 1).r, 0.75);
}

TEST(ComposeCustomPasses, AFaultOfAPassIsThatOfTheFilesLine) {
    const CustomEffect effect = parsed(
        "// @effect mine: Mine.\n// @image one: 1 r32f\n// @result one\n// @pass one: picture -> one\n"
        "vec4 mine_one(Pixel pixel, Mine parameters) {\n    return nonsense;\n}\n");
    Composer composer(gpu::test::device());
    composer.add(effect.info(), nullptr);
    const auto plan = composer.compile({.max_extent = {8, 8}});
    ASSERT_FALSE(plan);
    EXPECT_NE(plan.error().text.find("my.glsl:6"), std::string::npos) << plan.error().text;
    EXPECT_NE(plan.error().text.find("nonsense"), std::string::npos) << plan.error().text;
    EXPECT_EQ(plan.error().text.find('\n'), std::string::npos) << plan.error().text;
}

}  // namespace
}  // namespace darkroom
