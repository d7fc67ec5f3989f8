// SPDX-License-Identifier: MIT
// A host with a render graph of its own: it places every barrier of its images by what the plan tells, and runs passes
// of its own before, between and behind.
#include <fmt/format.h>

#include <map>

#include "compose/test_stacks/host.hpp"
#include "gpu/resource/formats.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;

/// Barriers of images by whoever calls the driver through the device's table.
PFN_vkCmdPipelineBarrier2 put_barriers = nullptr;
std::map<VkImage, int> barriers_of_library;
std::map<VkImage, VkImageMemoryBarrier2> last_barrier;  ///< of the library

/// Where an image is, and what was last done to it: the least that a render graph knows.
struct GraphImage {
    VkImage image = VK_NULL_HANDLE;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;

    void use(VkCommandBuffer commands, VkImageLayout next, VkPipelineStageFlags2 by, VkAccessFlags2 as) {
        const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                            .srcStageMask = stages,
                                            .srcAccessMask = access,
                                            .dstStageMask = by,
                                            .dstAccessMask = as,
                                            .oldLayout = layout,
                                            .newLayout = next,
                                            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                            .image = image,
                                            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        const VkDependencyInfo all{
            .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
        put_barriers(commands, &all);
        layout = next;
        stages = by;
        access = as;
    }
    /// Before a recording that uses it as `told`.
    void use(VkCommandBuffer commands, const PlanImage& told, ImageRef& reference) {
        use(commands, told.layout, told.stages, told.access);
        reference.layout = told.layout;
        reference.final_layout = layout = told.final_layout;
        reference.last_stages = reference.final_stages = VK_PIPELINE_STAGE_2_NONE;
        reference.last_access = reference.final_access = VK_ACCESS_2_NONE;
    }
};

const PlanImage& told(const Plan& plan, std::string_view name) {
    const auto found = std::ranges::find(plan.images, name, &PlanImage::name);
    EXPECT_NE(found, plan.images.end()) << name;
    return *found;
}

class ComposeToldUses : public test::StackTest {
  protected:
    void SetUp() override {
        test::StackTest::SetUp();
        gpu::Dispatch& vk = gpu::test::device().context().vk;
        put_barriers = vk.CmdPipelineBarrier2;
        barriers_of_library.clear();
        last_barrier.clear();
        vk.CmdPipelineBarrier2 = [](VkCommandBuffer commands, const VkDependencyInfo* all) {
            for (const auto& barrier : std::span(all->pImageMemoryBarriers, all->imageMemoryBarrierCount)) {
                ++barriers_of_library[barrier.image];
                last_barrier[barrier.image] = barrier;
            }
            put_barriers(commands, all);
        };
    }
    void TearDown() override {
        if (put_barriers != nullptr) gpu::test::device().context().vk.CmdPipelineBarrier2 = put_barriers;
    }
};

TEST_F(ComposeToldUses, AHostThatPlacesItsBarriersGetsNoneOfOurs) {
    const ReferenceImage picture = test::round_to_float(test::random_display(40, 33, 3));
    Host host(picture);
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        for (const bool is_fused : {true, false}) {
            Composer composer(host.device);
            const Handle bloom = add(composer, "bloom", {{"intensity", 0.5}, {"threshold", 0.25}});
            add(composer, "exposure", {{"exposure", 2}});
            add(composer, "gaussian_blur", {}, {.second = scene_color, .opacity = 0.5f});
            add(composer, "dither");
            CompileDesc desc = host.compile_desc();
            desc.kernels = stage;
            desc.fuse = is_fused;
            const Plan plan = test::must(composer.compile(desc));
            const ReferenceImage expected = host.run(composer);
            for (const bool has_bloom : {true, false}) {
                test::must(composer.set_enabled(bloom, has_bloom));
                GraphImage color{host.color.image.handle, host.color.layout}, target{host.target.image.handle};
                barriers_of_library.clear();
                test::must(gpu::submit_and_wait(host.device.context(), "a host's frame", [&](VkCommandBuffer commands) {
                    Frame frame = host.frame();
                    color.use(commands, told(plan, "color"), frame.color);
                    target.use(commands, told(plan, "target"), frame.target);
                    test::must(composer.record(commands, frame));
                    color.use(commands, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                              VK_ACCESS_2_MEMORY_READ_BIT);
                    target.use(commands, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                               VK_ACCESS_2_MEMORY_READ_BIT);
                }));
                host.color.layout = host.target.layout = VK_IMAGE_LAYOUT_GENERAL;
                EXPECT_EQ(barriers_of_library[color.image], 0);
                EXPECT_EQ(barriers_of_library[target.image], 0);
                if (!has_bloom) continue;
                EXPECT_EQ(test::worst_difference(host.read_target(), expected), 0);
            }
        }
    }
}

