// SPDX-License-Identifier: MIT
#include "window/surface_functions.hpp"

#include <type_traits>

namespace darkroom::window {

bool SurfaceFunctions::load(const gpu::Context& context) {
    bool is_complete = true;
    const auto of_instance = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
            context.vk.GetInstanceProcAddr(context.instance, name));
        is_complete = is_complete && function != nullptr;
    };
    const auto of_device = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
            context.vk.GetDeviceProcAddr(context.device, name));
        is_complete = is_complete && function != nullptr;
    };
    of_instance(GetPhysicalDeviceSurfaceSupportKHR, "vkGetPhysicalDeviceSurfaceSupportKHR");
    of_instance(GetPhysicalDeviceSurfaceCapabilitiesKHR, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
    of_instance(GetPhysicalDeviceSurfaceFormatsKHR, "vkGetPhysicalDeviceSurfaceFormatsKHR");
    of_instance(GetPhysicalDeviceSurfacePresentModesKHR, "vkGetPhysicalDeviceSurfacePresentModesKHR");
    of_instance(DestroySurfaceKHR, "vkDestroySurfaceKHR");
    of_device(CreateSwapchainKHR, "vkCreateSwapchainKHR");
    of_device(DestroySwapchainKHR, "vkDestroySwapchainKHR");
    of_device(GetSwapchainImagesKHR, "vkGetSwapchainImagesKHR");
    of_device(AcquireNextImageKHR, "vkAcquireNextImageKHR");
    of_device(QueuePresentKHR, "vkQueuePresentKHR");
    of_device(CreateSemaphore, "vkCreateSemaphore");
    of_device(DestroySemaphore, "vkDestroySemaphore");
    of_device(WaitSemaphores, "vkWaitSemaphores");
    of_device(GetSemaphoreCounterValue, "vkGetSemaphoreCounterValue");
    SetHdrMetadataEXT =
        reinterpret_cast<PFN_vkSetHdrMetadataEXT>(context.vk.GetDeviceProcAddr(context.device, "vkSetHdrMetadataEXT"));
    return is_complete;
}

}  // namespace darkroom::window
