// SPDX-License-Identifier: MIT
// Darkroom in a host that calls Vulkan by volk, takes all memory from the Vulkan Memory Allocator, Darkroom's too, and draws
// by dynamic rendering. It develops three pixels of light and prints them.

#define VOLK_IMPLEMENTATION
#include <volk.h>
#define VMA_IMPLEMENTATION
#define VMA_STATIC_VULKAN_FUNCTIONS 0
#define VMA_DYNAMIC_VULKAN_FUNCTIONS 1
#include <vk_mem_alloc.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <darkroom/darkroom.hpp>

namespace {

constexpr VkExtent2D extent{3, 1};
constexpr VkFormat hdr_format = VK_FORMAT_R16G16B16A16_SFLOAT, target_format = VK_FORMAT_R8G8B8A8_UNORM;

void check(VkResult result) {
    if (result == VK_SUCCESS) return;
    std::fprintf(stderr, "vma: VkResult %d\n", result);
    std::exit(2);
}
template <class T>
T check(darkroom::Result<T> result) {
    if (result) return *std::move(result);
    std::fprintf(stderr, "vma: %s\n", result.error().text.c_str());
    std::exit(2);
}

VkResult allocate(void* user, VkDevice, const darkroom::DeviceMemoryRequest* request, darkroom::DeviceMemory* memory) {
    const VkMemoryRequirements needs{request->size, request->alignment, 1U << request->memory_type};
    VmaAllocationCreateInfo how{};
    if (request->is_mapped) how.flags |= VMA_ALLOCATION_CREATE_MAPPED_BIT;
    if (request->prefers_dedicated) how.flags |= VMA_ALLOCATION_CREATE_DEDICATED_MEMORY_BIT;
    VmaAllocation allocation{};
    VmaAllocationInfo made{};
    const auto result = vmaAllocateMemory(static_cast<VmaAllocator>(user), &needs, &how, &allocation, &made);
    if (result == VK_SUCCESS) *memory = {made.deviceMemory, made.offset, made.pMappedData, allocation};
    return result;
}
void release(void* user, VkDevice, const darkroom::DeviceMemory* memory) {
    vmaFreeMemory(static_cast<VmaAllocator>(user), static_cast<VmaAllocation>(memory->owner));
}

struct Image {
    VkImage image{};
    VkImageView view{};
    VmaAllocation allocation{};
};

Image create_image(VkDevice device, VmaAllocator allocator, VkFormat format, VkImageUsageFlags usage) {
    const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                 .imageType = VK_IMAGE_TYPE_2D,
                                 .format = format,
                                 .extent = {extent.width, extent.height, 1},
                                 .mipLevels = 1,
                                 .arrayLayers = 1,
                                 .samples = VK_SAMPLE_COUNT_1_BIT,
                                 .usage = usage};
    const VmaAllocationCreateInfo how{.usage = VMA_MEMORY_USAGE_AUTO};
    Image out;
    check(vmaCreateImage(allocator, &info, &how, &out.image, &out.allocation, nullptr));
    const VkImageViewCreateInfo view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = out.image,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = format,
                                     .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    check(vkCreateImageView(device, &view, nullptr, &out.view));
    return out;
}

void barrier(VkCommandBuffer commands, const VkImageMemoryBarrier2* image, const VkMemoryBarrier2* memory) {
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .memoryBarrierCount = memory != nullptr,
                                      .pMemoryBarriers = memory,
                                      .imageMemoryBarrierCount = image != nullptr,
                                      .pImageMemoryBarriers = image};
    vkCmdPipelineBarrier2(commands, &dependency);
}

/// The host's scene: 0.18, 0.5 and 2.
void draw(VkCommandBuffer commands, const Image& hdr) {
    const VkImageMemoryBarrier2 first{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                      .dstStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                      .dstAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                      .newLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                      .image = hdr.image,
                                      .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    barrier(commands, &first, nullptr);
    const VkRenderingAttachmentInfo attachment{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                               .imageView = hdr.view,
                                               .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                               .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                               .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                    .renderArea = {{}, extent},
                                    .layerCount = 1,
                                    .colorAttachmentCount = 1,
                                    .pColorAttachments = &attachment};
    vkCmdBeginRendering(commands, &rendering);
    std::int32_t x = 0;
    for (const float light : {0.18f, 0.5f, 2.0f}) {
        const VkClearAttachment color{VK_IMAGE_ASPECT_COLOR_BIT, 0, {.color = {.float32 = {light, light, light, 1}}}};
        const VkClearRect pixel{{{x++, 0}, {1, 1}}, 0, 1};
        vkCmdClearAttachments(commands, 1, &color, 1, &pixel);
    }
    vkCmdEndRendering(commands);
}

}  // namespace

