// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <limits>
#include <memory>
#include <mutex>
#include <string>

#include "gpu/device/cleared.hpp"
#include "gpu/resource/formats.hpp"
#include "gpu/resource/resources.hpp"

namespace darkroom::gpu {

/// Pool and fence.
struct Submission::State {
    explicit State(Context& owner, std::string_view doing) : context(owner), what(doing) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    // What was begun is finished, whoever looks at it.
    ~State() {
        if (is_running) static_cast<void>(wait());
        context.vk.DestroyFence(context.device, fence, context.allocator);
        context.vk.DestroyCommandPool(context.device, pool, context.allocator);
    }
    VkResult run(const std::function<void(VkCommandBuffer)>& body);
    VkResult wait() {
        is_running = false;
        const VkResult waited =
            context.vk.WaitForFences(context.device, 1, &fence, VK_TRUE, std::numeric_limits<std::uint64_t>::max());
        if (waited == VK_SUCCESS || waited == VK_ERROR_DEVICE_LOST) return waited;
        // The commands still run, and pool and fence go next.
        const std::lock_guard lock(context.queue_mutex);
        return context.vk.DeviceWaitIdle(context.device);
    }

    Context& context;
    std::string what;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    bool is_running = false;
};

VkResult Submission::State::run(const std::function<void(VkCommandBuffer)>& body) {
    const Dispatch& vk = context.vk;
    const VkCommandPoolCreateInfo pool_info{
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
        .queueFamilyIndex = context.queue_family,
    };
    VkResult result =
        cleared_on_failure(vk.CreateCommandPool(context.device, &pool_info, context.allocator, &pool), pool);
    if (result != VK_SUCCESS) return result;
    const VkFenceCreateInfo fence_info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    result = cleared_on_failure(vk.CreateFence(context.device, &fence_info, context.allocator, &fence), fence);
    if (result != VK_SUCCESS) return result;
    const VkCommandBufferAllocateInfo allocate_info{
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    VkCommandBuffer commands = VK_NULL_HANDLE;
    result = vk.AllocateCommandBuffers(context.device, &allocate_info, &commands);
    if (result != VK_SUCCESS) return result;
    const VkCommandBufferBeginInfo begin_info{
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    result = vk.BeginCommandBuffer(commands, &begin_info);
    if (result != VK_SUCCESS) return result;
    body(commands);
    result = vk.EndCommandBuffer(commands);
    if (result != VK_SUCCESS) return result;
    const VkCommandBufferSubmitInfo command_info{
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
        .commandBuffer = commands,
    };
    const VkSubmitInfo2 submit_info{
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
        .commandBufferInfoCount = 1,
        .pCommandBufferInfos = &command_info,
    };
    const std::lock_guard lock(context.queue_mutex);
    result = vk.QueueSubmit2(context.queue, 1, &submit_info, fence);
    is_running = result == VK_SUCCESS;
    return result;
}

Submission::Submission() = default;
Submission::Submission(std::unique_ptr<State> state) : state_(std::move(state)) {}
Submission::Submission(Submission&&) noexcept = default;
Submission& Submission::operator=(Submission&&) noexcept = default;
Submission::~Submission() = default;

Result<Submission> Submission::begin(Context& context, std::string_view what,
                                     const std::function<void(VkCommandBuffer)>& body) {
    if (context.queue == VK_NULL_HANDLE) {
        return machine_error(
            fmt::format("{}: an adopted device is the host's, and the library does not submit to its queue", what));
    }
    auto state = std::make_unique<State>(context, what);
    DARKROOM_TRY(context.check(state->run(body), what));
    return Submission(std::move(state));
}

Result<> Submission::wait() {
    if (!state_) return {};
    const std::unique_ptr<State> state = std::move(state_);
    return state->context.check(state->wait(), state->what);
}

Result<> submit_and_wait(Context& context, std::string_view what, const std::function<void(VkCommandBuffer)>& body) {
    Result<Submission> submission = Submission::begin(context, what, body);
    return submission ? submission->wait() : failure(std::move(submission));
}

}  // namespace darkroom::gpu
