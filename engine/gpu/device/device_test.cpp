// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <darkroom/device.hpp>

#include "core/files.hpp"
#include "gpu/device/test_host_desc.hpp"
#include "gpu/test_run.hpp"

namespace darkroom {

namespace {

using gpu::test::cache_folder;
using gpu::test::has;
using gpu::test::host_desc;

TEST(GpuDevice, ListsAndSelects) {
    const Result<std::vector<DeviceInfo>> devices = Device::list();
    ASSERT_TRUE(devices) << devices.error().text;
    ASSERT_FALSE(devices->empty());
    const DeviceInfo& best = devices->front();
    EXPECT_TRUE(best.is_usable) << best.reason;
    EXPECT_EQ(gpu::test::device().info().name, best.name);
    const Result<Device> by_index =
        Device::create({.select = std::to_string(best.index), .cache_folder = cache_folder});
    ASSERT_TRUE(by_index) << by_index.error().text;
    EXPECT_EQ(by_index->info().name, best.name);
    std::string part = best.name.substr(0, 4);
    std::ranges::transform(part, part.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    const Result<Device> by_name = Device::create({.select = part, .cache_folder = cache_folder});
    ASSERT_TRUE(by_name) << by_name.error().text;
    EXPECT_EQ(by_name->info().name, best.name);
}

TEST(GpuDevice, UnknownSelectionNamesWhatThereIs) {
    const Result<Device> device = Device::create({.select = "voodoo"});
    ASSERT_FALSE(device);
    EXPECT_EQ(device.error().fault, Fault::User);
    EXPECT_TRUE(has(device.error().text, "\"voodoo\": no such device")) << device.error().text;
    EXPECT_TRUE(has(device.error().text, gpu::test::device().info().name)) << device.error().text;
    EXPECT_FALSE(Device::create({.select = "999"}));
}

TEST(GpuDevice, ExtensionsThatAreMissingAreNamed) {
    constexpr std::array wanted{"VK_KHR_nowhere", "VK_KHR_neither"};
    const Result<Device> no_instance = Device::create({.cache_folder = cache_folder, .instance_extensions = wanted});
    ASSERT_FALSE(no_instance);
    EXPECT_EQ(no_instance.error().fault, Fault::Machine);
    EXPECT_EQ(no_instance.error().text, "the Vulkan loader lacks VK_KHR_nowhere, VK_KHR_neither");
    const Result<Device> no_device = Device::create({.cache_folder = cache_folder, .device_extensions = wanted});
    ASSERT_FALSE(no_device);
    EXPECT_TRUE(has(no_device.error().text, "lacks VK_KHR_nowhere, VK_KHR_neither")) << no_device.error().text;
}

TEST(GpuDevice, ValidationMessagesAreCountedAndLogged) {
    std::vector<std::string> messages;
    const Result<Device> device =
        Device::create({.validate = true,
                        .log = [&](Severity, std::string_view text) { messages.emplace_back(text); },
                        .cache_folder = cache_folder});
    if (!device && has(device.error().text, "is not installed")) GTEST_SKIP() << device.error().text;
    ASSERT_TRUE(device) << device.error().text;
    gpu::Context& context = device->context();
    EXPECT_EQ(device->validation_messages(), 0U);
    const VkFenceCreateInfo wrong{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO};
    VkFence fence = VK_NULL_HANDLE;
    context.vk.CreateFence(context.device, &wrong, nullptr, &fence);
    context.vk.DestroyFence(context.device, fence, nullptr);
    EXPECT_GE(device->validation_messages(), 1U);
    ASSERT_FALSE(messages.empty());
    EXPECT_TRUE(has(messages.back(), "sType")) << messages.back();
}

TEST(GpuDevice, AdoptNamesEverythingThatIsMissing) {
    const VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    AdoptDesc desc = host_desc(&features);
    desc.queue_family = 77;
    const Result<Device> device = Device::adopt(desc);
    ASSERT_FALSE(device);
    for (const std::string_view part : {"queue family 77", "synchronization2", "dynamicRendering"}) {
        EXPECT_TRUE(has(device.error().text, part)) << device.error().text;
    }
    EXPECT_EQ(std::ranges::count(device.error().text, '\n'), 0);
    const Result<Device> nothing = Device::adopt({});
    ASSERT_FALSE(nothing);
    EXPECT_TRUE(has(nothing.error().text, "instance, physical_device, device, get_proc")) << nothing.error().text;
}

TEST(GpuDevice, AdoptReadsEitherKindOfFeatureStructure) {
    VkPhysicalDeviceVulkan13Features features13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                .robustImageAccess = VK_TRUE,
                                                .synchronization2 = VK_TRUE,
                                                .dynamicRendering = VK_TRUE};
    const VkPhysicalDeviceFeatures2 together{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                             .pNext = &features13};
    VkPhysicalDeviceSynchronization2Features synchronization{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, .synchronization2 = VK_TRUE};
    VkPhysicalDeviceDynamicRenderingFeatures rendering{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES,
        .pNext = &synchronization,
        .dynamicRendering = VK_TRUE};
    const VkPhysicalDeviceFeatures2 apart{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &rendering,
                                          .features = {.shaderStorageImageExtendedFormats = VK_TRUE}};
    for (const VkPhysicalDeviceFeatures2* features : {&together, &apart}) {
        Result<Device> device = Device::adopt(host_desc(features));
        ASSERT_TRUE(device) << device.error().text;
        EXPECT_EQ(device->context().traits.has_extended_storage_formats, features == &apart);
        EXPECT_EQ(device->context().traits.has_robust_images, features == &together);
        EXPECT_FALSE(device->context().traits.has_debug_labels);
        EXPECT_FALSE(gpu::submit_and_wait(device->context(), "testing", [](VkCommandBuffer) {}));
    }
    EXPECT_TRUE(gpu::submit_and_wait(gpu::test::context(), "testing", [](VkCommandBuffer) {}))
        << "the host's device lives";
}

TEST(GpuDevice, SavesThePipelineCacheAndIgnoresADamagedOne) {
    const std::filesystem::path folder = ::testing::TempDir() + "darkroom_pipeline_cache_test";
    std::filesystem::remove_all(folder);
    const gpu::KernelSpec spec{.name = "red",
                               .outputs = {VK_FORMAT_R8G8B8A8_UNORM},
                               .body = "vec4 shade(Pixel p) { return vec4(1, 0, 0, 1); }"};
    std::vector<std::string> messages;
    const auto use = [&] {
        const DeviceDesc desc{.log = [&](Severity, std::string_view text) { messages.emplace_back(text); },
                              .cache_folder = folder};
        const Device device = gpu::test::must(Device::create(desc));
        EXPECT_TRUE(gpu::Kernel::create(device.context(), spec, gpu::Stage::Compute));
    };
    use();
    std::filesystem::path file;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.is_regular_file()) file = entry.path();
    }
    ASSERT_FALSE(file.empty());
    use();
    EXPECT_TRUE(messages.empty()) << messages.front();
    std::vector<std::byte> bytes = read_file(file).value();
    bytes.back() ^= std::byte{1};
    ASSERT_TRUE(write_file(file, bytes));
    use();
    EXPECT_EQ(messages.size(), 1U);
    use();
    EXPECT_EQ(messages.size(), 1U) << "mended";
    std::filesystem::remove_all(folder);
}