// A host that goes on from final_layout, final_stages and final_access does so in every frame: of an image that is
// read, that is not read now, that no effect reads, that the plan does not know, and of a target that came with no
// content.
TEST_F(ComposeToldUses, EveryImageIsLeftAsTheHostAsks) {
    if (find_effect("motion_blur") == nullptr) GTEST_SKIP() << "this build has no effect motion_blur";
    const Host host(test::random_display(16, 16, 3));
    gpu::Context& context = host.device.context();
    const std::array others{gpu::test::blank(context, {16, 16}, VK_FORMAT_R16G16_SFLOAT),
                            gpu::test::blank(context, {16, 16}, VK_FORMAT_R32_SFLOAT),
                            gpu::test::blank(context, {16, 16}, VK_FORMAT_R16G16B16A16_SFLOAT)};
    Composer composer(host.device);
    const Handle blur = add(composer, "motion_blur");
    add(composer, "gaussian_blur");
    CompileDesc desc = host.compile_desc();
    desc.depth = {VK_FORMAT_R32_SFLOAT};
    desc.velocity = {VK_FORMAT_R16G16_SFLOAT};
    desc.reactive = {VK_FORMAT_R32_SFLOAT};
    const Plan plan = test::must(composer.compile(desc));
    for (const bool is_on : {true, false})
        for (const bool is_brought : {false, true}) {  // by barriers of the host's own
            test::must(composer.set_enabled(blur, is_on));
            Frame frame = host.frame();
            frame.camera.depth = DepthKind::Planar;
            frame.velocity = test::image_ref(others[0]);
            frame.depth = frame.reactive = test::image_ref(others[1]);
            frame.reactive.image = VK_NULL_HANDLE;  // what was not given is left alone
            frame.normals = test::image_ref(others[2]);
            for (ImageRef* const image : {&frame.color, &frame.velocity, &frame.depth, &frame.normals, &frame.target}) {
                image->last_stages = is_brought ? VK_PIPELINE_STAGE_2_NONE : VK_PIPELINE_STAGE_2_CLEAR_BIT;
                image->last_access = is_brought ? VK_ACCESS_2_NONE : VK_ACCESS_2_TRANSFER_WRITE_BIT;
                image->final_layout = VK_IMAGE_LAYOUT_UNDEFINED;
                image->final_stages = VK_PIPELINE_STAGE_2_COPY_BIT;
                image->final_access = VK_ACCESS_2_TRANSFER_READ_BIT;
            }
            frame.normals.final_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
            frame.target.layout = VK_IMAGE_LAYOUT_UNDEFINED;
            last_barrier.clear();
            test::must(host.record(composer, frame));
            for (const ImageRef& image : {frame.color, frame.velocity, frame.depth, frame.normals, frame.target}) {
                SCOPED_TRACE(fmt::format("{}, motion blur is {}, brought by the host: {}",
                                         gpu::format_name(image.format), is_on, is_brought));
                ASSERT_EQ(last_barrier.count(image.image), 1u);
                const VkImageMemoryBarrier2& left = last_barrier.at(image.image);
                EXPECT_EQ(left.dstStageMask, VK_PIPELINE_STAGE_2_COPY_BIT);
                EXPECT_EQ(left.dstAccessMask, VK_ACCESS_2_TRANSFER_READ_BIT);
                EXPECT_NE(left.newLayout, VK_IMAGE_LAYOUT_UNDEFINED);
                EXPECT_NE(left.srcStageMask, VK_PIPELINE_STAGE_2_NONE) << "it waits for no barrier of the host";
                const bool is_target = image.image == frame.target.image;
                if (is_target) continue;
                EXPECT_EQ(left.newLayout,
                          image.image == frame.normals.image ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : image.layout);
            }
            EXPECT_EQ(last_barrier.count(VK_NULL_HANDLE), 0u);
            // Back to where the test's picture has it.
            test::must(gpu::submit_and_wait(context, "a host's frame", [&](VkCommandBuffer commands) {
                gpu::transition(context, commands, others[2].image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                others[2].layout);
            }));
        }
}

