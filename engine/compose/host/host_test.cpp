// SPDX-License-Identifier: MIT
// The embedding contract: layouts, frames in flight, recompiling meanwhile, threads, views, another device, and errors
// that record nothing.

#include <limits>
#include <thread>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;

class ComposeHost : public test::StackTest {};

void fill(Composer& composer) {
    add(composer, "bloom", {{"intensity", 0.5}, {"threshold", 0.25}});
    add(composer, "exposure", {{"exposure", 2}});
    add(composer, "dither");
}
ReferenceImage small_picture(std::uint32_t number = 3) {
    return test::round_to_float(test::random_display(40, 33, number));
}

void move_to(const Host& host, gpu::test::Picture& picture, VkImageLayout layout) {
    test::must(gpu::submit_and_wait(host.device.context(), "moving a picture", [&](VkCommandBuffer commands) {
        gpu::transition(host.device.context(), commands, picture.image, picture.layout, layout);
    }));
    picture.layout = layout;
}

// The validation layer compares the layouts that are said with those that images are in.
TEST_F(ComposeHost, EveryImageIsLeftInTheLayoutAskedFor) {
    Host host(small_picture());
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        ReferenceImage expected;
        Composer composer(host.device);
        fill(composer);
        CompileDesc desc = host.compile_desc();
        desc.kernels = stage;
        test::must(composer.compile(desc));
        for (const VkImageLayout layout :
             {VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
              VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL}) {
            Frame frame = host.frame();
            frame.color.final_layout = layout;
            frame.target.final_layout = layout;
            frame.target.layout = layout == VK_IMAGE_LAYOUT_GENERAL ? VK_IMAGE_LAYOUT_UNDEFINED : frame.target.layout;
            test::must(host.record(composer, frame));
            host.color.layout = host.target.layout = layout;
            const ReferenceImage out = host.read_target();
            if (expected.pixels.empty()) expected = out;
            EXPECT_EQ(test::worst_difference(out, expected), 0) << "layout " << layout;
        }
        move_to(host, host.color, VK_IMAGE_LAYOUT_GENERAL);
        move_to(host, host.target, VK_IMAGE_LAYOUT_GENERAL);
    }
    EXPECT_EQ(
        test::worst_difference(test::image_of(gpu::test::download(host.device.context(), host.color)), small_picture()),
        0)
        << "the host's colour was written";
}

/// A command buffer of the host's, and its fence. For the validation layer it is in use until wait().
class Submission {
  public:
    explicit Submission(gpu::Context& owner) : context_(owner) {
        const gpu::Dispatch& vk = owner.vk;
        const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                           .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                           .queueFamilyIndex = owner.queue_family};
        check(vk.CreateCommandPool(owner.device, &pool, nullptr, &pool_));
        const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                   .commandPool = pool_,
                                                   .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                   .commandBufferCount = 1};
        check(vk.AllocateCommandBuffers(owner.device, &allocate, &commands_));
        const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        check(vk.CreateFence(owner.device, &fence, nullptr, &fence_));
    }
    Submission(const Submission&) = delete;
    Submission& operator=(const Submission&) = delete;
    ~Submission() {
        wait();
        context_.vk.DestroyFence(context_.device, fence_, nullptr);
        context_.vk.DestroyCommandPool(context_.device, pool_, nullptr);
    }

    void record(Composer& composer, const Frame& frame) {
        wait();
        const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        check(context_.vk.BeginCommandBuffer(commands_, &begin));
        test::must(composer.record(commands_, frame));
        check(context_.vk.EndCommandBuffer(commands_));
    }
    void submit() {
        const VkCommandBufferSubmitInfo own{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                            .commandBuffer = commands_};
        const VkSubmitInfo2 submit{
            .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &own};
        const std::lock_guard lock(context_.queue_mutex);
        check(context_.vk.QueueSubmit2(context_.queue, 1, &submit, fence_));
        is_pending_ = true;
    }
    void wait() {
        if (!is_pending_) return;
        check(
            context_.vk.WaitForFences(context_.device, 1, &fence_, VK_TRUE, std::numeric_limits<std::uint64_t>::max()));
        check(context_.vk.ResetFences(context_.device, 1, &fence_));
        is_pending_ = false;
    }

  private:
    void check(VkResult result) const { test::must(context_.check(result, "a test submission")); }
    gpu::Context& context_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    bool is_pending_ = false;
};

