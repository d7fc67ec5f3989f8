// SPDX-License-Identifier: MIT
// The interface's chain as a whole: the original's arithmetic, written down once more; what stays untouched; sizes.
#include <gtest/gtest.h>
#include <darkroom/look.hpp>
#include <darkroom/ui_constants.hpp>

#include "compose/test_stacks/host.hpp"
#include "develop/reference_chain.hpp"
#include "shared/sample_reference.hpp"

namespace darkroom {
namespace {

using test::add;

class ChainUi : public test::StackTest {
  protected:
    void SetUp() override {
        StackTest::SetUp();
        for (const std::string_view name : {"ui_warp", "ui_chroma", "ui_echo", "ui_composite", "contrast_gamma"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    }
};

/// A premultiplied interface of 8 bits: bars, half-transparent panes, and nothing, to the very edge.
ReferenceImage interface_of(std::uint32_t width, std::uint32_t height) {
    ReferenceImage out(width, height, {0, 0, 0, 0});
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const double u = (x + 0.5) / width, v = (y + 0.5) / height;
            const double alpha = u < 0.25 || v > 0.85 ? 1 : (x / 5 + y / 3) % 3 == 0 ? 128 / 255.0 : 0;
            const auto code = [&](std::uint32_t value) { return std::floor(alpha * (value % 256)) / 255; };
            out.at(x, y) = {code(x * 7 + y), code(y * 5), code(x + 3 * y), alpha};
        }
    return out;
}
ReferenceImage encoded_world(std::uint32_t width, std::uint32_t height) {
    return test::round_to_float(test::random_display(width, height, 5));
}

/// An entry of the interface's own chain.
Handle add_ui(Composer& composer, std::string_view effect, std::initializer_list<test::Value> values = {}) {
    return add(composer, effect, values, {.is_ui = true});
}

void fill(Composer& composer) {
    add_ui(composer, "ui_warp");
    add_ui(composer, "ui_chroma");
    add_ui(composer, "ui_echo");
    add(composer, "encode");
    add(composer, "ui_composite");
    add(composer, "contrast_gamma");
}

/// The original's fragment shader, from its description, on an encoded world.
ReferenceImage original(const ReferenceImage& world, const ReferenceImage& ui, const DarkroomUiConstants& c) {
    ReferenceImage out(world.width, world.height);
    const auto barrel = [&](double x, double y, double s) {
        const double cx = x - 0.5, cy = y - 0.5, r2 = cx * cx + cy * cy;
        return sample_reference(ui, cx * (1 + s * r2) + 0.5, cy * (1 + s * r2) + 0.5);
    };
    for (std::uint32_t py = 0; py < out.height; ++py)
        for (std::uint32_t px = 0; px < out.width; ++px) {
            const double warp = c.warp_strength, scale = 1 + std::abs(warp) * 0.5;
            const double x = ((px + 0.5) / out.width - 0.5) * scale + 0.5 + c.ui_offset_x;
            const double y = ((py + 0.5) / out.height - 0.5) * scale + 0.5 + c.ui_offset_y;
            Rgba l = barrel(x, y, warp);
            if (c.chromatic_strength > 0) {
                l.r = barrel(x, y, warp + c.chromatic_strength).r;
                l.b = barrel(x, y, warp - c.chromatic_strength).b;
            }
            if (c.echo_strength > 0) {
                const Rgba e = barrel((x - 0.5) * c.echo_scale + 0.5, (y - 0.5) * c.echo_scale + 0.5, warp);
                l = {l.r + e.r * c.echo_strength, l.g + e.g * c.echo_strength, l.b + e.b * c.echo_strength,
                     std::max(l.a, e.a * c.echo_strength)};
            }
            const double opacity = std::clamp<double>(c.ui_opacity, 0.1, 1),
                         add = std::clamp<double>(c.ui_additive, 0, 1);
            const double weight = std::min(1.0, l.a * opacity * (1 - add)), light = opacity * (1 - add + 0.7 * add);
            const auto channel = [&](double below, double above) {
                const double composed = (below * (1 - weight) + above * light) * std::clamp<double>(c.contrast, 1, 2);
                return std::pow(std::max(0.0, composed), double{c.gamma});
            };
            const Rgba& w = world.at(px, py);
            out.at(px, py) = {channel(w.r, l.r), channel(w.g, l.g), channel(w.b, l.b), 1};
        }
    return out;
}

/// Filtered by some drivers in more than 8 bits.
constexpr VkFormat float4 = VK_FORMAT_R32G32B32A32_SFLOAT;
const DarkroomUiConstants plain{.gamma = 1, .contrast = 1, .ui_opacity = 1, .echo_scale = 1};

/// World (linear light) and interface through the stack that the constants were set on, by the GPU.
ReferenceImage composed(const ReferenceImage& world, const ReferenceImage& ui, const DarkroomUiConstants& constants,
                        test::RunOptions options = {}) {
    options.ui = &ui;
    return test::develop(
        [&](Composer& composer) {
            fill(composer);
            test::must(set_ui_constants(composer, constants, world.height));
        },
        world, options);
}

ReferenceImage encoded(const ReferenceImage& linear) {
    ReferenceImage out = linear;
    const auto curve = [](double v) {
        v = std::clamp(v, 0.0, 1.0);
        return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    };
    for (Rgba& p : out.pixels) p = {curve(p.r), curve(p.g), curve(p.b), p.a};
    return out;
}

// Two heights, three aspect ratios, both stages. What remains is the encoding's polynomial (3.3e-5), raised by a
// contrast of up to 2, and the eighth of a bit that a sampler places its texels by.
TEST_F(ChainUi, IsTheOriginalsArithmetic) {
    std::vector<DarkroomUiConstants> all(10, plain);
    all[1].warp_strength = -0.4F;
    all[2].warp_strength = 0.3F, all[2].chromatic_strength = 0.05F;
    all[3].echo_strength = 0.4F, all[3].echo_scale = 1.2F, all[3].warp_strength = -0.15F;
    all[4].ui_opacity = 0.75F, all[4].ui_additive = 0.5F, all[4].contrast = 1.4F, all[4].gamma = 0.9F;
    all[5].ui_offset_x = 0.03F, all[5].ui_offset_y = -0.02F, all[5].warp_strength = -0.1F;
    all[6].echo_strength = 3, all[6].echo_scale = 0.7F, all[6].ui_opacity = 0;
    all[8].contrast = 0.5F, all[8].gamma = 0.8F;
    all[9].contrast = 3.5F;
    all[7] = {0.9F, 1.4F, -0.15F, 0.01F, 0.01F, 0.01F, 0.75F, 0.2F, 1.01F, 0.25F};
    for (const VkExtent2D size : {VkExtent2D{96, 54}, {72, 54}, {120, 51}, {192, 108}}) {
        const ReferenceImage world = encoded_world(size.width, size.height);
        const ReferenceImage ui = interface_of(size.width, size.height), under = encoded(world);
        for (std::size_t i = 0; i < all.size(); ++i)
            for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
                // Of text, white on nothing, a filtered layer and its echo.
                const double gain = std::clamp(double{all[i].contrast}, 1.0, 2.0) * (1 + double{all[i].echo_strength});
                SCOPED_TRACE(fmt::format("{}x{}, constants {}", size.width, size.height, i));
                EXPECT_LE(test::worst_difference(composed(world, ui, all[i], {.kernels = stage, .ui_format = float4}),
                                                 original(under, ui, all[i])),
                          (i == 6 ? 6e-3 : 2e-3) + 2 * gpu::test::filter_step() * gain);
            }
    }
}

TEST_F(ChainUi, OpaquePixelsAreTheirOwnBitsWhereAllIsNeutral) {
    const ReferenceImage world = encoded_world(75, 44), ui = interface_of(75, 44);
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        const ReferenceImage out = composed(world, ui, plain, {.kernels = stage, .target = VK_FORMAT_R8G8B8A8_UNORM});
        ASSERT_EQ(out.pixels.size(), ui.pixels.size());
        for (std::size_t i = 0; i < ui.pixels.size(); ++i) {
            if (ui.pixels[i].a < 1) continue;
            EXPECT_EQ(std::lround(out.pixels[i].r * 255), std::lround(ui.pixels[i].r * 255));
            EXPECT_EQ(std::lround(out.pixels[i].b * 255), std::lround(ui.pixels[i].b * 255));
        }
    }
}

TEST_F(ChainUi, NeitherSeesTheOthersEffects) {
    const ReferenceImage world = encoded_world(64, 48), ui = interface_of(64, 48), none(64, 48, {0, 0, 0, 0});
    const auto run = [&](const ReferenceImage& layer, bool has_ui_effects, bool has_world_effects) {
        return test::develop(
            [&](Composer& composer) {
                add_ui(composer, "ui_warp", {{"strength", has_ui_effects ? -0.5 : 0}});
                add(composer, "exposure", {{"exposure", has_world_effects ? 0.25 : 1}});
                add_ui(composer, "ui_echo", {{"strength", has_ui_effects ? 0.5 : 0}});
                add(composer, "vignette", {{"intensity", has_world_effects ? 1.0 : 0.0}});
                add(composer, "encode");
                add(composer, "ui_composite");
            },
            world, {.ui = &layer});
    };
    EXPECT_EQ(test::worst_difference(run(none, true, true), run(none, false, true)), 0) << "the world is not warped";
    const ReferenceImage bright = run(ui, false, false), dark = run(ui, false, true);
    for (std::size_t i = 0; i < ui.pixels.size(); ++i)
        if (ui.pixels[i].a == 1) {
            ASSERT_EQ(bright.pixels[i].g, dark.pixels[i].g) << "the interface is not exposed";
        }
    EXPECT_GT(test::worst_difference(bright, dark), 0.1);
}

// Whatever the picture's effects do, and in both orders: they lie before the interface, so what is opaque in it keeps
// its codes, dither being the last of them.
TEST_F(ChainUi, OpaquePixelsKeepTheirCodesInBothOrders) {
    const ReferenceImage world = test::random_hdr(75, 44, 9), ui = interface_of(75, 44);
    for (const LookOrder order : {LookOrder::Documented, LookOrder::SceneLinear}) {
        const Look look = test::must(
            parse_look(fmt::format("[post_process]\norder = \"{}\"\nexposure = 1.7\nvignette_enabled = true\n"
                                   "vignette_intensity = 0.9\ndither_enabled = true\ndither_intensity = 0.1\n"
                                   "chromatic_aberration = 0.02\n[ui]\nui_composite_enabled = true\n",
                                   order == LookOrder::Documented ? "documented" : "scene_linear"),
                       "a look"));
        const auto run = [&](const ReferenceImage& layer) {
            return test::develop([&](Composer& composer) { test::must(apply(look, composer)); }, world,
                                 {.target = VK_FORMAT_R8G8B8A8_UNORM, .ui = &layer});
        };
        const ReferenceImage out = run(ui), bare = run(ReferenceImage(75, 44, {0, 0, 0, 0}));
        ASSERT_EQ(out.pixels.size(), ui.pixels.size());
        std::size_t seen = 0;
        for (std::size_t i = 0; i < ui.pixels.size(); ++i) {
            if (ui.pixels[i].a < 1) continue;
            for (double Rgba::*channel : {&Rgba::r, &Rgba::g, &Rgba::b})
                ASSERT_EQ(std::lround(out.pixels[i].*channel * 255), std::lround(ui.pixels[i].*channel * 255)) << i;
            seen += std::lround(bare.pixels[i].g * 255) != std::lround(out.pixels[i].g * 255);
        }
        EXPECT_GT(seen, 500U) << "the picture below is another";
    }
}

// Red and blue part by a strength times 1080 / height, and alpha is that of green: the entry itself, not its constants.
TEST_F(ChainUi, ChannelsPartByTheHeightAndAlphaIsGreens) {
    for (const std::uint32_t height : {60U, 180U}) {
        const ReferenceImage world(80, height, {0.2, 0.2, 0.2, 1}), ui = interface_of(80, height);
        DarkroomUiConstants constants = plain;
        constants.chromatic_strength = 0.004F * 1080 / static_cast<float>(height);
        const ReferenceImage out = test::develop(
            [](Composer& composer) {
                add_ui(composer, "ui_chroma", {{"strength", 0.004}});
                add(composer, "encode");
                add(composer, "ui_composite");
            },
            world, {.ui = &ui, .ui_format = float4});
        EXPECT_LE(test::worst_difference(out, original(encoded(world), ui, constants)),
                  2e-3 + 2 * gpu::test::filter_step())
            << height;
    }
}

// A bar in the middle, half as wide as its ghost of twice the size: beside the bar lies the ghost alone, whose alpha is
// the larger one, and on the bar light is added. A ghost that is stronger than what it is of stays a number.
TEST_F(ChainUi, TheGhostIsAddedAndTheLargerAlphaCounts) {
    const ReferenceImage world(64, 8, {0.5, 0.5, 0.5, 1});
    ReferenceImage ui(64, 8, {0, 0, 0, 0});
    for (std::uint32_t y = 0; y < 8; ++y)
        for (std::uint32_t x = 24; x < 40; ++x) ui.at(x, y) = {0.3, 0.1, 0, 0.6};
    const double below = encoded(world).pixels[0].r;
    for (const float strength : {0.5F, 4.0F}) {
        const ReferenceImage out = test::develop(
            [&](Composer& composer) {
                add_ui(composer, "ui_echo", {{"strength", strength}, {"size", 2}});
                add(composer, "encode");
                add(composer, "ui_composite");
            },
            world, {.ui = &ui, .ui_format = float4});
        const double ghost = 0.6 * double{strength}, beside = std::min(ghost, 1.0),
                     on = std::min(std::max(ghost, 0.6), 1.0);
        EXPECT_NEAR(out.at(20, 4).r, below * (1 - beside) + 0.3 * double{strength}, 1e-3);
        EXPECT_NEAR(out.at(32, 4).r, below * (1 - on) + 0.3 * (1 + double{strength}), 1e-3);
        EXPECT_NEAR(out.at(12, 4).r, below, 1e-3) << "beyond twice the bar there is nothing";
        for (const Rgba& pixel : out.pixels) ASSERT_TRUE(std::isfinite(pixel.r) && std::isfinite(pixel.g));
    }
}

// No contrast outside of [1, 2] reaches the picture, by whatever way it comes.
TEST_F(ChainUi, ContrastBeyondItsBoundsIsRefusedOrTheBound) {
    const ReferenceImage world = encoded_world(20, 10), ui = interface_of(20, 10);
    for (const auto& [given, taken] : {std::pair{0.25F, 1.0F}, {-3.0F, 1.0F}, {2.5F, 2.0F}, {1e9F, 2.0F}}) {
        DarkroomUiConstants beyond = plain, bound = plain;
        beyond.contrast = given;
        bound.contrast = taken;
        EXPECT_EQ(test::worst_difference(composed(world, ui, beyond), composed(world, ui, bound)), 0) << given;
        Composer composer(Device::assumed());
        const Handle handle = add(composer, "contrast_gamma");
        const std::array words{std::bit_cast<std::uint32_t>(given)};
        EXPECT_FALSE(composer.set(handle, "contrast", words)) << given;
        EXPECT_FALSE(parse_look(fmt::format("[ui]\ncontrast_gamma_contrast = {}\n", given), "a look")) << given;
    }
}

TEST_F(ChainUi, IsOneKernelWithTheTail) {
    Composer composer(Device::assumed());
    fill(composer);
    CompileDesc desc{.max_extent = {640, 360}, .ui = {VK_FORMAT_R8G8B8A8_UNORM}};
    const auto plan = composer.plan(desc);
    ASSERT_TRUE(plan) << plan.error().text;
    ASSERT_EQ(plan->passes.size(), 1U) << plan->text();
    EXPECT_EQ(plan->passes[0].entries.size(), 6U);
    desc.ui = {};
    const auto without = composer.plan(desc);
    ASSERT_TRUE(without) << without.error().text;
    EXPECT_EQ(without->left_out.size(), 4U) << without->text();
    EXPECT_EQ(without->passes.size(), 1U);
}

TEST_F(ChainUi, FusedAndUnfusedAndReferenceAreOnePicture) {
    const ReferenceImage world = encoded_world(90, 50), ui = interface_of(90, 50);
    const auto build = [](Composer& composer) {
        add_ui(composer, "ui_warp", {{"strength", -0.3}});
        add_ui(composer, "ui_chroma", {{"strength", 0.004}});
        const Handle hud = add_ui(composer, "ui_echo", {{"strength", 0.3}, {"size", 1.1}});
        add(composer, "encode");
        add(composer, "ui_composite", {{"additive", 0.2}}, {.opacity = 0.8F});
        add(composer, "blend", {{"amount", 0.3}}, {.second = hud});
        add(composer, "contrast_gamma", {{"contrast", 1.2}});
    };
    Composer composer(gpu::test::device());
    build(composer);
    const auto expected = run_reference(composer, {.color = &world, .images = {{FrameImage::Ui, &ui}}});
    ASSERT_TRUE(expected) << expected.error().text;
    for (const bool fuse : {true, false})
        EXPECT_LE(test::worst_difference(test::develop(build, world, {.fuse = fuse, .ui = &ui, .ui_format = float4}),
                                         expected->picture),
                  3e-3)
            << fuse;
}

// A map that is not laid over the whole picture is one by itself.
TEST_F(ChainUi, MapsMixLikeAnyEntry) {
    const ReferenceImage world = encoded_world(60, 40), mask = interface_of(60, 40);
    const auto build = [](Composer& composer) {
        add(composer, "ui_warp", {{"strength", -0.6}});
        add(composer, "ui_chroma", {{"strength", 0.02}}, {.opacity = 0.5F});
        add(composer, "ui_warp", {{"strength", 0.2}}, {.mask = ui_layer, .blend = BlendMode::Add});
        add(composer, "ui_echo", {{"strength", 0.5}});
        add(composer, "exposure", {{"exposure", 0.5}});
    };
    Composer composer(gpu::test::device());
    build(composer);
    const auto expected =
        run_reference(composer, {.color = &world, .images = {{FrameImage::Ui, &mask}}, .encodes_target = false});
    ASSERT_TRUE(expected) << expected.error().text;
    for (const bool fuse : {true, false})
        EXPECT_LE(test::worst_difference(test::develop(build, world, {.fuse = fuse, .ui = &mask}), expected->picture),
                  5e-3)
            << fuse;
}

TEST_F(ChainUi, NoStrengthMakesNotANumber) {
    const ReferenceImage world = encoded_world(33, 21), ui = interface_of(33, 21);
    for (const float warp : {-4.0F, 4.0F})
        for (const float echo : {0.0F, 4.0F})
            for (const float additive : {0.0F, 1.0F}) {
                DarkroomUiConstants c{.gamma = 0.1F,
                                      .contrast = 2,
                                      .warp_strength = warp,
                                      .chromatic_strength = 1,
                                      .ui_offset_x = 1,
                                      .ui_offset_y = -1,
                                      .ui_opacity = 1,
                                      .echo_strength = echo,
                                      .echo_scale = 0.05F,
                                      .ui_additive = additive};
                for (const Rgba& p : composed(world, ui, c).pixels)
                    for (const double v : {p.r, p.g, p.b, p.a}) ASSERT_TRUE(std::isfinite(v) && v >= 0) << warp;
            }
    const float nan = std::nanf("");
    const DarkroomUiConstants none{nan, nan, nan, nan, nan, nan, nan, nan, nan, nan};
    EXPECT_EQ(test::worst_difference(composed(world, ui, none), composed(world, ui, plain)), 0);
}

TEST_F(ChainUi, TwoBitsOfAlphaAreRefused) {
    Composer composer(gpu::test::device());
    fill(composer);
    const auto plan = composer.compile({.max_extent = {64, 64}, .ui = {VK_FORMAT_A2B10G10R10_UNORM_PACK32}});
    ASSERT_FALSE(plan);
    EXPECT_NE(plan.error().text.find("ui.format = A2B10G10R10_UNORM_PACK32"), std::string::npos) << plan.error().text;
}

// The colour has half the target's sides: the picture is sampled into the target, and the interface keeps its pixels.
TEST_F(ChainUi, IsComposedAtTheTargetsSize) {
    const ReferenceImage world = encoded_world(40, 24), ui = interface_of(80, 48);
    const test::Host host(world);
    const gpu::test::Picture layer = gpu::test::upload(host.device.context(), test::pixels_of(ui),
                                                       VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_LAYOUT_GENERAL);
    const gpu::test::Picture target = gpu::test::blank(host.device.context(), {80, 48}, VK_FORMAT_R8G8B8A8_UNORM);
    for (const bool has_dither : {false, true}) {
        Composer composer(host.device);
        fill(composer);
        if (has_dither) add(composer, "dither", {{"intensity", 0.02}});
        CompileDesc desc = host.compile_desc();
        desc.target = {target.image.info.format, target.image.info.usage};
        desc.target_extent = {80, 48};
        desc.ui = {VK_FORMAT_R8G8B8A8_UNORM};
        const auto plan = composer.compile(desc);
        ASSERT_TRUE(plan) << plan.error().text;
        EXPECT_EQ(plan->passes.size(), 2U) << plan->text();
        Frame frame = host.frame();
        frame.target = test::image_ref(target);
        frame.ui = test::image_ref(layer);
        test::must(host.record(composer, frame));
        if (has_dither) continue;
        const ReferenceImage out = test::image_of(gpu::test::download(host.device.context(), target));
        for (std::size_t i = 0; i < ui.pixels.size(); ++i)
            if (ui.pixels[i].a == 1) {
                ASSERT_EQ(std::lround(out.pixels[i].g * 255), std::lround(ui.pixels[i].g * 255)) << i;
            }
        frame.ui = test::image_ref(host.color);
        EXPECT_FALSE(host.record(composer, frame)) << "as large as the colour, not as the target";
    }
}

// A linear target takes light: the composed picture, decoded.
TEST_F(ChainUi, ALinearTargetGetsTheDecodedPicture) {
    const ReferenceImage world = encoded_world(40, 30), ui = interface_of(40, 30);
    const ReferenceImage light = composed(world, ui, plain, {.target_domain = Domain::SceneLinear});
    EXPECT_LE(test::worst_difference(encoded(light), original(encoded(world), ui, plain)), 1e-3);
}

}  // namespace
}  // namespace darkroom
