// SPDX-License-Identifier: MIT
// Compute passes in a stack, and values: an exact histogram, a number made of it, and an effect that reads the number.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

struct Meter {
    float scale = 1;
};
struct Lift {
    float amount = 1;
};

constexpr std::uint32_t bins = 256;
constexpr std::array<EffectFile, 4> meter_files{{
    {"meter_count.glsl",
     "shared uint meter_part[256];\n"
     "void run() {\n"
     "    uint own = gl_LocalInvocationIndex;\n"
     "    meter_part[own] = meter_part[own + 128u] = 0u;\n"
     "    barrier();\n"
     "    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);\n"
     "    if (all(lessThan(texel, size(meter_in))))\n"
     "        atomicAdd(meter_part[uint(clamp(load(meter_in, texel).r * 256.0, 0.0, 255.0))], 1u);\n"
     "    barrier();\n"
     "    atomicAdd(meter_counts[own], meter_part[own]);\n"
     "    atomicAdd(meter_counts[own + 128u], meter_part[own + 128u]);\n}\n"},
    {"meter_clear.glsl", "void run() { meter_counts[gl_GlobalInvocationID.x] = 0u; }\n"},
    {"meter_sum.glsl",
     "void run() {\n"
     "    uint sum = 0u;\n"
     "    for (int i = 0; i < 256; ++i) sum += meter_counts[i] * uint(i);\n"
     "    for (int i = 0; i < 256; ++i) meter_levels[i] = float(meter_counts[i]);\n"
     "    meter_value[0] = float(sum) * meter_parameters().scale;\n"
     "    meter_value[1] += 1.0;\n}\n"},
    {"meter.glsl", "vec4 meter(vec4 color, Pixel pixel, Meter parameters) { return color; }\n"},
}};
constexpr std::array<EffectFile, 1> lift_files{{
    {"lift.glsl",
     "vec4 lift(vec4 color, Pixel pixel, Lift parameters) {\n"
     "    return vec4(vec3(lift_metered[0], lift_metered[1], 0.0) * parameters.amount, color.a);\n}\n"},
}};
constexpr auto meter_rows = describe(field<&Meter::scale>("What the sum is multiplied by.", {0, 16}));
constexpr auto lift_rows = describe(field<&Lift::amount>("What the value is multiplied by.", {0, 16}));

using Access = ComputePassDesc::Access;

const EffectInfo meter_effect{.name = "meter",
                              .doc = "Counts the picture's levels of red.",
                              .parameters = meter_rows.table(),
                              .files = meter_files,
                              .build = [](PassBuilder& builder) {
                                  const PassBuffer counts = builder.create_buffer("counts", 4 * bins),
                                                   value = builder.value("metered", 2),
                                                   levels = builder.value("levels", bins);
                                  const PassImage picture = builder.source();
                                  builder.add_compute({.name = "clear",
                                                       .shader = "meter_clear.glsl",
                                                       .inputs = {},
                                                       .buffers = {{"meter_counts", counts, Access::Write}},
                                                       .workgroup = {64, 1},
                                                       .groups = {bins / 64, 1}});
                                  builder.add_compute({.name = "count",
                                                       .shader = "meter_count.glsl",
                                                       .inputs = {{.name = "meter_in", .image = picture}},
                                                       .buffers = {{"meter_counts", counts, Access::ReadWrite}},
                                                       .workgroup = {16, 8},
                                                       .shared_bytes = 4 * bins});
                                  builder.add_compute({.name = "sum",
                                                       .shader = "meter_sum.glsl",
                                                       .inputs = {},
                                                       .buffers = {{"meter_counts", counts},
                                                                   {"meter_value", value, Access::ReadWrite, "float"},
                                                                   {"meter_levels", levels, Access::Write, "float"}},
                                                       .workgroup = {1, 1},
                                                       .groups = {1, 1}});
                              }};
const EffectInfo lift_effect{
    .name = "lift",
    .doc = "Shows the value.",
    .parameters = lift_rows.table(),
    .files = lift_files,
    .build = [](PassBuilder& builder) { builder.value_side("lift_metered", builder.find_value("metered")); }};

/// Of the part of the picture that begins at (x, y).
std::vector<float> expected_levels(const ReferenceImage& picture, VkRect2D part) {
    std::vector<float> counts(bins, 0.0F);
    for (std::uint32_t y = 0; y < part.extent.height; ++y)
        for (std::uint32_t x = 0; x < part.extent.width; ++x) {
            const double red =
                picture.at(static_cast<std::uint32_t>(part.offset.x) + x, static_cast<std::uint32_t>(part.offset.y) + y)
                    .r;
            ++counts[static_cast<std::size_t>(std::clamp(static_cast<float>(red) * 256.0F, 0.0F, 255.0F))];
        }
    return counts;
}
double expected_sum(const ReferenceImage& picture) {
    double sum = 0;
    const std::vector<float> counts = expected_levels(picture, {{}, {picture.width, picture.height}});
    for (std::size_t i = 0; i < counts.size(); ++i) sum += static_cast<double>(i) * double{counts[i]};
    return sum;
}

