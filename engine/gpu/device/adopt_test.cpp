// SPDX-License-Identifier: MIT
#include <darkroom/device.hpp>
#include <map>
#include <set>
#include <string_view>

#include "draw/pipeline.hpp"
#include "gpu/device/loader.hpp"
#include "gpu/device/test_host_desc.hpp"
#include "gpu/test_run.hpp"

namespace darkroom {

namespace {

using gpu::Context;
using gpu::Dispatch;
using gpu::test::cache_folder;
using gpu::test::has;
using gpu::test::host_desc;

const gpu::KernelSpec red{.name = "red",
                          .outputs = {VK_FORMAT_R32G32B32A32_SFLOAT},
                          .body = "vec4 shade(Pixel p) { return vec4(1, 0.5, 0, 1); }"};

/// Features as the extensions have them, one structure each.
struct Features {
    Features() = default;
    Features(const Features&) = delete;
    Features& operator=(const Features&) = delete;
    VkPhysicalDeviceSynchronization2Features synchronization{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, .synchronization2 = VK_TRUE};
    VkPhysicalDeviceDynamicRenderingFeatures rendering{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES,
        .pNext = &synchronization,
        .dynamicRendering = VK_TRUE};
    VkPhysicalDeviceFeatures2 all{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &rendering};
};

PFN_vkGetInstanceProcAddr real_get_proc = nullptr;
PFN_vkGetDeviceProcAddr real_get_device_proc = nullptr;
PFN_vkGetPhysicalDeviceProperties real_properties = nullptr;

bool is_hidden(std::string_view name) {
    static const std::set<std::string_view> hidden{"vkQueueSubmit2", "vkCmdPipelineBarrier2", "vkCmdWriteTimestamp2",
                                                   "vkCmdBeginRendering", "vkCmdEndRendering"};
    return hidden.contains(name);
}

void properties_of_1_2(VkPhysicalDevice device, VkPhysicalDeviceProperties* properties) {
    real_properties(device, properties);
    properties->apiVersion = VK_API_VERSION_1_2;
}

PFN_vkVoidFunction device_proc_of_1_2(VkDevice device, const char* name) {
    return is_hidden(name) ? nullptr : real_get_device_proc(device, name);
}

/// A loader on whose devices Vulkan ends at 1.2: it says so, and has none of the later functions.
PFN_vkVoidFunction get_proc_of_1_2(VkInstance instance, const char* name) {
    const std::string_view wanted(name);
    if (wanted == "vkGetPhysicalDeviceProperties") return reinterpret_cast<PFN_vkVoidFunction>(properties_of_1_2);
    if (wanted == "vkGetDeviceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(device_proc_of_1_2);
    return is_hidden(wanted) ? nullptr : real_get_proc(instance, name);
}

/// An engine that targets Vulkan 1.2 and has enabled both extensions.
class Host {
  public:
    Host() {
        real_get_proc = gpu::test::must(gpu::open_vulkan_loader());
        gpu::test::must(vk.load_loader(real_get_proc));
        const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                            .apiVersion = VK_API_VERSION_1_2};
        const VkInstanceCreateInfo instance_info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                                 .pApplicationInfo = &application};
        EXPECT_EQ(vk.CreateInstance(&instance_info, nullptr, &instance), VK_SUCCESS);
        gpu::test::must(vk.load_instance(instance, false));
        real_properties = vk.GetPhysicalDeviceProperties;
        real_get_device_proc = vk.GetDeviceProcAddr;
        find_device();
        const float priority = 1;
        const VkDeviceQueueCreateInfo queue_info{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                                 .queueFamilyIndex = gpu::test::context().queue_family,
                                                 .queueCount = 1,
                                                 .pQueuePriorities = &priority};
        const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .pNext = &features.all,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue_info,
                                      .enabledExtensionCount = 2,
                                      .ppEnabledExtensionNames = gpu::promoted_extensions.data()};
        EXPECT_EQ(vk.CreateDevice(physical_device, &info, nullptr, &device), VK_SUCCESS);
        gpu::test::must(vk.load_device(device, false, gpu::PromotedNames::Khr));
        vk.GetDeviceQueue(device, queue_info.queueFamilyIndex, 0, &queue);
    }
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;
    ~Host() {
        vk.DestroyDevice(device, nullptr);
        vk.DestroyInstance(instance, nullptr);
    }
    [[nodiscard]] AdoptDesc desc() const {
        return {.instance = instance,
                .physical_device = physical_device,
                .device = device,
                .queue_family = gpu::test::context().queue_family,
                .api_version = VK_API_VERSION_1_2,
                .enabled_features = &features.all,
                .enabled_device_extensions = gpu::promoted_extensions,
                .get_proc = get_proc_of_1_2,
                .cache_folder = cache_folder};
    }

