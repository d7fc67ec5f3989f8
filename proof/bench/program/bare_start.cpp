// SPDX-License-Identifier: MIT
#include "bare_start.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>

#include "bench/chain/full_screen.hpp"
#include "core/files.hpp"
#include "gpu/device/loader.hpp"

namespace darkroom::bench {

namespace {

/// An instance and a device, and all that was made on it.
struct Bare {
    Bare() = default;
    Bare(const Bare&) = delete;
    Bare& operator=(const Bare&) = delete;
    ~Bare() {
        for (const VkPipeline pipeline : pipelines) vk.DestroyPipeline(device, pipeline, nullptr);
        for (const VkPipelineLayout layout : layouts) vk.DestroyPipelineLayout(device, layout, nullptr);
        for (const VkDescriptorSetLayout set : sets) vk.DestroyDescriptorSetLayout(device, set, nullptr);
        for (const VkShaderModule module : modules) vk.DestroyShaderModule(device, module, nullptr);
        if (cache != VK_NULL_HANDLE) vk.DestroyPipelineCache(device, cache, nullptr);
        if (device != VK_NULL_HANDLE) vk.DestroyDevice(device, nullptr);
        if (instance != VK_NULL_HANDLE) vk.DestroyInstance(instance, nullptr);
    }
    gpu::Dispatch vk;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkPipelineCache cache = VK_NULL_HANDLE;
    std::vector<VkShaderModule> modules;
    std::vector<VkDescriptorSetLayout> sets;
    std::vector<VkPipelineLayout> layouts;
    std::vector<VkPipeline> pipelines;
};

Result<> check(VkResult result, std::string_view what) {
    if (result == VK_SUCCESS) return {};
    return machine_error(fmt::format("{} failed: {}", what, gpu::result_name(result)));
}

Result<> find_device(Bare& bare, const std::string& name) {
    std::uint32_t count = 0;
    bare.vk.EnumeratePhysicalDevices(bare.instance, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    bare.vk.EnumeratePhysicalDevices(bare.instance, &count, devices.data());
    for (const VkPhysicalDevice device : devices) {
        VkPhysicalDeviceProperties properties{};
        bare.vk.GetPhysicalDeviceProperties(device, &properties);
        if (name == properties.deviceName) bare.physical_device = device;
    }
    if (bare.physical_device == VK_NULL_HANDLE) return machine_error(fmt::format("\"{}\": the device is gone", name));
    return {};
}

Result<> create_device(Bare& bare, const std::string& name) {
    DARKROOM_TRY_VALUE(const auto loader, gpu::open_vulkan_loader());
    DARKROOM_TRY(bare.vk.load_loader(loader));
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo instance_info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                             .pApplicationInfo = &application};
    DARKROOM_TRY(check(bare.vk.CreateInstance(&instance_info, nullptr, &bare.instance), "creating an instance"));
    DARKROOM_TRY(bare.vk.load_instance(bare.instance, false));
    DARKROOM_TRY(find_device(bare, name));
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue_info{
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    VkPhysicalDeviceVulkan13Features features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    features.synchronization2 = VK_TRUE;
    features.dynamicRendering = VK_TRUE;
    VkPhysicalDeviceFeatures core{};
    core.shaderStorageImageExtendedFormats = VK_TRUE;
    core.shaderStorageImageWriteWithoutFormat = VK_TRUE;
    const VkDeviceCreateInfo device_info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                         .pNext = &features,
                                         .queueCreateInfoCount = 1,
                                         .pQueueCreateInfos = &queue_info,
                                         .pEnabledFeatures = &core};
    auto ok =
        check(bare.vk.CreateDevice(bare.physical_device, &device_info, nullptr, &bare.device), "creating a device");
    return ok ? bare.vk.load_device(bare.device, false) : ok;
}

Result<VkPipelineShaderStageCreateInfo> load_stage(Bare& bare, const std::filesystem::path& path,
                                                   VkShaderStageFlagBits stage) {
    DARKROOM_TRY_VALUE(const auto bytes, read_file(path));
    const void* const words = bytes.data();
    const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = bytes.size(),
                                        .pCode = static_cast<const std::uint32_t*>(words)};
    VkShaderModule module = VK_NULL_HANDLE;
    DARKROOM_TRY(check(bare.vk.CreateShaderModule(bare.device, &info, nullptr, &module), "creating a shader module"));
    bare.modules.push_back(module);
    return VkPipelineShaderStageCreateInfo{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                           .stage = stage,
                                           .module = module,
                                           .pName = "main"};
}

Result<> make_pipeline(Bare& bare, const BarePipeline& wanted) {
    const VkDescriptorSetLayoutCreateInfo set_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                   .bindingCount = static_cast<std::uint32_t>(wanted.bindings.size()),
                                                   .pBindings = wanted.bindings.data()};
    VkResult result = bare.vk.CreateDescriptorSetLayout(bare.device, &set_info, nullptr, &bare.sets.emplace_back());
    DARKROOM_TRY(check(result, "creating a set layout"));
    const VkPipelineLayoutCreateInfo layout_info{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, .setLayoutCount = 1, .pSetLayouts = &bare.sets.back()};
    result = bare.vk.CreatePipelineLayout(bare.device, &layout_info, nullptr, &bare.layouts.emplace_back());
    DARKROOM_TRY(check(result, "creating a pipeline layout"));

    const bool is_compute = wanted.vertex.empty();
    DARKROOM_TRY_VALUE(
        auto shader,
        load_stage(bare, wanted.shader, is_compute ? VK_SHADER_STAGE_COMPUTE_BIT : VK_SHADER_STAGE_FRAGMENT_BIT));
    if (is_compute) {
        const VkComputePipelineCreateInfo info{
            .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO, .stage = shader, .layout = bare.layouts.back()};
        VkPipeline& pipeline = bare.pipelines.emplace_back();
        return check(bare.vk.CreateComputePipelines(bare.device, bare.cache, 1, &info, nullptr, &pipeline),
                     "creating a pipeline");
    }
    DARKROOM_TRY_VALUE(auto vertex, load_stage(bare, wanted.vertex, VK_SHADER_STAGE_VERTEX_BIT));
    const std::array stages{vertex, shader};
    return check(create_full_screen_pipeline(
                     bare.vk, bare.device, bare.cache,
                     {.layout = bare.layouts.back(), .stages = stages, .output = wanted.output, .blend = wanted.blend},
                     bare.pipelines.emplace_back()),
                 "creating a pipeline");
}

}  // namespace

Result<double> bare_start(const std::string& device_name, const std::vector<BarePipeline>& pipelines,
                          std::span<const std::byte> pipeline_cache) {
    const auto start = std::chrono::steady_clock::now();
    Bare bare;
    DARKROOM_TRY(create_device(bare, device_name));
    const VkPipelineCacheCreateInfo cache_info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                               .initialDataSize = pipeline_cache.size(),
                                               .pInitialData = pipeline_cache.data()};
    auto made =
        check(bare.vk.CreatePipelineCache(bare.device, &cache_info, nullptr, &bare.cache), "creating a pipeline cache");
    for (const BarePipeline& pipeline : pipelines)
        if (made) made = make_pipeline(bare, pipeline);
    if (!made) return failure(std::move(made));
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace darkroom::bench
