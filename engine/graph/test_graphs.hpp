// SPDX-License-Identifier: MIT
#pragma once
// What the tests of the frame graph share: short ways to declare, invented memory requirements, random graphs.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>

#include "graph/schedule.hpp"
#include "graph_check/check.hpp"

namespace darkroom::graph::test {

inline constexpr VkExtent2D full_hd{1920, 1080};
inline constexpr VkImageUsageFlags any_usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                               VK_IMAGE_USAGE_TRANSFER_DST_BIT;

/// Eight bytes a pixel, a third more with mip levels, aligned to 64 KiB.
inline Result<Requirements> measure(const ImageDesc& desc, VkImageUsageFlags, const Extents& frame) {
    const VkExtent2D extent = desc.size.of(frame);
    VkDeviceSize size = VkDeviceSize{8} * extent.width * extent.height;
    if (desc.mip_levels > 1) size += size / 3;
    return Requirements{.size = (size + 65535) / 65536 * 65536, .alignment = 65536};
}

inline ImageDesc image(std::string name, std::uint32_t mip_levels = 1) {
    return {.name = std::move(name), .mip_levels = mip_levels};
}
inline Version host_image(Graph& graph, std::string name) {
    return graph.import({.image = image(std::move(name)), .usage = any_usage});
}
inline Version constant(Graph& graph, std::string name) {
    return graph.import({.image = image(std::move(name)), .usage = VK_IMAGE_USAGE_SAMPLED_BIT, .is_constant = true});
}

/// The host hands its images over in `layout`, written by colour attachments, and wants them back for sampling.
inline ImportState host_state(VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL) {
    return {.layout = layout,
            .stages = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
            .access = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
            .final_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
            .final_stages = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
            .final_access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
}

inline constexpr std::uint32_t gate_count = 4;

/// A graph of up to twenty passes with gates, fall-backs of images and of readers, mip chains, histories and in-place
/// writes. Not every one
/// compiles: the caller skips those.
inline Graph random_graph(std::uint32_t seed, std::uint32_t& import_count) {
    std::mt19937 random(seed);
    const auto pick = [&random](std::size_t count) { return static_cast<std::uint32_t>(random() % count); };
    struct Live {
        Version version;
        std::uint32_t image;
        std::uint32_t mip_levels = 1;
        bool is_writable = true;
        bool is_constant = false;
    };
    Graph graph;
    std::vector<Live> live;
    std::uint32_t image_count = 0;
    const Version black = constant(graph, "black"), white = constant(graph, "white");
    live.push_back({black, image_count++, 1, false, true});
    const std::uint32_t hosts = 1 + pick(3);
    for (std::uint32_t i = 0; i < hosts; ++i) {
        live.push_back({host_image(graph, fmt::format("host{}", i)), image_count++});
    }
    import_count = hosts + 2;
    std::vector<Live> unwritten;
    if (pick(2) == 0) {
        const Graph::History history = graph.history(image("history"));
        unwritten.push_back({history.current, image_count++});
        live.push_back({history.previous, image_count++, 1, false});
    }
    // Buffers that hold something; the first is read and written across frames.
    std::vector<Version> buffers{graph.lasting_buffer("lasting", 64)};
    const std::uint32_t pass_count = 4 + pick(16);
    for (std::uint32_t i = 0; i < pass_count; ++i) {
        PassDesc pass{.name = fmt::format("pass{}", i)};
        if (pick(3) == 0) pass.gate = static_cast<std::int32_t>(pick(gate_count));
        std::vector<std::uint32_t> used_images;
        const auto is_used = [&used_images](std::uint32_t index) {
            return std::find(used_images.begin(), used_images.end(), index) != used_images.end();
        };
        for (std::uint32_t j = 0, count = 1 + pick(3); j < count; ++j) {
            const Live& source = live[pick(live.size())];
            if (is_used(source.image)) continue;
            used_images.push_back(source.image);
            constexpr Use any_reads[] = {Use::SampledCompute, Use::SampledFragment, Use::StorageRead,
                                         Use::StorageReadFragment};
            const Use use = source.is_constant || pick(2) == 0 ? any_reads[pick(2)] : any_reads[pick(4)];
            pass.reads.push_back({source.version, use, {pick(source.mip_levels), pick(2) == 0 ? 1 : ~0u}});
            if (pick(3) == 0) pass.reads.back().instead = pick(2) == 0 ? white : live[pick(live.size())].version;
        }
        std::vector<std::size_t> replaced;
        std::vector<Live> made;
        constexpr Use fresh_writes[] = {Use::StorageWrite, Use::ColorWrite};
        constexpr Use in_place_writes[] = {Use::StorageReadWrite, Use::ColorBlend, Use::StorageWrite};
        const std::uint32_t kind = pick(4);
        const std::size_t target = pick(live.size());
        if (kind == 0 && live[target].is_writable && !is_used(live[target].image)) {
            pass.writes.push_back({live[target].version, in_place_writes[pick(3)]});
            made.push_back(live[target]);
            replaced.push_back(target);
        } else if (kind == 1 && !unwritten.empty()) {
            pass.writes.push_back({unwritten.back().version, fresh_writes[pick(2)]});
            made.push_back(unwritten.back());
            unwritten.pop_back();
        } else {
            const std::uint32_t mips = pick(3) == 0 ? 3 : 1;
            const Version fresh = graph.create(
                {.name = fmt::format("image{}", i), .size = Size::fraction(1u << pick(4)), .mip_levels = mips});
            pass.writes.push_back({fresh, fresh_writes[pick(2)], {0, mips == 3 && pick(2) == 0 ? 1 : ~0u}});
            made.push_back({fresh, image_count++, mips});
        }
        const std::size_t image_writes = pass.writes.size();
        const bool has_second_output = kind > 1 && pick(4) == 0;
        if (has_second_output) {
            pass.writes.push_back({graph.create(image(fmt::format("second{}", i))), pass.writes[0].use});
            ++image_count;
        }
        constexpr Use buffer_reads[] = {Use::BufferRead, Use::BufferReadFragment, Use::BufferCopy};
        const std::uint32_t buffer_kind = pick(5);
        const std::size_t buffer = pick(buffers.size());
        if (buffer_kind == 0) pass.reads.push_back({buffers[buffer], buffer_reads[pick(3)]});
        if (buffer_kind == 1)
            pass.writes.push_back({buffers[buffer], pick(3) == 0 ? Use::BufferWrite : Use::BufferReadWrite});
        if (buffer_kind == 2 && pass.gate < 0)
            pass.writes.push_back({graph.create_buffer(fmt::format("buffer{}", i), 256), Use::BufferWrite});
        const bool writes_buffer = pass.writes.size() > image_writes + (has_second_output ? 1 : 0);
        const bool is_pyramid = made[0].mip_levels == 3 && pass.writes[0].mips.count == 1;
        const std::int32_t gate = pass.gate;
        const Version instead = pick(2) == 0 || pass.reads.empty() ? black : pass.reads[0].version;
        const std::string name = pass.name;
        const std::vector<Version> written = graph.add(std::move(pass));
        made[0].version = written[0];
        if (has_second_output && gate < 0) live.push_back({written[1], image_count - 1});
        if (writes_buffer && buffer_kind == 1) buffers[buffer] = written.back();
        if (writes_buffer && buffer_kind == 2) buffers.push_back(written.back());
        if (is_pyramid) {
            for (std::uint32_t level = 1; level < 3; ++level) {
                made[0].version = graph.add({.name = fmt::format("{}-mip{}", name, level),
                                             .reads = {{made[0].version, Use::SampledCompute, {level - 1, 1}}},
                                             .writes = {{made[0].version, Use::StorageWrite, {level, 1}}},
                                             .gate = gate})[0];
            }
        }
        if (gate >= 0 && (replaced.empty() || pick(2) == 0)) graph.fall_back(made[0].version, instead);
        for (const std::size_t index : replaced) live.erase(live.begin() + static_cast<std::ptrdiff_t>(index));
        live.push_back(made[0]);
    }
    if (pick(2) == 0)
        graph.add({.name = "read back",
                   .reads = {{buffers[pick(buffers.size())], Use::BufferCopy}},
                   .has_side_effect = true});
    graph.add({.name = "result", .reads = {{live.back().version, Use::SampledFragment}}, .has_side_effect = true});
    graph.add({.name = "other result",
               .reads = {{.version = live[pick(live.size())].version, .use = Use::SampledFragment, .instead = white}},
               .has_side_effect = true});
    return graph;
}

}  // namespace darkroom::graph::test
