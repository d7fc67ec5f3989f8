// SPDX-License-Identifier: MIT
// Histories on a real device: shared by plans that follow each other, reset one by one, resampled when the frame's
// extent changes.
#include <gtest/gtest.h>

#include <cmath>

#include "graph/physical/test_physical.hpp"

namespace darkroom::graph::test {
namespace {

constexpr VkExtent2D small_extent{16, 8};
constexpr HistoryKey key{.owner = 7};

/// target = history = previous + value of the frame, after `delays` passes.
struct Trail {
    int delays = 0;
    ImageDesc image = float_image("trail");
    HistoryKey own_key = key;

    void operator()(Graph& graph) const {
        const Version target = graph.import({.image = float_image("target"), .usage = any_usage});
        const Graph::History history = graph.history(image, own_key);
        Version sum = graph.add({.name = "add",
                                 .reads = {{history.previous, Use::SampledCompute}},
                                 .writes = {{history.current, Use::StorageWrite}}})[0];
        for (int i = 0; i < delays; ++i) {
            sum = graph.add({.name = fmt::format("delay{}", i),
                             .reads = {{sum, Use::SampledCompute}},
                             .writes = {{graph.create(float_image(fmt::format("t{}", i))), Use::StorageWrite}}})[0];
        }
        graph.keep(graph.add(
            {.name = "show", .reads = {{sum, Use::SampledCompute}}, .writes = {{target, Use::StorageWrite}}})[0]);
    }
};

/// The same, and a pass that is off may draw over the sum.
void also_painted(Graph& graph) {
    const Version target = graph.import({.image = float_image("target"), .usage = any_usage});
    const Graph::History history = graph.history(float_image("trail"), key);
    const Version sum = graph.add({.name = "add",
                                   .reads = {{history.previous, Use::SampledCompute}},
                                   .writes = {{history.current, Use::StorageWrite}}})[0];
    const Version drawn = graph.add({.name = "paint", .writes = {{sum, Use::ColorBlend}}, .gate = 0})[0];
    graph.keep(graph.add(
        {.name = "show", .reads = {{drawn, Use::SampledCompute}}, .writes = {{target, Use::StorageWrite}}})[0]);
}

/// target = value of the frame.
void without_history(Graph& graph) {
    const Version target = graph.import({.image = float_image("target"), .usage = any_usage});
    graph.keep(graph.add({.name = "fill", .writes = {{target, Use::StorageWrite}}})[0]);
}

class GraphPhysicalHistory : public ::testing::Test {
  protected:
    /// Records a frame and returns what the target holds then.
    float frame(Runner& runner, std::uint32_t view, float value, VkExtent2D extent = small_extent) {
        runner.frame(std::array{&target_}, view, extent, value);
        return gpu::test::download(context_, target_).at(extent.width - 1, extent.height - 1)[0];
    }

    /// A frame with what has a switch off.
    float with_nothing_on(Runner& runner, float value, VkExtent2D extent = small_extent) {
        runner.frame(std::array{&target_}, 0, extent, value, std::array{false});
        return gpu::test::download(context_, target_).at(3, 3)[0];
    }

