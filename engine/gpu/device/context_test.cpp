// SPDX-License-Identifier: MIT
#include "gpu/device/context.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <thread>

#include "core/files.hpp"
#include "core/hash.hpp"
#include "core/thread/parallel.hpp"
#include "gpu/test_support.hpp"

namespace darkroom::gpu {

namespace {

TEST(Context, OneThreadAtATimeSpeaksToTheLog) {
    std::atomic<int> inside{0}, overlaps{0};
    int heard = 0;
    Context context;
    context.log = [&](Severity, std::string_view) {
        if (inside++ != 0) ++overlaps;
        for (int i = 0; i < 100; ++i) std::this_thread::yield();
        ++heard;
        --inside;
    };
    parallel_for(200, 8, [&](std::size_t) { context.say(Severity::Info, "a remark"); });
    EXPECT_EQ(overlaps, 0);
    EXPECT_EQ(heard, 200);
}

TEST(Context, ASinkMayMakeTheLibrarySpeakAgain) {
    std::vector<std::string> messages;
    Context context;
    context.log = [&](Severity, std::string_view text) {
        messages.emplace_back(text);
        if (messages.size() < 2) context.say(Severity::Info, "another");
    };
    context.say(Severity::Info, "one");
    EXPECT_EQ(messages, (std::vector<std::string>{"one", "another"}));
}

std::atomic<int>& asked() {
    static std::atomic<int> count{0};
    return count;
}

TEST(Context, TheDriverIsAskedOnceAFormat) {
    Context context;
    context.vk.GetPhysicalDeviceFormatProperties = [](VkPhysicalDevice, VkFormat format, VkFormatProperties* out) {
        ++asked();
        *out = {.optimalTilingFeatures = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT};
        if (format == VK_FORMAT_R8_UNORM) {
            out->optimalTilingFeatures |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
        }
    };
    asked() = 0;
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(context.is_filterable(VK_FORMAT_R8_UNORM));
        EXPECT_FALSE(context.is_filterable(VK_FORMAT_R32_SFLOAT));
        EXPECT_TRUE(context.supports(VK_FORMAT_R32_SFLOAT, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT));
        EXPECT_FALSE(context.supports(VK_FORMAT_R32_SFLOAT, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT));
    }
    EXPECT_EQ(asked(), 2);
    std::atomic<int> wrong{0};
    parallel_for(400, 8, [&](std::size_t i) {
        const auto format = static_cast<VkFormat>(VK_FORMAT_R8_UNORM + i % 40);
        if (context.is_filterable(format) != (format == VK_FORMAT_R8_UNORM)) ++wrong;
    });
    EXPECT_EQ(wrong, 0);
}

TEST(GpuContext, KnowsTheLimitsThatKernelsMustKeep) {
    const Context& context = test::context();
    VkPhysicalDeviceProperties properties{};
    context.vk.GetPhysicalDeviceProperties(context.physical_device, &properties);
    const VkPhysicalDeviceLimits& limits = properties.limits;
    const Traits& traits = context.traits;
    EXPECT_EQ(traits.max_workgroup_invocations, limits.maxComputeWorkGroupInvocations);
    EXPECT_TRUE(std::ranges::equal(traits.max_workgroup_size, limits.maxComputeWorkGroupSize));
    EXPECT_EQ(traits.max_shared_bytes, limits.maxComputeSharedMemorySize);
    EXPECT_EQ(traits.max_storage_images,
              std::min(limits.maxPerStageDescriptorStorageImages, limits.maxFragmentCombinedOutputResources));
    EXPECT_EQ(traits.max_sampled_images,
              std::min(limits.maxPerStageDescriptorSampledImages, limits.maxPerStageDescriptorSamplers));
    EXPECT_EQ(traits.max_uniform_range, limits.maxUniformBufferRange);
    EXPECT_EQ(traits.max_storage_range, limits.maxStorageBufferRange);
    EXPECT_EQ(traits.uniform_alignment, limits.minUniformBufferOffsetAlignment);
    EXPECT_EQ(traits.storage_alignment, limits.minStorageBufferOffsetAlignment);
    EXPECT_EQ(traits.sub_texel_bits, limits.subTexelPrecisionBits);
    EXPECT_EQ(traits.max_image_dimension, limits.maxImageDimension2D);
    EXPECT_EQ(traits.sample_counts, limits.framebufferColorSampleCounts & limits.framebufferDepthSampleCounts &
                                        limits.sampledImageColorSampleCounts & limits.sampledImageDepthSampleCounts);
    // What Vulkan promises is what is assumed where nothing is known.
    const Traits least;
    EXPECT_LE(least.max_workgroup_invocations, traits.max_workgroup_invocations);
    EXPECT_LE(least.max_storage_images, traits.max_storage_images);
    EXPECT_LE(least.max_uniform_range, traits.max_uniform_range);
}

/// What the null driver's cache holds, and how often it was asked for.
std::atomic<std::size_t> cache_bytes{0};
std::atomic<int> cache_reads{0};

/// The software driver's cache never grows.
void fake_cache_data(Context& context) {
    cache_bytes = 64;
    cache_reads = 0;
    context.vk.GetPipelineCacheData = [](VkDevice, VkPipelineCache, std::size_t* size, void* data) {
        const std::size_t bytes = cache_bytes;
        ++cache_reads;
        if (data != nullptr && *size < bytes) return VK_INCOMPLETE;
        if (data != nullptr) std::memset(data, static_cast<int>(bytes % 251), bytes);
        *size = bytes;
        return VK_SUCCESS;
    };
}

/// Pipelines are as large as one likes.
void grow(const Device& device) {
    ++device.context().pipelines_created;
    cache_bytes += 100;
}

class GpuPipelineCache : public ::testing::Test {
  protected:
    void SetUp() override { std::filesystem::remove_all(folder); }
    void TearDown() override { std::filesystem::remove_all(folder); }
    [[nodiscard]] std::filesystem::path file() const {
        std::error_code error;
        for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
            if (entry.is_regular_file()) return entry.path();
        }
        return {};
    }
    [[nodiscard]] Device create() const { return test::must(Device::create({.cache_folder = folder})); }
    static void build(const Device& device, std::string_view color) {
        const KernelSpec spec{.name = std::string(color),
                              .outputs = {VK_FORMAT_R8G8B8A8_UNORM},
                              .body = "vec4 shade(Pixel p) { return vec4(" + std::string(color) + "); }"};
        EXPECT_TRUE(Kernel::create(device.context(), spec, Stage::Compute));
    }
    std::filesystem::path folder =
        std::filesystem::path(::testing::TempDir()) /
        ("darkroom_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(GpuPipelineCache, IsSavedWhilePicturesAreMadeAndOnlyWhenItGrew) {
    const Device device = create();
    Context& context = device.context();
    fake_cache_data(context);
    context.save_pipeline_cache_if_grown();
    EXPECT_TRUE(file().empty()) << "there is nothing to save";
    EXPECT_EQ(cache_reads, 0);
    grow(device);
    context.save_pipeline_cache_if_grown();
    ASSERT_FALSE(file().empty()) << "saved before the device goes";
    EXPECT_EQ(std::filesystem::file_size(file()), sizeof(Hash) + 164);
    cache_reads = 0;
    context.save_pipeline_cache_if_grown();
    EXPECT_EQ(cache_reads, 0) << "the driver is not asked where no pipeline is new";
    std::filesystem::remove(file());
    ++context.pipelines_created;
    context.save_pipeline_cache_if_grown();
    EXPECT_TRUE(file().empty()) << "the new pipeline was in the cache already";
    grow(device);
    context.save_pipeline_cache_if_grown();
    ASSERT_FALSE(file().empty());
    EXPECT_EQ(std::filesystem::file_size(file()), sizeof(Hash) + 264);
}

TEST_F(GpuPipelineCache, SavingFromSeveralThreadsLeavesAWholeFile) {
    const Device device = create();
    fake_cache_data(device.context());
    parallel_for(64, 4, [&](std::size_t) {
        grow(device);
        device.context().save_pipeline_cache_if_grown();
    });
    device.context().save_pipeline_cache_if_grown();
    const std::vector<std::byte> bytes = read_file(file()).value();
    ASSERT_EQ(bytes.size(), sizeof(Hash) + cache_bytes) << "the last state";
    Hash expected;
    std::memcpy(&expected, bytes.data(), sizeof expected);
    EXPECT_EQ(content_hash(std::span(bytes).subspan(sizeof expected)), expected);
}

TEST_F(GpuPipelineCache, OneThatIsTooLargeIsNotKept) {
    const Device device = create();
    fake_cache_data(device.context());
    device.context().max_pipeline_cache_bytes = 200;
    grow(device);
    device.context().save_pipeline_cache_if_grown();
    ASSERT_FALSE(file().empty());
    grow(device);
    device.context().save_pipeline_cache_if_grown();
    EXPECT_TRUE(file().empty());
}

TEST_F(GpuPipelineCache, IsNotReadWhereOthersMayWrite) {
    using enum std::filesystem::perms;
    using std::filesystem::perm_options;
    {
        const mode_t before = ::umask(0);
        const Device device = create();
        build(device, "1, 0, 0, 1");
        device.context().save_pipeline_cache_if_grown();
        ::umask(before);
    }
    const std::filesystem::path saved = file();
    ASSERT_FALSE(saved.empty());
    const auto is_ignored = [&] {
        std::vector<std::string> said;
        const Device device = test::must(Device::create(
            {.log = [&](Severity, std::string_view text) { said.emplace_back(text); }, .cache_folder = folder}));
        return std::ranges::any_of(said, [&](const std::string& text) {
            return text == saved.string() + ": others may write it or its folder, ignored";
        });
    };
    EXPECT_FALSE(is_ignored()) << "what the library made, whatever the umask";
    for (const std::filesystem::path& one : {saved, folder}) {
        for (const std::filesystem::perms bit : {group_write, others_write}) {
            std::filesystem::permissions(one, bit, perm_options::add);
            EXPECT_TRUE(is_ignored()) << one;
            std::filesystem::permissions(one, bit, perm_options::remove);
        }
        EXPECT_FALSE(is_ignored());
        if (::geteuid() != 0) continue;
        ASSERT_EQ(::chown(one.c_str(), 12345, ::getegid()), 0);
        EXPECT_TRUE(is_ignored()) << one << " is another user's";
        ASSERT_EQ(::chown(one.c_str(), 0, ::getegid()), 0);
    }
}

TEST_F(GpuPipelineCache, NoFileIsWrittenWhereCachesAreSwitchedOff) {
    {
        const Device device = test::must(Device::create({.cache_folder = folder, .caches_on_disk = false}));
        build(device, "1, 0, 0, 1");
        device.context().save_pipeline_cache_if_grown();
    }
    EXPECT_FALSE(std::filesystem::exists(folder));
    ASSERT_EQ(::setenv("DARKROOM_SHADER_CACHE", "off", 1), 0);
    {
        const Device device = create();
        build(device, "1, 0, 0, 1");
    }
    ::unsetenv("DARKROOM_SHADER_CACHE");
    EXPECT_FALSE(std::filesystem::exists(folder));
}

}  // namespace

}  // namespace darkroom::gpu
