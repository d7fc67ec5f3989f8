// SPDX-License-Identifier: MIT
// A stack that is edited while the picture runs: recordings go on with the plan they have, entries keep what is theirs,
// and nobody outlives what it reads.

#include <atomic>
#include <chrono>
#include <darkroom/custom_effect.hpp>
#include <darkroom/describe.hpp>
#include <thread>

#include "compose/test_stacks/random_stack.hpp"
#include "compose/test_stacks/record_in_vain.hpp"
#include "core/test_support_small.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;
using test::must;

struct NoParameters {
    float unused = 0;
};
constexpr auto rows = describe(field<&NoParameters::unused>("Nothing.", {0, 1}));
constexpr EffectFile files[] = {
    {"trail.glsl",
     "vec4 shade(Pixel pixel) {\n"
     "    return vec4(0.5 * load(trail_before, pixel.texel).rgb + load(trail_in, pixel.texel).rgb, 1.0);\n}\n"},
};

void build_trail(PassBuilder& builder) {
    const PassBuilder::History history = builder.history({.name = "trail", .format = VK_FORMAT_R32G32B32A32_SFLOAT});
    builder.result(builder.add({.name = "trail",
                                .shader = "trail.glsl",
                                .inputs = {{.name = "trail_in", .image = builder.picture()},
                                           {.name = "trail_before", .image = history.previous}},
                                .output = history.current}));
}
/// Adds half of what it gave in the last frame.
const EffectInfo& trail() {
    static const EffectInfo info{.name = "trail",
                                 .doc = "Leaves a trail.",
                                 .parameters = rows.table(),
                                 .files = files,
                                 .touch = Touch::History,
                                 .build = build_trail};
    return info;
}

ReferenceImage small_picture(std::uint32_t number = 3) {
    return test::round_to_float(test::random_display(40, 33, number));
}

class ComposeEdit : public test::StackTest {
  protected:
    /// Records until compile_later() has been taken.
    static void wait_until_taken(const Host& host, Composer& composer) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (composer.pending().is_pending && std::chrono::steady_clock::now() < deadline) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            must(host.record(composer, host.frame()));
        }
        ASSERT_FALSE(composer.pending().is_pending);
    }
};

TEST_F(ComposeEdit, EditsChangeTheOrderAndKeepValues) {
    const Host host(small_picture());
    Composer composer(host.device);
    const Handle exposure = add(composer, "exposure", {{"exposure", 2}});
    const Handle negative = add(composer, "negative");
    const Handle gray = must(composer.insert(negative, *find_effect("grayscale"), nullptr));
    EXPECT_EQ(composer.entry(1), gray);
    must(composer.move(exposure, {}));
    EXPECT_EQ(composer.entry(2), exposure);
    must(composer.move(exposure, gray));
    EXPECT_EQ(composer.entry(0), exposure);
    must(composer.remove(gray));
    EXPECT_EQ(composer.size(), 2u);
    must(composer.compile(host.compile_desc()));
    const double out = host.run(composer).pixels[7].g;
    EXPECT_NEAR(out, 1 - std::min(1.0, small_picture().pixels[7].g * 2), 2.0) << "of exposure 2, then the negative";

    must(composer.replace(negative, *find_effect("grayscale"), nullptr));
    EXPECT_EQ(composer.info(negative)->name, "grayscale");
    must(composer.compile(host.compile_desc()));
    const Rgba gray_pixel = host.run(composer).pixels[7];
    EXPECT_NEAR(gray_pixel.r, gray_pixel.g, 1e-5);
}

