// SPDX-License-Identifier: MIT
#pragma once
// A host that the examples in C share, with nothing of Darkroom in it: its instance, device, images and commands are made
// the ordinary way.

#include <stdio.h>
#include <stdlib.h>
#include <vulkan/vulkan.h>

enum { width = 640, height = 360 };

typedef struct Host {
    VkInstance instance;
    VkPhysicalDevice gpu;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    // What the device is created with, kept for Darkroom, because Vulkan cannot be asked for it later.
    VkPhysicalDeviceVulkan13Features features13;
    VkPhysicalDeviceFeatures2 features;
    // Of who shows pictures in a window: set before create_device(), which then enables VK_KHR_swapchain, too.
    const char** instance_extensions;
    uint32_t instance_extension_count;
} Host;

typedef struct Image {
    VkImage image;
    VkImageView view;
    VkDeviceMemory memory;
} Image;

static inline void check(VkResult result, const char* what) {
    if (result == VK_SUCCESS) return;
    fprintf(stderr, "%s: VkResult %d\n", what, (int)result);
    exit(2);
}

static inline void create_device(Host* host) {
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                           .pApplicationInfo = &application,
                                           .enabledExtensionCount = host->instance_extension_count,
                                           .ppEnabledExtensionNames = host->instance_extensions};
    check(vkCreateInstance(&instance, NULL, &host->instance), "vkCreateInstance");

    uint32_t count = 1;
    const VkResult found = vkEnumeratePhysicalDevices(host->instance, &count, &host->gpu);
    check(found == VK_INCOMPLETE ? VK_SUCCESS : found, "vkEnumeratePhysicalDevices");
    if (count == 0) check(VK_ERROR_INITIALIZATION_FAILED, "no Vulkan device");
    VkQueueFamilyProperties families[32];
    uint32_t family_count = 32;
    vkGetPhysicalDeviceQueueFamilyProperties(host->gpu, &family_count, families);
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    while (host->family < family_count && (families[host->family].queueFlags & wanted) != wanted) ++host->family;
    if (host->family == family_count) check(VK_ERROR_INITIALIZATION_FAILED, "no queue family with graphics and compute");

    host->features13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    host->features13.synchronization2 = VK_TRUE;
    host->features13.dynamicRendering = VK_TRUE;
    host->features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    host->features.pNext = &host->features13;
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = host->family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    const char* const swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    const VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                       .pNext = &host->features,
                                       .queueCreateInfoCount = 1,
                                       .pQueueCreateInfos = &queue,
                                       .enabledExtensionCount = host->instance_extension_count > 0,
                                       .ppEnabledExtensionNames = &swapchain};
    check(vkCreateDevice(host->gpu, &device, NULL, &host->device), "vkCreateDevice");
    vkGetDeviceQueue(host->device, host->family, 0, &host->queue);
}

static inline void destroy_device(const Host* host) {
    vkDestroyDevice(host->device, NULL);
    vkDestroyInstance(host->instance, NULL);
}

static inline VkDeviceMemory allocate(const Host* host, VkMemoryRequirements needs, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(host->gpu, &memory);
    uint32_t type = 0;
    while (type < memory.memoryTypeCount &&
           ((needs.memoryTypeBits >> type & 1u) == 0 || (memory.memoryTypes[type].propertyFlags & wanted) != wanted))
        ++type;
    const VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size, .memoryTypeIndex = type};
    VkDeviceMemory out = VK_NULL_HANDLE;
    check(vkAllocateMemory(host->device, &info, NULL, &out), "vkAllocateMemory");
    return out;
}

static inline VkImageView create_view(const Host* host, VkImage image, VkFormat format) {
    const VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = image,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = format,
                                        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    VkImageView out = VK_NULL_HANDLE;
    check(vkCreateImageView(host->device, &info, NULL, &out), "vkCreateImageView");
    return out;
}

static inline Image create_image(const Host* host, VkFormat format, VkImageUsageFlags usage) {
    Image out = {0};
    const VkImageCreateInfo image = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                     .imageType = VK_IMAGE_TYPE_2D,
                                     .format = format,
                                     .extent = {width, height, 1},
                                     .mipLevels = 1,
                                     .arrayLayers = 1,
                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                     .usage = usage};
    check(vkCreateImage(host->device, &image, NULL, &out.image), "vkCreateImage");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(host->device, out.image, &needs);
    out.memory = allocate(host, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check(vkBindImageMemory(host->device, out.image, out.memory, 0), "vkBindImageMemory");
    out.view = create_view(host, out.image, format);
    return out;
}

static inline void destroy_image(const Host* host, Image image) {
    vkDestroyImageView(host->device, image.view, NULL);
    vkDestroyImage(host->device, image.image, NULL);
    vkFreeMemory(host->device, image.memory, NULL);
}

/// A barrier of all commands around one image.
static inline void change_layout(VkCommandBuffer commands, Image image, VkImageLayout from, VkImageLayout to) {
    const VkImageMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                           .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                           .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                           .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                           .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                                           .oldLayout = from,
                                           .newLayout = to,
                                           .image = image.image,
                                           .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    const VkDependencyInfo dependency = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &dependency);
}