class ComposeCompute : public test::StackTest {};

}  // namespace

TEST_F(ComposeCompute, AValueOfAnExactHistogramReachesAPointwiseEffect) {
    const ReferenceImage picture = test::round_to_float(test::random_display(53, 37, 9));
    const test::Host host(picture);
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        Composer composer(host.device);
        composer.add(meter_effect, nullptr);
        composer.add(lift_effect, nullptr);
        CompileDesc desc = host.compile_desc();
        desc.kernels = stage;
        const auto plan = composer.compile(desc);
        ASSERT_TRUE(plan) << plan.error().text;
        EXPECT_EQ(plan->passes.size(), 4u);
        Frame frame = host.frame();
        frame.delta_time = 0.1;
        for (int i = 1; i <= 3; ++i) {
            test::must(host.record(composer, frame));
            const Rgba pixel = host.read_target().at(7, 5);
            EXPECT_EQ(pixel.r, expected_sum(picture));
            EXPECT_EQ(pixel.g, i) << "what the last frame left";
        }
        frame.camera.is_cut = true;
        test::must(host.record(composer, frame));
        EXPECT_EQ(host.read_target().at(7, 5).g, 1) << "a cut resets it";
    }
}

TEST_F(ComposeCompute, AValueStaysWhileItsProducerIsOff) {
    const ReferenceImage picture = test::round_to_float(test::random_display(20, 11, 10));
    const test::Host host(picture);
    Composer composer(host.device);
    const Handle meter = composer.add(meter_effect, nullptr);
    composer.add(lift_effect, nullptr);
    test::must(composer.compile(host.compile_desc()));
    Frame frame = host.frame();
    frame.delta_time = 0.1;
    test::must(host.record(composer, frame));
    test::must(composer.set_enabled(meter, false));
    for (int i = 0; i < 2; ++i) {
        test::must(host.record(composer, frame));
        EXPECT_EQ(host.read_target().at(2, 3).r, expected_sum(picture));
        EXPECT_EQ(host.read_target().at(2, 3).g, 1);
    }
    test::must(composer.set_enabled(meter, true));
    test::must(host.record(composer, frame));
    EXPECT_EQ(host.read_target().at(2, 3).g, 2);
}