TEST_F(ComposeEdit, StaleHandlesAreErrorsAndNameNobodyElse) {
    Composer composer(gpu::test::device()), other(gpu::test::device());
    const Handle first = add(composer, "exposure");
    const Handle elsewhere = add(other, "exposure");
    must(composer.remove(first));
    const Handle second = add(composer, "exposure");
    EXPECT_NE(first, second);
    for (const Handle stale : {first, elsewhere, Handle{}, Handle{~0u - 7}}) {
        EXPECT_FALSE(composer.check(stale));
        EXPECT_EQ(composer.info(stale), nullptr);
        EXPECT_EQ(composer.desc(stale), nullptr);
        EXPECT_TRUE(composer.words(stale).empty());
        EXPECT_TRUE(composer.current(stale).empty());
        EXPECT_FALSE(composer.set(stale, "exposure", 2.0));
        EXPECT_FALSE(composer.set_enabled(stale, false));
        EXPECT_FALSE(composer.set_opacity(stale, 0.5f));
        EXPECT_FALSE(composer.remove(stale));
        EXPECT_FALSE(composer.move(stale, second));
        EXPECT_FALSE(composer.replace(stale, *find_effect("exposure"), nullptr));
        EXPECT_FALSE(composer.rewire(stale, {}));
        EXPECT_FALSE(composer.insert(stale, *find_effect("exposure"), nullptr));
    }
    const auto error = composer.check(first);
    EXPECT_NE(error.error().text.find("removed"), std::string::npos) << error.error().text;
    EXPECT_EQ(composer.current(second), std::vector<std::uint32_t>{std::bit_cast<std::uint32_t>(1.0f)});

    add(composer, "blend", {}, {.second = second});
    must(composer.remove(second));
    const auto planned = composer.plan({.max_extent = {8, 8}});
    ASSERT_FALSE(planned);
    EXPECT_NE(planned.error().text.find("its second is no entry"), std::string::npos) << planned.error().text;
}

TEST_F(ComposeEdit, RecordingGoesOnWithThePlanItHas) {
    const Host host(small_picture());
    Composer composer(host.device);
    const Handle exposure = add(composer, "exposure", {{"exposure", 2}});
    must(composer.compile(host.compile_desc()));
    const ReferenceImage before = host.run(composer);
    add(composer, "negative");
    EXPECT_EQ(test::worst_difference(host.run(composer), before), 0) << "not compiled yet";
    must(composer.set(exposure, "exposure", 3.0));
    const ReferenceImage brighter = host.run(composer);
    EXPECT_NEAR(brighter.pixels[5].g, small_picture().pixels[5].g * 3, 1e-4) << "with present values";
    must(composer.remove(exposure));
    EXPECT_EQ(test::worst_difference(host.run(composer), brighter), 0) << "of an entry that is gone";
    must(composer.compile_later(host.compile_desc()));
    wait_until_taken(host, composer);
    EXPECT_GT(test::worst_difference(host.run(composer), brighter), 0.1);
}

// The entry is the same one from add to remove, so what runs goes on with its values, whatever a compile makes later.
TEST_F(ComposeEdit, ControlsOfAnEntryThatIsWiredAnewMoveThePictureThatRuns) {
    const Host host(small_picture());
    Composer composer(host.device);
    const Handle damage = add(composer, "exposure", {{"exposure", 0.5}});
    const Handle exposure = add(composer, "exposure", {{"exposure", 2}});
    must(composer.compile(host.compile_desc()));
    const double plain = small_picture().pixels[5].g / 2;
    const auto green = [&] { return host.run(composer).pixels[5].g; };
    const std::uint32_t quarter = std::bit_cast<std::uint32_t>(0.25f);
    const auto look_at_all = [&] {
        must(composer.set(exposure, "exposure", 3.0));
        EXPECT_NEAR(green(), plain * 3, 1e-4);
        must(composer.set_override(exposure, "exposure", "damage", {&quarter, 1}));
        EXPECT_NEAR(green(), plain / 4, 1e-4);
        composer.drop_overrides("damage");
        EXPECT_NEAR(green(), plain * 3, 1e-4);
        must(composer.add_layer({.name = "dark", .weight = 1, .values = {{exposure, "exposure", {quarter}}}}));
        EXPECT_NEAR(green(), plain / 4, 1e-4);
        composer.remove_layer("dark");
        must(composer.add_pulse({.event = "hit", .entry = exposure, .parameter = "exposure", .amount = {2}}));
        EXPECT_EQ(composer.fire("hit"), 1u);
        EXPECT_NEAR(green(), plain * 5, 1e-4);
        composer.remove_pulses();
        must(composer.set_enabled(exposure, false));
        EXPECT_NEAR(green(), plain, 1e-4);
        must(composer.set_enabled(exposure, true));
    };
    look_at_all();
    must(composer.rewire(exposure, *composer.desc(exposure)));
    look_at_all();
    must(composer.rewire(exposure, {.input = scene_color}));
    look_at_all();  // behind the other one until it is compiled
    const Handle gone = add(composer, "dither");
    must(composer.rewire(exposure, {.input = gone}));
    must(composer.remove(gone));
    EXPECT_FALSE(composer.compile(host.compile_desc()));
    look_at_all();
    must(composer.rewire(exposure, {.input = damage}));
    must(composer.compile(host.compile_desc()));
    look_at_all();
    // The same effect put in its own place has new values and keeps the rest.
    must(composer.replace(exposure, *find_effect("exposure"), nullptr));
    EXPECT_NEAR(green(), plain, 1e-4);
    look_at_all();
    // Another one in its place: the picture that runs is switched by the handle still.
    must(composer.replace(exposure, *find_effect("grayscale"), nullptr));
    EXPECT_NEAR(green(), plain * 3, 1e-4);
    must(composer.set_enabled(exposure, false));
    EXPECT_NEAR(green(), plain, 1e-4);
    must(composer.set_enabled(exposure, true));
    must(composer.set_opacity(exposure, 0.5f));
    EXPECT_NEAR(green(), plain * 2, 1e-4);
}