// What no effect reads may be one image under several names: its layout changes once, for all who asked.
TEST_F(ComposeToldUses, AnImageThatIsGivenTwiceIsLeftOnce) {
    const Host host(test::random_display(16, 16, 3));
    const gpu::test::Picture other = gpu::test::blank(host.device.context(), {16, 16}, VK_FORMAT_R16G16B16A16_SFLOAT);
    Composer composer(host.device);
    add(composer, "exposure");
    test::must(composer.compile(host.compile_desc()));
    Frame frame = host.frame();
    frame.normals = test::image_ref(other);
    frame.normals.final_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    frame.normals.last_stages = VK_PIPELINE_STAGE_2_CLEAR_BIT;
    frame.normals.final_stages = VK_PIPELINE_STAGE_2_COPY_BIT;
    frame.velocity = frame.normals;
    frame.velocity.final_stages = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const std::array watched{Watched{.id = 3, .target = frame.normals}};
    frame.watched = watched;
    barriers_of_library.clear();
    test::must(host.record(composer, frame));
    EXPECT_EQ(barriers_of_library[frame.normals.image], 1);
    EXPECT_EQ(last_barrier.at(frame.normals.image).dstStageMask,
              VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

// Segments: a composer for what comes before the host's pass, and one for what comes behind it.
TEST_F(ComposeToldUses, APassOfTheHostRunsBetweenTwoOfOurs) {
    const ReferenceImage picture = test::round_to_float(test::random_display(40, 33, 3));
    const Host host(picture);
    gpu::Context& context = host.device.context();
    gpu::test::Picture between = gpu::test::blank(context, {40, 33}, VK_FORMAT_R32G32B32A32_SFLOAT);
    CompileDesc before = host.compile_desc(), behind = before;
    before.target_domain = Domain::SceneLinear;
    behind.target_domain = Domain::SceneLinear;
    behind.color = {between.image.info.format, between.image.info.usage};
    Composer first(host.device), second(host.device);
    add(first, "exposure", {{"exposure", 2}});
    add(second, "exposure", {{"exposure", 0.25}});
    const Plan first_plan = test::must(first.compile(before)), second_plan = test::must(second.compile(behind));
    // What the host draws in between: red, over everything.
    const VkClearColorValue red{.float32 = {8, 0, 0, 1}};
    barriers_of_library.clear();
    for (const bool draws : {false, true}) {
        GraphImage color{host.color.image.handle, host.color.layout}, middle{between.image.handle, between.layout},
            target{host.target.image.handle, host.target.layout};
        test::must(gpu::submit_and_wait(context, "a host's frame", [&](VkCommandBuffer commands) {
            Frame frame = host.frame();
            frame.target = test::image_ref(between);
            color.use(commands, told(first_plan, "color"), frame.color);
            middle.use(commands, told(first_plan, "target"), frame.target);
            test::must(first.record(commands, frame));
            if (draws) {
                middle.use(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_CLEAR_BIT,
                           VK_ACCESS_2_TRANSFER_WRITE_BIT);
                const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
                context.vk.CmdClearColorImage(commands, middle.image, middle.layout, &red, 1, &all);
            }
            frame = host.frame();
            frame.color = test::image_ref(between);
            middle.use(commands, told(second_plan, "color"), frame.color);
            target.use(commands, told(second_plan, "target"), frame.target);
            test::must(second.record(commands, frame));
            for (GraphImage* const one : {&color, &middle, &target})
                one->use(commands, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                         VK_ACCESS_2_MEMORY_READ_BIT);
        }));
        const ReferenceImage out = host.read_target();
        ReferenceImage expected = picture;
        for (Rgba& pixel : expected.pixels)
            pixel = draws ? Rgba{2, 0, 0, 1} : Rgba{pixel.r / 2, pixel.g / 2, pixel.b / 2, pixel.a};
        EXPECT_LE(test::worst_difference(out, expected), 1e-6);
        EXPECT_EQ(barriers_of_library[middle.image], 0);
    }
}

}  // namespace
}  // namespace darkroom
