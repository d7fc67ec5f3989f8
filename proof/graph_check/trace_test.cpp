// SPDX-License-Identifier: MIT
// Whole traces of small graphs. No device: sizes and memory are invented.
#include <gtest/gtest.h>

#include <array>

#include "graph/test_graphs.hpp"

namespace darkroom::graph::test {
namespace {

/// Compiles, derives one frame, lets the checker look at it, and returns the trace.
std::string trace_of(const Graph& graph, std::span<const bool> gates, std::span<const ImportState> imports,
                     std::uint64_t frame = 0) {
    const auto compiled = graph.compile(full_hd, measure);
    if (!compiled) return compiled.error().text;
    Schedule schedule(*compiled);
    schedule.derive(gates, imports, frame);
    const auto checked = check(*compiled, schedule, imports);
    EXPECT_TRUE(checked) << checked.error().text;
    return trace(*compiled, schedule);
}

Version depth_image(Graph& graph) {
    return graph.import(
        {.image = {.name = "depth", .format = VK_FORMAT_D32_SFLOAT_S8_UINT}, .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
}
/// Just written by the tests of the host's last pass; to stay where it is.
ImportState depth_state(VkImageLayout layout) {
    return {
        .layout = layout,
        .stages = VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
        .access = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
    };
}

}  // namespace

TEST(GraphTrace, OnePassFromHostToHost) {
    Graph graph;
    const Version color = host_image(graph, "color");
    const Version target = host_image(graph, "target");
    graph.keep(graph.add(
        {.name = "copy", .reads = {{color, Use::SampledCompute}}, .writes = {{target, Use::StorageWrite}}})[0]);
    const std::array imports{host_state(VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL),
                             host_state(VK_IMAGE_LAYOUT_UNDEFINED)};
    EXPECT_EQ(trace_of(graph, {}, imports),
              "barrier color: color-output:color-write -> compute:sample, color -> read-only\n"
              "barrier target: color-output:color-write -> compute:store, undefined -> general\n"
              "pass copy\n"
              "final color: compute:sample -> fragment:sample\n"
              "final target: compute:store -> fragment:sample, general -> read-only\n");
}

TEST(GraphTrace, SecondReaderOfTheSameStageNeedsNoBarrier) {
    Graph graph;
    const Version middle = graph.create(image("middle"));
    const Version written = graph.add({.name = "write", .writes = {{middle, Use::StorageWrite}}})[0];
    graph.add({.name = "first", .reads = {{written, Use::SampledCompute}}, .has_side_effect = true});
    graph.add({.name = "second", .reads = {{written, Use::SampledCompute}}, .has_side_effect = true});
    const Version late = graph.add({.name = "copy",
                                    .reads = {{written, Use::SampledCompute}},
                                    .writes = {{graph.create(image("late")), Use::StorageWrite}}})[0];
    graph.add({.name = "other stage",
               .reads = {{written, Use::SampledFragment}, {late, Use::SampledFragment}},
               .has_side_effect = true});
    graph.add({.name = "other layout", .reads = {{written, Use::StorageRead}}, .has_side_effect = true});
    EXPECT_EQ(trace_of(graph, {}, {}),
              "barrier middle: compute|fragment:store -> compute:store, undefined -> general\n"
              "pass write\n"
              "barrier middle: compute:store -> compute:sample, general -> read-only\n"
              "barrier late: compute|fragment:store -> compute:store, undefined -> general\n"
              "pass first\n"
              "pass second\n"
              "pass copy\n"
              "barrier middle: compute -> fragment:sample\n"
              "barrier late: compute:store -> fragment:sample, general -> read-only\n"
              "pass other stage\n"
              "barrier middle: compute|fragment:sample -> compute:load, read-only -> general\n"
              "pass other layout\n");
}

TEST(GraphTrace, WriteAfterReadWaitsWithoutFlush) {
    Graph graph;
    const Version middle = graph.create(image("middle"));
    const Version first = graph.add({.name = "write", .writes = {{middle, Use::StorageWrite}}})[0];
    graph.add({.name = "read", .reads = {{first, Use::StorageRead}}, .has_side_effect = true});
    const Version second = graph.add({.name = "again", .writes = {{first, Use::StorageWrite}}})[0];
    graph.add({.name = "end", .reads = {{second, Use::StorageRead}}, .has_side_effect = true});
    EXPECT_EQ(trace_of(graph, {}, {}),
              "barrier middle: compute:store -> compute:store, undefined -> general\n"
              "pass write\n"
              "barrier middle: compute:store -> compute:load\n"
              "pass read\n"
              "barrier middle: compute:load -> compute:store\n"
              "pass again\n"
              "barrier middle: compute:store -> compute:load\n"
              "pass end\n");
}

TEST(GraphTrace, PyramidMovesOneLevelAtATime) {
    Graph graph;
    Version pyramid = graph.create(image("pyramid", 3));
    pyramid = graph.add({.name = "bright", .writes = {{pyramid, Use::StorageWrite, {0, 1}}}})[0];
    for (std::uint32_t level = 1; level < 3; ++level) {
        pyramid = graph.add({.name = "down" + std::to_string(level),
                             .reads = {{pyramid, Use::SampledCompute, {level - 1, 1}}},
                             .writes = {{pyramid, Use::StorageWrite, {level, 1}}}})[0];
    }
    graph.add({.name = "composite", .reads = {{pyramid, Use::SampledCompute}}, .has_side_effect = true});
    EXPECT_EQ(trace_of(graph, {}, {}),
              "barrier pyramid mip 0: compute:store -> compute:store, undefined -> general\n"
              "pass bright\n"
              "barrier pyramid mip 0: compute:store -> compute:sample, general -> read-only\n"
              "barrier pyramid mip 1: compute:store -> compute:store, undefined -> general\n"
              "pass down1\n"
              "barrier pyramid mip 1: compute:store -> compute:sample, general -> read-only\n"
              "barrier pyramid mip 2: compute:store -> compute:store, undefined -> general\n"
              "pass down2\n"
              "barrier pyramid mip 2: compute:store -> compute:sample, general -> read-only\n"
              "pass composite\n");
}

TEST(GraphTrace, NeighbouringLevelsShareABarrier) {
    Graph graph;
    const Version pyramid = graph.create(image("pyramid", 4));
    const Version lower = graph.add({.name = "lower", .writes = {{pyramid, Use::StorageWrite, {1, 3}}}})[0];
    graph.add({.name = "read", .reads = {{lower, Use::SampledCompute, {1, 3}}}, .has_side_effect = true});
    EXPECT_EQ(trace_of(graph, {}, {}),
              "barrier pyramid mips 1-3: compute:store -> compute:store, undefined -> general\n"
              "pass lower\n"
              "barrier pyramid mips 1-3: compute:store -> compute:sample, general -> read-only\n"
              "pass read\n");
}

TEST(GraphTrace, PassThatIsOffIsReplacedByItsInput) {
    Graph graph;
    const Version color = host_image(graph, "color");
    const Version side = graph.create(image("side"));
    const Version blurred = graph.create(image("blurred"));
    // Only the gated pass needs this one, so it goes with it.
    const Version prepared = graph.add({.name = "prepare", .writes = {{side, Use::ColorWrite}}})[0];
    const Version blur = graph.add({.name = "blur",
                                    .reads = {{color, Use::SampledCompute}, {prepared, Use::SampledCompute}},
                                    .writes = {{blurred, Use::StorageWrite}},
                                    .gate = 0})[0];
    graph.fall_back(blur, color);
    graph.add({.name = "show", .reads = {{blur, Use::SampledFragment}}, .has_side_effect = true});
    const std::array imports{ImportState{.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                         .stages = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                         .access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT}};
    EXPECT_EQ(trace_of(graph, std::array{false}, imports),
              "barrier color: fragment -> fragment:sample\n"
              "pass show\n"
              "final color: fragment:sample -> all:read|write\n");
    EXPECT_EQ(trace_of(graph, std::array{true}, imports),
              "barrier side: compute|color-output:color-write -> color-output:color-write, undefined -> color\n"
              "pass prepare\n"
              "barrier color: fragment -> compute:sample\n"
              "barrier side: color-output:color-write -> compute:sample, color -> read-only\n"
              "barrier blurred: compute|fragment:store -> compute:store, undefined -> general\n"
              "pass blur\n"
              "barrier blurred: compute:store -> fragment:sample, general -> read-only\n"
              "pass show\n"
              "final color: compute:sample -> all:read|write\n");
}

TEST(GraphTrace, BlendThatIsOffLeavesTheOlderContent) {
    Graph graph;
    const Version target = host_image(graph, "target");
    const Version filled = graph.add({.name = "fill", .writes = {{target, Use::ColorWrite}}})[0];
    graph.keep(graph.add({.name = "overlay", .writes = {{filled, Use::ColorBlend}}, .gate = 0})[0]);
    const std::array imports{host_state(VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL)};
    EXPECT_EQ(trace_of(graph, std::array{true}, imports),
              "barrier target: color-output:color-write -> color-output:color-write\n"
              "pass fill\n"
              "barrier target: color-output:color-write -> color-output:color-read|color-write\n"
              "pass overlay\n"
              "final target: color-output:color-write -> fragment:sample, color -> read-only\n");
    EXPECT_EQ(trace_of(graph, std::array{false}, imports),
              "barrier target: color-output:color-write -> color-output:color-write\n"
              "pass fill\n"
              "final target: color-output:color-write -> fragment:sample, color -> read-only\n");
}

TEST(GraphTrace, HistoryChangesSlotsEveryFrame) {
    Graph graph;
    const Version color = host_image(graph, "color");
    const Graph::History history = graph.history(image("history"));
    const Version current = graph.add({.name = "accumulate",
                                       .reads = {{color, Use::SampledCompute}, {history.previous, Use::SampledCompute}},
                                       .writes = {{history.current, Use::StorageWrite}}})[0];
    graph.add({.name = "show", .reads = {{current, Use::SampledCompute}}, .has_side_effect = true});
    const std::array imports{ImportState{.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, .stages = 0, .access = 0}};
    EXPECT_EQ(trace_of(graph, {}, imports, 0),
              "barrier history#0: compute:store -> compute:store, undefined -> general\n"
              "pass accumulate\n"
              "barrier history#0: compute:store -> compute:sample, general -> read-only\n"
              "pass show\n"
              "final color: compute:sample -> all:read|write\n");
    EXPECT_EQ(trace_of(graph, {}, imports, 1),
              "barrier history#1: compute:store -> compute:store, undefined -> general\n"
              "pass accumulate\n"
              "barrier history#1: compute:store -> compute:sample, general -> read-only\n"
              "pass show\n"
              "final color: compute:sample -> all:read|write\n");
}

TEST(GraphTrace, HistoryWriterIsKeptByTheReaderOfThePreviousFrame) {
    Graph graph;
    const Graph::History history = graph.history(image("average"));
    graph.add({.name = "show", .reads = {{history.previous, Use::SampledFragment}}, .has_side_effect = true});
    graph.add({.name = "measure", .writes = {{history.current, Use::StorageWrite}}});
    EXPECT_EQ(trace_of(graph, {}, {}, 0),
              "pass show\n"
              "barrier average#0: compute|fragment:store -> compute:store, undefined -> general\n"
              "pass measure\n"
              "final average#0: compute:store -> compute|fragment:sample, general -> read-only\n");
}

TEST(GraphTrace, HistoryMovesAfterTheReadersOfTheLastFrame) {
    Graph graph;
    const Graph::History history = graph.history(image("history"));
    graph.add({.name = "first", .reads = {{history.previous, Use::SampledFragment}}, .has_side_effect = true});
    graph.add({.name = "second", .reads = {{history.previous, Use::SampledCompute}}, .has_side_effect = true});
    const Version current = graph.add({.name = "write", .writes = {{history.current, Use::ColorWrite}}})[0];
    // Both stages see the content, so the frame ends without a barrier.
    graph.add({.name = "third", .reads = {{current, Use::SampledFragment}}, .has_side_effect = true});
    graph.add({.name = "fourth", .reads = {{current, Use::SampledCompute}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled) << compiled.error().text;
    std::array<Schedule, 3> schedules{Schedule(*compiled), Schedule(*compiled), Schedule(*compiled)};
    std::vector<Recording> recordings;
    for (std::uint64_t frame = 0; frame < schedules.size(); ++frame) {
        schedules[frame].derive({}, {}, frame);
        recordings.push_back(schedules[frame].recording());
    }
    const auto checked = check_frames(*compiled, recordings, {});
    EXPECT_TRUE(checked) << checked.error().text;
}

TEST(GraphTrace, UnusedImportStillGoesToItsFinalLayoutStagesAndAccess) {
    Graph graph;
    host_image(graph, "moved");
    host_image(graph, "stays");
    const std::array imports{host_state(VK_IMAGE_LAYOUT_GENERAL), host_state(VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)};
    EXPECT_EQ(trace_of(graph, {}, imports),
              "final moved: color-output:color-write -> fragment:sample, general -> read-only\n"
              "final stays: color-output:color-write -> fragment:sample\n");
}

TEST(GraphTrace, DepthIsSampledWhereTheHostHasIt) {
    constexpr std::array layouts{VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                                 VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL,
                                 VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL,
                                 VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL};
    for (const VkImageLayout layout : layouts) {
        SCOPED_TRACE(static_cast<int>(layout));
        Graph graph;
        const Version depth = depth_image(graph);
        graph.add({.name = "fog", .reads = {{depth, Use::SampledCompute}}, .has_side_effect = true});
        graph.add({.name = "show", .reads = {{depth, Use::SampledFragment}}, .has_side_effect = true});
        std::array imports{depth_state(layout)};
        EXPECT_EQ(trace_of(graph, {}, imports),
                  "barrier depth: depth-tests:depth-write -> compute|fragment:sample\n"
                  "pass fog\n"
                  "pass show\n"
                  "final depth: compute|fragment:sample -> all:read|write\n");
        imports[0].final_layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        const auto compiled = graph.compile(full_hd, measure);
        ASSERT_TRUE(compiled);
        Schedule schedule(*compiled);
        schedule.derive({}, imports, 0);
        EXPECT_EQ(schedule.read_layout(0), layout);
        ASSERT_EQ(schedule.final_barriers().size(), 1u);
        EXPECT_EQ(schedule.final_barriers()[0].old_layout, layout);
        EXPECT_TRUE(check(*compiled, schedule, imports));
    }
}

TEST(GraphTrace, DepthMovesFromWhereItCannotBeSampled) {
    Graph graph;
    graph.add({.name = "fog", .reads = {{depth_image(graph), Use::SampledCompute}}, .has_side_effect = true});
    EXPECT_EQ(trace_of(graph, {}, std::array{depth_state(VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL)}),
              "barrier depth: depth-tests:depth-write -> compute:sample, depth -> read-only\n"
              "pass fog\n"
              "final depth: compute:sample -> all:read|write\n");
}

TEST(GraphTrace, ImageThatIsAlsoLoadedOrWrittenMoves) {
    Graph graph;
    const Version color = host_image(graph, "color"), other = host_image(graph, "other");
    graph.add({.name = "sample",
               .reads = {{color, Use::SampledCompute}, {other, Use::SampledCompute}},
               .has_side_effect = true});
    graph.add({.name = "load", .reads = {{color, Use::StorageRead}}, .has_side_effect = true, .gate = 0});
    graph.keep(graph.add({.name = "write", .writes = {{other, Use::StorageReadWrite}}, .gate = 1})[0]);
    const std::array imports{ImportState{.layout = VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL, .stages = 0, .access = 0},
                             ImportState{.layout = VK_IMAGE_LAYOUT_GENERAL, .stages = 0, .access = 0}};
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled) << compiled.error().text;
    Schedule schedule(*compiled);
    const auto layouts = [&](bool is_loaded, bool is_written) {
        schedule.derive(std::array{is_loaded, is_written}, imports, 0);
        const auto checked = check(*compiled, schedule, imports);
        EXPECT_TRUE(checked) << checked.error().text;
        return std::pair(schedule.read_layout(0), schedule.read_layout(1));
    };
    constexpr VkImageLayout moved = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    EXPECT_EQ(layouts(false, false), std::pair(VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL));
    EXPECT_EQ(layouts(true, false), std::pair(moved, VK_IMAGE_LAYOUT_GENERAL));
    EXPECT_EQ(layouts(false, true), std::pair(VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL, moved));
}

TEST(GraphTrace, ImageInGeneralIsLoadedAndSampledThere) {
    Graph graph;
    const Version color = host_image(graph, "color");
    graph.add({.name = "sample", .reads = {{color, Use::SampledCompute}}, .has_side_effect = true});
    graph.add({.name = "load", .reads = {{color, Use::StorageRead}}, .has_side_effect = true});
    EXPECT_EQ(trace_of(graph, {}, std::array{ImportState{.layout = VK_IMAGE_LAYOUT_GENERAL, .stages = 0, .access = 0}}),
              "pass sample\n"
              "pass load\n"
              "final color: compute:sample|load -> all:read|write\n");
}

TEST(GraphTrace, StencilStaysWhereTheHostKeepsItApart) {
    Graph graph;
    graph.add({.name = "fog", .reads = {{depth_image(graph), Use::SampledCompute}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    Schedule schedule(*compiled);
    const auto is_depth_alone = [&](VkImageLayout before, VkImageLayout after) {
        std::array imports{depth_state(before)};
        imports[0].final_layout = after;
        schedule.derive({}, imports, 0);
        EXPECT_EQ(schedule.barriers()[0].is_depth_alone, schedule.final_barriers()[0].is_depth_alone);
        return schedule.barriers()[0].is_depth_alone;
    };
    constexpr VkImageLayout together = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    EXPECT_FALSE(is_depth_alone(together, together));
    EXPECT_TRUE(is_depth_alone(VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL));
    EXPECT_TRUE(is_depth_alone(VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL));
    EXPECT_TRUE(is_depth_alone(VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL));
}

TEST(GraphTrace, ConstantsNeedNoBarrier) {
    Graph graph;
    const Version black = constant(graph, "black");
    graph.add({.name = "show", .reads = {{black, Use::SampledFragment}}, .has_side_effect = true});
    EXPECT_EQ(trace_of(graph, {}, {}), "pass show\n");
}

}  // namespace darkroom::graph::test
