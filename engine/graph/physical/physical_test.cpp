// SPDX-License-Identifier: MIT
// The images of a graph on a real device, under the validation layer: aliased transients, a history, lent images.
#include "graph/physical/physical.hpp"

#include <gtest/gtest.h>

#include "core/test_support_allocations.hpp"
#include "graph/physical/test_physical.hpp"

namespace darkroom::graph::test {
namespace {

constexpr VkExtent2D own_extent{16, 8};

/// fill -> t0 -> t1 -> t2 -> the host's target, and the history is one frame behind: `value` goes in, "previous" goes
/// to the second target.
struct Fixture {
    gpu::Context& context = gpu::test::context();
    std::vector<Version> transients;
    Version current;
    HistoryPool pool;
    Runner runner{own_extent, 2, pool, [this](Graph& graph) { declare(graph); }};
    Physical& physical = runner.physical;
    gpu::test::Picture result = gpu::test::blank(context, own_extent, float_format);
    gpu::test::Picture delayed = gpu::test::blank(context, own_extent, float_format);

    void declare(Graph& graph) {
        const Version target = graph.import({.image = float_image("target"), .usage = any_usage});
        const Version delayed_target = graph.import({.image = float_image("delayed"), .usage = any_usage});
        const Graph::History history = graph.history(float_image("history"));
        for (int i = 0; i < 3; ++i) {
            PassDesc pass{.name = fmt::format("pass{}", i),
                          .writes = {{graph.create(float_image(fmt::format("t{}", i))), Use::StorageWrite}}};
            if (i > 0) pass.reads = {{transients.back(), Use::SampledCompute}};
            transients.push_back(graph.add(pass)[0]);
        }
        const auto copy = [&](std::string name, Version from, Version to) {
            return graph.add({.name = std::move(name),
                              .reads = {{from, Use::SampledCompute}},
                              .writes = {{to, Use::StorageWrite}}})[0];
        };
        current = copy("remember", transients.back(), history.current);
        graph.keep(copy("show", transients.back(), target));
        graph.keep(copy("show delayed", history.previous, delayed_target));
    }