TEST_F(ComposeEdit, WhatAHostFilledInWronglyIsRefused) {
    const Host host(small_picture());
    const auto error = [](const auto& done) { return done ? std::string("none") : done.error().text; };
    for (const auto& [opacity, text] : {std::pair{-1.0f, "-1"}, {7.0f, "7"}, {std::nanf(""), "nan"}}) {
        Composer composer(host.device);
        const Handle handle = add(composer, "negative", {}, {.opacity = opacity});
        const std::string expected = fmt::format("negative: opacity = {}: allowed is [0, 1]", text);
        EXPECT_EQ(error(composer.compile(host.compile_desc())), expected);
        EXPECT_EQ(error(composer.rewire(handle, {.opacity = opacity})), expected);
    }
    Composer composer(host.device);
    const auto wrong = static_cast<BlendMode>(77);
    const Handle handle = add(composer, "negative", {}, {.blend = wrong});
    EXPECT_EQ(error(composer.compile(host.compile_desc())), "negative: blend = 77: allowed is 0 to 8");
    must(composer.rewire(handle, {}));
    EXPECT_EQ(error(composer.compile(host.compile_desc())), "none");
    EXPECT_FALSE(composer.rewire(handle, {.blend = wrong}));
    ColorTable flat{.size = 2, .cube = std::vector<float>(24, 0.5f)};
    must(composer.define(flat));
    flat.min = flat.max;
    EXPECT_EQ(error(composer.define(flat)),
              "a cube from 1 to 1: allowed is a finite domain that ends above where it begins");
}

/// Until a plan is ready; records nothing.
void wait_until_ready(const Composer& composer) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!composer.pending().is_ready && std::chrono::steady_clock::now() < deadline)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_TRUE(composer.pending().is_ready);
}

TEST_F(ComposeEdit, APlanForOtherFormatsWaitsForTheFirstFrameOfThem) {
    const Host host(small_picture());
    const Host other(small_picture(), VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R8G8B8A8_UNORM);
    for (const std::uint32_t threads : {0U, 1U}) {
        Composer composer(host.device, {.max_threads = threads});
        add(composer, "exposure", {{"exposure", 2}});
        must(composer.compile(host.compile_desc()));
        const ReferenceImage before = host.run(composer);
        add(composer, "negative");
        EXPECT_FALSE(composer.pending().is_ready);
        must(composer.compile_later(other.compile_desc()));
        wait_until_ready(composer);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(test::worst_difference(host.run(composer), before), 0);
        EXPECT_TRUE(composer.pending().is_ready);
        EXPECT_GT(test::worst_difference(other.run(composer), before), 0.1);
        EXPECT_FALSE(composer.pending().is_pending);
        EXPECT_FALSE(host.record(composer, host.frame())) << "of formats that are no more";
    }
}

