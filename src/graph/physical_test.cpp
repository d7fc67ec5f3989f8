// SPDX-License-Identifier: MIT
// The images of a graph on a real device, under the validation layer: aliased transients, a history, a lent image, with
// clears and copies as passes, so that pixels show what went where.
#include "graph/physical.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "core/test_support_allocations.hpp"
#include "gpu/test_run.hpp"
#include "graph/test_graphs.hpp"

namespace darkroom::graph::test {
namespace {

constexpr VkFormat float_format = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkExtent2D small_extent{16, 8};

ImageDesc float_image(std::string name) { return {.name = std::move(name), .format = float_format}; }

void clear(const gpu::Context& context, VkCommandBuffer commands, VkImage image, float value) {
    const VkClearColorValue color{.float32 = {value, value, value, value}};
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    context.vk.CmdClearColorImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &color, 1, &range);
}

void copy(const gpu::Context& context, VkCommandBuffer commands, VkImage from, VkImage to) {
    constexpr VkImageSubresourceLayers layers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageCopy region{layers, {}, layers, {}, {small_extent.width, small_extent.height, 1}};
    context.vk.CmdCopyImage(commands, from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

/// fill -> t0 -> t1 -> t2 -> the host's target, and the history is one frame behind: `value` goes in, "previous" goes
/// to the second target.
struct Fixture {
    gpu::Context& context = gpu::test::context();
    Graph graph;
    Version target, delayed_target;
    std::vector<Version> transients;
    Graph::History history;
    Version current;
    std::optional<Compiled> compiled;
    std::optional<Schedule> schedule;
    Physical physical;
    gpu::test::Picture result, delayed;

    Fixture() {
        using gpu::test::must;
        target = graph.import({.image = float_image("target"), .usage = any_usage});
        delayed_target = graph.import({.image = float_image("delayed"), .usage = any_usage});
        history = graph.history(float_image("history"));
        for (int i = 0; i < 3; ++i) {
            PassDesc pass{.name = fmt::format("pass{}", i),
                          .writes = {{graph.create(float_image(fmt::format("t{}", i))), Use::TransferWrite}}};
            if (i > 0) pass.reads = {{transients.back(), Use::TransferRead}};
            transients.push_back(graph.add(pass)[0]);
        }
        current = graph.add({.name = "remember",
                             .reads = {{transients.back(), Use::TransferRead}},
                             .writes = {{history.current, Use::TransferWrite}}})[0];
        graph.keep(graph.add({.name = "show",
                              .reads = {{transients.back(), Use::TransferRead}},
                              .writes = {{target, Use::TransferWrite}}})[0]);
        graph.keep(graph.add({.name = "show delayed",
                              .reads = {{history.previous, Use::TransferRead}},
                              .writes = {{delayed_target, Use::TransferWrite}}})[0]);
        compiled.emplace(must(graph.compile(small_extent, measure_on(context))));
        schedule.emplace(*compiled);
        physical = must(Physical::create(context, *compiled, 2));
        result = gpu::test::blank(context, small_extent, float_format);
        delayed = gpu::test::blank(context, small_extent, float_format);
    }

    void record(VkCommandBuffer commands, std::uint32_t view, float value) {
        const auto image = [&](Version version) { return physical.handle(schedule->slot_of(version), view); };
        for (const Step& step : schedule->steps()) {
            physical.record_barriers(commands, context.vk,
                                     schedule->barriers().subspan(step.first_barrier, step.barrier_count), view);
            const PassDesc& pass = compiled->passes()[step.pass];
            const VkImage written = image(compiled->made(step.pass)[0]);
            if (pass.reads.empty()) {
                clear(context, commands, written, value);
            } else {
                copy(context, commands, image(pass.reads[0].version), written);
            }
        }
        physical.record_barriers(commands, context.vk, schedule->final_barriers(), view);
    }

    /// Returns what the two targets hold after the frame.
    std::array<float, 2> frame(std::uint64_t number, std::uint32_t view, float value) {
        constexpr ImportState host{.layout = VK_IMAGE_LAYOUT_GENERAL, .final_layout = VK_IMAGE_LAYOUT_GENERAL};
        constexpr std::array imports{host, host};
        schedule->derive({}, imports, number);
        EXPECT_TRUE(check(*compiled, *schedule, imports));
        physical.bind(0,
                      {.handle = result.image.handle, .view = result.image.view, .mip_views = result.image.mip_views});
        physical.bind(1, {.handle = delayed.image.handle, .view = delayed.image.view});
        gpu::test::must(gpu::submit_and_wait(context, "a test frame", [&](VkCommandBuffer commands) {
            if (number == 0) physical.record_reset(commands, context.vk, view);
            record(commands, view, value);
        }));
        return {gpu::test::download(context, result).at(3, 3)[0], gpu::test::download(context, delayed).at(3, 3)[0]};
    }
};

}  // namespace

TEST(GraphPhysical, FramesGoThroughSharedMemory) {
    Fixture fixture;
    EXPECT_LT(fixture.compiled->transient_bytes(), fixture.compiled->transient_bytes_unaliased());
    // Two views take turns; each has its own history, which starts at zero.
    EXPECT_EQ(fixture.frame(0, 0, 1.0F), (std::array{1.0F, 0.0F}));
    EXPECT_EQ(fixture.frame(0, 1, 10.0F), (std::array{10.0F, 0.0F}));
    EXPECT_EQ(fixture.frame(1, 0, 2.0F), (std::array{2.0F, 1.0F}));
    EXPECT_EQ(fixture.frame(1, 1, 20.0F), (std::array{20.0F, 10.0F}));
    EXPECT_EQ(fixture.frame(2, 0, 3.0F), (std::array{3.0F, 2.0F}));
    EXPECT_EQ(fixture.frame(2, 1, 30.0F), (std::array{30.0F, 20.0F}));
}

TEST(GraphPhysical, RecordsInBatchesWithoutAllocation) {
    static std::uint32_t image_barriers, memory_barriers, calls;
    image_barriers = memory_barriers = calls = 0;
    Fixture fixture;
    gpu::Dispatch counting = fixture.context.vk;
    counting.CmdPipelineBarrier2 = [](VkCommandBuffer, const VkDependencyInfo* dependency) {
        ++calls;
        image_barriers += dependency->imageMemoryBarrierCount;
        memory_barriers += dependency->memoryBarrierCount;
    };
    fixture.schedule->derive({}, {}, 0);
    const std::uint32_t slot = fixture.schedule->slot_of(fixture.transients[0]);
    std::vector<Barrier> barriers(40, Barrier{.slot = slot,
                                              .mips = {0, 1},
                                              .source_access = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                              .old_layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                              .new_layout = VK_IMAGE_LAYOUT_GENERAL});
    barriers.back().old_layout = VK_IMAGE_LAYOUT_UNDEFINED;
    const std::uint64_t before = darkroom::test::allocation_count();
    fixture.physical.record_barriers(VK_NULL_HANDLE, counting, barriers);
    fixture.physical.record_barriers(VK_NULL_HANDLE, counting, {});
    EXPECT_EQ(darkroom::test::allocation_count(), before);
    EXPECT_EQ(calls, 2u);
    EXPECT_EQ(image_barriers, 40u);
    EXPECT_EQ(memory_barriers, 1u) << "the transient that begins, and only that, waits for all memory";
}

TEST(GraphPhysical, SlotsHaveWhatTheGraphAskedFor) {
    Fixture fixture;
    fixture.schedule->derive({}, {}, 0);
    const std::uint32_t transient = fixture.schedule->slot_of(fixture.transients[0]);
    EXPECT_EQ(fixture.physical.extent(transient).width, small_extent.width);
    EXPECT_EQ(fixture.physical.format(transient), float_format);
    EXPECT_EQ(fixture.physical.mip_levels(transient), 1u);
    EXPECT_EQ(fixture.physical.handle(transient, 0), fixture.physical.handle(transient, 1));
    const std::uint32_t history = fixture.schedule->slot_of(fixture.current);
    EXPECT_NE(fixture.physical.handle(history, 0), fixture.physical.handle(history, 1));
    EXPECT_EQ(fixture.physical.handle(0), VK_NULL_HANDLE) << "nothing is lent yet";
    const std::array views{fixture.result.image.mip_views[0]};
    fixture.physical.bind(
        0, {.handle = fixture.result.image.handle, .view = fixture.result.image.view, .mip_views = views});
    EXPECT_EQ(fixture.physical.handle(0), fixture.result.image.handle);
    EXPECT_EQ(fixture.physical.view(0, 1), fixture.result.image.view);
    EXPECT_EQ(fixture.physical.mip_view(0, 0, 1), views[0]);
}

}  // namespace darkroom::graph::test
