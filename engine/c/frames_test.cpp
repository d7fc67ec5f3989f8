// SPDX-License-Identifier: MIT
// Frames by the C interface: the picture of the C++ one, bit for bit, and nothing allocated.
#include <gtest/gtest.h>

#include <darkroom/effects/bloom.hpp>
#include <darkroom/effects/encode.hpp>
#include <darkroom/effects/exposure.hpp>
#include <darkroom/effects/tonemap.hpp>

#include "c/frame_of.hpp"
#include "compose/test_stacks/host.hpp"
#include "core/test_support_allocations.hpp"

namespace darkroom {
namespace {

using test::Host;

DarkroomImage image_of(const gpu::test::Picture& picture) {
    DarkroomImage out{};
    out.struct_size = sizeof out;
    out.image = picture.image.handle;
    out.view = picture.image.mip_views[0];
    out.format = picture.image.info.format;
    out.extent = {picture.image.info.extent.width, picture.image.info.extent.height};
    out.layout = picture.layout;
    out.final_layout = picture.layout;
    return out;
}

class GpuCInterface : public test::StackTest {};

TEST_F(GpuCInterface, RecordsThePictureOfCppAndAllocatesNothing) {
    const Host host(test::random_hdr(67, 35, 1));
    Composer composer(host.device);
    composer.add(Bloom{.intensity = 0.3f});
    composer.add(Exposure{.exposure = 1.5f});
    composer.add(Tonemap{});
    composer.add(Encode{});
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage wanted = host.run(composer);

    const DarkroomComposer composer_object = new DarkroomComposerObject{Composer(host.device)};
    DarkroomHandle bloom = 0, exposure = 0;
    ASSERT_EQ(darkroom_composer_add(composer_object, "bloom", nullptr, &bloom), DARKROOM_OK);
    ASSERT_EQ(darkroom_composer_set_number(composer_object, bloom, "intensity", 0.3), DARKROOM_OK);
    ASSERT_EQ(darkroom_composer_add(composer_object, "exposure", nullptr, &exposure), DARKROOM_OK);
    ASSERT_EQ(darkroom_composer_set_number(composer_object, exposure, "exposure", 1.5), DARKROOM_OK);
    ASSERT_EQ(darkroom_composer_add(composer_object, "tonemap", nullptr, nullptr), DARKROOM_OK);
    ASSERT_EQ(darkroom_composer_add(composer_object, "encode", nullptr, nullptr), DARKROOM_OK);
    const gpu::ImageInfo& color_info = host.color.image.info;
    const gpu::ImageInfo& target_info = host.target.image.info;
    const DarkroomImageUse color_use{sizeof color_use, color_info.format, color_info.usage};
    const DarkroomImageUse target_use{sizeof target_use, target_info.format, target_info.usage};
    DarkroomCompileDesc desc{};
    desc.struct_size = sizeof desc;
    desc.max_extent = {67, 35};
    desc.color = &color_use;
    desc.target = &target_use;
    desc.target_is_encoded = DARKROOM_CHOICE_YES;
    desc.intermediate = VK_FORMAT_R32G32B32A32_SFLOAT;
    ASSERT_EQ(darkroom_composer_compile(composer_object, &desc, nullptr), DARKROOM_OK) << darkroom_error();

    const DarkroomImage color = image_of(host.color), target = image_of(host.target);
    DarkroomFrame frame{};
    frame.struct_size = sizeof frame;
    frame.color = &color;
    frame.target = &target;
    DarkroomResult result = DARKROOM_ERROR_USER;
    test::must(gpu::submit_and_wait(host.device.context(), "a test frame", [&](VkCommandBuffer commands) {
        result = darkroom_composer_record(composer_object, commands, &frame);
    }));
    EXPECT_EQ(result, DARKROOM_OK) << darkroom_error();
    EXPECT_EQ(test::worst_difference(host.read_target(), wanted), 0);
    // What this interface does beside Composer::record(), which the layers of validation allocate in.
    const std::uint64_t before = test::allocation_count();
    const bool is_read = c::frame_of(&frame, *composer_object).has_value();
    EXPECT_EQ(test::allocation_count() - before, 0u);
    EXPECT_TRUE(is_read);

    // A frame that is refused says why, and by which member.
    frame.color = nullptr;
    test::must(gpu::submit_and_wait(host.device.context(), "no frame", [&](VkCommandBuffer commands) {
        result = darkroom_composer_record(composer_object, commands, &frame);
    }));
    EXPECT_EQ(result, DARKROOM_ERROR_USER);
    EXPECT_EQ(std::string_view(darkroom_error()).find("darkroom_composer_record: frame.color"), 0u) << darkroom_error();
    darkroom_composer_destroy(composer_object);
}

/// A host's allocator, by the driver's own functions.
struct Allocator {
    int live = 0, most = 1000;
    static VkResult allocate(void* user, VkDevice device, const DarkroomMemoryRequest* request,
                             DarkroomMemory* memory) {
        auto& self = *static_cast<Allocator*>(user);
        EXPECT_EQ(request->struct_size, sizeof *request);
        EXPECT_EQ(memory->struct_size, sizeof *memory);
        if (self.live == self.most) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        const gpu::Dispatch& vk = gpu::test::context().vk;
        const VkMemoryDedicatedAllocateInfo dedicated{.sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO,
                                                      .image = request->image,
                                                      .buffer = request->buffer};
        const bool is_dedicated = request->requires_dedicated != 0;
        const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .pNext = is_dedicated ? &dedicated : nullptr,
                                        .allocationSize = request->size,
                                        .memoryTypeIndex = request->memory_type};
        if (const VkResult made = vk.AllocateMemory(device, &info, nullptr, &memory->memory); made != VK_SUCCESS)
            return made;
        if (request->is_mapped != 0) vk.MapMemory(device, memory->memory, 0, VK_WHOLE_SIZE, 0, &memory->mapped);
        memory->owner = user;
        ++self.live;
        return VK_SUCCESS;
    }
    static void release(void* user, VkDevice device, const DarkroomMemory* memory) {
        EXPECT_EQ(memory->owner, user);
        gpu::test::context().vk.FreeMemory(device, memory->memory, nullptr);
        --static_cast<Allocator*>(user)->live;
    }
};

TEST_F(GpuCInterface, AHostsDeviceAndMemory) {
    const gpu::Context& host = gpu::test::context();
    VkPhysicalDeviceVulkan13Features features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                              .synchronization2 = VK_TRUE,
                                              .dynamicRendering = VK_TRUE};
    const VkPhysicalDeviceFeatures2 all{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features};
    Allocator memory;
    std::string said;
    DarkroomAdoptDesc desc{};
    desc.struct_size = sizeof desc;
    desc.instance = host.instance;
    desc.physical_device = host.physical_device;
    desc.device = host.device;
    desc.queue_family = host.queue_family;
    desc.get_proc = host.vk.GetInstanceProcAddr;
    desc.no_caches = VK_TRUE;
    desc.log = [](void* user, DarkroomSeverity, const char* text) { *static_cast<std::string*>(user) += text; };
    desc.log_user = &said;
    DarkroomDevice device = nullptr;
    EXPECT_EQ(darkroom_device_adopt(&desc, &device), DARKROOM_ERROR_UNSUPPORTED) << "nothing was said to be enabled";
    EXPECT_NE(std::string_view(darkroom_error()).find("synchronization2"), std::string_view::npos) << darkroom_error();
    desc.enabled_features = &all;
    desc.allocate = Allocator::allocate;
    EXPECT_EQ(darkroom_device_adopt(&desc, &device), DARKROOM_ERROR_USER) << "half of the hooks";
    desc.free = Allocator::release;
    desc.memory_user = &memory;
    ASSERT_EQ(darkroom_device_adopt(&desc, &device), DARKROOM_OK) << darkroom_error();
    DarkroomDeviceInfo info{};
    info.struct_size = sizeof info;
    ASSERT_EQ(darkroom_device_info(device, &info), DARKROOM_OK);
    EXPECT_EQ(info.name, gpu::test::device().info().name);