TEST(GpuContext, ErrorsNameTheResult) {
    const Result<> lost = gpu::test::context().check(VK_ERROR_DEVICE_LOST, "submitting");
    ASSERT_FALSE(lost);
    EXPECT_EQ(lost.error().text, "submitting failed: VK_ERROR_DEVICE_LOST");
    EXPECT_EQ(lost.error().fault, Fault::Machine);
    EXPECT_EQ(lost.error().code, ErrorCode::DeviceLost);
    for (const VkResult result :
         {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_POOL_MEMORY})
        EXPECT_EQ(gpu::test::context().check(result, "allocating").error().code, ErrorCode::OutOfMemory);
    for (const VkResult result : {VK_ERROR_FEATURE_NOT_PRESENT, VK_ERROR_EXTENSION_NOT_PRESENT,
                                  VK_ERROR_INCOMPATIBLE_DRIVER, VK_ERROR_FORMAT_NOT_SUPPORTED})
        EXPECT_EQ(gpu::test::context().check(result, "creating").error().code, ErrorCode::Unsupported);
    EXPECT_EQ(gpu::test::context().check(VK_ERROR_UNKNOWN, "creating").error().code, ErrorCode::Other);
}

TEST(GpuTimers, MeasureWithoutWaiting) {
    gpu::Context& context = gpu::test::context();
    if (context.traits.timestamp_period_ns <= 0) GTEST_SKIP() << "no timestamps";
    gpu::Timers timers = gpu::test::must(gpu::Timers::create(context, 2, 3));
    std::array<double, 2> milliseconds{-1, -1};
    gpu::test::must(
        gpu::submit_and_wait(context, "resetting", [&](VkCommandBuffer commands) { timers.begin(commands, 1); }));
    EXPECT_EQ(timers.read(1, 3, milliseconds), 0U);
    const VkBufferCopy half{.dstOffset = VkDeviceSize{8} << 20, .size = VkDeviceSize{8} << 20};
    const gpu::Buffer copied = gpu::test::must(
        gpu::Buffer::create(context, 2 * half.size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                            gpu::Memory::Kind::Upload, "a test's time"));
    // The least of some: others may run between two marks.
    std::array<double, 2> least{1e9, 1e9};
    for (int i = 0; i < 8; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        gpu::test::must(gpu::submit_and_wait(context, "marking", [&](VkCommandBuffer commands) {
            timers.begin(commands, 1);
            timers.mark(commands, 1, 0);
            context.vk.CmdCopyBuffer(commands, copied.handle, copied.handle, 1, &half);
            timers.mark(commands, 1, 1);
            timers.mark(commands, 1, 2);
        }));
        const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - begin;
        EXPECT_EQ(timers.read(1, 3, milliseconds), 2U);
        EXPECT_LT(milliseconds[0] + milliseconds[1], passed.count());
        for (std::size_t k = 0; k < 2; ++k) least[k] = std::min(least[k], milliseconds[k]);
    }
    EXPECT_GT(least[0], least[1]) << "8 MiB are copied between the first two";
    EXPECT_GE(least[1], 0.0);
}

}  // namespace

}  // namespace darkroom
