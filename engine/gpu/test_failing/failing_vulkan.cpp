// SPDX-License-Identifier: MIT
#include "gpu/test_failing/failing_vulkan.hpp"

#include <fmt/format.h>

#include <bit>
#include <map>
#include <mutex>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/test_support_allocations.hpp"
#include "gpu/device/dispatch.hpp"

namespace darkroom::gpu::test::failing {

namespace {

struct Row {
    std::string_view name;
    std::vector<VkResult> errors;
};

struct State {
    PFN_vkGetInstanceProcAddr real_instance_proc = nullptr;
    PFN_vkGetDeviceProcAddr real_device_proc = nullptr;

    std::mutex mutex;  ///< guards what follows
    bool is_armed = false;
    std::uint64_t failing = never;
    std::size_t error = 0;
    std::vector<Call> calls;
    Failed failed;
    struct Made {
        std::string_view by;
        std::uint64_t bytes = 0;
    };
    std::map<std::uint64_t, Made> alive;
    std::vector<std::string> wrongs;
};

State& state() {
    static State all;
    return all;
}

VkResult take_failure(const Row& row) {
    State& all = state();
    const std::lock_guard lock(all.mutex);
    if (!all.is_armed || row.errors.empty()) return VK_SUCCESS;
    all.calls.push_back({row.name, row.errors.size()});
    if (all.calls.size() != all.failing + 1) return VK_SUCCESS;
    all.failed = {row.name, row.errors[all.error % row.errors.size()]};
    return all.failed.result;
}

void add(std::uint64_t handle, std::string_view by, std::uint64_t bytes) {
    State& all = state();
    const std::lock_guard lock(all.mutex);
    all.alive[handle] = {by, bytes};
}

/// False: nobody made it.
bool forget(std::uint64_t handle, std::string_view by) {
    State& all = state();
    const std::lock_guard lock(all.mutex);
    if (handle == 0 || all.alive.erase(handle) > 0) return true;
    all.wrongs.push_back(fmt::format("{} of {:#x}, which nobody made", by, handle));
    return false;
}

template <class Handle>
std::uint64_t number_of(Handle handle) {
    return std::bit_cast<std::uint64_t>(handle);
}

/// What the specification says of results where a call fails: they are undefined, but of pipelines and of what comes
/// out of pools.
constexpr std::uint64_t undefined = 0xdeadbeefdeadbee0;

constexpr bool is_pool(std::string_view name) {
    return name == "vkAllocateDescriptorSets" || name == "vkAllocateCommandBuffers";
}
constexpr bool is_pipelines(std::string_view name) {
    return name == "vkCreateComputePipelines" || name == "vkCreateGraphicsPipelines";
}

template <class Out>
void spoil(Out* out, std::string_view name, std::size_t count) {
    if constexpr (std::is_pointer_v<Out> && !std::is_const_v<Out>) {
        for (Out& one : std::span(out, count))
            one = is_pipelines(name) || is_pool(name) ? nullptr : std::bit_cast<Out>(undefined);
    }
}
template <class Other>
void spoil(Other, std::string_view, std::size_t) {}

/// The number that a call counts or tells.
template <class... Args>
void spoil_count(const std::tuple<Args...>& args) {
    constexpr std::size_t place = sizeof...(Args) == 1 ? 0 : sizeof...(Args) - 2;
    if constexpr (std::is_same_v<std::tuple_element_t<place, std::tuple<Args...>>, std::uint32_t*>)
        *std::get<place>(args) = 7;
}

template <class Out>
void note_made(Out* out, std::string_view name, std::size_t count, std::uint64_t bytes) {
    if constexpr (std::is_pointer_v<Out> && !std::is_const_v<Out> && !std::is_void_v<std::remove_pointer_t<Out>>)
        for (const Out one : std::span(out, count)) add(number_of(one), name, bytes);
}
template <class Other>
void note_made(Other, std::string_view, std::size_t, std::uint64_t) {}

template <class... Args>
std::uint64_t bytes_of(const std::tuple<Args...>& args) {
    if constexpr (sizeof...(Args) == 4)
        if constexpr (std::is_same_v<std::tuple_element_t<1, std::tuple<Args...>>, const VkMemoryAllocateInfo*>)
            return std::get<1>(args)->allocationSize;
    return 0;
}

/// How many objects a call makes.
template <class... Args>
std::size_t count_of(std::string_view name, const std::tuple<Args...>& args) {
    if constexpr (sizeof...(Args) == 6)
        if constexpr (std::is_same_v<std::tuple_element_t<2, std::tuple<Args...>>, std::uint32_t>)
            if (is_pipelines(name)) return std::get<2>(args);
    if constexpr (sizeof...(Args) == 3) {
        using Info = std::tuple_element_t<1, std::tuple<Args...>>;
        if constexpr (std::is_same_v<Info, const VkDescriptorSetAllocateInfo*>)
            return std::get<1>(args)->descriptorSetCount;
        if constexpr (std::is_same_v<Info, const VkCommandBufferAllocateInfo*>)
            return std::get<1>(args)->commandBufferCount;
    }
    return 1;
}

bool has(std::string_view name, std::string_view part) { return name.find(part) != std::string_view::npos; }

template <auto member>
struct Replaced;
template <class Owner, class Back, class... Args, Back (VKAPI_PTR* Owner::*member)(Args...)>
struct Replaced<member> {
    static inline PFN_vkVoidFunction real = nullptr;
    static inline Row row;