    Dispatch vk;
    Features features;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;

  private:
    void find_device() {
        std::uint32_t count = 0;
        vk.EnumeratePhysicalDevices(instance, &count, nullptr);
        std::vector<VkPhysicalDevice> devices(count);
        vk.EnumeratePhysicalDevices(instance, &count, devices.data());
        for (const VkPhysicalDevice candidate : devices) {
            VkPhysicalDeviceProperties properties{};
            vk.GetPhysicalDeviceProperties(candidate, &properties);
            if (gpu::test::device().info().name == properties.deviceName) physical_device = candidate;
        }
    }
};

bool has_extended_formats(const Host& host) {
    VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    host.vk.GetPhysicalDeviceFeatures2(host.physical_device, &features);
    return features.features.shaderStorageImageExtendedFormats == VK_TRUE;
}

TEST(GpuAdopt, KernelsRunOnVulkan12WithBothExtensions) {
    const Host host;
    const Result<Device> device = Device::adopt(host.desc());
    ASSERT_TRUE(device) << device.error().text;
    Context& context = device->context();
    EXPECT_EQ(device->info().api_version, VK_API_VERSION_1_2);
    context.queue = host.queue;
    for (const gpu::Stage stage : {gpu::Stage::Compute, gpu::Stage::Raster}) {
        const std::unique_ptr<gpu::Kernel> kernel = gpu::test::must(gpu::Kernel::create(context, red, stage));
        gpu::test::Picture out = gpu::test::blank(context, {5, 3}, VK_FORMAT_R32G32B32A32_SFLOAT);
        gpu::test::run_kernel(context, *kernel, {.outputs = {&out}});
        EXPECT_EQ(gpu::test::download(context, out).at(4, 2), (std::array{1.0F, 0.5F, 0.0F, 1.0F}));
    }
    gpu::Timers timers = gpu::test::must(gpu::Timers::create(context, 1, 2));
    gpu::test::must(gpu::submit_and_wait(context, "marking", [&](VkCommandBuffer commands) {
        timers.begin(commands, 0);
        timers.mark(commands, 0, 0);
        timers.mark(commands, 0, 1);
    }));
    double milliseconds = -1;
    EXPECT_EQ(timers.read(0, 2, {&milliseconds, 1}), !timers.pools.empty() ? 1U : 0U);
}

TEST(GpuAdopt, NamesTheExtensionsThatVulkan12Lacks) {
    const Host host;
    AdoptDesc desc = host.desc();
    const std::array only_one{VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME};
    desc.enabled_device_extensions = only_one;
    const Result<Device> one = Device::adopt(desc);
    ASSERT_FALSE(one);
    EXPECT_TRUE(has(one.error().text,
                    "it lacks Vulkan 1.3 (the device has 1.2) or VK_KHR_dynamic_rendering in "
                    "enabled_device_extensions"))
        << one.error().text;
    EXPECT_FALSE(has(one.error().text, "VK_KHR_synchronization2")) << one.error().text;
    desc.enabled_device_extensions = {};
    desc.get_proc = real_get_proc;
    const Result<Device> none = Device::adopt(desc);
    ASSERT_FALSE(none);
    EXPECT_TRUE(has(none.error().text, "Vulkan 1.3 (api_version is 1.2) or VK_KHR_synchronization2"))
        << "the instance is the reason, not the device: " << none.error().text;
}

