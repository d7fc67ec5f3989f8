// SPDX-License-Identifier: MIT
#include "gpu/kernel/pipeline_statistics.hpp"

#include <string_view>
#include <vector>

#include "gpu/device/context.hpp"

namespace darkroom::gpu {

namespace {

constexpr std::string_view what = "reading what the driver says of a pipeline";

/// Vulkan's way of listing: count, then items. An item list that shrank meanwhile is taken as it is.
template <class Item>
Result<std::vector<Item>> list(const Context& context, const Item& empty, const auto& call) {
    std::uint32_t count = 0;
    DARKROOM_TRY(context.check(call(&count, nullptr), what));
    std::vector<Item> items(count, empty);
    DARKROOM_TRY(context.check(call(&count, items.data()), what));
    items.resize(count);
    return items;
}

double number_of(const VkPipelineExecutableStatisticKHR& statistic) {
    switch (statistic.format) {
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
            return statistic.value.b32 == VK_TRUE ? 1 : 0;
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
            return static_cast<double>(statistic.value.i64);
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR:
            return statistic.value.f64;
        default:
            return static_cast<double>(statistic.value.u64);
    }
}

/// The last of a program's texts: compilers show their steps in order, machine code at the end.
Result<std::string> machine_code(const Context& context, const VkPipelineExecutableInfoKHR& program) {
    using Representation = VkPipelineExecutableInternalRepresentationKHR;
    const auto call = [&](std::uint32_t* count, Representation* out) {
        return context.vk.GetPipelineExecutableInternalRepresentationsKHR(context.device, &program, count, out);
    };
    DARKROOM_TRY_VALUE(
        auto texts,
        list(context, Representation{.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR},
             call));
    if (texts.empty() || texts.back().isText == VK_FALSE) return std::string();
    // Without a place for the others they tell their sizes alone.
    std::string out(texts.back().dataSize, '\0');
    for (Representation& text : texts) text.pData = nullptr;
    texts.back().pData = out.data();
    auto count = static_cast<std::uint32_t>(texts.size());
    DARKROOM_TRY(context.check(call(&count, texts.data()), what));
    out.resize(out.find_last_not_of('\0') + 1);
    return out;
}

}  // namespace

Result<KernelStatistics> pipeline_statistics(const Context& context, VkPipeline pipeline, VkShaderStageFlagBits stage) {
    using Program = VkPipelineExecutablePropertiesKHR;
    const VkPipelineInfoKHR info{.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, .pipeline = pipeline};
    DARKROOM_TRY_VALUE(const auto programs,
                       list(context, Program{.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR},
                            [&](std::uint32_t* count, Program* out) {
                                return context.vk.GetPipelineExecutablePropertiesKHR(context.device, &info, count, out);
                            }));
    for (std::uint32_t index = 0; index < programs.size(); ++index) {
        if ((programs[index].stages & stage) == 0) continue;
        const VkPipelineExecutableInfoKHR program{
            .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = pipeline, .executableIndex = index};
        using Statistic = VkPipelineExecutableStatisticKHR;
        DARKROOM_TRY_VALUE(const auto statistics,
                           list(context, Statistic{.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR},
                                [&](std::uint32_t* count, Statistic* out) {
                                    return context.vk.GetPipelineExecutableStatisticsKHR(context.device, &program,
                                                                                         count, out);
                                }));
        KernelStatistics out{.subgroup = programs[index].subgroupSize};
        for (const Statistic& one : statistics) out.values.push_back({one.name, number_of(one)});
        DARKROOM_TRY_VALUE(out.machine_code, machine_code(context, program));
        return out;
    }
    return machine_error("the driver tells nothing about a pipeline's program");
}

}  // namespace darkroom::gpu
