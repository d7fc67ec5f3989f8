// SPDX-License-Identifier: MIT
// Darkroom in front of a bare swapchain, in a window of GLFW: its target is the image that is shown. Nothing is drawn in
// between; two frames are in flight.
//     swapchain [FRAMES]
// Without a number it runs until its window is closed.

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <darkroom/darkroom.h>

#include "host.h"

enum { in_flight = 2, max_images = 8 };

static void need(DarkroomResult result) {
    if (result == DARKROOM_OK) return;
    fprintf(stderr, "swapchain: %s\n", darkroom_error());
    exit(2);
}

/// The host's part of a frame.
typedef struct Slot {
    VkCommandBuffer commands;
    VkSemaphore acquired;
    VkFence finished;
} Slot;

typedef struct Swapchain {
    VkSwapchainKHR swapchain;
    uint32_t count;
    VkImage images[max_images];
    VkImageView views[max_images];
    VkSemaphore rendered[max_images];
} Swapchain;

static VkSemaphore create_semaphore(const Host* host) {
    const VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore out = VK_NULL_HANDLE;
    check(vkCreateSemaphore(host->device, &info, NULL, &out), "vkCreateSemaphore");
    return out;
}

static Swapchain create_swapchain(const Host* host, VkSurfaceKHR surface, VkFormat format) {
    VkSurfaceCapabilitiesKHR can;
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(host->gpu, surface, &can), "the surface");
    VkBool32 presents = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(host->gpu, host->family, surface, &presents), "the surface");
    if (!presents) check(VK_ERROR_INITIALIZATION_FAILED, "no queue that presents");
    const VkSwapchainCreateInfoKHR info = {.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                           .surface = surface,
                                           .minImageCount = can.minImageCount,
                                           .imageFormat = format,
                                           .imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR,
                                           .imageExtent = {width, height},
                                           .imageArrayLayers = 1,
                                           .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                           .preTransform = can.currentTransform,
                                           .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                           .presentMode = VK_PRESENT_MODE_FIFO_KHR,
                                           .clipped = VK_TRUE};
    Swapchain out = {.count = max_images};
    check(vkCreateSwapchainKHR(host->device, &info, NULL, &out.swapchain), "vkCreateSwapchainKHR");
    check(vkGetSwapchainImagesKHR(host->device, out.swapchain, &out.count, out.images), "vkGetSwapchainImagesKHR");
    for (uint32_t i = 0; i < out.count; ++i) {
        out.views[i] = create_view(host, out.images[i], format);
        out.rendered[i] = create_semaphore(host);
    }
    return out;
}