TEST_F(ComposeEdit, APlanWithAnotherImageWaitsForItAndOneThatIsForgottenIsAnError) {
    if (find_effect("fog") == nullptr) GTEST_SKIP() << "this build has no effect fog";
    const Host host(small_picture());
    const gpu::test::Picture depth = gpu::test::blank(host.device.context(), {40, 33}, VK_FORMAT_R32_SFLOAT);
    Composer composer(host.device, {.max_threads = 0});
    add(composer, "exposure", {{"exposure", 2}});
    must(composer.compile(host.compile_desc()));
    add(composer, "fog");
    CompileDesc desc = host.compile_desc();
    desc.depth = {VK_FORMAT_R32_SFLOAT};
    must(composer.compile_later(desc));
    must(host.record(composer, host.frame()));
    EXPECT_TRUE(composer.pending().is_ready);
    Frame frame = host.frame();
    frame.camera.depth = DepthKind::Planar;
    frame.depth = test::image_ref(depth);
    must(host.record(composer, frame));
    EXPECT_FALSE(composer.pending().is_pending);
    must(composer.compile_later(desc));
    const auto forgotten = host.record(composer, host.frame());
    ASSERT_FALSE(forgotten);
    EXPECT_EQ(forgotten.error().text, "record: frame.depth is not given, and the plan reads it");
}

TEST_F(ComposeEdit, AHostThatAsksForTheComingPlanGetsNoOther) {
    const Host host(small_picture());
    Composer composer(host.device, {.max_threads = 0});
    add(composer, "exposure", {{"exposure", 2}});
    must(composer.compile(host.compile_desc()));
    const ReferenceImage before = host.run(composer);
    EXPECT_EQ(composer.coming_plan(), nullptr);
    add(composer, "gaussian_blur");
    must(composer.compile_later(host.compile_desc()));
    EXPECT_TRUE(composer.pending().is_ready);
    EXPECT_EQ(test::worst_difference(host.run(composer), before), 0) << "it came after the host had asked";
    const Plan* const coming = composer.coming_plan();
    ASSERT_NE(coming, nullptr);
    EXPECT_GT(coming->passes.size(), composer.current_plan()->passes.size());
    const std::string text = coming->text();
    EXPECT_GT(test::worst_difference(host.run(composer), before), 1e-3);
    EXPECT_EQ(composer.current_plan()->text(), text);
    EXPECT_EQ(composer.coming_plan(), nullptr);
}

TEST_F(ComposeEdit, WhatAHostWasToldOfIsTakenThoughANewerPlanIsReady) {
    const Host host(small_picture());
    Composer composer(host.device, {.max_threads = 0});
    add(composer, "exposure", {{"exposure", 2}});
    must(composer.compile(host.compile_desc()));
    add(composer, "gaussian_blur");
    must(composer.compile_later(host.compile_desc()));
    const Plan* const told = composer.coming_plan();
    ASSERT_NE(told, nullptr);
    const std::string text = told->text();
    add(composer, "negative");
    must(composer.compile_later(host.compile_desc()));
    EXPECT_EQ(told->text(), text) << "it is the host's until the next recording";
    static_cast<void>(host.run(composer));
    EXPECT_EQ(composer.current_plan()->text(), text);
    const Plan* const newest = composer.coming_plan();
    ASSERT_NE(newest, nullptr);
    EXPECT_NE(newest->text().find("negative"), std::string::npos);
}

TEST_F(ComposeEdit, AnEntryReplacedTwiceIsStillSwitchedInThePictureThatRuns) {
    const Host host(small_picture());
    Composer composer(host.device);
    const Handle entry = add(composer, "negative");
    must(composer.compile(host.compile_desc()));
    EXPECT_GT(test::worst_difference(host.run(composer), small_picture()), 0.1);
    must(composer.replace(entry, *find_effect("grayscale"), nullptr));
    must(composer.replace(entry, *find_effect("exposure"), nullptr));
    must(composer.set_enabled(entry, false));
    EXPECT_EQ(test::worst_difference(host.run(composer), small_picture()), 0);
}

TEST_F(ComposeEdit, AMaskThatIsWiredAwayStaysInThePictureThatRuns) {
    ReferenceImage picture = small_picture();
    for (Rgba& color : picture.pixels) color.a = 0.5;
    const Host host(picture);
    Composer composer(host.device);
    const Handle entry = add(composer, "negative", {}, {.mask = scene_alpha});
    must(composer.compile(host.compile_desc()));
    composer.wait_for_kernels();
    const ReferenceImage before = host.run(composer);
    must(composer.rewire(entry, {}));
    composer.wait_for_kernels();
    EXPECT_EQ(test::worst_difference(host.run(composer), before), 0);
}

