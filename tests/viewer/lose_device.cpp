// SPDX-License-Identifier: MIT
// Put before the C library by LD_PRELOAD: the program loads this in place of the Vulkan loader, which it passes on to.
// SIGUSR1 makes the device a lost one, until another is made.
#include <dlfcn.h>
#include <signal.h>
#include <vulkan/vulkan.h>

#include <atomic>
#include <cstring>
#include <string_view>

namespace {

using Open = void* (*)(const char*, int);

std::atomic<bool> is_lost{false};
PFN_vkGetInstanceProcAddr real_instance_proc = nullptr;
PFN_vkGetDeviceProcAddr real_device_proc = nullptr;
PFN_vkCreateDevice real_create_device = nullptr;
PFN_vkQueueSubmit2 real_submit = nullptr;
PFN_vkWaitSemaphores real_wait = nullptr;
PFN_vkDeviceWaitIdle real_wait_idle = nullptr;

VkResult create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                       const VkAllocationCallbacks* allocator, VkDevice* device) {
    is_lost = false;
    return real_create_device(physical, info, allocator, device);
}

VkResult submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* infos, VkFence fence) {
    return is_lost ? VK_ERROR_DEVICE_LOST : real_submit(queue, count, infos, fence);
}

VkResult wait(VkDevice device, const VkSemaphoreWaitInfo* info, std::uint64_t timeout) {
    return is_lost ? VK_ERROR_DEVICE_LOST : real_wait(device, info, timeout);
}

/// What was submitted before has to end, so that nothing is destroyed that is in use.
VkResult wait_idle(VkDevice device) {
    const VkResult result = real_wait_idle(device);
    return is_lost ? VK_ERROR_DEVICE_LOST : result;
}

template <class Function>
PFN_vkVoidFunction between(PFN_vkVoidFunction found, Function& real, Function ours) {
    if (found == nullptr) return nullptr;
    real = reinterpret_cast<Function>(found);
    return reinterpret_cast<PFN_vkVoidFunction>(ours);
}

PFN_vkVoidFunction of_device(PFN_vkVoidFunction found, std::string_view name) {
    if (name == "vkQueueSubmit2" || name == "vkQueueSubmit2KHR") return between(found, real_submit, &submit);
    if (name == "vkWaitSemaphores" || name == "vkWaitSemaphoresKHR") return between(found, real_wait, &wait);
    if (name == "vkDeviceWaitIdle") return between(found, real_wait_idle, &wait_idle);
    return found;
}

PFN_vkVoidFunction device_proc(VkDevice device, const char* name) {
    return of_device(real_device_proc(device, name), name);
}

}  // namespace

extern "C" [[gnu::visibility("default")]] PFN_vkVoidFunction vkGetInstanceProcAddr(VkInstance instance,
                                                                                   const char* name) {
    if (std::strcmp(name, "vkGetInstanceProcAddr") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(&vkGetInstanceProcAddr);
    const PFN_vkVoidFunction found = real_instance_proc(instance, name);
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return between(found, real_device_proc, &device_proc);
    if (std::strcmp(name, "vkCreateDevice") == 0) return between(found, real_create_device, &create_device);
    return of_device(found, name);
}

extern "C" [[gnu::visibility("default")]] void* dlopen(const char* name, int flags) {
    const auto open = reinterpret_cast<Open>(::dlsym(RTLD_NEXT, "dlopen"));
    void* const handle = open(name, flags);
    if (handle == nullptr || name == nullptr || std::string_view(name) != "libvulkan.so.1") return handle;
    real_instance_proc = reinterpret_cast<PFN_vkGetInstanceProcAddr>(::dlsym(handle, "vkGetInstanceProcAddr"));
    struct sigaction action {};
    action.sa_handler = [](int) { is_lost = true; };
    ::sigaction(SIGUSR1, &action, nullptr);
    Dl_info own{};
    return ::dladdr(reinterpret_cast<void*>(&vkGetInstanceProcAddr), &own) != 0 ? open(own.dli_fname, flags) : handle;
}