int main(int argc, char** argv) {
    const long frame_count = argc > 1 ? atol(argv[1]) : -1;
    if (!glfwInit()) check(VK_ERROR_INITIALIZATION_FAILED, "no display");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
    GLFWwindow* const window = glfwCreateWindow(width, height, "Darkroom", NULL, NULL);
    Host host = {0};
    host.instance_extensions = glfwGetRequiredInstanceExtensions(&host.instance_extension_count);
    create_device(&host);
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    check(glfwCreateWindowSurface(host.instance, window, NULL, &surface), "glfwCreateWindowSurface");
    const VkFormat hdr_format = VK_FORMAT_R16G16B16A16_SFLOAT, shown_format = VK_FORMAT_B8G8R8A8_UNORM;
    const Swapchain shown = create_swapchain(&host, surface, shown_format);
    const Image hdr = create_image(&host, hdr_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    const VkCommandPool pool = create_pool(&host);
    Slot slots[in_flight];
    for (int i = 0; i < in_flight; ++i) {
        const VkFenceCreateInfo signaled = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                            .flags = VK_FENCE_CREATE_SIGNALED_BIT};
        slots[i].commands = create_commands(&host, pool);
        slots[i].acquired = create_semaphore(&host);
        check(vkCreateFence(host.device, &signaled, NULL, &slots[i].finished), "vkCreateFence");
    }

    // Once.
    const DarkroomAdoptDesc adopt = {sizeof adopt, .instance = host.instance, .physical_device = host.gpu,
                                     .device = host.device, .queue_family = host.family,
                                     .enabled_features = &host.features, .get_proc = vkGetInstanceProcAddr};
    const DarkroomComposerDesc frames = {sizeof frames, .frames_in_flight = in_flight};
    const DarkroomImageUse target = {sizeof target, .format = shown_format};
    const DarkroomCompileDesc desc = {sizeof desc, .max_extent = {width, height}, .target = &target};
    DarkroomDevice device = NULL;
    DarkroomComposer composer = NULL;
    DarkroomHandle bloom = 0, exposure = 0;
    need(darkroom_device_adopt(&adopt, &device));
    need(darkroom_composer_create(device, &frames, &composer));
    need(darkroom_composer_add(composer, "bloom", NULL, &bloom));
    need(darkroom_composer_set_number(composer, bloom, "intensity", 0.08));
    need(darkroom_composer_add(composer, "exposure", NULL, &exposure));
    need(darkroom_composer_set_number(composer, exposure, "exposure", 1.5));
    need(darkroom_composer_add(composer, "tonemap", NULL, NULL));
    need(darkroom_composer_add(composer, "encode", NULL, NULL));
    need(darkroom_composer_compile(composer, &desc, NULL));

    for (long n = 0; n != frame_count && !glfwWindowShouldClose(window); ++n) {
        glfwPollEvents();
        const Slot* const slot = &slots[n % in_flight];
        // The recording that this one takes the place of has finished.
        check(vkWaitForFences(host.device, 1, &slot->finished, VK_TRUE, UINT64_MAX), "vkWaitForFences");
        uint32_t index = 0;
        check(vkAcquireNextImageKHR(host.device, shown.swapchain, UINT64_MAX, slot->acquired, VK_NULL_HANDLE, &index),
              "vkAcquireNextImageKHR");
        check(vkResetFences(host.device, 1, &slot->finished), "vkResetFences");
        const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        check(vkBeginCommandBuffer(slot->commands, &begin), "vkBeginCommandBuffer");
        draw_scene(slot->commands, hdr);
        const DarkroomImage color = {sizeof color, .image = hdr.image, .view = hdr.view, .format = hdr_format,
                                     .extent = {width, height}, .layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        const DarkroomImage picture = {
            sizeof picture, .image = shown.images[index], .view = shown.views[index], .format = shown_format,
            .extent = {width, height}, .final_layout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
            // Where the submission waits for the image.
            .last_stages = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT};
        const DarkroomFrame frame = {sizeof frame, .color = &color, .target = &picture, .frame_index = (uint64_t)n};
        need(darkroom_composer_record(composer, slot->commands, &frame));
        check(vkEndCommandBuffer(slot->commands), "vkEndCommandBuffer");
        const VkPipelineStageFlags waits = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
        const VkSubmitInfo submission = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .waitSemaphoreCount = 1,
                                         .pWaitSemaphores = &slot->acquired, .pWaitDstStageMask = &waits,
                                         .commandBufferCount = 1, .pCommandBuffers = &slot->commands,
                                         .signalSemaphoreCount = 1, .pSignalSemaphores = &shown.rendered[index]};
        check(vkQueueSubmit(host.queue, 1, &submission, slot->finished), "vkQueueSubmit");
        const VkPresentInfoKHR present = {.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR, .waitSemaphoreCount = 1,
                                          .pWaitSemaphores = &shown.rendered[index], .swapchainCount = 1,
                                          .pSwapchains = &shown.swapchain, .pImageIndices = &index};
        check(vkQueuePresentKHR(host.queue, &present), "vkQueuePresentKHR");
    }

    check(vkDeviceWaitIdle(host.device), "vkDeviceWaitIdle");
    darkroom_composer_destroy(composer);
    darkroom_device_destroy(device);
    for (int i = 0; i < in_flight; ++i) {
        vkDestroySemaphore(host.device, slots[i].acquired, NULL);
        vkDestroyFence(host.device, slots[i].finished, NULL);
    }
    vkDestroyCommandPool(host.device, pool, NULL);
    destroy_image(&host, hdr);
    for (uint32_t i = 0; i < shown.count; ++i) {
        vkDestroyImageView(host.device, shown.views[i], NULL);
        vkDestroySemaphore(host.device, shown.rendered[i], NULL);
    }
    vkDestroySwapchainKHR(host.device, shown.swapchain, NULL);
    vkDestroySurfaceKHR(host.instance, surface, NULL);
    destroy_device(&host);
    glfwTerminate();
    return 0;
}
