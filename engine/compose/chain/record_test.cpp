// SPDX-License-Identifier: MIT
// The promise of the frame loop: recording, toggles and changed values allocate nothing, create nothing, submit nothing
// and wait for nothing on the recording thread. Every Vulkan call of it goes through a table whose entries count.

#include <dlfcn.h>
#include <bit>
#include <chrono>
#include <map>
#include <mutex>
#include <thread>

#include "compose/chain/tables.hpp"
#include "compose/test_stacks/host.hpp"
#include "core/test_support_allocations.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom {
namespace {

using gpu::Dispatch;
using test::add;

/// Set on the thread that is inside a frame: its commands go nowhere, and what must not be called there is counted.
thread_local bool is_in_frame = false;
thread_local std::uint64_t commands_recorded = 0;
thread_local std::uint64_t forbidden_calls = 0;
thread_local std::uint64_t allocations_of_layers = 0;  ///< inside destroying calls, which are allowed
thread_local VkPipeline last_pipeline = VK_NULL_HANDLE;
thread_local std::uint64_t uploads = 0;
/// Of mutexes. Sanitizers have a pthread_mutex_lock of their own.
[[maybe_unused]] thread_local std::uint64_t locks = 0;
thread_local VkImageLayout color_layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< that barriers left the host's colour in
const auto host_color = reinterpret_cast<VkImage>(std::uintptr_t{16});

template <class Function>
struct Wrapped;
template <class R, class... Arguments>
struct Wrapped<R (*)(Arguments...)> {
    template <auto Member>
    static inline R (*original)(Arguments...) = nullptr;

