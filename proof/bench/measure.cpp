// SPDX-License-Identifier: MIT
#include "measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <limits>

namespace darkroom::bench {

namespace {

Sample read_clocks() {
    timespec cpu{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
    const auto wall = std::chrono::steady_clock::now().time_since_epoch();
    return {.cpu_ms = static_cast<double>(cpu.tv_sec) * 1e3 + static_cast<double>(cpu.tv_nsec) * 1e-6,
            .wall_ms = std::chrono::duration<double, std::milli>(wall).count()};
}

}  // namespace

Stopwatch::Stopwatch() : start_(read_clocks()) {}

Sample Stopwatch::elapsed() const {
    const Sample now = read_clocks();
    return {.cpu_ms = now.cpu_ms - start_.cpu_ms, .wall_ms = now.wall_ms - start_.wall_ms};
}

Result<std::unique_ptr<Submitter>> Submitter::create(gpu::Context& context) {
    std::unique_ptr<Submitter> made(new Submitter(context));
    const gpu::Dispatch& vk = context.vk;
    const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                            .queueFamilyIndex = context.queue_family};
    const VkFenceCreateInfo fence_info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkResult result = vk.CreateCommandPool(context.device, &pool_info, nullptr, &made->pool_);
    if (result == VK_SUCCESS) result = vk.CreateFence(context.device, &fence_info, nullptr, &made->fence_);
    const VkCommandBufferAllocateInfo allocate_info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                    .commandPool = made->pool_,
                                                    .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                    .commandBufferCount = 1};
    if (result == VK_SUCCESS) result = vk.AllocateCommandBuffers(context.device, &allocate_info, &made->commands_);
    DARKROOM_TRY(context.check(result, "creating a command buffer"));
    DARKROOM_TRY_VALUE(made->timers_, gpu::Timers::create(context, 1, 2));
    return made;
}

Submitter::~Submitter() {
    context_.vk.DestroyFence(context_.device, fence_, nullptr);
    context_.vk.DestroyCommandPool(context_.device, pool_, nullptr);
}

Result<VkCommandBuffer> Submitter::begin() {
    const VkCommandBufferBeginInfo begin_info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                              .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    VkResult result = context_.vk.ResetCommandPool(context_.device, pool_, 0);
    if (result == VK_SUCCESS) result = context_.vk.BeginCommandBuffer(commands_, &begin_info);
    DARKROOM_TRY(context_.check(result, "beginning a command buffer"));
    return commands_;
}

Result<> Submitter::submit() {
    const VkCommandBufferSubmitInfo command_info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                                 .commandBuffer = commands_};
    const VkSubmitInfo2 submit_info{
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &command_info};
    VkResult result = context_.vk.ResetFences(context_.device, 1, &fence_);
    if (result == VK_SUCCESS) result = context_.vk.QueueSubmit2(context_.queue, 1, &submit_info, fence_);
    return context_.check(result, "submitting");
}

Result<> Submitter::wait() {
    constexpr auto forever = std::numeric_limits<std::uint64_t>::max();
    return context_.check(context_.vk.WaitForFences(context_.device, 1, &fence_, VK_TRUE, forever), "waiting");
}

Result<Sample> Submitter::run(const std::function<Result<>(VkCommandBuffer)>& record) {
    DARKROOM_TRY_VALUE(auto commands, begin());
    timers_.begin(commands, 0);
    timers_.mark(commands, 0, 0);
    DARKROOM_TRY(record(commands));
    timers_.mark(commands, 0, 1);
    auto done = context_.check(context_.vk.EndCommandBuffer(commands), "ending a command buffer");
    if (!done) return failure(std::move(done));

    const Stopwatch watch;
    done = submit();
    if (done) done = wait();
    if (!done) return failure(std::move(done));
    Sample sample = watch.elapsed();
    timers_.read(0, 2, {&sample.gpu_ms, 1});
    return sample;
}

Result<> measure(Bed& bed, std::vector<Row>& rows, std::uint32_t rounds) {
    DARKROOM_TRY_VALUE(auto submitter, Submitter::create(bed.context));
    const auto run = [&](const Row& row) -> Result<Sample> {
        if (row.record) return submitter->run(row.record);
        const Stopwatch watch;
        row.host();
        return watch.elapsed();
    };
    // The first run of a kernel is when a driver may compile it.
    for (std::uint32_t round = 0; round <= rounds; ++round) {
        for (Row& row : rows) {
            const auto sample = run(row);
            if (!sample)
                return failure(Error{sample.error().fault, fmt::format("{}: {}", row.name, sample.error().text)});
            if (round > 0) row.samples.push_back(*sample);
        }
    }
    return {};
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::ranges::sort(values);
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double minimum(const std::vector<double>& values) { return values.empty() ? 0 : *std::ranges::min_element(values); }

std::vector<double> column(const Row& row, double Sample::*member) {
    std::vector<double> values;
    for (const Sample& sample : row.samples) values.push_back(sample.*member);
    return values;
}

double ratio(const Row& row, const Row& unit, double Sample::*member) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(row.samples.size(), unit.samples.size()); ++i)
        if (unit.samples[i].*member > 0) ratios.push_back(row.samples[i].*member / unit.samples[i].*member);
    return median(ratios);
}

double difference(const Row& row, const Row& less, const Row& unit, double Sample::*member) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min({row.samples.size(), less.samples.size(), unit.samples.size()}); ++i)
        if (unit.samples[i].*member > 0)
            ratios.push_back((row.samples[i].*member - less.samples[i].*member) / unit.samples[i].*member);
    return median(ratios);
}

double Sample::*cost_of(const Device& device) { return device.info().is_software ? &Sample::cpu_ms : &Sample::gpu_ms; }

}  // namespace darkroom::bench