// What a host has to change is its own code, not its machine.
TEST(GpuAdopt, AFeatureThatIsThereAndNotEnabledIsToldAsThat) {
    const Host host;
    AdoptDesc desc = host.desc();
    VkPhysicalDeviceVulkan13Features half{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                          .synchronization2 = VK_TRUE};
    const VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &half};
    desc.enabled_features = &features;
    const Result<Device> one = Device::adopt(desc);
    ASSERT_FALSE(one);
    EXPECT_TRUE(has(one.error().text,
                    "the feature dynamicRendering (it has it, but it is not enabled: not in enabled_features)"))
        << one.error().text;
    EXPECT_FALSE(has(one.error().text, "synchronization2")) << one.error().text;
    desc.enabled_features = nullptr;
    const Result<Device> none = Device::adopt(desc);
    ASSERT_FALSE(none);
    EXPECT_TRUE(has(none.error().text, "not enabled: enabled_features is null")) << none.error().text;
}

// The same of a feature that one kernel asks for.
TEST(GpuAdopt, AKernelTellsAFeatureThatIsMissingFromOneThatIsNotEnabled) {
    const Host host;
    const Device device = gpu::test::must(Device::adopt(host.desc()));
    gpu::KernelSpec spec = red;
    spec.outputs = {VK_FORMAT_R16_SFLOAT};
    const auto refusal = [&] {
        const auto usable = gpu::usable(device.context(), spec, gpu::Stage::Compute);
        return usable ? std::string("none") : usable.error().text;
    };
    if (!has_extended_formats(host)) GTEST_SKIP() << "this device has no shaderStorageImageExtendedFormats";
    EXPECT_TRUE(refusal().ends_with(": shaderStorageImageExtendedFormats is not enabled")) << refusal();
    device.context().vk.GetPhysicalDeviceFeatures2 = [](VkPhysicalDevice, VkPhysicalDeviceFeatures2* features) {
        features->features = {};
    };
    EXPECT_TRUE(refusal().ends_with(": the device has no shaderStorageImageExtendedFormats")) << refusal();
}

TEST(GpuAdopt, AnInstanceThatIsTooOldIsTheReasonGiven) {
    const Host host;
    AdoptDesc desc = host.desc();
    desc.api_version = VK_API_VERSION_1_1;
    const Result<Device> told = Device::adopt(desc);
    ASSERT_FALSE(told);
    EXPECT_EQ(told.error().fault, Fault::User);
    EXPECT_EQ(told.error().text, "adopting a device: api_version is 1.1; the instance must be made for 1.2 or later");
    // The host says nothing of its version, and the driver has no functions beyond it.
    desc.api_version = VK_API_VERSION_1_3;
    desc.get_proc = [](VkInstance instance, const char* name) -> PFN_vkVoidFunction {
        if (std::string_view(name) == "vkGetDeviceProcAddr") return get_proc_of_1_2(instance, name);
        return real_get_proc(instance, name);
    };
    const Result<Device> untold = Device::adopt(desc);
    ASSERT_FALSE(untold);
    EXPECT_TRUE(has(untold.error().text, "vkCmdPipelineBarrier2")) << untold.error().text;
    EXPECT_TRUE(has(untold.error().text, "the instance was made for an older Vulkan than api_version says (1.3)"))
        << untold.error().text;
}