TEST_F(ComposeCompute, AHistogramIsExactAtEverySizeAndInEveryRegion) {
    constexpr std::array<VkExtent2D, 6> extents{{{1, 1}, {3, 2}, {129, 1}, {53, 37}, {251, 127}, {256, 144}}};
    for (const VkExtent2D extent : extents) {
        const ReferenceImage picture =
            test::round_to_float(test::random_display(extent.width, extent.height, extent.width));
        const test::Host host(picture);
        Composer composer(host.device, {.frames_in_flight = 1});
        composer.add(meter_effect, nullptr);
        test::must(composer.compile(host.compile_desc()));
        Frame frame = host.frame();
        VkRect2D last{};
        // Regions at odd places, of every extent down to one texel: dynamic resolution, too.
        for (std::uint32_t i = 0; i < 8; ++i) {
            const std::uint32_t x = std::min(3 * i, extent.width - 1), y = std::min(5 * i, extent.height - 1);
            const VkRect2D part{
                {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
                {std::max(1u, (extent.width - x) / (i % 3 + 1)), std::max(1u, (extent.height - y) / (i % 2 + 1))}};
            frame.color.region = frame.target.region = part;
            test::must(host.record(composer, frame));
            if (i > 0) {
                const auto counts = composer.value("levels").numbers;
                EXPECT_EQ(std::vector<float>(counts.begin(), counts.end()), expected_levels(picture, last))
                    << extent.width << "x" << extent.height << " region " << i - 1;
            }
            last = part;
        }
    }
}

TEST_F(ComposeCompute, TheHostReadsAValueOfAnEarlierFrame) {
    const ReferenceImage picture = test::round_to_float(test::random_display(41, 29, 11));
    const test::Host host(picture);
    Composer composer(host.device, {.frames_in_flight = 2});
    const Handle meter = composer.add(meter_effect, nullptr);
    CompileDesc desc = host.compile_desc();
    desc.views = 2;
    test::must(composer.compile(desc));
    Frame frame = host.frame();
    frame.delta_time = 0.1;
    EXPECT_TRUE(composer.value("metered").numbers.empty());
    // Four recordings may be unfinished: the fifth finds what the first one left.
    for (std::uint64_t i = 0; i < 12; ++i) {
        frame.frame_index = 100 + i;
        frame.view = static_cast<std::uint32_t>(i % 2);
        test::must(composer.set(meter, "scale", static_cast<double>(1 + i)));
        test::must(host.record(composer, frame));
        const ValueReading reading = composer.value("metered", frame.view),
                           other = composer.value("metered", 1 - frame.view);
        if (i < 4) {
            EXPECT_TRUE(reading.numbers.empty());
            continue;
        }
        ASSERT_EQ(reading.numbers.size(), 2u);
        EXPECT_EQ(reading.frame_index, 100 + i - 4);
        EXPECT_EQ(reading.numbers[0], expected_sum(picture) * static_cast<double>(i - 3));
        EXPECT_EQ(reading.numbers[1], static_cast<float>((i - 4) / 2 + 1)) << "each view has its own";
        EXPECT_EQ(other.numbers.empty(), i == 4);
    }
    EXPECT_TRUE(composer.value("unknown").numbers.empty());
    EXPECT_TRUE(composer.value("metered", 2).numbers.empty());
    // What is not submitted is not read.
    test::must(host.record(composer, frame));
    const std::uint64_t before = composer.value("metered", 1).frame_index;
    test::must(composer.abandon());
    frame.frame_index = 500;
    for (int i = 0; i < 3; ++i) test::must(host.record(composer, frame));
    EXPECT_GE(composer.value("metered", 1).frame_index, before);
}

TEST_F(ComposeCompute, AValueIsReadByKernelsOfPasses) {
    static constexpr std::array<EffectFile, 2> files{
        {{"show_pass.glsl", "vec4 shade(Pixel pixel) { return vec4(show_metered[0], show_metered[1], 0.0, 1.0); }\n"},
         {"show.glsl", ""}}};
    static const EffectInfo show{
        .name = "show",
        .doc = "Shows the value by a pass.",
        .parameters = lift_rows.table(),
        .files = files,
        .touch = Touch::Neighbourhood,
        .build = [](PassBuilder& builder) {
            builder.result(
                builder.add({.name = "pass",
                             .shader = "show_pass.glsl",
                             .inputs = {},
                             .output = builder.create({.name = "shown", .format = VK_FORMAT_R32G32B32A32_SFLOAT}),
                             .values = {{"show_metered", builder.find_value("metered")}}}));
        }};
    const ReferenceImage picture = test::round_to_float(test::random_display(20, 11, 12));
    const test::Host host(picture);
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        Composer composer(host.device);
        composer.add(meter_effect, nullptr);
        composer.add(show, nullptr);
        CompileDesc desc = host.compile_desc();
        desc.kernels = stage;
        test::must(composer.compile(desc));
        test::must(host.record(composer, host.frame()));
        EXPECT_EQ(host.read_target().at(3, 4).r, expected_sum(picture));
        EXPECT_EQ(host.read_target().at(3, 4).g, 1);
    }
    Composer composer(host.device);
    composer.add(show, nullptr);
    const auto plan = composer.compile(host.compile_desc());
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().text, "effect 'show': pass 'pass' reads 'show_metered', which is not a value");
}

TEST_F(ComposeCompute, AValueGoesOnAcrossEditsThatKeepItsEntry) {
    const ReferenceImage picture = test::round_to_float(test::random_display(20, 11, 13));
    const test::Host host(picture);
    Composer composer(host.device);
    const Handle meter = composer.add(meter_effect, nullptr);
    composer.add(lift_effect, nullptr);
    test::must(composer.compile(host.compile_desc()));
    Frame frame = host.frame();
    frame.delta_time = 0.1;
    test::must(host.record(composer, frame));
    // In front of it one with values of its own, and a kernel of many steps between.
    test::must(composer.insert(meter, meter_effect, nullptr));
    for (int i = 0; i < 3; ++i) test::must(composer.insert(meter, *find_effect("exposure"), nullptr));
    test::must(composer.compile(host.compile_desc()));
    test::must(host.record(composer, frame));
    EXPECT_EQ(host.read_target().at(2, 3).g, 2) << "of the entry that stayed";
}

TEST_F(ComposeCompute, SaysWhatItMayNotAsk) {
    const test::Host host(test::uniform(16, 8, {}));
    static const EffectInfo greedy{.name = "meter",
                                   .doc = "Asks too much.",
                                   .parameters = meter_rows.table(),
                                   .files = meter_files,
                                   .build = [](PassBuilder& builder) {
                                       builder.add_compute({.name = "count",
                                                            .shader = "meter_count.glsl",
                                                            .inputs = {{.name = "meter_in", .image = builder.source()}},
                                                            .workgroup = {16, 8},
                                                            .shared_bytes = 1u << 30});
                                   }};
    Composer composer(host.device);
    composer.add(greedy, nullptr);
    const auto plan = composer.compile(host.compile_desc());
    ASSERT_FALSE(plan);
    EXPECT_TRUE(
        plan.error().text.starts_with("effect 'meter': pass 'count': 1073741824 bytes of shared memory; at most "))
        << plan.error().text;
}

}  // namespace darkroom