    /// Returns what the two targets hold after the frame.
    std::array<float, 2> frame(std::uint32_t view, float value) {
        runner.frame(std::array{&result, &delayed}, view, own_extent, value);
        return {gpu::test::download(context, result).at(3, 3)[0], gpu::test::download(context, delayed).at(3, 3)[0]};
    }
};

gpu::test::Picture cleared_depth(float value, VkImageLayout layout) {
    gpu::Context& context = gpu::test::context();
    gpu::test::Picture depth{
        .image = gpu::test::must(gpu::Image::create(
            context, {.name = "depth",
                      .format = VK_FORMAT_D32_SFLOAT,
                      .extent = {own_extent.width, own_extent.height, 1},
                      .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                               VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT})),
        .layout = layout};
    gpu::test::must(gpu::submit_and_wait(context, "clearing a test depth", [&](VkCommandBuffer commands) {
        constexpr VkImageLayout cleared = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        const VkClearDepthStencilValue clear{.depth = value};
        const VkImageSubresourceRange range{VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
        gpu::transition(context, commands, depth.image, VK_IMAGE_LAYOUT_UNDEFINED, cleared);
        context.vk.CmdClearDepthStencilImage(commands, depth.image.handle, cleared, &clear, 1, &range);
        gpu::transition(context, commands, depth.image, cleared, layout);
    }));
    return depth;
}

}  // namespace

TEST(GraphPhysical, FramesGoThroughSharedMemory) {
    Fixture fixture;
    EXPECT_LT(fixture.runner.compiled->transient_bytes(), fixture.runner.compiled->transient_bytes_unaliased());
    // Two views take turns; each has its own history, which starts at zero.
    EXPECT_EQ(fixture.frame(0, 1.0F), (std::array{1.0F, 0.0F}));
    EXPECT_EQ(fixture.frame(1, 10.0F), (std::array{10.0F, 0.0F}));
    EXPECT_EQ(fixture.frame(0, 2.0F), (std::array{2.0F, 1.0F}));
    EXPECT_EQ(fixture.frame(1, 20.0F), (std::array{20.0F, 10.0F}));
    EXPECT_EQ(fixture.frame(0, 3.0F), (std::array{3.0F, 2.0F}));
    EXPECT_EQ(fixture.frame(1, 30.0F), (std::array{30.0F, 20.0F}));
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
    fixture.runner.schedule->derive({}, {}, 0);
    const std::uint32_t slot = fixture.runner.schedule->slot_of(fixture.transients[0]);
    std::vector<Barrier> barriers(40, Barrier{.slot = slot,
                                              .mips = {0, 1},
                                              .source_access = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                              .old_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
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
    fixture.runner.schedule->derive({}, {}, 0);
    const std::uint32_t transient = fixture.runner.schedule->slot_of(fixture.transients[0]);
    EXPECT_EQ(fixture.physical.extent(transient).width, own_extent.width);
    EXPECT_EQ(fixture.physical.format(transient), float_format);
    EXPECT_EQ(fixture.physical.mip_levels(transient), 1u);
    EXPECT_EQ(fixture.physical.handle(transient, 0), fixture.physical.handle(transient, 1));
    const std::uint32_t history = fixture.runner.schedule->slot_of(fixture.current);
    EXPECT_NE(fixture.physical.handle(history, 0), fixture.physical.handle(history, 1));
    EXPECT_EQ(fixture.physical.handle(0), VK_NULL_HANDLE) << "nothing is lent yet";
    const std::array views{fixture.result.image.mip_views[0]};
    fixture.physical.bind(
        0, {.handle = fixture.result.image.handle, .view = fixture.result.image.view, .mip_views = views});
    EXPECT_EQ(fixture.physical.handle(0), fixture.result.image.handle);
    EXPECT_EQ(fixture.physical.view(0, 1), fixture.result.image.view);
    EXPECT_EQ(fixture.physical.mip_view(0, 0, 1), views[0]);

    Version half;
    Runner halved({9, 7}, 1, fixture.pool, [&](Graph& graph) {
        half = graph.add({.name = "halve",
                          .writes = {{graph.create(float_image("half", Size::fraction(2))), Use::StorageWrite}}})[0];
        graph.keep(half);
    });
    halved.schedule->derive({}, {}, 0);
    const VkExtent2D extent = halved.physical.extent(halved.schedule->slot_of(half));
    EXPECT_EQ(extent.width, 4u);
    EXPECT_EQ(extent.height, 3u);
}

TEST(GraphPhysical, DepthIsReadInTheLayoutOfTheHost) {
    gpu::Context& context = gpu::test::context();
    gpu::test::Picture target = gpu::test::blank(context, own_extent, float_format);
    HistoryPool pool;
    Runner runner(own_extent, 1, pool, [](Graph& graph) {
        const Version depth = graph.import(
            {.image = {.name = "depth", .format = VK_FORMAT_D32_SFLOAT}, .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
        const Version shown = graph.import({.image = float_image("target"), .usage = any_usage});
        graph.keep(graph.add(
            {.name = "show", .reads = {{depth, Use::SampledCompute}}, .writes = {{shown, Use::StorageWrite}}})[0]);
    });
    for (const VkImageLayout layout :
         {VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL,
          VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL}) {
        gpu::test::Picture depth = cleared_depth(0.25F, layout);
        runner.frame(std::array{&depth, &target}, 0, own_extent, 0);
        EXPECT_EQ(gpu::test::download(context, target).at(5, 5)[0], 0.25F) << layout;
        EXPECT_EQ(runner.schedule->read_layout(0) == layout,
                  layout != VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    }
}

TEST(GraphPhysical, BarriersNameTheAspectsThatTheHostMoves) {
    static VkImageAspectFlags aspects;
    Graph graph;
    (void)graph.import(
        {.image = {.name = "depth", .format = VK_FORMAT_D32_SFLOAT_S8_UINT}, .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    gpu::Context& context = gpu::test::context();
    const Compiled compiled = gpu::test::must(graph.compile(own_extent, measure_on(context)));
    Physical physical = gpu::test::must(Physical::create(context, compiled));
    physical.bind(0, {.handle = reinterpret_cast<VkImage>(std::uintptr_t{1})});
    gpu::Dispatch null{};
    null.CmdPipelineBarrier2 = [](VkCommandBuffer, const VkDependencyInfo* dependency) {
        aspects = dependency->pImageMemoryBarriers[0].subresourceRange.aspectMask;
    };
    Barrier barrier{.mips = {0, 1}, .new_layout = VK_IMAGE_LAYOUT_GENERAL};
    physical.record_barriers(VK_NULL_HANDLE, null, {&barrier, 1});
    EXPECT_EQ(aspects, VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT});
    barrier.is_depth_alone = true;
    physical.record_barriers(VK_NULL_HANDLE, null, {&barrier, 1});
    EXPECT_EQ(aspects, VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT});
}

}  // namespace darkroom::graph::test