    static Back VKAPI_CALL call(Args... args) {
        const darkroom::test::SparedAllocations spared;
        const auto function = reinterpret_cast<Back(VKAPI_PTR*)(Args...)>(real);
        const std::tuple<Args...> all(args...);
        if constexpr (std::is_same_v<Back, VkResult>) {
            const auto out = std::get<sizeof...(Args) - 1>(all);
            const std::size_t count = count_of(row.name, all);
            const bool makes = has(row.name, "vkCreate") || has(row.name, "vkAllocate") || row.name == "vkMapMemory";
            if (const VkResult error = take_failure(row); error != VK_SUCCESS) {
                // What was begun on a device that is lost has an end.
                if (error == VK_ERROR_DEVICE_LOST && has(row.name, "Wait")) static_cast<void>(function(args...));
                // A picture that comes too late for its window is taken back all the same.
                if (error == VK_ERROR_OUT_OF_DATE_KHR && has(row.name, "Present")) static_cast<void>(function(args...));
                if (makes) spoil(out, row.name, count);
                if (has(row.name, "vkEnumerate")) spoil_count(all);
                return error;
            }
            const VkResult result = function(args...);
            if (result == VK_SUCCESS && makes && !is_pool(row.name)) note_made(out, row.name, count, bytes_of(all));
            return result;
        } else {
            if constexpr (sizeof...(Args) >= 2) {
                const bool is_of_device = sizeof...(Args) == 3;
                if (has(row.name, "vkDestroy") || has(row.name, "vkFree")) {
                    const auto handle = std::get<sizeof...(Args) - 2>(all);
                    if constexpr (std::is_pointer_v<decltype(handle)>)
                        if (!forget(number_of(handle), row.name) && is_of_device) return;
                }
            }
            return function(args...);
        }
    }
};

struct Found {
    PFN_vkVoidFunction ours = nullptr;
    PFN_vkVoidFunction* real = nullptr;
};
using Table = std::map<std::string_view, Found>;

template <auto member>
void add(Table& table, std::string_view name, std::vector<VkResult> errors = {}) {
    Replaced<member>::row = {name, std::move(errors)};
    table[name] = {reinterpret_cast<PFN_vkVoidFunction>(&Replaced<member>::call), &Replaced<member>::real};
}

/// Errors by the specification's "Failure" of each.
void add_before_devices(Table& all) {
    const std::vector out_of_memory{VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY};
    add<&Dispatch::CreateInstance>(
        all, "vkCreateInstance",
        {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_INITIALIZATION_FAILED, VK_ERROR_INCOMPATIBLE_DRIVER});
    add<&Dispatch::EnumerateInstanceVersion>(all, "vkEnumerateInstanceVersion", {VK_ERROR_OUT_OF_HOST_MEMORY});
    add<&Dispatch::EnumerateInstanceLayerProperties>(all, "vkEnumerateInstanceLayerProperties", out_of_memory);
    add<&Dispatch::EnumerateInstanceExtensionProperties>(all, "vkEnumerateInstanceExtensionProperties", out_of_memory);
    add<&Dispatch::DestroyInstance>(all, "vkDestroyInstance");
    add<&Dispatch::EnumeratePhysicalDevices>(all, "vkEnumeratePhysicalDevices",
                                             {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_INITIALIZATION_FAILED});
    add<&Dispatch::GetPhysicalDeviceProperties>(all, "vkGetPhysicalDeviceProperties");
    add<&Dispatch::GetPhysicalDeviceProperties2>(all, "vkGetPhysicalDeviceProperties2");
    add<&Dispatch::GetPhysicalDeviceFeatures2>(all, "vkGetPhysicalDeviceFeatures2");
    add<&Dispatch::GetPhysicalDeviceFormatProperties>(all, "vkGetPhysicalDeviceFormatProperties");
    add<&Dispatch::GetPhysicalDeviceFormatProperties2>(all, "vkGetPhysicalDeviceFormatProperties2");
    add<&Dispatch::GetPhysicalDeviceMemoryProperties>(all, "vkGetPhysicalDeviceMemoryProperties");
    add<&Dispatch::GetPhysicalDeviceQueueFamilyProperties>(all, "vkGetPhysicalDeviceQueueFamilyProperties");
    add<&Dispatch::EnumerateDeviceExtensionProperties>(all, "vkEnumerateDeviceExtensionProperties", out_of_memory);
    add<&Dispatch::CreateDevice>(
        all, "vkCreateDevice",
        {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_INITIALIZATION_FAILED, VK_ERROR_TOO_MANY_OBJECTS, VK_ERROR_DEVICE_LOST});
    add<&Dispatch::CreateDebugUtilsMessengerEXT>(all, "vkCreateDebugUtilsMessengerEXT", {VK_ERROR_OUT_OF_HOST_MEMORY});
    add<&Dispatch::DestroyDebugUtilsMessengerEXT>(all, "vkDestroyDebugUtilsMessengerEXT");
}

void add_objects(Table& all) {
    const std::vector out_of_memory{VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY};
    const std::vector lost{VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_DEVICE_LOST};
    add<&Dispatch::DestroyDevice>(all, "vkDestroyDevice");
    add<&Dispatch::DeviceWaitIdle>(all, "vkDeviceWaitIdle", lost);
    add<&Dispatch::GetDeviceQueue>(all, "vkGetDeviceQueue");
    add<&Dispatch::QueueSubmit2>(all, "vkQueueSubmit2", lost);
    add<&Dispatch::AllocateMemory>(all, "vkAllocateMemory", out_of_memory);
    add<&Dispatch::FreeMemory>(all, "vkFreeMemory");
    add<&Dispatch::MapMemory>(all, "vkMapMemory", {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_MEMORY_MAP_FAILED});
    add<&Dispatch::CreateBuffer>(all, "vkCreateBuffer", out_of_memory);
    add<&Dispatch::DestroyBuffer>(all, "vkDestroyBuffer");
    add<&Dispatch::GetBufferMemoryRequirements2>(all, "vkGetBufferMemoryRequirements2");
    add<&Dispatch::BindBufferMemory>(all, "vkBindBufferMemory", out_of_memory);
    add<&Dispatch::CreateImage>(all, "vkCreateImage", out_of_memory);
    add<&Dispatch::DestroyImage>(all, "vkDestroyImage");
    add<&Dispatch::GetImageMemoryRequirements2>(all, "vkGetImageMemoryRequirements2");
    add<&Dispatch::BindImageMemory>(all, "vkBindImageMemory", out_of_memory);
    add<&Dispatch::CreateImageView>(all, "vkCreateImageView", out_of_memory);
    add<&Dispatch::DestroyImageView>(all, "vkDestroyImageView");
    add<&Dispatch::CreateSampler>(all, "vkCreateSampler", out_of_memory);
    add<&Dispatch::DestroySampler>(all, "vkDestroySampler");
    add<&Dispatch::CreateShaderModule>(all, "vkCreateShaderModule", out_of_memory);
    add<&Dispatch::DestroyShaderModule>(all, "vkDestroyShaderModule");
    add<&Dispatch::CreatePipelineCache>(all, "vkCreatePipelineCache", out_of_memory);
    add<&Dispatch::DestroyPipelineCache>(all, "vkDestroyPipelineCache");
    add<&Dispatch::GetPipelineCacheData>(all, "vkGetPipelineCacheData", out_of_memory);
    add<&Dispatch::CreateComputePipelines>(all, "vkCreateComputePipelines", out_of_memory);
    add<&Dispatch::CreateGraphicsPipelines>(all, "vkCreateGraphicsPipelines", out_of_memory);
    add<&Dispatch::DestroyPipeline>(all, "vkDestroyPipeline");
    add<&Dispatch::CreatePipelineLayout>(all, "vkCreatePipelineLayout", out_of_memory);
    add<&Dispatch::DestroyPipelineLayout>(all, "vkDestroyPipelineLayout");
    add<&Dispatch::CreateDescriptorSetLayout>(all, "vkCreateDescriptorSetLayout", out_of_memory);
    add<&Dispatch::DestroyDescriptorSetLayout>(all, "vkDestroyDescriptorSetLayout");
    add<&Dispatch::CreateDescriptorPool>(all, "vkCreateDescriptorPool",
                                         {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_FRAGMENTATION});
    add<&Dispatch::DestroyDescriptorPool>(all, "vkDestroyDescriptorPool");
    add<&Dispatch::AllocateDescriptorSets>(
        all, "vkAllocateDescriptorSets",
        {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_FRAGMENTED_POOL, VK_ERROR_OUT_OF_POOL_MEMORY});
    add<&Dispatch::UpdateDescriptorSets>(all, "vkUpdateDescriptorSets");
    add<&Dispatch::CreateQueryPool>(all, "vkCreateQueryPool", out_of_memory);
    add<&Dispatch::DestroyQueryPool>(all, "vkDestroyQueryPool");
    add<&Dispatch::GetQueryPoolResults>(all, "vkGetQueryPoolResults", lost);
    add<&Dispatch::CreateFence>(all, "vkCreateFence", out_of_memory);
    add<&Dispatch::DestroyFence>(all, "vkDestroyFence");
    add<&Dispatch::ResetFences>(all, "vkResetFences", {VK_ERROR_OUT_OF_DEVICE_MEMORY});
    add<&Dispatch::WaitForFences>(all, "vkWaitForFences", lost);
    add<&Dispatch::CreateCommandPool>(all, "vkCreateCommandPool", out_of_memory);
    add<&Dispatch::DestroyCommandPool>(all, "vkDestroyCommandPool");
    add<&Dispatch::ResetCommandPool>(all, "vkResetCommandPool", {VK_ERROR_OUT_OF_DEVICE_MEMORY});
    add<&Dispatch::AllocateCommandBuffers>(all, "vkAllocateCommandBuffers", out_of_memory);
}

void add_commands(Table& all) {
    const std::vector out_of_memory{VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY};
    add<&Dispatch::BeginCommandBuffer>(all, "vkBeginCommandBuffer", out_of_memory);
    add<&Dispatch::EndCommandBuffer>(all, "vkEndCommandBuffer", out_of_memory);
    add<&Dispatch::CmdBindPipeline>(all, "vkCmdBindPipeline");
    add<&Dispatch::CmdBindDescriptorSets>(all, "vkCmdBindDescriptorSets");
    add<&Dispatch::CmdPushConstants>(all, "vkCmdPushConstants");
    add<&Dispatch::CmdPipelineBarrier2>(all, "vkCmdPipelineBarrier2");
    add<&Dispatch::CmdDispatch>(all, "vkCmdDispatch");
    add<&Dispatch::CmdBeginRendering>(all, "vkCmdBeginRendering");
    add<&Dispatch::CmdEndRendering>(all, "vkCmdEndRendering");
    add<&Dispatch::CmdSetViewport>(all, "vkCmdSetViewport");
    add<&Dispatch::CmdSetScissor>(all, "vkCmdSetScissor");
    add<&Dispatch::CmdBindVertexBuffers>(all, "vkCmdBindVertexBuffers");
    add<&Dispatch::CmdBindIndexBuffer>(all, "vkCmdBindIndexBuffer");
    add<&Dispatch::CmdDraw>(all, "vkCmdDraw");
    add<&Dispatch::CmdDrawIndexed>(all, "vkCmdDrawIndexed");
    add<&Dispatch::CmdCopyBuffer>(all, "vkCmdCopyBuffer");
    add<&Dispatch::CmdFillBuffer>(all, "vkCmdFillBuffer");
    add<&Dispatch::CmdBlitImage>(all, "vkCmdBlitImage");
    add<&Dispatch::CmdCopyImage>(all, "vkCmdCopyImage");
    add<&Dispatch::CmdCopyBufferToImage>(all, "vkCmdCopyBufferToImage");
    add<&Dispatch::CmdCopyImageToBuffer>(all, "vkCmdCopyImageToBuffer");
    add<&Dispatch::CmdClearColorImage>(all, "vkCmdClearColorImage");
    add<&Dispatch::CmdClearDepthStencilImage>(all, "vkCmdClearDepthStencilImage");
    add<&Dispatch::CmdResetQueryPool>(all, "vkCmdResetQueryPool");
    add<&Dispatch::CmdWriteTimestamp2>(all, "vkCmdWriteTimestamp2");
    add<&Dispatch::SetDebugUtilsObjectNameEXT>(all, "vkSetDebugUtilsObjectNameEXT", out_of_memory);
    add<&Dispatch::CmdBeginDebugUtilsLabelEXT>(all, "vkCmdBeginDebugUtilsLabelEXT");
    add<&Dispatch::CmdEndDebugUtilsLabelEXT>(all, "vkCmdEndDebugUtilsLabelEXT");
}

/// What only a window calls.
struct WindowFunctions {
    PFN_vkGetPhysicalDeviceSurfaceSupportKHR GetPhysicalDeviceSurfaceSupportKHR;
    PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR GetPhysicalDeviceSurfaceCapabilitiesKHR;
    PFN_vkGetPhysicalDeviceSurfaceFormatsKHR GetPhysicalDeviceSurfaceFormatsKHR;
    PFN_vkGetPhysicalDeviceSurfacePresentModesKHR GetPhysicalDeviceSurfacePresentModesKHR;
    PFN_vkCreateSwapchainKHR CreateSwapchainKHR;
    PFN_vkDestroySwapchainKHR DestroySwapchainKHR;
    PFN_vkGetSwapchainImagesKHR GetSwapchainImagesKHR;
    PFN_vkAcquireNextImageKHR AcquireNextImageKHR;
    PFN_vkQueuePresentKHR QueuePresentKHR;
    PFN_vkCreateSemaphore CreateSemaphore;
    PFN_vkDestroySemaphore DestroySemaphore;
    PFN_vkWaitSemaphores WaitSemaphores;
    PFN_vkGetSemaphoreCounterValue GetSemaphoreCounterValue;
};

void add_window(Table& all) {
    using Of = WindowFunctions;
    const std::vector out_of_memory{VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY};
    const auto or_also = [&](std::vector<VkResult> others) {
        others.insert(others.end(), out_of_memory.begin(), out_of_memory.end());
        return others;
    };
    const std::vector no_surface = or_also({VK_ERROR_SURFACE_LOST_KHR});
    const std::vector lost = or_also({VK_ERROR_DEVICE_LOST});
    const std::vector shown = or_also({VK_ERROR_DEVICE_LOST, VK_ERROR_OUT_OF_DATE_KHR, VK_ERROR_SURFACE_LOST_KHR});
    add<&Of::GetPhysicalDeviceSurfaceSupportKHR>(all, "vkGetPhysicalDeviceSurfaceSupportKHR", no_surface);
    add<&Of::GetPhysicalDeviceSurfaceCapabilitiesKHR>(all, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR", no_surface);
    add<&Of::GetPhysicalDeviceSurfaceFormatsKHR>(all, "vkGetPhysicalDeviceSurfaceFormatsKHR", no_surface);
    add<&Of::GetPhysicalDeviceSurfacePresentModesKHR>(all, "vkGetPhysicalDeviceSurfacePresentModesKHR", no_surface);
    add<&Of::CreateSwapchainKHR>(all, "vkCreateSwapchainKHR",
                                 or_also({VK_ERROR_DEVICE_LOST, VK_ERROR_SURFACE_LOST_KHR,
                                          VK_ERROR_NATIVE_WINDOW_IN_USE_KHR, VK_ERROR_INITIALIZATION_FAILED}));
    add<&Of::DestroySwapchainKHR>(all, "vkDestroySwapchainKHR");
    add<&Of::GetSwapchainImagesKHR>(all, "vkGetSwapchainImagesKHR", out_of_memory);
    add<&Of::AcquireNextImageKHR>(all, "vkAcquireNextImageKHR", shown);
    add<&Of::QueuePresentKHR>(all, "vkQueuePresentKHR", shown);
    add<&Of::CreateSemaphore>(all, "vkCreateSemaphore", out_of_memory);
    add<&Of::DestroySemaphore>(all, "vkDestroySemaphore");
    add<&Of::WaitSemaphores>(all, "vkWaitSemaphores", lost);
    add<&Of::GetSemaphoreCounterValue>(all, "vkGetSemaphoreCounterValue", lost);
}

const Table& table() {
    static const Table all = [] {
        Table out;
        add_before_devices(out);
        add_objects(out);
        add_commands(out);
        add_window(out);
        return out;
    }();
    return all;
}

PFN_vkVoidFunction ours_for(PFN_vkVoidFunction real, const char* name) {
    const auto found = table().find(name);
    if (real == nullptr || found == table().end()) return real;
    *found->second.real = real;
    return found->second.ours;
}

PFN_vkVoidFunction VKAPI_CALL device_proc(VkDevice device, const char* name) {
    const darkroom::test::SparedAllocations spared;
    return ours_for(state().real_device_proc(device, name), name);
}

PFN_vkVoidFunction VKAPI_CALL instance_proc(VkInstance instance, const char* name) {
    const darkroom::test::SparedAllocations spared;
    const PFN_vkVoidFunction real = state().real_instance_proc(instance, name);
    if (std::string_view(name) != "vkGetDeviceProcAddr") return ours_for(real, name);
    state().real_device_proc = reinterpret_cast<PFN_vkGetDeviceProcAddr>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(&device_proc);
}

}  // namespace

PFN_vkGetInstanceProcAddr vulkan_over(PFN_vkGetInstanceProcAddr real) {
    state().real_instance_proc = real;
    return &instance_proc;
}

void arm(std::uint64_t number, std::size_t error) {
    State& all = state();
    const std::lock_guard lock(all.mutex);
    all.is_armed = true;
    all.failing = number;
    all.error = error;
    all.calls.clear();
    all.failed = {};
}

void disarm() {
    const std::lock_guard lock(state().mutex);
    state().is_armed = false;
}

std::vector<Call> calls() {
    const std::lock_guard lock(state().mutex);
    return state().calls;
}

Failed failed() {
    const std::lock_guard lock(state().mutex);
    return state().failed;
}

std::vector<std::string> alive() {
    const std::lock_guard lock(state().mutex);
    std::vector<std::string> out;
    for (const auto& [handle, made] : state().alive) out.emplace_back(made.by);
    return out;
}

std::uint64_t memory_bytes() {
    const std::lock_guard lock(state().mutex);
    std::uint64_t bytes = 0;
    for (const auto& [handle, made] : state().alive) bytes += made.bytes;
    return bytes;
}

std::vector<std::string> take_wrongs() {
    const std::lock_guard lock(state().mutex);
    return std::exchange(state().wrongs, {});
}

}  // namespace darkroom::gpu::test::failing
