// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "graph/solution.hpp"
#include "graph_check/check.hpp"

namespace darkroom::graph {
namespace {

struct Name {
    VkFlags64 bit;
    const char* text;
};
constexpr Name stage_names[] = {
    {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, "all"},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute"},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment"},
    {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "depth-tests"},
    {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "color-output"},
    {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer"},
    {VK_PIPELINE_STAGE_2_HOST_BIT, "host"}};
constexpr Name access_names[] = {{VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, "sample"},
                                 {VK_ACCESS_2_SHADER_STORAGE_READ_BIT, "load"},
                                 {VK_ACCESS_2_UNIFORM_READ_BIT, "uniform"},
                                 {VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, "store"},
                                 {VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT, "color-read"},
                                 {VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, "color-write"},
                                 {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, "depth-read"},
                                 {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, "depth-write"},
                                 {VK_ACCESS_2_TRANSFER_READ_BIT, "transfer-read"},
                                 {VK_ACCESS_2_TRANSFER_WRITE_BIT, "transfer-write"},
                                 {VK_ACCESS_2_HOST_READ_BIT, "host-read"},
                                 {VK_ACCESS_2_HOST_WRITE_BIT, "host-write"},
                                 {VK_ACCESS_2_MEMORY_READ_BIT, "read"},
                                 {VK_ACCESS_2_MEMORY_WRITE_BIT, "write"}};

std::string names(VkFlags64 mask, std::span<const Name> table) {
    std::string text;
    for (const Name& name : table) {
        if ((mask & name.bit) != name.bit) continue;
        if (!text.empty()) text += '|';
        text += name.text;
        mask &= ~name.bit;
    }
    if (mask != 0) text += fmt::format("{}{:#x}", text.empty() ? "" : "|", mask);
    return text.empty() ? "none" : text;
}

std::string scope(VkPipelineStageFlags2 stages, VkAccessFlags2 access) {
    if (access == 0) return names(stages, stage_names);
    return fmt::format("{}:{}", names(stages, stage_names), names(access, access_names));
}

std::string layout_name(VkImageLayout layout) {
    switch (layout) {
        case VK_IMAGE_LAYOUT_UNDEFINED:
            return "undefined";
        case VK_IMAGE_LAYOUT_GENERAL:
            return "general";
        case VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL:
            return "read-only";
        case VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL:
            return "color";
        case VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL:
            return "depth";
        case VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL:
            return "depth-read-only";
        case VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL:
            return "transfer-source";
        case VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL:
            return "transfer-target";
        case VK_IMAGE_LAYOUT_PRESENT_SRC_KHR:
            return "present";
        default:
            return fmt::format("layout-{}", static_cast<int>(layout));
    }
}

std::string line(const Compiled& compiled, const Barrier& barrier, const char* head) {
    const Slot& slot = compiled.slots()[barrier.slot];
    std::string text = fmt::format("{} {}", head, slot.desc.name);
    if (slot.kind == Slot::Kind::History) text += fmt::format("#{}", slot.history_parity);
    if (barrier.mips.count != slot.desc.mip_levels) {
        const std::uint32_t last = barrier.mips.first + barrier.mips.count - 1;
        text += barrier.mips.count == 1 ? fmt::format(" mip {}", last)
                                        : fmt::format(" mips {}-{}", barrier.mips.first, last);
    }
    text += fmt::format(": {} -> {}", scope(barrier.source_stages, barrier.source_access),
                        scope(barrier.target_stages, barrier.target_access));
    if (barrier.old_layout != barrier.new_layout) {
        text += fmt::format(", {} -> {}", layout_name(barrier.old_layout), layout_name(barrier.new_layout));
    }
    return text + "\n";
}

}  // namespace

std::string trace(const Compiled& compiled, const Schedule& schedule) {
    std::string text;
    for (const Step& step : schedule.steps()) {
        for (const Barrier& barrier : schedule.barriers().subspan(step.first_barrier, step.barrier_count)) {
            text += line(compiled, barrier, "barrier");
        }
        text += fmt::format("pass {}\n", compiled.passes()[step.pass].name);
    }
    for (const Barrier& barrier : schedule.final_barriers()) text += line(compiled, barrier, "final");
    return text;
}

}  // namespace darkroom::graph
