// SPDX-License-Identifier: MIT
// What compile() makes of a declaration: sizes, culling, lifetimes, memory; and that the checker finds planted faults.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "graph/solution.hpp"
#include "graph/test_graphs.hpp"

namespace darkroom::graph::test {
namespace {

const Slot& slot_named(const Compiled& compiled, std::string_view name) {
    for (const Slot& slot : compiled.slots()) {
        if (slot.desc.name == name) return slot;
    }
    ADD_FAILURE() << "no slot is named " << name;
    return compiled.slots()[0];
}

}  // namespace

TEST(GraphSize, FractionsAreFlooredButNotBelowOne) {
    const VkExtent2D half = Size::fraction(2).of(VkExtent2D{1921, 1});
    EXPECT_EQ(half.width, 960u);
    EXPECT_EQ(half.height, 1u);
    const VkExtent2D larger = Size{.numerator = 3, .denominator = 2}.of(VkExtent2D{100, 51});
    EXPECT_EQ(larger.width, 150u);
    EXPECT_EQ(larger.height, 76u);
    const VkExtent2D fixed = Size{.width = 64, .height = 32}.of(VkExtent2D{1920, 1080});
    EXPECT_EQ(fixed.width, 64u);
    EXPECT_EQ(fixed.height, 32u);
    const VkExtent2D level = mip_extent({1921, 3}, 2);
    EXPECT_EQ(level.width, 480u);
    EXPECT_EQ(level.height, 1u);
}

TEST(GraphSize, MipRanges) {
    EXPECT_EQ(mip_mask({}, 3), 0b111u);
    EXPECT_EQ(mip_mask({1, 1}, 3), 0b010u);
    EXPECT_EQ(mip_mask({1, 9}, 3), 0b110u);
    EXPECT_EQ(mip_mask({5, 2}, 3), 0b100u) << "a fall-back with fewer levels gives its last one";
    EXPECT_EQ(mip_mask({}, 32), ~0u);
}

TEST(GraphUse, AccessAndStageBelongTogether) {
    for (std::uint8_t i = 0; i < use_count; ++i) {
        const Use use{i};
        EXPECT_EQ(is_write(use), (access_of(use) & all_writes) != 0) << int{i};
        EXPECT_NE(stages_of(use), 0u) << int{i};
        EXPECT_EQ(layout_of(use) == VK_IMAGE_LAYOUT_UNDEFINED, is_of_buffers(use)) << int{i};
        EXPECT_TRUE(is_write(use) || !keeps_content(use)) << int{i};
    }
}

TEST(GraphCompile, CullsWhatNothingReads) {
    Graph graph;
    const Version used = graph.add({.name = "used", .writes = {{graph.create(image("x")), Use::StorageWrite}}})[0];
    const Version unused = graph.add({.name = "unused", .writes = {{graph.create(image("y")), Use::StorageWrite}}})[0];
    graph.add({.name = "also unused",
               .reads = {{unused, Use::SampledCompute}},
               .writes = {{graph.create(image("z")), Use::StorageWrite}}});
    graph.add({.name = "end", .reads = {{used, Use::SampledCompute}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    EXPECT_EQ(std::vector<std::string>(compiled->culled().begin(), compiled->culled().end()),
              (std::vector<std::string>{"unused", "also unused"}));
    ASSERT_EQ(compiled->passes().size(), 2u);
    EXPECT_EQ(compiled->kept_pass_of({0}), 0u);
    EXPECT_EQ(compiled->kept_pass_of({1}), none);
    EXPECT_EQ(compiled->kept_pass_of({3}), 1u);
    EXPECT_EQ(compiled->slots().size(), 1u);
}

TEST(GraphCompile, CullsLevelsThatNothingReads) {
    Graph graph;
    Version pyramid = graph.create(image("x", 3));
    for (std::uint32_t level = 0; level < 3; ++level) {
        pyramid = graph.add({.name = std::to_string(level), .writes = {{pyramid, Use::StorageWrite, {level, 1}}}})[0];
    }
    graph.add({.name = "end", .reads = {{pyramid, Use::SampledCompute, {1, 1}}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    ASSERT_EQ(compiled->passes().size(), 2u);
    EXPECT_EQ(compiled->passes()[0].name, "1");
    Schedule schedule(*compiled);
    schedule.derive({}, {}, 0);
    EXPECT_EQ(schedule.slot_of(pyramid), 0u);
    EXPECT_TRUE(check(*compiled, schedule, {}));
}

TEST(GraphCompile, ChainNeedsTwoImagesNotFour) {
    Graph graph;
    Version last = host_image(graph, "color");
    for (int i = 0; i < 4; ++i) {
        last = graph.add({.name = std::to_string(i),
                          .reads = {{last, Use::SampledCompute}},
                          .writes = {{graph.create(image(fmt::format("t{}", i))), Use::StorageWrite}}})[0];
    }
    graph.add({.name = "end", .reads = {{last, Use::SampledCompute}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    EXPECT_EQ(compiled->transient_bytes() * 2, compiled->transient_bytes_unaliased());
    EXPECT_EQ(slot_named(*compiled, "t0").offset, slot_named(*compiled, "t2").offset);
    EXPECT_NE(slot_named(*compiled, "t0").offset, slot_named(*compiled, "t1").offset);
}

TEST(GraphCompile, FallBackLivesAsLongAsItMayBeRead) {
    Graph graph;
    const Version color = graph.add({.name = "a", .writes = {{graph.create(image("x")), Use::StorageWrite}}})[0];
    const Version graded = graph.add({.name = "b",
                                      .reads = {{color, Use::SampledCompute}},
                                      .writes = {{graph.create(image("y")), Use::StorageWrite}},
                                      .gate = 0})[0];
    graph.fall_back(graded, color);
    const Version sharp = graph.add({.name = "c",
                                     .reads = {{graded, Use::SampledCompute}},
                                     .writes = {{graph.create(image("z")), Use::StorageWrite}},
                                     .gate = 1})[0];
    graph.fall_back(sharp, graded);
    graph.add({.name = "end", .reads = {{sharp, Use::SampledFragment}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    EXPECT_EQ(slot_named(*compiled, "x").last_pass, 3u);
    EXPECT_EQ(slot_named(*compiled, "x").usage,
              VkImageUsageFlags{VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
    Schedule schedule(*compiled);
    schedule.derive(std::array{false, false}, {}, 0);
    EXPECT_EQ(schedule.slot_of(sharp), schedule.slot_of(color));
    EXPECT_FALSE(schedule.runs(1));
    schedule.derive(std::array{false, true}, {}, 0);
    EXPECT_NE(schedule.slot_of(sharp), schedule.slot_of(color));
    EXPECT_EQ(schedule.slot_of(graded), schedule.slot_of(color));
}

TEST(GraphCompile, EveryReaderGetsItsOwnFallBack) {
    for (const bool is_black_first : {true, false}) {
        SCOPED_TRACE(is_black_first);
        Graph graph;
        const Version black = constant(graph, "black"), white = constant(graph, "white");
        const Version depth = host_image(graph, "depth");
        const Version shared = graph.add({.name = "shared",
                                          .reads = {{depth, Use::SampledCompute}},
                                          .writes = {{graph.create(image("x")), Use::StorageWrite}},
                                          .gate = 0})[0];
        const Version first = is_black_first ? black : white, second = is_black_first ? white : black;
        graph.add({.name = "first", .reads = {{.version = shared, .instead = first}}, .has_side_effect = true});
        graph.add({.name = "second", .reads = {{.version = shared, .instead = second}}, .has_side_effect = true});
        const auto compiled = graph.compile(full_hd, measure);
        ASSERT_TRUE(compiled) << compiled.error().text;
        const std::array<ImportState, 3> imports{{{}, {}, host_state()}};
        Schedule schedule(*compiled);
        schedule.derive(std::array{false}, imports, 0);
        EXPECT_EQ(schedule.slot_of(shared, black), schedule.slot_of(black));
        EXPECT_EQ(schedule.slot_of(shared, white), schedule.slot_of(white));
        EXPECT_EQ(schedule.slot_of(shared), none) << "who asks for nothing gets nothing";
        EXPECT_TRUE(check(*compiled, schedule, imports));
        schedule.derive(std::array{true}, imports, 1);
        EXPECT_EQ(schedule.slot_of(shared, black), schedule.slot_of(shared));
        EXPECT_EQ(schedule.slot_of(shared, white), schedule.slot_of(shared));
        EXPECT_TRUE(check(*compiled, schedule, imports));
    }
}

TEST(GraphCompile, OwnFallBackIsMadeForItsReaderAlone) {
    Graph graph;
    const Version black = constant(graph, "black");
    const Version shared =
        graph.add({.name = "shared", .writes = {{graph.create(image("x")), Use::StorageWrite}}, .gate = 0})[0];
    const Version usual = graph.add({.name = "usual", .writes = {{graph.create(image("y")), Use::StorageWrite}}})[0];
    const Version own = graph.add({.name = "own", .writes = {{graph.create(image("z")), Use::StorageWrite}}})[0];
    graph.fall_back(shared, usual);
    graph.add({.name = "first", .reads = {{.version = shared, .instead = own}}, .has_side_effect = true, .gate = 1});
    graph.add({.name = "second", .reads = {{.version = shared, .instead = black}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled) << compiled.error().text;
    ASSERT_EQ(compiled->culled().size(), 1u) << "every reader has its own";
    EXPECT_EQ(compiled->culled()[0], "usual");
    const std::uint32_t own_pass = compiled->kept_pass_of({2});
    Schedule schedule(*compiled);
    const auto runs_own = [&](bool shared_is_on, bool first_is_on) {
        schedule.derive(std::array{shared_is_on, first_is_on}, {}, 0);
        const auto checked = check(*compiled, schedule, {});
        EXPECT_TRUE(checked) << checked.error().text;
        return schedule.runs(own_pass);
    };
    EXPECT_FALSE(runs_own(true, true));
    EXPECT_FALSE(runs_own(false, false));
    EXPECT_TRUE(runs_own(false, true));
    EXPECT_EQ(schedule.slot_of(shared, own), schedule.slot_of(own));
}

TEST(GraphCompile, OwnFallBackStandsInForAWholePyramid) {
    Graph graph;
    const Version black = constant(graph, "black");
    Version pyramid = graph.create(image("x", 3));
    for (std::uint32_t level = 0; level < 3; ++level) {
        pyramid = graph.add(
            {.name = fmt::to_string(level), .writes = {{pyramid, Use::StorageWrite, {level, 1}}}, .gate = 0})[0];
    }
    graph.add({.name = "end", .reads = {{.version = pyramid, .instead = black}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled) << compiled.error().text;
    Schedule schedule(*compiled);
    schedule.derive(std::array{false}, {}, 0);
    EXPECT_EQ(schedule.slot_of(pyramid, black), schedule.slot_of(black));
    EXPECT_TRUE(check(*compiled, schedule, {}));
}

TEST(GraphCompile, OwnFallBackLeavesOlderContentAlone) {
    Graph graph;
    const Version black = constant(graph, "black");
    const Version filled = graph.add({.name = "fill", .writes = {{graph.create(image("x")), Use::ColorWrite}}})[0];
    const Version blended = graph.add({.name = "blend", .writes = {{filled, Use::ColorBlend}}, .gate = 0})[0];
    graph.add({.name = "end", .reads = {{.version = blended, .instead = black}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled) << compiled.error().text;
    Schedule schedule(*compiled);
    schedule.derive(std::array{false}, {}, 0);
    EXPECT_EQ(schedule.slot_of(blended, black), schedule.slot_of(filled));
    EXPECT_TRUE(check(*compiled, schedule, {}));
}

TEST(GraphCompile, KeptTransientIsNotSharedAfterItsWrite) {
    Graph graph;
    const Version kept = graph.add({.name = "a", .writes = {{graph.create(image("kept")), Use::StorageWrite}}})[0];
    graph.keep(kept);
    const Version other = graph.add({.name = "b", .writes = {{graph.create(image("other")), Use::StorageWrite}}})[0];
    graph.add({.name = "end", .reads = {{other, Use::SampledCompute}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    EXPECT_NE(slot_named(*compiled, "kept").offset, slot_named(*compiled, "other").offset);
}

TEST(GraphCompile, HistoryHasTwoImagesWithTheirOwnMemory) {
    Graph graph;
    const Graph::History history = graph.history(image("h"));
    const Version current = graph.add({.name = "a",
                                       .reads = {{history.previous, Use::SampledCompute}},
                                       .writes = {{history.current, Use::StorageWrite}}})[0];
    graph.keep(current);
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    ASSERT_EQ(compiled->slots().size(), 2u);
    EXPECT_EQ(compiled->transient_bytes(), 0u);
    Schedule schedule(*compiled);
    for (std::uint64_t frame = 0; frame < 3; ++frame) {
        schedule.derive({}, {}, frame);
        EXPECT_EQ(schedule.slot_of(current), frame % 2);
        EXPECT_EQ(schedule.slot_of(history.previous), 1 - frame % 2);
        EXPECT_EQ(compiled->slots()[schedule.slot_of(current)].history_parity, frame % 2);
    }
}

TEST(GraphPack, FillsTheSmallestGapAndAligns) {
    std::array intervals{Interval{.size = 100, .alignment = 64, .first = 0, .last = 9},
                         Interval{.size = 90, .alignment = 64, .first = 0, .last = 1},
                         Interval{.size = 80, .alignment = 64, .first = 0, .last = 9},
                         Interval{.size = 50, .alignment = 64, .first = 2, .last = 3}};
    EXPECT_EQ(pack(intervals), 336u);
    EXPECT_EQ(intervals[0].offset, 0u);
    EXPECT_EQ(intervals[1].offset, 128u);
    EXPECT_EQ(intervals[2].offset, 256u);
    EXPECT_EQ(intervals[3].offset, 128u);
}

TEST(GraphCheck, FindsImagesThatShareMemoryWhileBothLive) {
    Graph graph;
    const Version a = graph.add({.name = "a", .writes = {{graph.create(image("x")), Use::StorageWrite}}})[0];
    const Version b = graph.add({.name = "b", .writes = {{graph.create(image("y")), Use::StorageWrite}}})[0];
    graph.add({.name = "end", .reads = {{a, Use::SampledCompute}, {b, Use::SampledCompute}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    auto solution = std::make_unique<Solution>(compiled->solution());
    solution->slots[1].offset = solution->slots[0].offset;
    const Compiled broken(std::move(solution));
    Schedule schedule(broken);
    schedule.derive({}, {}, 0);
    const auto result = check(broken, schedule, {});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().text, "pass 'a' uses 'x' in layout 1, but it is in 0");
}

// Of an import that no pass uses.
TEST(GraphSchedule, AnUnusedImageIsLeftAsTheHostAsks) {
    constexpr VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL, sampled = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                            undefined = VK_IMAGE_LAYOUT_UNDEFINED;
    constexpr VkPipelineStageFlags2 clear = VK_PIPELINE_STAGE_2_CLEAR_BIT, copy = VK_PIPELINE_STAGE_2_COPY_BIT,
                                    no_stage = VK_PIPELINE_STAGE_2_NONE;
    constexpr VkAccessFlags2 writes = VK_ACCESS_2_TRANSFER_WRITE_BIT, reads = VK_ACCESS_2_TRANSFER_READ_BIT;
    const auto barriers_of = [&](const ImportState& host) {
        Graph graph;
        (void)host_image(graph, "color");
        const auto compiled = graph.compile(full_hd, measure);
        EXPECT_TRUE(compiled);
        Schedule schedule(*compiled);
        schedule.derive({}, {&host, 1}, 0);
        EXPECT_TRUE(check(*compiled, schedule, {&host, 1}));
        return schedule.final_barriers().size();
    };
    EXPECT_EQ(barriers_of({general, clear, writes, general, copy, reads}), 1u);
    EXPECT_EQ(barriers_of({general, clear, writes, undefined, copy, reads}), 1u);
    EXPECT_EQ(barriers_of({general, copy, reads, sampled, copy, reads}), 1u);
    EXPECT_EQ(barriers_of({general, copy, reads, general, copy, reads}), 0u) << "two reads wait for nothing";
    EXPECT_EQ(barriers_of({general, copy, reads, general, clear, writes}), 1u);
    EXPECT_EQ(barriers_of({general, no_stage, 0, general, no_stage, 0}), 0u) << "the host does it";
    EXPECT_EQ(barriers_of({general, no_stage, 0, sampled, no_stage, 0}), 1u);
    EXPECT_EQ(barriers_of({undefined, clear, writes, undefined, copy, reads}), 0u) << "it holds nothing";
}

TEST(GraphCheck, FindsAPassThatDidNotRun) {
    Graph graph;
    const Version a = graph.add({.name = "a", .writes = {{graph.create(image("x")), Use::StorageWrite}}})[0];
    graph.add({.name = "end", .reads = {{a, Use::SampledCompute}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    Schedule schedule(*compiled);
    schedule.derive({}, {}, 0);
    Recording recording = schedule.recording();
    const std::array steps{Step{.pass = 1, .first_barrier = 0, .barrier_count = 2}};
    recording.steps = steps;
    const auto result = check_frames(*compiled, {&recording, 1}, {});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().text, "pass 'end' needs 'x' from pass 'a', which did not run");
}

TEST(GraphCheck, FindsAWriteThatDoesNotWaitForAReader) {
    Graph graph;
    const Version color = host_image(graph, "color");
    graph.add({.name = "read", .reads = {{color, Use::StorageRead}}, .has_side_effect = true});
    graph.keep(graph.add({.name = "write", .writes = {{color, Use::StorageWrite}}})[0]);
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    const ImportState host{.layout = VK_IMAGE_LAYOUT_GENERAL};
    Schedule schedule(*compiled);
    schedule.derive({}, {&host, 1}, 0);
    Recording recording = schedule.recording();
    // The first barrier lets the writer see all that was before, so nothing but the order is at fault.
    std::array barriers{recording.barriers[0]};
    barriers[0].target_access |= VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    const std::array steps{Step{.pass = 0, .first_barrier = 0, .barrier_count = 1}, Step{.pass = 1}};
    recording.barriers = barriers;
    recording.steps = steps;
    const auto result = check_frames(*compiled, {&recording, 1}, {&host, 1});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().text, "pass 'write' does not wait for what pass 'read' did to 'color'");
}

TEST(GraphCheck, FindsAnImportInAnUndefinedLayout) {
    Graph graph;
    const Version color = host_image(graph, "color");
    graph.add({.name = "end", .reads = {{color, Use::SampledCompute}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    Schedule schedule(*compiled);
    schedule.derive({}, {}, 0);
    const auto result = check(*compiled, schedule, {});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().text, "pass 'end' reads 'color', which holds nothing it may read");
}

}  // namespace darkroom::graph::test