// Every frame has its own values: a ring that is too short would show those of a later frame.
TEST_F(ComposeHost, ThreeFramesInFlightKeepTheirOwnValues) {
    constexpr std::size_t frames_in_flight = 3;
    const ReferenceImage picture = small_picture();
    const Host host(picture);
    gpu::Context& context = host.device.context();
    std::vector<std::unique_ptr<Submission>> submissions;
    std::vector<gpu::test::Picture> targets;
    for (std::size_t i = 0; i < frames_in_flight; ++i) {
        submissions.push_back(std::make_unique<Submission>(context));
        targets.push_back(gpu::test::blank(context, {40, 33}, VK_FORMAT_R32G32B32A32_SFLOAT));
    }
    Composer composer(host.device, {.frames_in_flight = frames_in_flight});
    const Handle exposure = add(composer, "exposure");
    add(composer, "gaussian_blur", {{"radius", 0}});
    test::must(composer.compile(host.compile_desc()));
    for (int round = 0; round < 3; ++round) {
        const auto value = [&](std::size_t i) { return 2.0 + static_cast<double>(i) + 8.0 * round; };
        for (std::size_t i = 0; i < frames_in_flight; ++i) {
            test::must(composer.set(exposure, "exposure", value(i)));
            submissions[i]->record(composer,
                                   {.color = test::image_ref(host.color), .target = test::image_ref(targets[i])});
        }
        for (std::size_t i = 0; i < frames_in_flight; ++i) submissions[i]->submit();
        for (std::size_t i = 0; i < frames_in_flight; ++i) {
            submissions[i]->wait();
            const ReferenceImage out = test::image_of(gpu::test::download(context, targets[i]));
            EXPECT_NEAR(out.pixels[99].g, picture.pixels[99].g * value(i), 1e-4)
                << "round " << round << ", frame " << i;
        }
    }
}

// The validation layer sees objects destroyed that a pending command buffer uses.
TEST_F(ComposeHost, RecompilingKeepsWhatUnfinishedFramesUse) {
    const Host host(small_picture());
    gpu::Context& context = host.device.context();
    const std::uint64_t messages = host.device.validation_messages();
    Composer composer(host.device, {.frames_in_flight = 2});
    fill(composer);
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage expected = host.run(composer);
    {
        Submission first(context), second(context);
        first.record(composer, host.frame());
        first.submit();
        CompileDesc other = host.compile_desc();
        other.fuse = false;
        test::must(composer.compile(other));
        // Frames that record nothing do not count as newer ones.
        for (int i = 0; i < 5; ++i) EXPECT_FALSE(composer.record(VK_NULL_HANDLE, {}));
        second.record(composer, host.frame());
        second.submit();
        for (int i = 0; i < 5; ++i) EXPECT_FALSE(composer.record(VK_NULL_HANDLE, {}));
        EXPECT_EQ(host.device.validation_messages(), messages);
    }
    EXPECT_LE(test::worst_difference(host.read_target(), expected), 1e-5);
    for (int i = 0; i < 6; ++i) EXPECT_LE(test::worst_difference(host.run(composer), expected), 1e-5);
}

TEST_F(ComposeHost, RecompilingWithMoreViewsKeepsThemLonger) {
    const Host host(small_picture());
    gpu::Context& context = host.device.context();
    const std::uint64_t messages = host.device.validation_messages();
    Composer composer(host.device, {.frames_in_flight = 1});
    fill(composer);
    CompileDesc desc = host.compile_desc();
    test::must(composer.compile(desc));
    {
        Submission old(context), first(context), second(context);
        old.record(composer, host.frame());
        old.submit();
        desc.views = 3;
        test::must(composer.compile(desc));
        Frame frame = host.frame();
        first.record(composer, frame);
        first.submit();
        frame.view = 1;
        second.record(composer, frame);
        second.submit();
        EXPECT_EQ(host.device.validation_messages(), messages);
    }
    EXPECT_EQ(host.device.validation_messages(), messages);
}

TEST_F(ComposeHost, TwoComposersInTwoThreads) {
    const auto work = [](std::uint32_t number) {
        const Host host(small_picture(number));
        Composer composer(host.device);
        fill(composer);
        test::must(composer.compile(host.compile_desc()));
        const ReferenceImage expected = host.run(composer);
        const Handle exposure = *composer.find("exposure");
        for (int i = 0; i < 8; ++i) {
            test::must(composer.set_enabled(exposure, i % 2 == 1));
            const double difference = test::worst_difference(host.run(composer), expected);
            if (i % 2 == 1)
                EXPECT_EQ(difference, 0);
            else
                EXPECT_GT(difference, 0.1);
            if (i == 4) test::must(composer.compile(host.compile_desc()));
        }
    };
    std::thread other(work, 11);
    work(12);
    other.join();
}

TEST_F(ComposeHost, ViewsAreRecordedOneAfterTheOther) {
    const Host left(small_picture(1)), right(small_picture(2));
    Composer composer(left.device, {.frames_in_flight = 1});
    fill(composer);
    CompileDesc desc = left.compile_desc();
    test::must(composer.compile(desc));
    const ReferenceImage alone = left.run(composer), other_alone = right.run(composer);
    desc.views = 2;
    test::must(composer.compile(desc));
    test::must(gpu::submit_and_wait(left.device.context(), "two views", [&](VkCommandBuffer commands) {
        test::must(composer.record(commands, left.frame()));
        Frame second = right.frame();
        second.view = 1;
        test::must(composer.record(commands, second));
    }));
    EXPECT_EQ(test::worst_difference(left.read_target(), alone), 0);
    EXPECT_EQ(test::worst_difference(right.read_target(), other_alone), 0);
    Frame third = left.frame();
    third.view = 2;
    const auto refused = left.record(composer, third);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("frame.view is 2"), std::string::npos);
    desc.views = 0;
    EXPECT_FALSE(composer.compile(desc));
}