/// Holds whoever makes a pipeline while it is closed.
std::atomic<bool> is_gate_closed{false};
std::atomic<int> waiting{0};
PFN_vkCreateGraphicsPipelines create_graphics = nullptr;
PFN_vkCreateComputePipelines create_compute = nullptr;
void pass_gate() {
    ++waiting;
    while (is_gate_closed) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    --waiting;
}

TEST_F(ComposeEdit, ACompileThatIsHeldOpenHoldsNoRecording) {
    auto device = Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"});
    ASSERT_TRUE(device) << device.error().text;
    gpu::Dispatch& vk = device->context().vk;
    create_graphics = vk.CreateGraphicsPipelines;
    create_compute = vk.CreateComputePipelines;
    vk.CreateGraphicsPipelines = [](VkDevice d, VkPipelineCache cache, std::uint32_t count,
                                    const VkGraphicsPipelineCreateInfo* infos, const VkAllocationCallbacks* callbacks,
                                    VkPipeline* out) {
        pass_gate();
        return create_graphics(d, cache, count, infos, callbacks, out);
    };
    vk.CreateComputePipelines = [](VkDevice d, VkPipelineCache cache, std::uint32_t count,
                                   const VkComputePipelineCreateInfo* infos, const VkAllocationCallbacks* callbacks,
                                   VkPipeline* out) {
        pass_gate();
        return create_compute(d, cache, count, infos, callbacks, out);
    };
    {
        const Host host(small_picture(), VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, *device);
        Composer composer(*device);
        const Handle exposure = add(composer, "exposure", {{"exposure", 2}});
        must(composer.compile(host.compile_desc()));
        is_gate_closed = true;
        add(composer, "negative");
        must(composer.compile_later(host.compile_desc()));
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (waiting == 0 && std::chrono::steady_clock::now() < deadline)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ASSERT_GT(waiting, 0) << "nothing is being built";
        for (int i = 1; i <= 20; ++i) {
            must(composer.set(exposure, "exposure", 1.0 + i));
            EXPECT_NEAR(host.run(composer).pixels[3].r, small_picture().pixels[3].r * (1.0 + i), 1e-3);
            EXPECT_TRUE(composer.pending().is_pending);
        }
        is_gate_closed = false;
        wait_until_taken(host, composer);
        EXPECT_NE(composer.current_plan()->passes.back().name.find("negative"), std::string::npos);
    }
}

// Entries that are switched keep their place, and their passes come and go.
TEST_F(ComposeEdit, ThePlanIsWhatRunsNow) {
    const Host host(small_picture());
    Composer composer(host.device);
    add(composer, "exposure", {{"exposure", 2}});
    const Handle blur = add(composer, "gaussian_blur", {{"radius", 3}});
    add(composer, "negative");
    const auto blurs = [&] {
        return std::ranges::count_if(composer.current_plan()->passes,
                                     [](const PlanPass& pass) { return pass.name.starts_with("gaussian_blur."); });
    };
    EXPECT_EQ(composer.current_plan(), nullptr);
    must(composer.compile(host.compile_desc()));
    const auto on = blurs();
    EXPECT_GT(on, 0);
    (void)host.run(composer);
    EXPECT_EQ(blurs(), on);
    for (const bool is_on : {false, true, false}) {
        must(composer.set_enabled(blur, is_on));
        (void)host.run(composer);
        EXPECT_EQ(blurs(), is_on ? on : 0);
        const Plan anew = must(composer.plan(host.compile_desc()));
        EXPECT_EQ(composer.current_plan()->passes.size(), anew.passes.size());
    }
}

