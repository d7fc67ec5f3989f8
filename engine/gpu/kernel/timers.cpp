// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "core/assert.hpp"
#include "gpu/device/cleared.hpp"
#include "gpu/resource/resources.hpp"

namespace darkroom::gpu {

std::uint64_t elapsed_ticks(std::uint64_t begin, std::uint64_t end, std::uint32_t valid_bits) {
    const std::uint64_t mask = valid_bits < 64 ? (std::uint64_t{1} << valid_bits) - 1 : ~std::uint64_t{0};
    return (end - begin) & mask;
}

Result<Timers> Timers::create(Context& context, std::uint32_t slots, std::uint32_t marks) {
    DARKROOM_ASSERT(slots > 0 && marks > 0);
    Timers timers;
    timers.context = &context;
    timers.marks = marks;
    timers.ticks.resize(marks);
    if (context.traits.timestamp_period_ns <= 0.0) return timers;
    const VkQueryPoolCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
        .queryType = VK_QUERY_TYPE_TIMESTAMP,
        .queryCount = marks,
    };
    timers.is_reset = context.traits.has_host_query_reset;
    timers.pools.resize(slots);
    for (VkQueryPool& pool : timers.pools) {
        DARKROOM_TRY(
            context.check(cleared_on_failure(
                              context.vk.CreateQueryPool(context.device, &create_info, context.allocator, &pool), pool),
                          "creating the timestamp queries"));
        if (timers.is_reset) context.vk.ResetQueryPool(context.device, pool, 0, marks);
    }
    return timers;
}

Timers::Timers(Timers&& other) noexcept { *this = std::move(other); }
Timers& Timers::operator=(Timers&& other) noexcept {
    std::swap(pools, other.pools);
    std::swap(is_reset, other.is_reset);
    std::swap(marks, other.marks);
    std::swap(ticks, other.ticks);
    std::swap(context, other.context);
    return *this;
}
Timers::~Timers() {
    for (VkQueryPool pool : pools) context->vk.DestroyQueryPool(context->device, pool, context->allocator);
}

void Timers::begin(VkCommandBuffer commands, std::uint32_t slot) {
    if (pools.empty()) return;
    // At once: what the slot's last recording left is not to be taken for this one's, which may never be submitted.
    if (is_reset) context->vk.ResetQueryPool(context->device, pools[slot], 0, marks);
    context->vk.CmdResetQueryPool(commands, pools[slot], 0, marks);
}

void Timers::mark(VkCommandBuffer commands, std::uint32_t slot, std::uint32_t index) {
    DARKROOM_ASSERT(index < marks);
    if (pools.empty()) return;
    context->vk.CmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pools[slot], index);
}

std::size_t Timers::read(std::uint32_t slot, std::uint32_t count, std::span<double> milliseconds) {
    DARKROOM_ASSERT(count <= marks);
    if (pools.empty() || count < 2) return 0;
    const VkResult result =
        context->vk.GetQueryPoolResults(context->device, pools[slot], 0, count, count * sizeof(std::uint64_t),
                                        ticks.data(), sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT);
    if (result != VK_SUCCESS) return 0;
    constexpr double milliseconds_per_ns = 1e-6;
    const std::size_t interval_count = std::min<std::size_t>(count - 1, milliseconds.size());
    for (std::size_t index = 0; index < interval_count; ++index) {
        const auto elapsed =
            static_cast<double>(elapsed_ticks(ticks[index], ticks[index + 1], context->traits.timestamp_valid_bits));
        milliseconds[index] = elapsed * context->traits.timestamp_period_ns * milliseconds_per_ns;
    }
    return interval_count;
}

}  // namespace darkroom::gpu