    template <auto Member>
    static R destroy(Arguments... arguments) {
        const std::uint64_t before = test::allocation_count();
        original<Member>(arguments...);
        allocations_of_layers += test::allocation_count() - before;
    }
    template <auto Member, bool is_command>
    static R call(Arguments... arguments) {
        if (is_in_frame) {
            ++(is_command ? commands_recorded : forbidden_calls);
            if constexpr (is_command && std::is_void_v<R>) return;
        }
        return original<Member>(arguments...);
    }
};

template <auto Member, bool is_command>
void wrap(Dispatch& vk) {
    auto& entry = vk.*Member;
    using Wrapper = Wrapped<std::remove_reference_t<decltype(entry)>>;
    if (entry == nullptr) return;
    Wrapper::template original<Member> = entry;
    entry = Wrapper::template call<Member, is_command>;
}

template <auto Member>
void wrap_destroy(Dispatch& vk) {
    auto& entry = vk.*Member;
    using Wrapper = Wrapped<std::remove_reference_t<decltype(entry)>>;
    Wrapper::template original<Member> = entry;
    entry = Wrapper::template destroy<Member>;
}

PFN_vkCmdBindPipeline bind_pipeline = nullptr;
PFN_vkCmdCopyBufferToImage copy_to_image = nullptr;
PFN_vkCmdPipelineBarrier2 put_barriers = nullptr;

void wrap_all(Dispatch& vk) {
    const auto for_commands = [&]<auto... Members>() { (wrap<Members, true>(vk), ...); };
    for_commands.
    operator()<&Dispatch::UpdateDescriptorSets, &Dispatch::CmdBindPipeline, &Dispatch::CmdBindDescriptorSets,
               &Dispatch::CmdPushConstants, &Dispatch::CmdPipelineBarrier2, &Dispatch::CmdDispatch,
               &Dispatch::CmdBeginRendering, &Dispatch::CmdEndRendering, &Dispatch::CmdSetViewport,
               &Dispatch::CmdSetScissor, &Dispatch::CmdDraw, &Dispatch::CmdCopyBufferToImage,
               &Dispatch::CmdClearColorImage, &Dispatch::CmdResetQueryPool, &Dispatch::CmdWriteTimestamp2,
               &Dispatch::CmdBeginDebugUtilsLabelEXT, &Dispatch::CmdEndDebugUtilsLabelEXT>();
    const auto forbidden = [&]<auto... Members>() { (wrap<Members, false>(vk), ...); };
    forbidden.
    operator()<&Dispatch::AllocateMemory, &Dispatch::MapMemory, &Dispatch::CreateBuffer, &Dispatch::CreateImage,
               &Dispatch::CreateImageView, &Dispatch::CreateSampler, &Dispatch::CreateShaderModule,
               &Dispatch::CreatePipelineCache, &Dispatch::CreateComputePipelines, &Dispatch::CreateGraphicsPipelines,
               &Dispatch::CreatePipelineLayout, &Dispatch::CreateDescriptorSetLayout, &Dispatch::CreateDescriptorPool,
               &Dispatch::AllocateDescriptorSets, &Dispatch::CreateQueryPool, &Dispatch::CreateFence,
               &Dispatch::CreateCommandPool, &Dispatch::AllocateCommandBuffers, &Dispatch::BeginCommandBuffer,
               &Dispatch::EndCommandBuffer, &Dispatch::DeviceWaitIdle, &Dispatch::QueueSubmit2,
               &Dispatch::WaitForFences, &Dispatch::ResetFences, &Dispatch::SetDebugUtilsObjectNameEXT>();
    const auto destroying = [&]<auto... Members>() { (wrap_destroy<Members>(vk), ...); };
    destroying.
    operator()<&Dispatch::FreeMemory, &Dispatch::DestroyBuffer, &Dispatch::DestroyImage, &Dispatch::DestroyImageView,
               &Dispatch::DestroyShaderModule, &Dispatch::DestroyPipeline, &Dispatch::DestroyPipelineLayout,
               &Dispatch::DestroyDescriptorSetLayout, &Dispatch::DestroyDescriptorPool, &Dispatch::DestroyQueryPool>();
    bind_pipeline = vk.CmdBindPipeline;
    vk.CmdBindPipeline = [](VkCommandBuffer commands, VkPipelineBindPoint point, VkPipeline pipeline) {
        if (is_in_frame) last_pipeline = pipeline;
        bind_pipeline(commands, point, pipeline);
    };
    copy_to_image = vk.CmdCopyBufferToImage;
    vk.CmdCopyBufferToImage = [](VkCommandBuffer commands, VkBuffer from, VkImage to, VkImageLayout layout,
                                 std::uint32_t count, const VkBufferImageCopy* regions) {
        if (is_in_frame) ++uploads;
        copy_to_image(commands, from, to, layout, count, regions);
    };
    put_barriers = vk.CmdPipelineBarrier2;
    vk.CmdPipelineBarrier2 = [](VkCommandBuffer commands, const VkDependencyInfo* all) {
        if (is_in_frame)
            for (const auto& barrier : std::span(all->pImageMemoryBarriers, all->imageMemoryBarrierCount))
                if (barrier.image == host_color) color_layout = barrier.newLayout;
        put_barriers(commands, all);
    };
}

struct Counted {
    std::uint64_t allocations = 0, forbidden = 0, commands = 0;
};

class ComposeRecord : public test::StackTest {
  protected:
    void SetUp() override {
        test::StackTest::SetUp();
        if (IsSkipped()) return;
        auto made = Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"});
        ASSERT_TRUE(made) << made.error().text;
        device = std::make_unique<Device>(std::move(*made));
        wrap_all(device->context().vk);
    }