    gpu::Context& context_ = gpu::test::context();
    HistoryPool pool_;
    gpu::test::Picture target_ = gpu::test::blank(context_, small_extent, float_format);
};

}  // namespace

TEST_F(GraphPhysicalHistory, ANewerPlanGoesOnWhereTheOlderStopped) {
    Runner older(small_extent, 1, pool_, Trail{});
    EXPECT_EQ(frame(older, 0, 1), 1);
    Runner newer(small_extent, 1, pool_, Trail{.delays = 2});
    // The older plan goes on while the newer one is made.
    EXPECT_EQ(frame(older, 0, 2), 3);
    EXPECT_EQ(frame(newer, 0, 4), 7);
    EXPECT_EQ(frame(newer, 0, 8), 15);
    EXPECT_EQ(frame(newer, 0, 16), 31);
    EXPECT_EQ(frame(older, 0, 32), 63);
}

TEST_F(GraphPhysicalHistory, AnotherOwnerSizeFormatOrNumberOfLevelsStartsFromZero) {
    Runner first(small_extent, 1, pool_, Trail{});
    EXPECT_EQ(frame(first, 0, 1), 1);
    Runner other_owner(small_extent, 1, pool_, Trail{.own_key = {.owner = 8}});
    Runner other_number(small_extent, 1, pool_, Trail{.own_key = {.owner = 7, .number = 1}});
    EXPECT_EQ(frame(other_owner, 0, 2), 2);
    EXPECT_EQ(frame(other_number, 0, 3), 3);
    Runner other_size(small_extent, 1, pool_, Trail{.image = float_image("trail", {.width = 20, .height = 20})});
    EXPECT_EQ(frame(other_size, 0, 4), 4);
    const HistoryImages* const before = other_size.physical.history(0);
    EXPECT_EQ(Runner(small_extent, 1, pool_, Trail{.image = other_size.compiled->slots()[1].desc}).physical.history(0),
              before);
    ImageDesc desc = other_size.compiled->slots()[1].desc;
    desc.mip_levels = 2;
    EXPECT_NE(Runner(small_extent, 1, pool_, Trail{.image = desc}).physical.history(0), before);
    desc.mip_levels = 1;
    desc.format = VK_FORMAT_R32_SFLOAT;
    EXPECT_NE(Runner(small_extent, 1, pool_, Trail{.image = desc}).physical.history(0), before);
}

TEST_F(GraphPhysicalHistory, WithoutAnOwnerNothingIsShared) {
    Runner first(small_extent, 1, pool_, Trail{.own_key = {}});
    Runner second(small_extent, 1, pool_, Trail{.own_key = {}});
    EXPECT_EQ(frame(first, 0, 1), 1);
    EXPECT_EQ(frame(second, 0, 2), 2);
}

TEST_F(GraphPhysicalHistory, ViewsThatComeLaterLeaveTheOthersAlone) {
    Runner one(small_extent, 1, pool_, Trail{});
    EXPECT_EQ(frame(one, 0, 1), 1);
    Runner two(small_extent, 2, pool_, Trail{});
    EXPECT_EQ(frame(two, 1, 10), 10);
    EXPECT_EQ(frame(two, 0, 2), 3);
    EXPECT_EQ(frame(two, 1, 20), 30);
}

TEST_F(GraphPhysicalHistory, PausesStartFromZero) {
    Runner trail(small_extent, 1, pool_, Trail{});
    Runner pause(small_extent, 1, pool_, without_history);
    EXPECT_EQ(frame(trail, 0, 1), 1);
    EXPECT_EQ(frame(trail, 0, 2), 3);
    EXPECT_EQ(frame(pause, 0, 5), 5);
    EXPECT_EQ(frame(trail, 0, 4), 4);
    EXPECT_EQ(frame(trail, 0, 8), 12);
}

TEST_F(GraphPhysicalHistory, ThePoolHoldsNothingItself) {
    auto older = std::make_unique<Runner>(small_extent, 2, pool_, Trail{});
    EXPECT_EQ(frame(*older, 0, 1), 1);
    EXPECT_EQ(frame(*older, 1, 10), 10);
    Runner newer(small_extent, 1, pool_, Trail{});
    older.reset();
    Runner newest(small_extent, 2, pool_, Trail{});
    EXPECT_EQ(frame(newest, 0, 2), 3) << "the plan in between has it";
    EXPECT_EQ(frame(newest, 1, 20), 20) << "the second view went with the only plan that had it";
}

// The newest plan that lives is gone on from, not the newest that was made: one whose compile failed behind its
// histories has left nothing.
TEST_F(GraphPhysicalHistory, OneThatCouldNotBeMadeLeavesWhatThereIs) {
    Runner older(small_extent, 1, pool_, Trail{});
    EXPECT_EQ(frame(older, 0, 1), 1);
    {
        const Runner failed(small_extent, 1, pool_, also_painted);
        ASSERT_NE(failed.physical.history(0), older.physical.history(0));
    }
    Runner newer(small_extent, 1, pool_, also_painted);
    EXPECT_EQ(with_nothing_on(newer, 2), 3);
    Runner newest(small_extent, 1, pool_, Trail{});
    EXPECT_EQ(frame(newest, 0, 4), 7);
}

TEST_F(GraphPhysicalHistory, OneIsResetAloneTheOtherGoesOn) {
    const auto declare = [](Graph& graph) {
        const Version target = graph.import({.image = float_image("target"), .usage = any_usage});
        std::array<Version, 2> sums;
        for (std::uint32_t i = 0; i < 2; ++i) {
            const Graph::History history = graph.history(float_image(fmt::format("trail{}", i)), {7, i});
            sums[i] = graph.add({.name = fmt::format("add{}", i),
                                 .reads = {{history.previous, Use::SampledCompute}},
                                 .writes = {{history.current, Use::StorageWrite}}})[0];
        }
        graph.keep(graph.add({.name = "show",
                              .reads = {{sums[0], Use::SampledCompute}, {sums[1], Use::SampledCompute}},
                              .writes = {{target, Use::StorageWrite}}})[0]);
    };
    Runner runner(small_extent, 1, pool_, declare);
    EXPECT_EQ(frame(runner, 0, 1), 2);
    EXPECT_EQ(frame(runner, 0, 10), 22);
    runner.physical.history(1)->last_written = HistoryImages::never;
    EXPECT_EQ(frame(runner, 0, 100), 111 + 100);
    EXPECT_EQ(frame(runner, 0, 0), 111 + 100);
}

TEST_F(GraphPhysicalHistory, OneThatAFrameDidNotWriteIsZeroInTheNext) {
    const auto declare = [](Graph& graph) {
        const Version target = graph.import({.image = float_image("target"), .usage = any_usage});
        const Graph::History history = graph.history(float_image("trail"), key);
        const Version sum = graph.add({.name = "add",
                                       .reads = {{history.previous, Use::SampledCompute}},
                                       .writes = {{history.current, Use::StorageWrite}}})[0];
        const Version shown =
            graph.add({.name = "fill", .writes = {{graph.create(float_image("plain")), Use::StorageWrite}}})[0];
        const Version merged = graph.add({.name = "merge",
                                          .reads = {{sum, Use::SampledCompute}},
                                          .writes = {{graph.create(float_image("merged")), Use::StorageWrite}},
                                          .gate = 0})[0];
        graph.fall_back(merged, shown);
        graph.keep(graph.add(
            {.name = "show", .reads = {{merged, Use::SampledCompute}}, .writes = {{target, Use::StorageWrite}}})[0]);
    };
    Runner runner(small_extent, 1, pool_, declare);
    const auto shown = [&](float value, bool is_read) {
        runner.frame(std::array{&target_}, 0, small_extent, value, std::array{is_read});
        return gpu::test::download(context_, target_).at(3, 3)[0];
    };
    EXPECT_EQ(shown(1, true), 1);
    EXPECT_EQ(shown(2, true), 3);
    EXPECT_EQ(shown(4, false), 4) << "its writer is on, but nobody reads it";
    EXPECT_EQ(shown(8, true), 8);
    EXPECT_EQ(shown(16, true), 24);
}

TEST_F(GraphPhysicalHistory, APlanThatUsesItInOtherWaysGoesOn) {
    Runner older(small_extent, 1, pool_, Trail{});
    EXPECT_EQ(frame(older, 0, 1), 1);
    Runner newer(small_extent, 1, pool_, also_painted);
    ASSERT_NE(newer.physical.history(0), older.physical.history(0)) << "its images were not made to be drawn into";
    EXPECT_EQ(frame(older, 0, 2), 3);
    EXPECT_EQ(with_nothing_on(newer, 4), 7);
    newer.physical.abandon();
    EXPECT_EQ(with_nothing_on(newer, 4, {11, 5}), 7);
    EXPECT_EQ(with_nothing_on(newer, 8), 15);
    EXPECT_EQ(with_nothing_on(newer, 16), 31);
    // Taken out again: the images of the newer plan serve as well.
    Runner newest(small_extent, 1, pool_, Trail{});
    EXPECT_EQ(newest.physical.history(0), newer.physical.history(0));
    EXPECT_EQ(frame(newest, 0, 32), 63);
}

// The last pass writes all of it, so the first one runs only for who looks in between.
TEST_F(GraphPhysicalHistory, OneThatIsWrittenOnceMoreGoesOn) {
    Runner runner(small_extent, 1, pool_, [](Graph& graph) {
        const Version target = graph.import({.image = float_image("target"), .usage = any_usage});
        const Graph::History history = graph.history(float_image("trail"));
        const Version early = graph.add({.name = "early", .writes = {{history.current, Use::StorageWrite}}})[0];
        graph.add({.name = "look",
                   .reads = {{early, Use::SampledCompute}},
                   .writes = {{graph.create(float_image("seen")), Use::StorageWrite}},
                   .has_side_effect = true,
                   .gate = 0});
        const Version sum = graph.add({.name = "add",
                                       .reads = {{history.previous, Use::SampledCompute}},
                                       .writes = {{early, Use::StorageWrite}}})[0];
        graph.keep(graph.add(
            {.name = "show", .reads = {{sum, Use::SampledCompute}}, .writes = {{target, Use::StorageWrite}}})[0]);
    });
    EXPECT_EQ(with_nothing_on(runner, 1), 1);
    EXPECT_EQ(with_nothing_on(runner, 2), 3);
    EXPECT_EQ(with_nothing_on(runner, 4), 7);
}

// A level that is read, and that a switch leaves unwritten, holds what an older frame left.
TEST_F(GraphPhysicalHistory, OneOfWhichALevelIsNotWrittenStartsFromZero) {
    const auto declare = [](Graph& graph) {
        const Version target = graph.import({.image = float_image("target"), .usage = any_usage});
        ImageDesc image = float_image("trail");
        image.mip_levels = 2;
        const Graph::History history = graph.history(image);
        const Version sum = graph.add({.name = "add",
                                       .reads = {{history.previous, Use::SampledCompute, {0, 1}}},
                                       .writes = {{history.current, Use::StorageWrite, {0, 1}}}})[0];
        const Version both = graph.add({.name = "second", .writes = {{sum, Use::StorageWrite, {1, 1}}}, .gate = 0})[0];
        const Version shown =
            graph.add({.name = "merge",
                       .reads = {{both, Use::SampledCompute, {0, 1}}, {history.previous, Use::SampledCompute, {1, 1}}},
                       .writes = {{graph.create(float_image("merged")), Use::StorageWrite}}})[0];
        graph.keep(graph.add(
            {.name = "show", .reads = {{shown, Use::SampledCompute}}, .writes = {{target, Use::StorageWrite}}})[0]);
    };
    const auto compiled = [&] {
        Graph graph;
        declare(graph);
        return gpu::test::must(graph.compile(small_extent, measure_on(context_)));
    }();
    Schedule schedule(compiled);
    for (const bool is_on : {true, false}) {
        schedule.derive(std::array{is_on}, {}, 0);
        EXPECT_TRUE(schedule.reads_history(0));
        EXPECT_EQ(schedule.writes_history(0), is_on);
    }
}

TEST_F(GraphPhysicalHistory, WhatIsGivenUpOrTakenBackLeavesNoTrace) {
    Runner runner(small_extent, 1, pool_, Trail{});
    EXPECT_EQ(frame(runner, 0, 1), 1);
    for (const VkExtent2D extent : {small_extent, VkExtent2D{5, 3}}) {
        runner.physical.prepare(extent, false);
        runner.physical.prepare(extent, true);
    }
    EXPECT_EQ(frame(runner, 0, 2), 3);
    runner.physical.prepare(VkExtent2D{5, 3}, false);
    runner.schedule->derive({}, {}, runner.physical.frame());
    runner.physical.end(*runner.schedule);
    runner.physical.abandon();
    EXPECT_EQ(frame(runner, 0, 4), 7);
}

TEST_F(GraphPhysicalHistory, EachHasTwoImagesOfItsOwn) {
    const auto declare = [](Graph& graph) {
        const Version target = graph.import({.image = float_image("target"), .usage = any_usage});
        std::array<Version, 3> sums;
        for (std::uint32_t i = 0; i < 3; ++i) {
            const ImageDesc image = float_image(fmt::format("trail{}", i), Size::fraction(1U << i));
            const Graph::History history = graph.history(image, {7, i});
            sums[i] = graph.add({.name = fmt::format("add{}", i),
                                 .reads = {{history.previous, Use::SampledCompute}},
                                 .writes = {{history.current, Use::StorageWrite}}})[0];
        }
        PassDesc show{.name = "show", .writes = {{target, Use::StorageWrite}}};
        for (const Version sum : sums) show.reads.push_back({sum, Use::SampledCompute});
        graph.keep(graph.add(show)[0]);
    };
    const Runner runner(small_extent, 1, pool_, declare);
    for (std::uint32_t i = 0; i < 3; ++i)
        for (const gpu::Image& image : runner.physical.history(i)->images)
            EXPECT_EQ(image.info.extent.width, small_extent.width >> i) << i;
}

TEST_F(GraphPhysicalHistory, OnlyAnotherPlanIsWaitedForAsAWhole) {
    static std::uint32_t memory_barriers;
    memory_barriers = 0;
    Runner older(small_extent, 1, pool_, Trail{});
    Runner newer(small_extent, 1, pool_, Trail{});
    EXPECT_EQ(frame(older, 0, 1), 1);
    gpu::Dispatch counting = context_.vk;
    counting.CmdPipelineBarrier2 = [](VkCommandBuffer, const VkDependencyInfo* dependency) {
        memory_barriers += dependency->memoryBarrierCount;
        if (dependency->memoryBarrierCount == 0) return;
        EXPECT_EQ(dependency->pMemoryBarriers->srcStageMask, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
        EXPECT_EQ(dependency->pMemoryBarriers->dstStageMask, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    };
    const auto record = [&](Runner& runner) {
        runner.physical.prepare(small_extent, true);
        runner.schedule->derive({}, {}, runner.physical.frame());
        runner.physical.begin(VK_NULL_HANDLE, counting, *runner.schedule);
        runner.physical.end(*runner.schedule);
    };
    record(older);
    EXPECT_EQ(memory_barriers, 0u);
    record(newer);
    EXPECT_EQ(memory_barriers, 1u);
    record(newer);
    EXPECT_EQ(memory_barriers, 1u);
    // What was taken back may have been another plan's turn.
    newer.physical.abandon();
    record(older);
    record(newer);
    EXPECT_EQ(memory_barriers, 3u);
}

TEST_F(GraphPhysicalHistory, TrailsGoOnThroughChangesOfTheExtent) {
    Runner runner(small_extent, 1, pool_, Trail{});
    float sum = 0;
    constexpr std::array<VkExtent2D, 7> extents{{{16, 8}, {11, 5}, {7, 7}, {7, 7}, {16, 8}, {1, 1}, {13, 3}}};
    for (std::size_t i = 0; i < extents.size(); ++i) {
        sum += static_cast<float>(i + 1);
        EXPECT_EQ(frame(runner, 0, static_cast<float>(i + 1), extents[i]), sum) << "frame " << i;
    }
}

}  // namespace darkroom::graph::test
