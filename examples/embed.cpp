// SPDX-License-Identifier: MIT
// Darkroom inside a host that owns Vulkan: the host makes its instance, device, images and command buffer the ordinary
// way, draws an HDR picture, lets Darkroom record its stack between commands of its own, and saves the result.
//     embed [PICTURE.ppm [KERNELS.dkb]]
// The second file holds the kernels of the stack, from `darkroom bake`; without it the library compiles them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <darkroom/darkroom.hpp>
#include <vector>

namespace {

constexpr VkExtent2D extent{640, 360};

/// The host's camera, at the origin: 60 degrees high, 16 : 9, clip space as Vulkan has it, from 0.1 to 100.
constexpr darkroom::Camera camera{
    .projection = {0.9742786f, 0, 0, 0, 0, -1.7320508f, 0, 0, 0, 0, 100.0f / (0.1f - 100.0f), -1, 0, 0,
                   0.1f * 100.0f / (0.1f - 100.0f), 0},
    .near_distance = 0.1f,
    .far_distance = 100.0f};

void check(VkResult result, const char* what) {
    if (result == VK_SUCCESS) return;
    std::fprintf(stderr, "embed: %s: VkResult %d\n", what, result);
    std::exit(2);
}
template <class T>
T check(darkroom::Result<T> result) {
    if (!result) {
        std::fprintf(stderr, "embed: %s\n", result.error().text.c_str());
        std::exit(2);
    }
    if constexpr (!std::is_void_v<T>) return std::move(*result);
}

struct Host {
    VkInstance instance{};
    VkPhysicalDevice gpu{};
    VkDevice device{};
    VkQueue queue{};
    std::uint32_t family = 0;
    // What the device is created with, kept for Darkroom, because Vulkan cannot be asked for it later.
    VkPhysicalDeviceVulkan13Features features13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                .synchronization2 = VK_TRUE,
                                                .dynamicRendering = VK_TRUE};
    VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features13};
};