    /// The default stack, an entry with passes of its own and all the wiring there is.
    void fill(Composer& composer) {
        bloom = add(composer, "bloom", {}, {.source = scene_color});
        exposure = add(composer, "exposure", {{"exposure", 1.5}});
        blur = add(composer, "gaussian_blur", {}, {.opacity = 0.5f});
        const Handle tonemap = add(composer, "tonemap");
        negative = add(composer, "negative", {}, {.mask = tonemap});
        add(composer, "blend", {}, {.second = tonemap});
        add(composer, "encode");
        add(composer, "dither");
        vignette = add(composer, "vignette");
    }
    static CompileDesc desc() { return {.max_extent = {160, 120}, .views = 2}; }
    /// Images that are never touched: commands go nowhere.
    static Frame frame(VkExtent2D extent = {160, 120}) {
        return {.color = image(16, VK_FORMAT_R16G16B16A16_SFLOAT, extent),
                .target = image(32, VK_FORMAT_R8G8B8A8_UNORM, extent)};
    }
    static ImageRef image(std::uintptr_t at, VkFormat format, VkExtent2D extent) {
        return {.image = reinterpret_cast<VkImage>(at),
                .view = reinterpret_cast<VkImageView>(at + 1),
                .format = format,
                .extent = extent,
                .layout = VK_IMAGE_LAYOUT_GENERAL,
                .final_layout = VK_IMAGE_LAYOUT_GENERAL};
    }
    template <class Work>
    static Counted counted(const Work& work) {
        forbidden_calls = commands_recorded = allocations_of_layers = 0;
        const std::uint64_t before = test::allocation_count();
        is_in_frame = true;
        work();
        is_in_frame = false;
        return {test::allocation_count() - before - allocations_of_layers, forbidden_calls, commands_recorded};
    }
    static bool is_recorded(Composer& composer, const Frame& frame) {
        return composer.record(VK_NULL_HANDLE, frame).has_value();
    }

    std::unique_ptr<Device> device;
    Handle bloom, exposure, blur, negative, vignette;
};

TEST_F(ComposeRecord, TheTableCountsWhatItIsMeantTo) {
    const Counted seen = counted([&] {
        (void)gpu::Buffer::create(device->context(), 16, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, gpu::Memory::Kind::Upload,
                                  "counted");
    });
    EXPECT_GE(seen.forbidden, 2u);
}

TEST_F(ComposeRecord, FramesAllocateCreateAndWaitForNothing) {
    for (const KernelStage stage : {KernelStage::Auto, KernelStage::Compute, KernelStage::Raster}) {
        for (const bool has_timers : {false, true}) {
            Composer composer(*device, {.has_timers = has_timers});
            fill(composer);
            CompileDesc with = desc();
            with.kernels = stage;
            with.watches = {{.id = 4, .entry = exposure}, {.id = 5, .image = "bloom.pyramid"}};
            test::must(composer.compile(with));
            std::array<Watched, 2> watched{{{.id = 5, .target = image(48, VK_FORMAT_R32G32B32A32_SFLOAT, {8, 8})},
                                            {.id = 4, .target = image(64, VK_FORMAT_R32G32B32A32_SFLOAT, {8, 8})}}};
            bool is_good = true;
            const Counted seen = counted([&] {
                for (std::uint32_t i = 0; i < 20; ++i) {
                    Frame next = frame({160 - 7 * i, 120 - 5 * i});
                    next.frame_index = i;
                    next.time = i / 60.0;
                    next.view = i % 2;
                    next.watched = std::span(watched).first(i % 3);
                    is_good = is_good && is_recorded(composer, next);
                }
            });
            EXPECT_TRUE(is_good);
            EXPECT_EQ(seen.allocations, 0u);
            EXPECT_EQ(seen.forbidden, 0u);
            EXPECT_GT(seen.commands, 20u * 10);
            EXPECT_GT(composer.record_microseconds(), 0.0);
        }
    }
}

#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
}  // namespace
}  // namespace darkroom

// Every lock of a std::mutex is one of these; a try to lock is not.
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
    static const auto original = reinterpret_cast<int (*)(pthread_mutex_t*)>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
    if (darkroom::is_in_frame) ++darkroom::locks;
    return original(mutex);
}

