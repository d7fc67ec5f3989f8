// SPDX-License-Identifier: MIT
// What a history holds: the last frame to the bit, for ever, until a cut or a camera that is somewhere else.

#include <cmath>
#include <numbers>

#include <darkroom/describe.hpp>
#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using test::Host;
using test::must;

struct Loop {
    std::int32_t step = 0;
};
constexpr auto loop_rows = describe(field<&Loop::step>("Texels to the left that a frame goes.", {0, 1}));
constexpr EffectFile loop_files[] = {
    {"loop_load.glsl",
     "vec4 shade(Pixel pixel) {\n"
     "    return custom[0].x == 0.0 ? load(loop_in, pixel.texel) : load(loop_before, pixel.texel);\n}\n"},
    {"loop_sample.glsl",
     "vec4 shade(Pixel pixel) {\n"
     "    vec2 delta = vec2(float(loop_parameters().step) / float(pixel.size.x), 0.0);\n"
     "    return custom[0].x == 0.0 ? load(loop_in, pixel.texel)\n"
     "                              : sample_linear(loop_before, fract(pixel.uv + delta));\n}\n"},
};
void loop_constants(const void*, const PassContext& context, std::span<PassVector> out) {
    out[0] = {context.has_history ? 1.0f : 0.0f, 0, 0, 0};
}
template <VkFormat format, bool is_sampled>
void build_loop(PassBuilder& builder) {
    const PassBuilder::History history = builder.history({.name = "loop", .format = format});
    builder.result(builder.add({.name = "loop",
                                .shader = is_sampled ? "loop_sample.glsl" : "loop_load.glsl",
                                .inputs = {{.name = "loop_in", .image = builder.picture()},
                                           {.name = "loop_before", .image = history.previous}},
                                .output = history.current,
                                .custom_vectors = 1,
                                .constants = loop_constants}));
}
/// Shows the first frame of its history for ever.
template <VkFormat format, bool is_sampled = false>
const EffectInfo loop{.name = "loop",
                      .doc = "Feeds back what it made.",
                      .parameters = loop_rows.table(),
                      .files = loop_files,
                      .touch = Touch::History,
                      .build = build_loop<format, is_sampled>};