TEST(GpuAdopt, DebugUtilsIsAnExtensionOfTheInstance) {
    if (!gpu::test::context().traits.has_debug_labels) GTEST_SKIP() << "no VK_EXT_debug_utils here";
    const Features features;
    const std::array names{VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    AdoptDesc desc = host_desc(&features.all);
    desc.enabled_device_extensions = names;
    const Device without = gpu::test::must(Device::adopt(desc));
    EXPECT_FALSE(without.context().traits.has_debug_labels);
    desc.enabled_device_extensions = {};
    desc.enabled_instance_extensions = names;
    const Device with = gpu::test::must(Device::adopt(desc));
    EXPECT_TRUE(with.context().traits.has_debug_labels);
    EXPECT_NE(with.context().vk.CmdBeginDebugUtilsLabelEXT, nullptr);
}

/// Memory that a host hands out, and how much of it is in use.
struct Allocations {
    static void* allocate(void* user, std::size_t size, std::size_t alignment, VkSystemAllocationScope) {
        auto& self = *static_cast<Allocations*>(user);
        const std::lock_guard lock(self.mutex);
        // aligned_alloc wants whole multiples.
        const std::size_t aligned = std::max(alignment, alignof(std::max_align_t));
        void* const memory = std::aligned_alloc(aligned, (size + aligned - 1) / aligned * aligned);
        self.live[memory] = size;
        ++self.count;
        return memory;
    }
    static void* reallocate(void* user, void* old, std::size_t size, std::size_t alignment,
                            VkSystemAllocationScope scope) {
        auto& self = *static_cast<Allocations*>(user);
        void* const memory = size > 0 ? allocate(user, size, alignment, scope) : nullptr;
        if (old != nullptr && memory != nullptr) std::memcpy(memory, old, std::min(size, self.live[old]));
        free(user, old);
        return memory;
    }
    static void free(void* user, void* memory) {
        auto& self = *static_cast<Allocations*>(user);
        const std::lock_guard lock(self.mutex);
        self.live.erase(memory);
        std::free(memory);
    }
    VkAllocationCallbacks callbacks{
        .pUserData = this, .pfnAllocation = allocate, .pfnReallocation = reallocate, .pfnFree = free};
    std::mutex mutex;
    std::map<void*, std::size_t> live;
    std::size_t count = 0;
};

struct Calls {
    int with_allocator = 0, without = 0;
};
Calls& calls() {
    static Calls counts;
    return counts;
}
const VkAllocationCallbacks* expected_allocator = nullptr;

template <class Argument>
void note(const Argument&) {}
void note(const VkAllocationCallbacks* const& allocator) {
    ++(allocator == expected_allocator ? calls().with_allocator : calls().without);
}

/// Counts the calls of one entry by whether they pass the host's allocator.
template <auto Member, class Value, class... Arguments>
void watch(Dispatch& vk, Value (*Dispatch::*)(Arguments...)) {
    static Value (*original)(Arguments...) = nullptr;
    original = vk.*Member;
    vk.*Member = [](Arguments... arguments) -> Value {
        (note(arguments), ...);
        return original(arguments...);
    };
}
template <auto... Members>
void watch_all(Dispatch& vk) {
    (watch<Members>(vk, Members), ...);
}

TEST(GpuAdopt, EveryObjectIsMadeAndDestroyedWithTheHostsAllocator) {
    Allocations allocations;
    const Features features;
    AdoptDesc desc = host_desc(&features.all);
    desc.allocator = expected_allocator = &allocations.callbacks;
    calls() = {};
    {
        const Device device = gpu::test::must(Device::adopt(desc));
        Context& context = device.context();
        watch_all<
            &Dispatch::AllocateMemory, &Dispatch::FreeMemory, &Dispatch::CreateBuffer, &Dispatch::DestroyBuffer,
            &Dispatch::CreateImage, &Dispatch::DestroyImage, &Dispatch::CreateImageView, &Dispatch::DestroyImageView,
            &Dispatch::CreateSampler, &Dispatch::DestroySampler, &Dispatch::CreateShaderModule,
            &Dispatch::DestroyShaderModule, &Dispatch::CreatePipelineCache, &Dispatch::DestroyPipelineCache,
            &Dispatch::CreateComputePipelines, &Dispatch::CreateGraphicsPipelines, &Dispatch::DestroyPipeline,
            &Dispatch::CreatePipelineLayout, &Dispatch::DestroyPipelineLayout, &Dispatch::CreateDescriptorSetLayout,
            &Dispatch::DestroyDescriptorSetLayout, &Dispatch::CreateDescriptorPool, &Dispatch::DestroyDescriptorPool,
            &Dispatch::CreateQueryPool, &Dispatch::DestroyQueryPool, &Dispatch::CreateFence, &Dispatch::DestroyFence,
            &Dispatch::CreateCommandPool, &Dispatch::DestroyCommandPool>(context.vk);
        context.queue = gpu::test::context().queue;
        for (const gpu::Stage stage : {gpu::Stage::Compute, gpu::Stage::Raster}) {
            const std::unique_ptr<gpu::Kernel> kernel = gpu::test::must(gpu::Kernel::create(context, red, stage));
            gpu::test::Picture out = gpu::test::blank(context, {4, 4}, VK_FORMAT_R32G32B32A32_SFLOAT);
            gpu::test::run_kernel(context, *kernel, {.outputs = {&out}});
        }
        const gpu::Timers timers = gpu::test::must(gpu::Timers::create(context, 1, 2));
        const gpu::SetLayout::Binding binding{};
        const gpu::SetLayout layout = gpu::test::must(gpu::SetLayout::create(context, {&binding, 1}));
        EXPECT_FALSE(allocations.live.empty());
    }
    EXPECT_EQ(calls().without, 0);
    EXPECT_GE(calls().with_allocator, 50);
    EXPECT_TRUE(allocations.live.empty()) << allocations.live.size() << " of " << allocations.count;
}

/// Device memory that a host hands out.
struct Pool {
    static VkResult allocate(void* user, VkDevice device, const DeviceMemoryRequest* request, DeviceMemory* memory) {
        auto& self = *static_cast<Pool*>(user);
        const Dispatch& vk = gpu::test::context().vk;
        ++self.asked;
        if (self.is_exhausted) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .allocationSize = self.offset + request->size,
                                        .memoryTypeIndex = request->memory_type};
        if (const VkResult result = vk.AllocateMemory(device, &info, nullptr, &memory->memory); result != VK_SUCCESS)
            return result;
        self.live.insert(memory->memory);
        memory->offset = self.offset;
        memory->owner = user;
        return request->is_mapped && self.maps
                   ? vk.MapMemory(device, memory->memory, self.offset, request->size, 0, &memory->mapped)
                   : VK_SUCCESS;
    }
    static void free(void* user, VkDevice device, const DeviceMemory* memory) {
        EXPECT_EQ(memory->owner, user);
        static_cast<Pool*>(user)->live.erase(memory->memory);
        gpu::test::context().vk.FreeMemory(device, memory->memory, nullptr);
    }
    std::set<VkDeviceMemory> live;
    int asked = 0;
    bool is_exhausted = false;
    bool maps = true;
    VkDeviceSize offset = 0;
};