namespace darkroom {
namespace {

// Kernels that are missing are asked for, chains put away and plans taken, all by a thread beside.
TEST_F(ComposeRecord, FramesTakeNoLock) {
    Composer composer(*device);
    fill(composer);
    std::mutex one;
    locks = 0;
    (void)counted([&] { const std::scoped_lock lock(one); });
    ASSERT_EQ(locks, 1u);
    locks = 0;
    for (std::uint32_t i = 0; i < 40; ++i) {
        if (i % 8 == 0) test::must(composer.compile(desc()));
        if (i % 8 == 4) test::must(composer.compile_later(desc()));
        test::must(composer.set_enabled(vignette, i % 3 == 0));
        bool is_good = false;
        (void)counted([&] { is_good = is_recorded(composer, frame()); });
        EXPECT_TRUE(is_good);
    }
    EXPECT_EQ(locks, 0u);
}
#endif

TEST_F(ComposeRecord, TogglesAndValuesAllocateCreateAndWaitForNothing) {
    Composer composer(*device);
    fill(composer);
    test::must(composer.compile(desc()));
    const std::array words{std::bit_cast<std::uint32_t>(2.0f)};
    test::must(composer.set_override(exposure, "exposure", "a pulse with a long name", words));
    test::must(composer.set_override(vignette, "smoothness", "a pulse with a long name", words));
    const Frame next = frame();
    bool is_good = true;
    const Counted toggles = counted([&] {
        for (std::uint32_t i = 0; i < 64; ++i) {
            for (std::uint32_t entry = 0; entry < composer.size(); ++entry)
                is_good = composer.set_enabled(composer.entry(entry), (i * 37 >> entry & 1) != 0) && is_good;
            is_good = composer.set_opacity(negative, static_cast<float>(i % 5) / 4) && is_good;
            is_good = composer.set_opacity(blur, static_cast<float>(i % 3) / 2) && is_good;
            is_good = is_recorded(composer, next) && is_good;
        }
    });
    EXPECT_TRUE(is_good);
    EXPECT_EQ(toggles.allocations, 0u);
    EXPECT_EQ(toggles.forbidden, 0u);
    const Counted values = counted([&] {
        for (std::uint32_t i = 0; i < 64; ++i) {
            is_good = composer.set(bloom, "intensity", i * 0.1) && composer.set(blur, "radius", i % 6) && is_good;
            is_good = composer.set(bloom, "soft_threshold", words) || is_good;
            const std::array vary{std::bit_cast<std::uint32_t>(0.5f + static_cast<float>(i))};
            is_good = composer.set(exposure, "exposure", vary) && is_good;
            is_good = is_recorded(composer, next) && is_good;
        }
    });
    EXPECT_TRUE(is_good);
    EXPECT_EQ(values.forbidden, 0u);
    const Counted overrides = counted([&] {
        for (std::uint32_t i = 0; i < 64; ++i) {
            const std::array vary{std::bit_cast<std::uint32_t>(0.5f + static_cast<float>(i % 8))};
            is_good = composer.set_override(exposure, "exposure", "a pulse with a long name", vary) && is_good;
            is_good = composer.set_override(vignette, "smoothness", "a pulse with a long name", vary) && is_good;
            is_good = is_recorded(composer, next) && is_good;
        }
        composer.drop_overrides("a pulse with a long name");
    });
    EXPECT_TRUE(is_good);
    EXPECT_EQ(overrides.allocations, 0u);
    EXPECT_EQ(overrides.forbidden, 0u);
}

TEST_F(ComposeRecord, LayersAndPulsesAllocateNothing) {
    Composer composer(*device);
    fill(composer);
    const auto word = [](float value) { return std::vector{std::bit_cast<std::uint32_t>(value)}; };
    test::must(composer.add_layer({.name = "a layer with a long name",
                                   .distance = LayerDistance{},
                                   .values = {{exposure, "exposure", word(3)}, {blur, "opacity", word(0.25f)}}}));
    for (const Envelope shape : {Envelope::Linear, Envelope::Exponential, Envelope::Spring})
        test::must(composer.add_pulse({.event = "an event with a long name",
                                       .entry = vignette,
                                       .parameter = "intensity",
                                       .amount = {0.3f},
                                       .envelope = shape}));
    test::must(composer.compile(desc()));
    bool is_good = true;
    const Counted seen = counted([&] {
        for (std::uint32_t i = 0; i < 64; ++i) {
            Frame next = frame();
            next.time = i / 60.0;
            if (i % 9 == 0) is_good = composer.fire("an event with a long name") == 3 && is_good;
            is_good = composer.set_layer_weight("a layer with a long name", static_cast<float>(i % 5) / 4) && is_good;
            is_good = is_recorded(composer, next) && is_good;
        }
    });
    EXPECT_TRUE(is_good);
    EXPECT_EQ(seen.allocations, 0u);
    EXPECT_EQ(seen.forbidden, 0u);
}

TEST_F(ComposeRecord, ChangedValuesAllocateNothing) {
    Composer composer(*device);
    fill(composer);
    const Handle encode = *composer.find("encode");
    bool is_good = true;
    const Counted values = counted([&] {
        const std::array half{std::bit_cast<std::uint32_t>(0.5f)};
        const std::array<std::uint32_t, 1> choice{2}, on{1};
        is_good = composer.set(bloom, "intensity", 0.5) && composer.set(blur, "radius", 3.0) && is_good;
        is_good = composer.set(vignette, "smoothness", half) && composer.set(encode, "transfer", choice) && is_good;
        is_good = composer.set(bloom, "firefly_filter", on) && is_good;
    });
    EXPECT_TRUE(is_good);
    EXPECT_EQ(values.allocations, 0u);
}

TEST_F(ComposeRecord, KernelsThatAreBuiltAreNotBuiltAgain) {
    Composer composer(*device);
    fill(composer);
    test::must(composer.compile(desc()));
    composer.wait_for_kernels();
    gpu::Context& context = device->context();
    const auto made = [&] {
        return context.pipelines_created + context.shaders->compiled + context.shaders->from_cache;
    };
    const std::uint64_t after_compile = made();
    for (int i = 0; i < 5; ++i) (void)counted([&] { (void)is_recorded(composer, frame()); });
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    EXPECT_EQ(made(), after_compile) << "a frame without a change made something";

    test::must(composer.set_enabled(exposure, false));
    composer.wait_for_kernels();
    const std::uint64_t after_toggle = made();
    EXPECT_GT(after_toggle, after_compile) << "the lean kernel of the present toggles is not there";
    (void)counted([&] { (void)is_recorded(composer, frame()); });
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    EXPECT_EQ(made(), after_toggle) << "wait_for_kernels built others than the frame wants";
}

TEST_F(ComposeRecord, TheLeanKernelArrivesByItself) {
    Composer composer(*device);
    add(composer, "exposure", {{"exposure", 2}});
    add(composer, "tonemap");
    test::must(composer.compile(desc()));
    const auto pipeline = [&] {
        (void)counted([&] { (void)is_recorded(composer, frame()); });
        return last_pipeline;
    };
    const VkPipeline with_all = pipeline();
    EXPECT_EQ(pipeline(), with_all);
    test::must(composer.set_enabled(composer.entry(0), false));
    const VkPipeline complete = pipeline();
    EXPECT_NE(complete, with_all) << "the complete kernel stands in until the lean one is there";
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    VkPipeline lean = complete;
    while (lean == complete && std::chrono::steady_clock::now() < deadline) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        lean = pipeline();
    }
    EXPECT_NE(lean, complete) << "the lean kernel never came";
    EXPECT_NE(lean, with_all);
    test::must(composer.set_enabled(composer.entry(0), true));
    EXPECT_EQ(pipeline(), with_all) << "back to what was built before";
}

// The frame that outlives a recompiled chain takes it away: without memory, and without a wait for the device.
TEST_F(ComposeRecord, ARetiredChainIsNotWaitedForInAFrame) {
    Composer composer(*device, {.frames_in_flight = 1});
    fill(composer);
    test::must(composer.compile(desc()));
    (void)counted([&] { (void)is_recorded(composer, frame()); });
    test::must(composer.compile(desc()));
    const Counted seen = counted([&] {
        for (int i = 0; i < 5; ++i) (void)is_recorded(composer, frame());
    });
    EXPECT_EQ(seen.allocations, 0u);
    EXPECT_EQ(seen.forbidden, 0u);
}

TEST_F(ComposeRecord, AResizeUploadsNoTableAgain) {
    Composer composer(*device);
    add(composer, "dither");
    const auto uploaded = [&](VkExtent2D extent) {
        test::must(composer.compile({.max_extent = extent}));
        uploads = 0;
        (void)counted([&] { (void)is_recorded(composer, frame(extent)); });
        return uploads;
    };
    EXPECT_GT(uploaded({160, 120}), 0u);
    EXPECT_EQ(uploaded({200, 90}), 0u);
    test::must(composer.abandon());
    EXPECT_EQ(uploaded({160, 120}), 0u);
}

// A picture of the host and a table go on through edits; what is new comes by itself.
TEST_F(ComposeRecord, AnEditUploadsNoTableAgain) {
    Composer composer(*device, {.frames_in_flight = 1});
    const Resource picture =
        test::must(composer.define(ResourceImage{.width = 512, .height = 300, .rgba = std::vector<float>(614400)}));
    add(composer, "blend", {}, {.second = Composer::picture_of(picture), .opacity = 0.5f});
    add(composer, "dither");
    const auto uploaded = [&] {
        test::must(composer.compile(desc()));
        uploads = 0;
        (void)counted([&] { (void)is_recorded(composer, frame()); });
        return uploads;
    };
    const std::uint64_t first = uploaded();
    EXPECT_GE(first, 2u);
    test::must(composer.abandon());
    const Handle negative_one = add(composer, "negative");
    EXPECT_EQ(uploaded(), first) << "what the recording that was taken back uploaded is uploaded again, once";
    for (int i = 0; i < 3; ++i) (void)counted([&] { (void)is_recorded(composer, frame()); });
    test::must(composer.remove(negative_one));
    EXPECT_EQ(uploaded(), 0u);
    add(composer, "film_grain");
    EXPECT_GT(uploaded(), 0u);
    EXPECT_EQ(uploaded(), 0u);
}

TEST_F(ComposeRecord, AnUploadThatIsAbandonedIsMadeAgain) {
    Composer composer(*device);
    add(composer, "dither");
    test::must(composer.compile({.max_extent = {160, 120}}));
    (void)counted([&] { (void)is_recorded(composer, frame()); });
    test::must(composer.abandon());
    uploads = 0;
    (void)counted([&] { (void)is_recorded(composer, frame()); });
    EXPECT_GT(uploads, 0u);
}

TEST_F(ComposeRecord, StagingOfTablesGoesOnceNoRecordingUsesIt) {
    plan::FixedImage table{.desc = {.name = "table", .data = std::vector<std::byte>(1)}};
    compose::Tables tables = test::must(compose::Tables::create(device->context(), {&table, 1}));
    EXPECT_EQ(tables.spent_staging(9, 2), nullptr) << "nothing was uploaded";
    (void)counted([&] { tables.upload(VK_NULL_HANDLE, 7); });
    EXPECT_EQ(tables.spent_staging(9, 2), nullptr) << "the recording that uploaded may still run";
    auto* const staging = tables.spent_staging(10, 2);
    ASSERT_NE(staging, nullptr);
    staging->reset();
    EXPECT_EQ(tables.spent_staging(11, 2), nullptr);
}

TEST_F(ComposeRecord, AnImageIsLeftAsItCameUnlessTheHostSaysHow) {
    Composer composer(*device);
    fill(composer);
    test::must(composer.compile(desc()));
    for (const VkImageLayout asked : {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL}) {
        Frame next = frame();
        next.color.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        next.color.final_layout = asked;
        color_layout = VK_IMAGE_LAYOUT_UNDEFINED;
        (void)counted([&] { EXPECT_TRUE(is_recorded(composer, next)); });
        EXPECT_EQ(color_layout, asked == VK_IMAGE_LAYOUT_UNDEFINED ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : asked);
    }
}

}  // namespace
}  // namespace darkroom