int main() {
    check(volkInitialize());
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo instance_info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                             .pApplicationInfo = &application};
    VkInstance instance{};
    check(vkCreateInstance(&instance_info, nullptr, &instance));
    volkLoadInstance(instance);
    std::uint32_t count = 1;
    VkPhysicalDevice gpu{};
    if (const VkResult found = vkEnumeratePhysicalDevices(instance, &count, &gpu); found != VK_INCOMPLETE) check(found);
    if (count == 0) check(VK_ERROR_INITIALIZATION_FAILED);
    VkPhysicalDeviceVulkan13Features features13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                .synchronization2 = VK_TRUE,
                                                .dynamicRendering = VK_TRUE};
    const VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features13};
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue_info{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                             .queueFamilyIndex = 0,
                                             .queueCount = 1,
                                             .pQueuePriorities = &priority};
    const VkDeviceCreateInfo device_info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                         .pNext = &features,
                                         .queueCreateInfoCount = 1,
                                         .pQueueCreateInfos = &queue_info};
    VkDevice device{};
    check(vkCreateDevice(gpu, &device_info, nullptr, &device));
    volkLoadDevice(device);
    VkQueue queue{};
    vkGetDeviceQueue(device, 0, 0, &queue);

    const VmaVulkanFunctions functions{.vkGetInstanceProcAddr = vkGetInstanceProcAddr,
                                       .vkGetDeviceProcAddr = vkGetDeviceProcAddr};
    const VmaAllocatorCreateInfo allocator_info{.physicalDevice = gpu,
                                                .device = device,
                                                .pVulkanFunctions = &functions,
                                                .instance = instance,
                                                .vulkanApiVersion = VK_API_VERSION_1_3};
    VmaAllocator allocator{};
    check(vmaCreateAllocator(&allocator_info, &allocator));
    const Image hdr = create_image(device, allocator, hdr_format,
                                   VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    const Image target = create_image(device, allocator, target_format,
                                      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    const VkBufferCreateInfo buffer_info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                         .size = 4 * extent.width,
                                         .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    const VmaAllocationCreateInfo mapped{
        .flags = VMA_ALLOCATION_CREATE_MAPPED_BIT | VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT,
        .usage = VMA_MEMORY_USAGE_AUTO};
    VkBuffer buffer{};
    VmaAllocation buffer_allocation{};
    VmaAllocationInfo buffer_memory{};
    check(vmaCreateBuffer(allocator, &buffer_info, &mapped, &buffer, &buffer_allocation, &buffer_memory));
    const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, .queueFamilyIndex = 0};
    VkCommandPool pool{};
    check(vkCreateCommandPool(device, &pool_info, nullptr, &pool));
    const VkCommandBufferAllocateInfo commands_info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                    .commandPool = pool,
                                                    .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                    .commandBufferCount = 1};
    VkCommandBuffer commands{};
    check(vkAllocateCommandBuffers(device, &commands_info, &commands));
    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check(vkBeginCommandBuffer(commands, &begin));
    draw(commands, hdr);

    {
        const darkroom::Device darkroom_device = check(
            darkroom::Device::adopt({.instance = instance,
                                     .physical_device = gpu,
                                     .device = device,
                                     .queue_family = 0,
                                     .enabled_features = &features,
                                     .get_proc = vkGetInstanceProcAddr,
                                     .memory = {.allocate = allocate, .free = release, .user = allocator}}));
        darkroom::Composer composer(darkroom_device);
        composer.add(darkroom::Exposure{.exposure = 1.5f});
        composer.add(darkroom::Tonemap{});
        composer.add(darkroom::Encode{});
        check(composer.compile({.max_extent = extent,
                                .color = {hdr_format},
                                .target = {target_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}}));
        if (const auto recorded =
                composer.record(commands, {.color = {.image = hdr.image,
                                                     .view = hdr.view,
                                                     .format = hdr_format,
                                                     .extent = extent,
                                                     .layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
                                           .target = {.image = target.image,
                                                      .view = target.view,
                                                      .format = target_format,
                                                      .extent = extent,
                                                      .final_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}});
            !recorded) {
            std::fprintf(stderr, "vma: %s\n", recorded.error().text.c_str());
            return 2;
        }

        const VkBufferImageCopy whole{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                      .imageExtent = {extent.width, extent.height, 1}};
        vkCmdCopyImageToBuffer(commands, target.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &whole);
        const VkMemoryBarrier2 to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                       .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                       .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                       .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                       .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
        barrier(commands, nullptr, &to_host);
        check(vkEndCommandBuffer(commands));
        const VkSubmitInfo submission{
            .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
        check(vkQueueSubmit(queue, 1, &submission, VK_NULL_HANDLE));
        check(vkQueueWaitIdle(queue));
        // The composer goes here: its recording has finished, and the allocator is still there.
    }
    check(vmaInvalidateAllocation(allocator, buffer_allocation, 0, VK_WHOLE_SIZE));
    const auto* const bytes = static_cast<const unsigned char*>(buffer_memory.pMappedData);
    for (std::uint32_t i = 0; i < extent.width; ++i)
        std::printf("%d %d %d\n", bytes[4 * i], bytes[4 * i + 1], bytes[4 * i + 2]);

    vkDestroyCommandPool(device, pool, nullptr);
    vmaDestroyBuffer(allocator, buffer, buffer_allocation);
    for (const Image& image : {hdr, target}) {
        vkDestroyImageView(device, image.view, nullptr);
        vmaDestroyImage(allocator, image.image, image.allocation);
    }
    vmaDestroyAllocator(allocator);  // a leak would be an assertion
    vkDestroyDevice(device, nullptr);
    vkDestroyInstance(instance, nullptr);
}