TEST(GpuAdopt, DeviceMemoryComesFromTheHostsHooksAlone) {
    Pool pool;
    const Features features;
    AdoptDesc desc = host_desc(&features.all);
    desc.memory = {.allocate = Pool::allocate, .free = Pool::free, .user = &pool};
    const Device device = gpu::test::must(Device::adopt(desc));
    Context& context = device.context();
    context.vk.AllocateMemory = nullptr;
    context.vk.FreeMemory = nullptr;
    const gpu::ImageInfo info{
        .name = "test", .format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {8, 8, 1}, .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    {
        const gpu::Image image = gpu::test::must(gpu::Image::create(context, info));
        gpu::Buffer buffer = gpu::test::must(
            gpu::Buffer::create(context, 64, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, gpu::Memory::Kind::Constants, "test"));
        EXPECT_NE(buffer.memory.mapped, nullptr);
        EXPECT_EQ(pool.live.size(), 2U);
        const gpu::Buffer moved = std::move(buffer);
        EXPECT_EQ(pool.live.size(), 2U);
    }
    EXPECT_TRUE(pool.live.empty());
    const auto refused_upload = [&] {
        const auto buffer =
            gpu::Buffer::create(context, 64, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Memory::Kind::Upload, "test");
        EXPECT_FALSE(buffer);
        EXPECT_TRUE(pool.live.empty());
        return buffer ? "" : buffer.error().text;
    };
    pool.maps = false;
    EXPECT_TRUE(has(refused_upload(), "the buffer \"test\": the host's memory.allocate gave memory not mapped"));
    pool.maps = true;
    pool.offset = 1;
    EXPECT_TRUE(has(refused_upload(), "gave memory at 1, which is not a multiple of "));
    pool.offset = 0;
    pool.is_exhausted = true;
    const int asked = pool.asked;
    const Result<gpu::Image> refused = gpu::Image::create(context, info);
    ASSERT_FALSE(refused);
    EXPECT_TRUE(has(refused.error().text, "of memory for the image \"test\" failed: VK_ERROR_OUT_OF_DEVICE_MEMORY"))
        << refused.error().text;
    EXPECT_EQ(refused.error().code, ErrorCode::OutOfMemory);
    EXPECT_GT(pool.asked, asked);
}

TEST(GpuAdopt, HalfAPairOfMemoryHooksIsRefused) {
    const Features features;
    AdoptDesc desc = host_desc(&features.all);
    desc.memory = {.allocate = Pool::allocate};
    const Result<Device> device = Device::adopt(desc);
    ASSERT_FALSE(device);
    EXPECT_EQ(device.error().text, "adopting a device: memory.allocate is given without memory.free");
}

PFN_vkCreateComputePipelines real_create_compute = nullptr;
VkPipelineCache used_cache = VK_NULL_HANDLE;

TEST(GpuAdopt, TheHostsPipelineCacheIsUsedAndNeitherSavedNorDestroyed) {
    const std::filesystem::path folder = ::testing::TempDir() + "darkroom_host_pipeline_cache_test";
    std::filesystem::remove_all(folder);
    const Context& host = gpu::test::context();
    const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    VkPipelineCache cache = VK_NULL_HANDLE;
    ASSERT_EQ(host.vk.CreatePipelineCache(host.device, &info, nullptr, &cache), VK_SUCCESS);
    const Features features;
    AdoptDesc desc = host_desc(&features.all);
    desc.cache_folder = folder;
    desc.pipeline_cache = cache;
    {
        const Device device = gpu::test::must(Device::adopt(desc));
        Context& context = device.context();
        real_create_compute = context.vk.CreateComputePipelines;
        context.vk.CreateComputePipelines = [](VkDevice of, VkPipelineCache given, std::uint32_t count,
                                               const VkComputePipelineCreateInfo* infos,
                                               const VkAllocationCallbacks* allocator, VkPipeline* out) {
            used_cache = given;
            return real_create_compute(of, given, count, infos, allocator, out);
        };
        EXPECT_TRUE(gpu::Kernel::create(context, red, gpu::Stage::Compute));
        context.save_pipeline_cache_if_grown();
    }
    EXPECT_EQ(used_cache, cache);
    std::size_t size = 0;
    EXPECT_EQ(host.vk.GetPipelineCacheData(host.device, cache, &size, nullptr), VK_SUCCESS) << "it lives";
    host.vk.DestroyPipelineCache(host.device, cache, nullptr);
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        EXPECT_TRUE(entry.is_directory()) << entry.path();
    }
    std::filesystem::remove_all(folder);
}

}  // namespace

}  // namespace darkroom