    DarkroomComposer composer = nullptr;
    ASSERT_EQ(darkroom_composer_create(device, nullptr, &composer), DARKROOM_OK);
    darkroom_device_destroy(device);  // the composer has what it needs of it
    ASSERT_EQ(darkroom_composer_add(composer, "bloom", nullptr, nullptr), DARKROOM_OK);
    DarkroomCompileDesc frames{};
    frames.struct_size = sizeof frames;
    frames.max_extent = {64, 64};
    memory.most = 0;
    EXPECT_EQ(darkroom_composer_compile(composer, &frames, nullptr), DARKROOM_ERROR_OUT_OF_MEMORY) << darkroom_error();
    memory.most = 1000;
    DarkroomPlan plan = nullptr;
    ASSERT_EQ(darkroom_composer_compile(composer, &frames, &plan), DARKROOM_OK) << darkroom_error();
    EXPECT_GT(memory.live, 0);
    EXPECT_GT(darkroom_plan_bytes_read(plan), 0u);
    darkroom_plan_destroy(plan);
    DarkroomPlan current = nullptr;
    EXPECT_EQ(darkroom_composer_current_plan(composer, &current), DARKROOM_OK);
    darkroom_plan_destroy(current);
    darkroom_composer_destroy(composer);
    EXPECT_EQ(memory.live, 0);
}

}  // namespace
}  // namespace darkroom