void create_device(Host& host) {
    const VkApplicationInfo application{
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .pApplicationName = "embed", .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo instance{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                        .pApplicationInfo = &application};
    check(vkCreateInstance(&instance, nullptr, &host.instance), "vkCreateInstance");

    std::uint32_t count = 1;
    const VkResult found = vkEnumeratePhysicalDevices(host.instance, &count, &host.gpu);
    check(found == VK_INCOMPLETE ? VK_SUCCESS : found, "vkEnumeratePhysicalDevices");
    if (count == 0) check(VK_ERROR_INITIALIZATION_FAILED, "no Vulkan device");
    std::uint32_t family_count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(host.gpu, &family_count, nullptr);
    std::vector<VkQueueFamilyProperties> families(family_count);
    vkGetPhysicalDeviceQueueFamilyProperties(host.gpu, &family_count, families.data());
    constexpr VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    while (host.family < family_count && (families[host.family].queueFlags & wanted) != wanted) ++host.family;
    if (host.family == family_count) check(VK_ERROR_INITIALIZATION_FAILED, "no queue family with graphics and compute");

    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueFamilyIndex = host.family,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    const VkDeviceCreateInfo device{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                    .pNext = &host.features,
                                    .queueCreateInfoCount = 1,
                                    .pQueueCreateInfos = &queue};
    check(vkCreateDevice(host.gpu, &device, nullptr, &host.device), "vkCreateDevice");
    vkGetDeviceQueue(host.device, host.family, 0, &host.queue);
}

VkDeviceMemory allocate(const Host& host, const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(host.gpu, &memory);
    std::uint32_t type = 0;
    while (type < memory.memoryTypeCount &&
           ((needs.memoryTypeBits >> type & 1u) == 0 || (memory.memoryTypes[type].propertyFlags & wanted) != wanted))
        ++type;
    const VkMemoryAllocateInfo info{
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size, .memoryTypeIndex = type};
    VkDeviceMemory out{};
    check(vkAllocateMemory(host.device, &info, nullptr, &out), "vkAllocateMemory");
    return out;
}

struct Image {
    VkFormat format{};
    VkImage image{};
    VkImageView view{};
    VkDeviceMemory memory{};
};

Image create_image(const Host& host, VkFormat format, VkImageUsageFlags usage) {
    Image out{.format = format};
    const VkImageCreateInfo image{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                  .imageType = VK_IMAGE_TYPE_2D,
                                  .format = format,
                                  .extent = {extent.width, extent.height, 1},
                                  .mipLevels = 1,
                                  .arrayLayers = 1,
                                  .samples = VK_SAMPLE_COUNT_1_BIT,
                                  .usage = usage};
    check(vkCreateImage(host.device, &image, nullptr, &out.image), "vkCreateImage");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(host.device, out.image, &needs);
    out.memory = allocate(host, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check(vkBindImageMemory(host.device, out.image, out.memory, 0), "vkBindImageMemory");
    const VkImageViewCreateInfo view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = out.image,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = format,
                                     .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    check(vkCreateImageView(host.device, &view, nullptr, &out.view), "vkCreateImageView");
    return out;
}

void destroy(const Host& host, const Image& image) {
    vkDestroyImageView(host.device, image.view, nullptr);
    vkDestroyImage(host.device, image.image, nullptr);
    vkFreeMemory(host.device, image.memory, nullptr);
}

/// The host's scene: rows of lamps, from a hundredth to sixteen times the white of a display.
void draw_scene(VkCommandBuffer commands, const Image& hdr) {
    const VkImageMemoryBarrier2 to_attachment{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                              .dstStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                              .dstAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                              .newLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                              .image = hdr.image,
                                              .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .imageMemoryBarrierCount = 1,
                                      .pImageMemoryBarriers = &to_attachment};
    vkCmdPipelineBarrier2(commands, &dependency);

    const VkRenderingAttachmentInfo attachment{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                               .imageView = hdr.view,
                                               .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                               .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                               .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                               .clearValue = {.color = {.float32 = {0.01f, 0.012f, 0.02f, 1.0f}}}};
    const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                    .renderArea = {{0, 0}, extent},
                                    .layerCount = 1,
                                    .colorAttachmentCount = 1,
                                    .pColorAttachments = &attachment};
    vkCmdBeginRendering(commands, &rendering);
    for (std::int32_t row = 0; row < 3; ++row) {
        float strength = 0.01f;
        for (std::int32_t column = 0; column < 11; ++column, strength *= 2.1f) {
            const VkClearAttachment color{
                .aspectMask = VK_IMAGE_ASPECT_COLOR_BIT,
                .clearValue = {.color = {.float32 = {row == 1 ? 0.3f * strength : strength, 0.6f * strength,
                                                     row == 0 ? 0.3f * strength : strength, 1.0f}}}};
            const VkClearRect lamp{.rect = {{30 + column * 54, 60 + row * 100}, {36, 36}}, .layerCount = 1};
            vkCmdClearAttachments(commands, 1, &color, 1, &lamp);
        }
    }
    vkCmdEndRendering(commands);
}

std::vector<std::byte> load(const char* path) {
    std::vector<std::byte> content;
    std::FILE* const file = std::fopen(path, "rb");
    if (file == nullptr) {
        std::fprintf(stderr, "embed: %s cannot be read\n", path);
        std::exit(2);
    }
    for (int byte = std::fgetc(file); byte != EOF; byte = std::fgetc(file)) content.push_back(std::byte(byte));
    std::fclose(file);
    return content;
}

void save(const char* path, const std::uint8_t* rgba) {
    std::FILE* const file = std::fopen(path, "wb");
    if (file == nullptr) {
        std::fprintf(stderr, "embed: %s cannot be written\n", path);
        std::exit(2);
    }
    std::fprintf(file, "P6\n%u %u\n255\n", extent.width, extent.height);
    for (std::size_t i = 0; i < std::size_t{extent.width} * extent.height; ++i) std::fwrite(rgba + 4 * i, 1, 3, file);
    std::fclose(file);
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::byte> kernels = argc > 2 ? load(argv[2]) : std::vector<std::byte>();
    Host host;
    create_device(host);
    const Image hdr = create_image(host, VK_FORMAT_R16G16B16A16_SFLOAT,
                                   VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    const Image target = create_image(
        host, VK_FORMAT_R8G8B8A8_UNORM,
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);

    VkBuffer pixels{};
    const VkBufferCreateInfo buffer{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                    .size = VkDeviceSize{extent.width} * extent.height * 4,
                                    .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    check(vkCreateBuffer(host.device, &buffer, nullptr, &pixels), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(host.device, pixels, &needs);
    const VkDeviceMemory pixel_memory =
        allocate(host, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    check(vkBindBufferMemory(host.device, pixels, pixel_memory, 0), "vkBindBufferMemory");

    VkCommandPool pool{};
    const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                            .queueFamilyIndex = host.family};
    check(vkCreateCommandPool(host.device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
    VkCommandBuffer commands{};
    const VkCommandBufferAllocateInfo commands_info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                    .commandPool = pool,
                                                    .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                    .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(host.device, &commands_info, &commands), "vkAllocateCommandBuffers");

    {
        darkroom::Device device = check(darkroom::Device::adopt({.instance = host.instance,
                                                                 .physical_device = host.gpu,
                                                                 .device = host.device,
                                                                 .queue_family = host.family,
                                                                 .enabled_features = &host.features,
                                                                 .get_proc = vkGetInstanceProcAddr,
                                                                 .kernels = kernels}));
        darkroom::Composer composer(device, {.frames_in_flight = 1});
        composer.add(darkroom::Bloom{.intensity = 0.08f});
        composer.add(darkroom::Exposure{.exposure = 1.5f});
        composer.add(darkroom::Tonemap{});
        composer.add(darkroom::Vignette{.intensity = 0.4f});
        composer.add(darkroom::Encode{});
        composer.add(darkroom::Dither{});
        const darkroom::Plan plan =
            check(composer.compile({.max_extent = extent,
                                    .color = {hdr.format},
                                    .target = {target.format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}}));
        std::printf("%s", plan.text().c_str());

        const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                             .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
        check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
        draw_scene(commands, hdr);
        // Darkroom is told how the images are and how to leave them, and places its own barriers in between.
        check(composer.record(commands, {.color = {.image = hdr.image,
                                                   .view = hdr.view,
                                                   .format = hdr.format,
                                                   .extent = extent,
                                                   .layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                                   .last_stages = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                                   .last_access = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
                                         .camera = camera,
                                         .time = 0.0,
                                         .target = {.image = target.image,
                                                    .view = target.view,
                                                    .format = target.format,
                                                    .extent = extent,
                                                    .last_stages = VK_PIPELINE_STAGE_2_NONE,
                                                    .last_access = VK_ACCESS_2_NONE,
                                                    .final_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                                    .final_stages = VK_PIPELINE_STAGE_2_COPY_BIT,
                                                    .final_access = VK_ACCESS_2_TRANSFER_READ_BIT}}));
        const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                       .imageExtent = {extent.width, extent.height, 1}};
        vkCmdCopyImageToBuffer(commands, target.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels, 1, &region);
        const VkMemoryBarrier2 to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                       .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                       .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                       .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                       .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
        const VkDependencyInfo dependency{
            .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
        vkCmdPipelineBarrier2(commands, &dependency);
        check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");

        const VkSubmitInfo submit{
            .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
        check(vkQueueSubmit(host.queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
        // The host waits, not Darkroom; a composer is destroyed only when its recordings have finished.
        check(vkQueueWaitIdle(host.queue), "vkQueueWaitIdle");
    }

    void* mapped = nullptr;
    check(vkMapMemory(host.device, pixel_memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
    const auto* const rgba = static_cast<const std::uint8_t*>(mapped);
    const auto texel = [&](std::uint32_t x, std::uint32_t y) { return rgba + 4 * (std::size_t{y} * extent.width + x); };
    // The strongest lamp is white, the weakest is dark, and the strong one shines into the pixels beside it.
    const bool is_right =
        texel(588, 278)[1] > 230 && texel(48, 278)[1] < 60 && texel(566, 278)[1] > texel(20, 278)[1] + 8;
    save(argc > 1 ? argv[1] : "embed.ppm", rgba);
    std::printf("lamps: %d and %d, beside the strongest %d\n", texel(588, 278)[1], texel(48, 278)[1],
                texel(566, 278)[1]);

    vkDestroyBuffer(host.device, pixels, nullptr);
    vkFreeMemory(host.device, pixel_memory, nullptr);
    vkDestroyCommandPool(host.device, pool, nullptr);
    destroy(host, hdr);
    destroy(host, target);
    vkDestroyDevice(host.device, nullptr);
    vkDestroyInstance(host.instance, nullptr);
    return is_right ? 0 : 1;
}