// What is built for kernels that recordings missed is no frame: the plan goes on telling of the last one.
TEST_F(ComposeEdit, WaitingForKernelsLeavesThePlanThatWasShown) {
    const Host host(small_picture());
    Composer composer(host.device);
    const Handle blur = add(composer, "gaussian_blur", {{"radius", 3}});
    add(composer, "negative");
    must(composer.add_layer({.name = "far",
                             .weight = 1,
                             .distance = LayerDistance{.near = 1, .far = 2, .point = {1000, 0, 0}},
                             .values = {{blur, "enabled", {0}}}}));
    must(composer.compile(host.compile_desc()));
    Frame frame = host.frame();
    frame.camera.view[12] = -1000;
    must(host.record(composer, frame));
    const std::string shown = composer.current_plan()->text();
    EXPECT_EQ(composer.current_plan()->passes.size(), 1U) << shown;
    composer.wait_for_kernels();
    EXPECT_EQ(composer.current_plan()->text(), shown);
}

TEST_F(ComposeEdit, AFailedCompileLaterLeavesThePlanThatIsReady) {
    const Host host(small_picture());
    auto broken = CustomEffect::parse(
        "// @effect broken: Does not compile.\nvec4 broken(vec4 color, Pixel pixel, Broken parameters) { return oops; "
        "}\n",
        "broken.glsl");
    ASSERT_TRUE(broken) << broken.error().text;
    Composer composer(host.device, {.max_threads = 0});
    const Handle blur = add(composer, "gaussian_blur", {}, {.opacity = 0.5f});
    must(composer.compile(host.compile_desc()));
    CompileDesc larger = host.compile_desc(), largest = larger;
    larger.max_extent = {50, 40};
    largest.max_extent = {60, 50};
    must(composer.compile_later(larger));
    EXPECT_TRUE(composer.pending().is_ready);
    must(composer.rewire(blur, {}));
    const Handle added = composer.add(broken->info(), nullptr);
    must(composer.compile_later(largest));
    EXPECT_TRUE(composer.pending().error.has_value());
    EXPECT_TRUE(composer.pending().is_ready) << "the one before";
    must(composer.set_opacity(blur, 0.25f));  // both plans that there are mix it
    must(composer.remove(added));
    const Plan plan = must(composer.rebind(host.device));
    EXPECT_EQ(plan.passes.front().extent.width, 50U);
}

TEST_F(ComposeEdit, AFailedCompileLeavesThePicture) {
    const Host host(small_picture());
    Composer composer(host.device);
    add(composer, "exposure", {{"exposure", 2}});
    must(composer.compile(host.compile_desc()));
    const ReferenceImage before = host.run(composer);
    auto broken = CustomEffect::parse(
        "// @effect broken: Does not compile.\nvec4 broken(vec4 color, Pixel pixel, Broken parameters) { return oops; "
        "}\n",
        "broken.glsl");
    ASSERT_TRUE(broken) << broken.error().text;
    const Handle added = composer.add(broken->info(), nullptr);
    must(composer.compile_later(host.compile_desc()));
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (composer.pending().is_pending && std::chrono::steady_clock::now() < deadline)
        EXPECT_EQ(test::worst_difference(host.run(composer), before), 0);
    ASSERT_TRUE(composer.pending().error.has_value());
    EXPECT_NE(composer.pending().error->text.find("oops"), std::string::npos) << composer.pending().error->text;
    EXPECT_EQ(test::worst_difference(host.run(composer), before), 0);
    EXPECT_FALSE(composer.compile(host.compile_desc())) << "nor at once";
    EXPECT_EQ(test::worst_difference(host.run(composer), before), 0);
    must(composer.remove(added));
    must(composer.compile_later(host.compile_desc()));
    wait_until_taken(host, composer);
    EXPECT_FALSE(composer.pending().error.has_value());
    EXPECT_EQ(test::worst_difference(host.run(composer), before), 0);
}

/// What a trail shows after `frames` frames of the picture, of which every one adds half of the one before.
double trail_of(double value, int frames) { return value * (2 - std::pow(0.5, frames - 1)); }