/// The first picture, `frames` recordings after another one took its place.
ReferenceImage fed_back(const EffectInfo& info, const Loop& parameters, const ReferenceImage& first, int frames) {
    const Host host(first);
    const gpu::test::Picture then = gpu::test::upload(
        host.device.context(), test::pixels_of(test::uniform(first.width, first.height, {9, 9, 9, 1})),
        VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
    Composer composer(host.device);
    composer.add(info, &parameters);
    must(composer.compile(host.compile_desc()));
    must(host.record(composer, host.frame()));
    Frame frame = host.frame();
    frame.color = test::image_ref(then);
    for (int i = 0; i < frames; ++i) must(host.record(composer, frame));
    return host.read_target();
}

TEST(ComposeHistory, AThousandCopiesAreTheFirstBitForBit) {
    const ReferenceImage halves = test::round_to_half(test::random_hdr(25, 9, 4));
    EXPECT_EQ(test::worst_difference(fed_back(loop<VK_FORMAT_R16G16B16A16_SFLOAT>, {}, halves, 1000), halves), 0);
    const ReferenceImage floats = test::round_to_float(test::random_hdr(7, 13, 5));
    EXPECT_EQ(test::worst_difference(fed_back(loop<VK_FORMAT_R32G32B32A32_SFLOAT>, {}, floats, 1000), floats), 0);
}

// A texel is 1 / width of uv. Rounding to codes takes what a place that is known to 2^-20 lets in of the neighbour.
TEST(ComposeHistory, AThousandStepsByTheTexelDeltaNeitherDriftNorBleed) {
    ReferenceImage codes = test::random_display(25, 9, 6);
    for (Rgba& p : codes.pixels)
        for (double* const value : {&p.r, &p.g, &p.b}) *value = static_cast<float>(std::round(*value * 255) / 255);
    const EffectInfo& sampled = loop<VK_FORMAT_R8G8B8A8_UNORM, true>;
    const ReferenceImage here = fed_back(sampled, {.step = 0}, codes, 1000);
    const ReferenceImage once = fed_back(sampled, {.step = 1}, codes, 1);
    const ReferenceImage round = fed_back(sampled, {.step = 1}, codes, 1000);  // forty times round
    EXPECT_LE(test::worst_difference(here, codes), 1e-7);
    EXPECT_EQ(test::worst_difference(round, here), 0);
    EXPECT_EQ(once.at(3, 4).r, here.at(4, 4).r);
    EXPECT_EQ(once.at(24, 4).r, here.at(0, 4).r);
}

/// What two frames show, the second with another camera: has the history of the first been used?
bool goes_on(const Camera& before, const Camera& after) {
    const ReferenceImage first = test::uniform(4, 4, {0.25, 0.25, 0.25, 1});
    const Host host(first);
    const gpu::test::Picture then =
        gpu::test::upload(host.device.context(), test::pixels_of(test::uniform(4, 4, {0.75, 0.75, 0.75, 1})),
                          VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
    Composer composer(host.device);
    composer.add(loop<VK_FORMAT_R32G32B32A32_SFLOAT>, nullptr);
    must(composer.compile(host.compile_desc()));
    Frame frame = host.frame();
    frame.camera = before;
    must(host.record(composer, frame));
    frame.camera = after;
    frame.color = test::image_ref(then);
    must(host.record(composer, frame));
    return host.read_target().at(1, 1).r == 0.25;
}

constexpr double degree = std::numbers::pi / 180;

/// Looks by `angle` radians to the side.
Camera looking(double angle, const std::array<double, 3>& eye = {1, 2, 3}) {
    return test::look_at(eye, {eye[0] + std::sin(angle), eye[1], eye[2] - std::cos(angle)}, 1, 1);
}

TEST(ComposeHistory, ACutEndsIt) {
    Camera cut = looking(0);
    EXPECT_TRUE(goes_on(looking(0), cut));
    cut.is_cut = true;
    EXPECT_FALSE(goes_on(looking(0), cut));
}

TEST(ComposeHistory, ACameraThatTurnsByMoreThanSixtyDegreesEndsIt) {
    EXPECT_TRUE(goes_on(looking(0.3), looking(0.3 + 59.9 * degree)));
    EXPECT_FALSE(goes_on(looking(0.3), looking(0.3 + 60.1 * degree)));
    EXPECT_FALSE(goes_on(looking(0), looking(180 * degree)));
}

TEST(ComposeHistory, ACameraThatMovesByMoreThanThirtyMetresEndsIt) {
    // With a turn, so that the place is that of the eye and not the matrix's last column.
    const auto moved = [](double way) { return looking(0.5, {1 + way * 0.6, 2, 3 - way * 0.8}); };
    EXPECT_TRUE(goes_on(looking(0), moved(29.9)));
    EXPECT_FALSE(goes_on(looking(0), moved(30.1)));
}

TEST(ComposeHistory, TheCameraSaysWhatAJumpIs) {
    const auto with = [](Camera camera, float distance, float angle) {
        camera.jump_distance = distance;
        camera.jump_angle = angle;
        return camera;
    };
    constexpr float never = std::numeric_limits<float>::infinity();
    const Camera far = looking(0, {1, 2, 3000}), turned = looking(0.2), behind = looking(180 * degree);
    EXPECT_TRUE(goes_on(looking(0), with(far, 3000, 1)));
    EXPECT_FALSE(goes_on(looking(0), with(far, 2000, never)));
    EXPECT_TRUE(goes_on(looking(0), with(far, never, 1)));
    EXPECT_FALSE(goes_on(looking(0), with(turned, never, 0.19F)));
    EXPECT_TRUE(goes_on(looking(0), with(turned, never, 0.21F)));
    EXPECT_TRUE(goes_on(looking(0), with(behind, never, never)));
    EXPECT_FALSE(goes_on(looking(0), with(behind, never, 3)));
}

/// Shows `value` everywhere, `times` times over; returns what the target holds then.
double shown(const Host& host, Composer& composer, double value, int times = 1) {
    const gpu::test::Picture picture =
        gpu::test::upload(host.device.context(), test::pixels_of(test::uniform(4, 4, {value, value, value, 1})),
                          VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
    Frame frame = host.frame();
    frame.color = test::image_ref(picture);
    for (int i = 0; i < times; ++i) must(host.record(composer, frame));
    return host.read_target().at(1, 1).r;
}

class ComposeHistoryStack : public test::StackTest {};

// A history is what its writer left in the last frame. Who writes it is always on here, who reads it is not.
TEST_F(ComposeHistoryStack, WhatNobodyReadForAWhileDoesNotComeBack) {
    if (find_effect("recursive_blend") == nullptr) GTEST_SKIP() << "this build has no effect recursive_blend";
    const Host host(test::uniform(4, 4, {1, 1, 1, 1}));
    for (int kind = 0; kind < 3; ++kind) {
        SCOPED_TRACE(kind);
        Composer composer(host.device);
        EntryDesc blend;
        if (kind == 0) blend.second = test::add(composer, "recursive_blend", {{"weight", 0.5}}, {.input = scene_color});
        if (kind == 1) blend.second = scene_color.previous();
        blend.input = test::add(composer, "gaussian_blur", {{"radius", 1.0}}, {.input = scene_color});
        if (kind == 2)
            blend.second = test::add(composer, "gaussian_blur", {{"radius", 1.0}}, {.input = scene_color}).previous();
        const Handle both = test::add(composer, "blend", {}, blend);
        test::add(composer, "gaussian_blur", {{"radius", 1.0}});
        must(composer.compile(host.compile_desc()));
        EXPECT_EQ(shown(host, composer, 1, 3), 1);
        must(composer.set_enabled(both, false));
        EXPECT_EQ(shown(host, composer, 0, 20), 0);
        must(composer.set_enabled(both, true));
        EXPECT_NEAR(shown(host, composer, 0), 0, 1e-5);
        EXPECT_NEAR(shown(host, composer, 0), 0, 1e-5);
    }
}

/// The first picture stays, whatever is shown, while the kernels' stage changes.
void expect_it_outlives_its_stage(Device& device) {
    const Host host(test::uniform(4, 4, {1, 1, 1, 1}), VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT,
                    device);
    Composer composer(device);
    composer.add(loop<VK_FORMAT_R32G32B32A32_SFLOAT>, nullptr);
    test::add(composer, "gaussian_blur", {{"radius", 1.0}});
    CompileDesc desc = host.compile_desc();
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster, KernelStage::Compute}) {
        desc.kernels = stage;
        must(composer.compile(desc));
        EXPECT_EQ(shown(host, composer, 1 - static_cast<double>(stage == KernelStage::Raster)), 1);
        EXPECT_EQ(shown(host, composer, 0.5), 1);
    }
}

TEST_F(ComposeHistoryStack, AnotherStageOfTheKernelsKeepsIt) { expect_it_outlives_its_stage(gpu::test::device()); }

// A format that cannot be blitted is copied, where the extent stays.
TEST_F(ComposeHistoryStack, AnotherStageKeepsItThoughItCannotBeBlitted) {
    static PFN_vkGetPhysicalDeviceFormatProperties ask;
    Device own = must(Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"}));
    gpu::Dispatch& vk = own.context().vk;
    ask = vk.GetPhysicalDeviceFormatProperties;
    vk.GetPhysicalDeviceFormatProperties = [](VkPhysicalDevice device, VkFormat format, VkFormatProperties* out) {
        ask(device, format, out);
        out->optimalTilingFeatures &= ~VkFormatFeatureFlags{VK_FORMAT_FEATURE_BLIT_DST_BIT};
    };
    expect_it_outlives_its_stage(own);
}

// The effect behind it fails to compile, after the images of another stage were made.
TEST_F(ComposeHistoryStack, ACompileThatFailsKeepsIt) {
    const Host host(test::uniform(4, 4, {1, 1, 1, 1}));
    Composer composer(host.device);
    composer.add(loop<VK_FORMAT_R32G32B32A32_SFLOAT>, nullptr);
    CompileDesc desc = host.compile_desc();
    desc.kernels = KernelStage::Compute;
    must(composer.compile(desc));
    EXPECT_EQ(shown(host, composer, 1), 1);
    desc.kernels = KernelStage::Raster;
    static PFN_vkCreateDescriptorPool create;
    gpu::Dispatch& vk = host.device.context().vk;
    create = vk.CreateDescriptorPool;
    vk.CreateDescriptorPool = [](VkDevice, const VkDescriptorPoolCreateInfo*, const VkAllocationCallbacks*,
                                 VkDescriptorPool*) { return VK_ERROR_OUT_OF_HOST_MEMORY; };
    EXPECT_FALSE(composer.compile(desc));
    vk.CreateDescriptorPool = create;
    EXPECT_EQ(shown(host, composer, 0.5), 1);
    must(composer.compile(desc));
    EXPECT_EQ(shown(host, composer, 0.25), 1);
}

// A recording of another view may be the first to read what the older plan left; that is held until it has finished.
TEST_F(ComposeHistoryStack, WhatAnOlderPlanLeftIsHeldWhileItIsRead) {
    const Host host(test::uniform(4, 4, {1, 1, 1, 1}));
    Composer composer(host.device, {.frames_in_flight = 1, .max_threads = 0});
    composer.add(loop<VK_FORMAT_R32G32B32A32_SFLOAT>, nullptr);
    CompileDesc desc = host.compile_desc();
    desc.views = 2;
    desc.kernels = KernelStage::Compute;
    must(composer.compile(desc));
    Frame frame = host.frame();
    for (const std::uint32_t view : {0U, 1U}) {
        frame.view = view;
        must(host.record(composer, frame));
    }
    desc.kernels = KernelStage::Raster;
    must(composer.compile(desc));
    frame.view = 0;
    must(host.record(composer, frame));
    // Two recordings may be unfinished: the second view's waits while the first view's next one is made, and while
    // what is no longer needed is freed.
    frame.view = 1;
    must(gpu::submit_and_wait(host.device.context(), "a recording that is late", [&](VkCommandBuffer commands) {
        must(composer.record(commands, frame));
        frame.view = 0;
        must(host.record(composer, frame));
        must(composer.compile_later(desc));
    }));
    EXPECT_EQ(host.read_target().at(1, 1).r, 1);
}

}  // namespace
}  // namespace darkroom