TEST_F(ComposeHost, RebindRecoversTheStackOnAnotherDevice) {
    const ReferenceImage picture = small_picture();
    const Host host(picture);
    auto other = Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"});
    ASSERT_TRUE(other) << other.error().text;
    Composer composer(host.device);
    fill(composer);
    EXPECT_FALSE(composer.rebind(*other)) << "nothing to compile";
    test::must(composer.compile(host.compile_desc()));
    test::must(composer.set(*composer.find("exposure"), "exposure", 3.0));
    const ReferenceImage expected = host.run(composer);
    {
        const Host there(picture, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, *other);
        const auto plan = composer.rebind(*other);
        ASSERT_TRUE(plan) << plan.error().text;
        EXPECT_EQ(test::worst_difference(there.run(composer), expected), 0);
        EXPECT_EQ(other->validation_messages(), 0u);
        test::must(composer.rebind(host.device));
    }
    EXPECT_EQ(test::worst_difference(host.run(composer), expected), 0);
}

TEST_F(ComposeHost, ErrorsNameTheImageAndRecordNothing) {
    const Host host(small_picture());
    Composer composer(host.device);
    fill(composer);
    const auto error = [&](const Frame& frame) {
        const auto recorded = host.record(composer, frame);
        return recorded ? std::string("recorded") : recorded.error().text;
    };
    EXPECT_NE(error(host.frame()).find("compile"), std::string::npos);
    CompileDesc desc = host.compile_desc();
    desc.max_extent = {40, 40};
    test::must(composer.compile(desc));
    test::must(host.record(composer, host.frame()));
    const ReferenceImage before = host.read_target();
    test::must(composer.set(*composer.find("exposure"), "exposure", 9.0));

    const auto expect_error = [&](std::string_view part, const std::function<void(Frame&)>& spoil) {
        Frame frame = host.frame();
        spoil(frame);
        const std::string text = error(frame);
        EXPECT_NE(text.find(part), std::string::npos) << text << " instead of ... " << part;
        EXPECT_EQ(text.find('\n'), std::string::npos);
    };
    expect_error("frame.color is not given", [](Frame& frame) { frame.color = {}; });
    expect_error("frame.target.view is null", [](Frame& frame) { frame.target.view = VK_NULL_HANDLE; });
    expect_error("R8G8B8A8_UNORM", [](Frame& frame) { frame.color.format = VK_FORMAT_R8G8B8A8_UNORM; });
    expect_error("frame.target.format is", [](Frame& frame) { frame.target.format = VK_FORMAT_B8G8R8A8_UNORM; });
    expect_error("1x1 to 40x40", [](Frame& frame) { frame.color.extent = frame.target.extent = {41, 40}; });
    expect_error("frame.target is 40x32", [](Frame& frame) { frame.target.region = {{0, 0}, {40, 32}}; });
    expect_error("frame.color.region", [](Frame& frame) { frame.color.region = {{1, 0}, {40, 33}}; });
    expect_error("frame.target.region", [](Frame& frame) { frame.target.region = {{-1, 0}, {40, 33}}; });
    expect_error("frame.color.region", [](Frame& frame) { frame.color.region = {{2000000000, 0}, {4000000000u, 33}}; });
    expect_error("layer_count is 2", [](Frame& frame) { frame.color.layer_count = 2; });
    EXPECT_EQ(test::worst_difference(host.read_target(), before), 0) << "a frame with an error wrote the target";
    test::must(host.record(composer, host.frame()));
    EXPECT_GT(test::worst_difference(host.read_target(), before), 0.1);

    for (const VkExtent2D wrong : {VkExtent2D{0, 40}, {40, 0}, {1u << 20, 40}}) {
        desc.max_extent = wrong;
        const auto refused = composer.compile(desc);
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.error().text.find("size"), std::string::npos);
    }
    test::must(host.record(composer, host.frame()));
}

TEST_F(ComposeHost, AComposerCanBeMoved) {
    const Host host(small_picture());
    Composer composer(host.device);
    fill(composer);
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage expected = host.run(composer);
    Composer moved(std::move(composer));
    EXPECT_EQ(test::worst_difference(host.run(moved), expected), 0);
    Composer assigned(host.device);
    assigned = std::move(moved);
    EXPECT_EQ(test::worst_difference(host.run(assigned), expected), 0);
}

}  // namespace
}  // namespace darkroom
