// SPDX-License-Identifier: MIT
// A host that records on a queue without graphics: what can run by compute does, and has the picture that others have;
// what cannot is refused in one line. By the smallest device, whose queue then refuses each command that needs
// graphics.

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

constexpr VkExtent2D extent{48, 31};

/// A frame with all that a host may bring, but shadows.
class World {
  public:
    explicit World(Device& device)
        : device_(device),
          host_(test::round_to_half(test::random_display(extent.width, extent.height, 7)), float_format, float_format,
                device),
          depth_(image(VK_FORMAT_R32_SFLOAT, {5, 0, 0, 1})),
          normals_(image(VK_FORMAT_R16G16B16A16_SFLOAT, {0, 0, 1, 0})),
          velocity_(image(VK_FORMAT_R16G16_SFLOAT, {6, -3, 0, 0})) {}

    /// Compiles and records one frame. None: refused, with the reason in `error`.
    std::optional<ReferenceImage> developed(const std::function<void(Composer&)>& fill, KernelStage kernels,
                                            std::string& error) {
        Composer composer(device_);
        fill(composer);
        CompileDesc desc = host_.compile_desc();
        desc.depth.format = VK_FORMAT_R32_SFLOAT;
        desc.normals.format = VK_FORMAT_R16G16B16A16_SFLOAT;
        desc.velocity.format = VK_FORMAT_R16G16_SFLOAT;
        desc.target.usage = VK_IMAGE_USAGE_STORAGE_BIT;
        desc.kernels = kernels;
        const auto plan = composer.compile(desc);
        if (!plan) {
            error = plan.error().text;
            return std::nullopt;
        }
        Frame frame = host_.frame();
        frame.depth = test::image_ref(depth_);
        frame.normals = test::image_ref(normals_);
        frame.velocity = test::image_ref(velocity_);
        frame.camera.depth = DepthKind::Planar;
        test::must(host_.record(composer, frame));
        return host_.read_target();
    }

  private:
    static constexpr VkFormat float_format = VK_FORMAT_R32G32B32A32_SFLOAT;
    gpu::test::Picture image(VkFormat format, const Rgba& value) {
        return gpu::test::upload(device_.context(), test::pixels_of(test::uniform(extent.width, extent.height, value)),
                                 format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    Device& device_;
    test::Host host_;
    gpu::test::Picture depth_, normals_, velocity_;
};

class ComposeComputeQueue : public test::StackTest {};

TEST_F(ComposeComputeQueue, RunsWhatComputeCan) {
    const gpu::test::ComputeQueue queue;
    Device compute_only = gpu::test::shared_device.smallest_again();
    ASSERT_FALSE(compute_only.context().traits.has_graphics);
    World there(compute_only), here(gpu::test::shared_device.smallest());
    std::size_t count = 0, refused = 0;
    for (const EffectInfo* const info : all_effects()) {
        SCOPED_TRACE(info->name);
        const auto fill = [&](Composer& composer) {
            composer.add(*info, nullptr, info->has_second() ? EntryDesc{.second = scene_color} : EntryDesc{});
        };
        std::string error;
        if (info->needs.contains(FrameImage::Ui) || info->needs.contains(FrameImage::Shadows)) continue;
        const auto picture = there.developed(fill, KernelStage::Auto, error);
        if (!picture) {
            EXPECT_NE(error.find("the device has no shaderStorageImageExtendedFormats"), error.npos) << error;
            EXPECT_EQ(error.find('\n'), error.npos) << error;
            ++refused;
            continue;
        }
        const auto expected = here.developed(fill, KernelStage::Compute, error);
        ASSERT_TRUE(expected) << error;
        EXPECT_EQ(test::worst_difference(*picture, *expected), 0);
        ++count;
    }
    EXPECT_GT(count, 15U);
    EXPECT_LE(refused, 5U)
        << "velocities, the slopes of occlusion, what taa counts, the edges of smaa and the circles of "
           "depth_of_field are of one or two channels";
}

TEST_F(ComposeComputeQueue, NamesWhatNeedsGraphics) {
    const gpu::test::ComputeQueue queue;
    Device device = gpu::test::shared_device.smallest_again();
    Composer composer(device);
    test::add(composer, "exposure", {{"exposure", 2}});
    const auto error = [&](const CompileDesc& desc) {
        const auto made = composer.compile(desc);
        return made ? std::string("compiled") : made.error().text;
    };
    constexpr ImageUse stored{VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_STORAGE_BIT};
    EXPECT_EQ(error({.max_extent = {16, 16}, .target = stored}), "compiled");
    EXPECT_EQ(
        error({.max_extent = {16, 16}, .target = {VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}}),
        "compile: target.usage = 0x10: R8G8B8A8_UNORM needs STORAGE on this device");
    EXPECT_EQ(error({.max_extent = {16, 16}, .target = {VK_FORMAT_B8G8R8A8_UNORM, VK_IMAGE_USAGE_STORAGE_BIT}}),
              "compile: target.format = B8G8R8A8_UNORM: allowed are colour formats that this device can render to or "
              "store; depth, integer and block-compressed ones are none");
    EXPECT_EQ(error({.max_extent = {16, 16}, .has_shadows = true, .target = stored}),
              "compile: has_shadows: allowed where the device's queue family has graphics");
}

// Nothing is blitted: a history of another extent begins anew.
TEST_F(ComposeComputeQueue, AnotherExtentResetsHistories) {
    if (find_effect("frame_blend") == nullptr) GTEST_SKIP() << "this build has no effect with a history";
    const gpu::test::ComputeQueue queue;
    Device device = gpu::test::shared_device.smallest_again();
    const auto host_of = [&](const Rgba& color) {
        return test::Host(test::uniform(extent.width, extent.height, color), VK_FORMAT_R32G32B32A32_SFLOAT,
                          VK_FORMAT_R32G32B32A32_SFLOAT, device);
    };
    const Rgba old_color{0.5, 0.25, 0.125, 1}, color{0.125, 0.5, 0.75, 1};
    const test::Host before = host_of(old_color), host = host_of(color);
    Composer composer(device);
    test::add(composer, "frame_blend", {{"amount", 0.5}});
    CompileDesc desc = host.compile_desc();
    desc.target.usage = VK_IMAGE_USAGE_STORAGE_BIT;
    desc.encodes_target = false;
    test::must(composer.compile(desc));
    double time = 0;
    const auto blue = [&](const test::Host& shown, VkExtent2D size) {
        Frame frame = shown.frame();
        frame.delta_time = 1.0 / 60;
        frame.time = time += frame.delta_time;
        frame.color = test::image_ref(shown.color, {{}, size});
        frame.target = test::image_ref(shown.target, {{}, size});
        test::must(shown.record(composer, frame));
        return shown.read_target().at(5, 5).b;
    };
    EXPECT_NEAR(blue(before, extent), old_color.b, 1e-6);
    const double mixed = blue(host, extent);
    EXPECT_LT(mixed, color.b - 0.05) << "the frame before is mixed in";
    for (const VkExtent2D size : {VkExtent2D{24, 16}, VkExtent2D{32, 20}}) {
        EXPECT_NEAR(blue(host, size), color.b, 1e-6) << size.width;
        static_cast<void>(blue(before, size));
    }
}

}  // namespace
}  // namespace darkroom
