// SPDX-License-Identifier: MIT
#include "gpu/device/dispatch.hpp"

#include <string>

namespace darkroom::gpu {

namespace {

/// Fills members one by one and remembers the names of those that the driver does not have.
template <class GetProc, class Handle>
class Loader {
  public:
    Loader(GetProc get_proc, Handle handle) : get_proc_(get_proc), handle_(handle) {}

    template <class Function>
    void operator()(Function& member, const char* name) {
        member = reinterpret_cast<Function>(get_proc_(handle_, name));
        if (member != nullptr) return;
        if (!missing_.empty()) missing_ += ", ";
        missing_ += name;
    }
    [[nodiscard]] Result<> result() const {
        if (missing_.empty()) return {};
        return machine_error("the Vulkan driver lacks the functions " + missing_, ErrorCode::Unsupported);
    }

  private:
    GetProc get_proc_;
    Handle handle_;
    std::string missing_;
};

template <class Load>
void load_loader_functions(Dispatch& table, Load& load) {
    load(table.CreateInstance, "vkCreateInstance");
    load(table.EnumerateInstanceVersion, "vkEnumerateInstanceVersion");
    load(table.EnumerateInstanceLayerProperties, "vkEnumerateInstanceLayerProperties");
    load(table.EnumerateInstanceExtensionProperties, "vkEnumerateInstanceExtensionProperties");
}

template <class Load>
void load_instance_functions(Dispatch& table, Load& load) {
    load(table.DestroyInstance, "vkDestroyInstance");
    load(table.EnumeratePhysicalDevices, "vkEnumeratePhysicalDevices");
    load(table.GetPhysicalDeviceProperties, "vkGetPhysicalDeviceProperties");
    load(table.GetPhysicalDeviceProperties2, "vkGetPhysicalDeviceProperties2");
    load(table.GetPhysicalDeviceFeatures2, "vkGetPhysicalDeviceFeatures2");
    load(table.GetPhysicalDeviceFormatProperties, "vkGetPhysicalDeviceFormatProperties");
    load(table.GetPhysicalDeviceFormatProperties2, "vkGetPhysicalDeviceFormatProperties2");
    load(table.GetPhysicalDeviceMemoryProperties, "vkGetPhysicalDeviceMemoryProperties");
    load(table.GetPhysicalDeviceQueueFamilyProperties, "vkGetPhysicalDeviceQueueFamilyProperties");
    load(table.EnumerateDeviceExtensionProperties, "vkEnumerateDeviceExtensionProperties");
    load(table.CreateDevice, "vkCreateDevice");
    load(table.GetDeviceProcAddr, "vkGetDeviceProcAddr");
}

template <class Load>
void load_device_functions(Dispatch& table, Load& load) {
    load(table.DestroyDevice, "vkDestroyDevice");
    load(table.DeviceWaitIdle, "vkDeviceWaitIdle");
    load(table.GetDeviceQueue, "vkGetDeviceQueue");
    load(table.AllocateMemory, "vkAllocateMemory");
    load(table.FreeMemory, "vkFreeMemory");
    load(table.MapMemory, "vkMapMemory");
    load(table.CreateBuffer, "vkCreateBuffer");
    load(table.DestroyBuffer, "vkDestroyBuffer");
    load(table.GetBufferMemoryRequirements2, "vkGetBufferMemoryRequirements2");
    load(table.BindBufferMemory, "vkBindBufferMemory");
    load(table.CreateImage, "vkCreateImage");
    load(table.DestroyImage, "vkDestroyImage");
    load(table.GetImageMemoryRequirements2, "vkGetImageMemoryRequirements2");
    load(table.BindImageMemory, "vkBindImageMemory");
    load(table.CreateImageView, "vkCreateImageView");
    load(table.DestroyImageView, "vkDestroyImageView");
    load(table.CreateSampler, "vkCreateSampler");
    load(table.DestroySampler, "vkDestroySampler");
    load(table.CreateShaderModule, "vkCreateShaderModule");
    load(table.DestroyShaderModule, "vkDestroyShaderModule");
    load(table.CreatePipelineCache, "vkCreatePipelineCache");
    load(table.DestroyPipelineCache, "vkDestroyPipelineCache");
    load(table.GetPipelineCacheData, "vkGetPipelineCacheData");
    load(table.CreateComputePipelines, "vkCreateComputePipelines");
    load(table.CreateGraphicsPipelines, "vkCreateGraphicsPipelines");
    load(table.DestroyPipeline, "vkDestroyPipeline");
    load(table.CreatePipelineLayout, "vkCreatePipelineLayout");
    load(table.DestroyPipelineLayout, "vkDestroyPipelineLayout");
    load(table.CreateDescriptorSetLayout, "vkCreateDescriptorSetLayout");
    load(table.DestroyDescriptorSetLayout, "vkDestroyDescriptorSetLayout");
    load(table.CreateDescriptorPool, "vkCreateDescriptorPool");
    load(table.DestroyDescriptorPool, "vkDestroyDescriptorPool");
    load(table.AllocateDescriptorSets, "vkAllocateDescriptorSets");
    load(table.UpdateDescriptorSets, "vkUpdateDescriptorSets");
    load(table.CreateQueryPool, "vkCreateQueryPool");
    load(table.DestroyQueryPool, "vkDestroyQueryPool");
    load(table.GetQueryPoolResults, "vkGetQueryPoolResults");
    load(table.ResetQueryPool, "vkResetQueryPool");
    load(table.CreateFence, "vkCreateFence");
    load(table.DestroyFence, "vkDestroyFence");
    load(table.ResetFences, "vkResetFences");
    load(table.WaitForFences, "vkWaitForFences");
    load(table.CreateCommandPool, "vkCreateCommandPool");
    load(table.DestroyCommandPool, "vkDestroyCommandPool");
    load(table.ResetCommandPool, "vkResetCommandPool");
    load(table.AllocateCommandBuffers, "vkAllocateCommandBuffers");
    load(table.BeginCommandBuffer, "vkBeginCommandBuffer");
    load(table.EndCommandBuffer, "vkEndCommandBuffer");
    load(table.CmdBindPipeline, "vkCmdBindPipeline");
    load(table.CmdBindDescriptorSets, "vkCmdBindDescriptorSets");
    load(table.CmdPushConstants, "vkCmdPushConstants");
    load(table.CmdDispatch, "vkCmdDispatch");
    load(table.CmdSetViewport, "vkCmdSetViewport");
    load(table.CmdSetScissor, "vkCmdSetScissor");
    load(table.CmdBindVertexBuffers, "vkCmdBindVertexBuffers");
    load(table.CmdBindIndexBuffer, "vkCmdBindIndexBuffer");
    load(table.CmdDraw, "vkCmdDraw");
    load(table.CmdDrawIndexed, "vkCmdDrawIndexed");
    load(table.CmdCopyBuffer, "vkCmdCopyBuffer");
    load(table.CmdFillBuffer, "vkCmdFillBuffer");
    load(table.CmdBlitImage, "vkCmdBlitImage");
    load(table.CmdCopyImage, "vkCmdCopyImage");
    load(table.CmdCopyBufferToImage, "vkCmdCopyBufferToImage");
    load(table.CmdCopyImageToBuffer, "vkCmdCopyImageToBuffer");
    load(table.CmdClearColorImage, "vkCmdClearColorImage");
    load(table.CmdClearDepthStencilImage, "vkCmdClearDepthStencilImage");
    load(table.CmdResetQueryPool, "vkCmdResetQueryPool");
}

template <class Load>
void load_promoted_functions(Dispatch& table, Load& load, PromotedNames names) {
    const bool is_core = names == PromotedNames::Core;
    load(table.QueueSubmit2, is_core ? "vkQueueSubmit2" : "vkQueueSubmit2KHR");
    load(table.CmdPipelineBarrier2, is_core ? "vkCmdPipelineBarrier2" : "vkCmdPipelineBarrier2KHR");
    load(table.CmdWriteTimestamp2, is_core ? "vkCmdWriteTimestamp2" : "vkCmdWriteTimestamp2KHR");
    load(table.CmdBeginRendering, is_core ? "vkCmdBeginRendering" : "vkCmdBeginRenderingKHR");
    load(table.CmdEndRendering, is_core ? "vkCmdEndRendering" : "vkCmdEndRenderingKHR");
}

}  // namespace

Result<> Dispatch::load_loader(PFN_vkGetInstanceProcAddr get_proc) {
    Dispatch& table = *this;
    GetInstanceProcAddr = get_proc;
    Loader load(get_proc, VkInstance{VK_NULL_HANDLE});
    load_loader_functions(table, load);
    return load.result();
}

Result<> Dispatch::load_instance(VkInstance instance, bool has_debug_utils) {
    Dispatch& table = *this;
    Loader load(GetInstanceProcAddr, instance);
    load_instance_functions(table, load);
    if (has_debug_utils) {
        load(table.CreateDebugUtilsMessengerEXT, "vkCreateDebugUtilsMessengerEXT");
        load(table.DestroyDebugUtilsMessengerEXT, "vkDestroyDebugUtilsMessengerEXT");
    }
    return load.result();
}

Result<> Dispatch::load_device(VkDevice device, bool has_debug_utils, PromotedNames names) {
    Dispatch& table = *this;
    Loader load(GetDeviceProcAddr, device);
    load_device_functions(table, load);
    load_promoted_functions(table, load, names);
    if (has_debug_utils) {
        load(table.SetDebugUtilsObjectNameEXT, "vkSetDebugUtilsObjectNameEXT");
        load(table.CmdBeginDebugUtilsLabelEXT, "vkCmdBeginDebugUtilsLabelEXT");
        load(table.CmdEndDebugUtilsLabelEXT, "vkCmdEndDebugUtilsLabelEXT");
    }
    return load.result();
}

Result<> Dispatch::load_statistics(VkDevice device) {
    Loader load(GetDeviceProcAddr, device);
    load(GetPipelineExecutablePropertiesKHR, "vkGetPipelineExecutablePropertiesKHR");
    load(GetPipelineExecutableStatisticsKHR, "vkGetPipelineExecutableStatisticsKHR");
    load(GetPipelineExecutableInternalRepresentationsKHR, "vkGetPipelineExecutableInternalRepresentationsKHR");
    return load.result();
}

}  // namespace darkroom::gpu