TEST_F(ComposeEdit, TrailsGoOnAcrossEditsBitForBit) {
    const Host host(small_picture());
    constexpr int frames = 12;
    std::vector<ReferenceImage> plain;
    for (const std::uint32_t threads : {0u, 1u}) {  // with none, compile_later() has compiled when it returns
        for (const bool is_edited : {false, true}) {
            Composer composer(host.device, {.max_threads = threads});
            const Handle moving = composer.add(trail(), nullptr);
            must(composer.compile(host.compile_desc()));
            for (int frame = 0; frame < frames; ++frame) {
                SCOPED_TRACE(fmt::format("{} threads, frame {}, edited: {}", threads, frame, is_edited));
                if (is_edited && frame == 3) {
                    must(composer.insert(moving, *find_effect("exposure"), nullptr));  // of 1: changes nothing
                    must(composer.compile_later(host.compile_desc()));
                }
                if (is_edited && frame == 8) must(composer.compile(host.compile_desc()));
                const ReferenceImage out = host.run(composer);
                EXPECT_NEAR(out.pixels[9].g, trail_of(small_picture().pixels[9].g, frame + 1), 1e-5);
                if (threads == 0 && !is_edited) plain.push_back(out);
                EXPECT_EQ(test::worst_difference(out, plain[static_cast<std::size_t>(frame)]), 0);
            }
        }
    }
}

TEST_F(ComposeEdit, SwitchingOneEffectOnResetsNoOtherTrail) {
    const Host host(small_picture());
    Composer composer(host.device);
    composer.add(trail(), nullptr);
    const Handle second = composer.add(trail(), nullptr, {.enabled = false});
    must(composer.compile(host.compile_desc()));
    for (int i = 0; i < 3; ++i) must(host.record(composer, host.frame()));
    must(composer.set_enabled(second, true));
    // Its own trail begins with what the first gives.
    EXPECT_NEAR(host.run(composer).pixels[9].g, trail_of(small_picture().pixels[9].g, 4), 1e-5);
}

TEST_F(ComposeEdit, SwitchingAnEffectOffEndsItsTrail) {
    const Host host(small_picture());
    const double green = small_picture().pixels[9].g;
    Composer composer(host.device);
    const Handle moving = composer.add(trail(), nullptr);
    must(composer.compile(host.compile_desc()));
    for (const int frames_off : {1, 2}) {
        for (int i = 0; i < 3; ++i) must(host.record(composer, host.frame()));
        must(composer.set_enabled(moving, false));
        for (int i = 0; i < frames_off; ++i) EXPECT_EQ(host.run(composer).pixels[9].g, green);
        must(composer.set_enabled(moving, true));
        EXPECT_NEAR(host.run(composer).pixels[9].g, trail_of(green, 1), 1e-5) << "what was before does not come back";
        EXPECT_NEAR(host.run(composer).pixels[9].g, trail_of(green, 2), 1e-5);
    }
}

// A new extent within the compiled one resamples what the last frame left.
TEST_F(ComposeEdit, TrailsLiveThroughDynamicResolution) {
    const Host host(test::uniform(40, 33, {0.5, 0.25, 0.75, 1}));
    Composer composer(host.device);
    composer.add(trail(), nullptr);
    must(composer.compile(host.compile_desc()));
    int frames = 0;
    for (const VkExtent2D extent : {VkExtent2D{40, 33}, {40, 33}, {21, 17}, {33, 30}, {40, 33}}) {
        Frame frame = host.frame();
        frame.color.region = frame.target.region = VkRect2D{{0, 0}, extent};
        must(host.record(composer, frame));
        ++frames;
        const ReferenceImage out = host.read_target();
        for (const std::uint32_t y : {0u, extent.height / 2, extent.height - 1})
            for (const std::uint32_t x : {0u, extent.width / 2, extent.width - 1})
                EXPECT_NEAR(out.at(x, y).r, trail_of(0.5, frames), 1e-5) << extent.width << ": " << x << ", " << y;
    }
    Frame cut = host.frame();
    cut.camera.is_cut = true;
    must(host.record(composer, cut));
    EXPECT_NEAR(host.read_target().at(9, 9).r, 0.5, 1e-6) << "a cut begins anew";
}

