// SPDX-License-Identifier: MIT
// Frames by the C interface: the picture of the C++ one, bit for bit, and nothing allocated.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace darkroom