/// The host's scene: rows of lamps, from a hundredth to sixteen times the white of a display.
static inline void draw_scene(VkCommandBuffer commands, Image hdr) {
    change_layout(commands, hdr, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    const VkRenderingAttachmentInfo attachment = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                                  .imageView = hdr.view,
                                                  .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                                  .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                  .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                  .clearValue = {.color = {.float32 = {0.01f, 0.012f, 0.02f, 1}}}};
    const VkRenderingInfo rendering = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                       .renderArea = {{0, 0}, {width, height}},
                                       .layerCount = 1,
                                       .colorAttachmentCount = 1,
                                       .pColorAttachments = &attachment};
    vkCmdBeginRendering(commands, &rendering);
    for (int row = 0; row < 3; ++row) {
        float strength = 0.01f;
        for (int column = 0; column < 11; ++column, strength *= 2.1f) {
            const VkClearAttachment color = {
                .aspectMask = VK_IMAGE_ASPECT_COLOR_BIT,
                .clearValue = {.color = {.float32 = {row == 1 ? 0.3f * strength : strength, 0.6f * strength,
                                                     row == 0 ? 0.3f * strength : strength, 1}}}};
            const VkClearRect lamp = {.rect = {{30 + column * 54, 60 + row * 100}, {36, 36}}, .layerCount = 1};
            vkCmdClearAttachments(commands, 1, &color, 1, &lamp);
        }
    }
    vkCmdEndRendering(commands);
}

/// The scene in the target as it is: what is brighter than white is white. Both are in TRANSFER_SRC_OPTIMAL then.
static inline void copy_scene(VkCommandBuffer commands, Image hdr, Image target) {
    change_layout(commands, hdr, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    change_layout(commands, target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkImageBlit whole = {.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                               .srcOffsets = {{0, 0, 0}, {width, height, 1}},
                               .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                               .dstOffsets = {{0, 0, 0}, {width, height, 1}}};
    vkCmdBlitImage(commands, hdr.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole, VK_FILTER_NEAREST);
    change_layout(commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

static inline VkCommandPool create_pool(const Host* host) {
    const VkCommandPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = host->family};
    VkCommandPool out = VK_NULL_HANDLE;
    check(vkCreateCommandPool(host->device, &info, NULL, &out), "vkCreateCommandPool");
    return out;
}

static inline VkCommandBuffer create_commands(const Host* host, VkCommandPool pool) {
    const VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .commandPool = pool,
                                              .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                              .commandBufferCount = 1};
    VkCommandBuffer out = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(host->device, &info, &out), "vkAllocateCommandBuffers");
    return out;
}

/// What the host copies its pictures to, and how it sends commands.
typedef struct Output {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkCommandPool pool;
    VkCommandBuffer commands;
} Output;

static inline Output create_output(const Host* host) {
    Output out = {0};
    const VkBufferCreateInfo buffer = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                       .size = 4 * width * height,
                                       .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    check(vkCreateBuffer(host->device, &buffer, NULL, &out.buffer), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(host->device, out.buffer, &needs);
    out.memory = allocate(host, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    check(vkBindBufferMemory(host->device, out.buffer, out.memory, 0), "vkBindBufferMemory");
    out.pool = create_pool(host);
    out.commands = create_commands(host, out.pool);
    return out;
}

/// Copies the picture, runs all that was recorded, and waits for it.
static inline void submit(const Host* host, Output output, Image target) {
    const VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                      .imageExtent = {width, height, 1}};
    vkCmdCopyImageToBuffer(output.commands, target.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, output.buffer, 1,
                           &region);
    const VkMemoryBarrier2 to_host = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                      .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                      .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                      .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                      .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo dependency = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
    vkCmdPipelineBarrier2(output.commands, &dependency);
    check(vkEndCommandBuffer(output.commands), "vkEndCommandBuffer");
    const VkSubmitInfo info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &output.commands};
    check(vkQueueSubmit(host->queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
    check(vkQueueWaitIdle(host->queue), "vkQueueWaitIdle");
}

static inline void* load(const char* path, size_t* size) {
    FILE* const file = fopen(path, "rb");
    if (file == NULL) {
        fprintf(stderr, "%s cannot be read\n", path);
        exit(2);
    }
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    void* const content = malloc(*size);
    if (content == NULL || fread(content, 1, *size, file) != *size) exit(2);
    fclose(file);
    return content;
}

static inline void save(const Host* host, Output output, const char* path) {
    void* mapped = NULL;
    check(vkMapMemory(host->device, output.memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
    FILE* const file = fopen(path, "wb");
    if (file == NULL) {
        fprintf(stderr, "%s cannot be written\n", path);
        exit(2);
    }
    fprintf(file, "P6\n%d %d\n255\n", width, height);
    for (size_t i = 0; i < (size_t)width * height; ++i) fwrite((const unsigned char*)mapped + 4 * i, 1, 3, file);
    fclose(file);
}

static inline void destroy_output(const Host* host, Output output) {
    vkDestroyBuffer(host->device, output.buffer, NULL);
    vkFreeMemory(host->device, output.memory, NULL);
    vkDestroyCommandPool(host->device, output.pool, NULL);
}