TEST_F(ComposeEdit, AnAbandonedRecordingDidNotHappen) {
    const Host host(small_picture());
    Composer composer(host.device, {.frames_in_flight = 1});
    add(composer, "dither");
    composer.add(trail(), nullptr);
    EXPECT_FALSE(composer.abandon());
    must(composer.compile(host.compile_desc()));
    Frame elsewhere = host.frame();
    elsewhere.camera.view[12] = 1000;                 // the camera was not there, either
    test::record_in_vain(composer, host, elsewhere);  // the uploads among it
    must(composer.abandon());
    EXPECT_FALSE(composer.abandon()) << "only the last one";
    for (int i = 0; i < 2; ++i) must(host.record(composer, host.frame()));
    test::record_in_vain(composer, host, elsewhere);
    must(composer.abandon());
    const ReferenceImage out = host.run(composer);

    Composer plain(host.device, {.frames_in_flight = 1});
    add(plain, "dither");
    plain.add(trail(), nullptr);
    must(plain.compile(host.compile_desc()));
    for (int i = 0; i < 2; ++i) must(host.record(plain, host.frame()));
    EXPECT_EQ(test::worst_difference(host.run(plain), out), 0);
}

TEST_F(ComposeEdit, NobodyOutlivesWhatItReads) {
    auto device =
        std::make_unique<Device>(must(Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"})));
    auto custom = std::make_unique<CustomEffect>(must(CustomEffect::parse(
        "// @effect halve: Halves.\n"
        "vec4 halve(vec4 color, Pixel pixel, Halve parameters) { return vec4(color.rgb * 0.5, color.a); }\n",
        "halve.glsl")));
    Composer composer(*device);
    const auto host =
        std::make_unique<Host>(small_picture(), VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, *device);
    composer.add(custom->info(), nullptr);
    custom.reset();
    must(composer.compile(host->compile_desc()));
    EXPECT_NEAR(host->run(composer).pixels[3].g, small_picture().pixels[3].g * 0.5, 1e-6);
    EXPECT_EQ(composer.info(composer.entry(0))->name, "halve");
    const std::shared_ptr<gpu::Context> context = device->shared_context();
    Device moved = std::move(*device);
    device.reset();
    must(composer.compile(host->compile_desc()));
}

// Everything at once: edits, toggles, values, sizes, in any order, and a picture all the time.
TEST_F(ComposeEdit, AThousandRandomEditsKeepThePicture) {
    const Host host(small_picture());
    Composer composer(host.device, {.frames_in_flight = 2});
    std::mt19937 random(20);
    const std::array<std::string_view, 8> effects{"exposure", "negative",      "grayscale", "vignette",
                                                  "tonemap",  "gaussian_blur", "bloom",     "dither"};
    add(composer, "exposure");
    must(composer.compile(host.compile_desc()));
    const auto pick = [&] { return composer.entry(test::below(random, static_cast<std::uint32_t>(composer.size()))); };
    double longest = 0;
    for (int i = 0; i < (test::is_small() ? 300 : 1000); ++i) {
        const EffectInfo& info = *find_effect(effects[test::below(random, effects.size())]);
        switch (test::below(random, 8)) {
            case 0:
                if (composer.size() < 8) composer.add(info, nullptr);
                break;
            case 1:
                if (composer.size() < 8 && composer.size() > 0) must(composer.insert(pick(), info, nullptr));
                break;
            case 2:
                if (composer.size() > 1) must(composer.remove(pick()));
                break;
            case 3:
                if (composer.size() > 1) must(composer.move(pick(), pick()));
                break;
            case 4:
                if (composer.size() > 0) must(composer.replace(pick(), info, nullptr));
                break;
            case 5:
                if (composer.size() > 0) must(composer.set_enabled(pick(), test::below(random, 2) != 0));
                break;
            default:
                break;
        }
        if (test::below(random, 4) == 0) {
            CompileDesc desc = host.compile_desc();
            if (test::below(random, 4) == 0) desc.max_extent = {64, 64};
            if (test::below(random, 4) == 0)
                must(composer.compile(desc));
            else
                must(composer.compile_later(desc));
        }
        Frame frame = host.frame();
        if (test::below(random, 4) == 0) {
            frame.color.region = VkRect2D{{0, 0}, {20 + test::below(random, 20), 33}};
            frame.target.region = frame.color.region;
        }
        must(host.record(composer, frame));
        longest = std::max(longest, composer.record_microseconds());
    }
    EXPECT_FALSE(composer.pending().error.has_value());
    RecordProperty("longest_record_microseconds", std::to_string(longest));
    std::printf("[ longest record: %.0f us ]\n", longest);
}

}  // namespace
}  // namespace darkroom
