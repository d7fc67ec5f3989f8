// SPDX-License-Identifier: MIT
#include "gpu/test_smallest/device.hpp"

#include "gpu/test_smallest/state.hpp"
#include "gpu/test_support.hpp"

namespace darkroom::gpu::test {

namespace {

std::mutex listener_mutex;
Refusals* listener = nullptr;

const Replacements& replacements() {
    static const Replacements functions = [] {
        Replacements all;
        replace_queries(all);
        replace_resources(all);
        replace_pipelines(all);
        replace_commands(all);
        return all;
    }();
    return functions;
}

PFN_vkVoidFunction device_proc(VkDevice device, const char* name) {
    const auto found = replacements().find(name);
    return found != replacements().end() ? found->second : smallest().real.GetDeviceProcAddr(device, name);
}

PFN_vkVoidFunction instance_proc(VkInstance instance, const char* name) {
    if (std::string_view(name) == "vkGetDeviceProcAddr") return as_void(device_proc);
    const auto found = replacements().find(name);
    return found != replacements().end() ? found->second : smallest().real.GetInstanceProcAddr(instance, name);
}

}  // namespace

SmallestState& smallest() {
    static SmallestState state;
    return state;
}

void refuse(const std::string& text) {
    const std::lock_guard lock(listener_mutex);
    if (listener != nullptr) return listener->add(text);
    if (smallest().log) smallest().log(Severity::Error, "the smallest device refuses: " + text);
}

void refuse(VkCommandBuffer commands, const std::string& text) {
    refuse(text);
    const std::lock_guard lock(smallest().mutex);
    smallest().broken.insert(commands);
}

ComputeQueue::ComputeQueue() { smallest().has_graphics = false; }
ComputeQueue::~ComputeQueue() { smallest().has_graphics = true; }

Refusals::Refusals() {
    const std::lock_guard lock(listener_mutex);
    listener = this;
}
Refusals::~Refusals() {
    const std::lock_guard lock(listener_mutex);
    listener = nullptr;
}
void Refusals::add(std::string text) {
    const std::lock_guard lock(mutex_);
    texts_.push_back(std::move(text));
}
std::vector<std::string> Refusals::texts() const {
    const std::lock_guard lock(mutex_);
    return texts_;
}

SmallestDevice::SmallestDevice(Device real) : real_(std::move(real)) {
    const Context& host = real_.context();
    SmallestState& state = smallest();
    state.real = host.vk;
    state.log = host.log;
    VkPhysicalDeviceProperties properties{};
    host.vk.GetPhysicalDeviceProperties(host.physical_device, &properties);
    state.limits = properties.limits;
    limit(state.limits);

    Dispatch vk;
    vk.GetInstanceProcAddr = instance_proc;
    must(vk.load_instance(host.instance, host.traits.has_debug_labels));
    vk.GetPhysicalDeviceFeatures2(host.physical_device, &features_);
    constexpr float priority = 1.0F;
    const VkDeviceQueueCreateInfo queue_info{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                             .queueFamilyIndex = host.queue_family,
                                             .queueCount = 1,
                                             .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &features_,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue_info};
    const VkResult made = vk.CreateDevice(host.physical_device, &info, nullptr, &handle_);
    must(host.check(made, "creating the smallest device"));
    // The layer knows its own functions by the device.
    must(state.real.load_device(handle_, host.traits.has_debug_labels));
    adopted_ = std::make_unique<Device>(adopted());
}

Device SmallestDevice::adopted() const {
    const Context& host = real_.context();
    const std::array extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    Device device = must(Device::adopt({
        .instance = host.instance,
        .physical_device = host.physical_device,
        .device = handle_,
        .queue_family = host.queue_family,
        .enabled_features = &features_,
        .enabled_instance_extensions = std::span(extensions).first(host.traits.has_debug_labels),
        .get_proc = instance_proc,
        .log = host.log,
        .cache_folder = host.cache_folder.string(),
        .caches_on_disk = !host.cache_folder.empty(),
    }));
    Context& context = device.context();
    context.vk.GetDeviceQueue(handle_, host.queue_family, 0, &context.queue);
    return device;
}

SmallestDevice::~SmallestDevice() {
    smallest().real.DeviceWaitIdle(handle_);
    adopted_.reset();
    smallest().real.DestroyDevice(handle_, nullptr);
}

}  // namespace darkroom::gpu::test
