// SPDX-License-Identifier: MIT
#include "gpu/device/dispatch.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "gpu/device/context.hpp"
#include "gpu/kernel/kernel.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom::gpu {

namespace {

std::map<std::string, int>& calls() {
    static std::map<std::string, int> counts;
    return counts;
}

/// Just enough of Vulkan for a kernel to be made and recorded: it counts, and gives out handles that are never used.
void fill_null(Dispatch& vk) {
    vk.GetPhysicalDeviceFormatProperties = [](VkPhysicalDevice, VkFormat, VkFormatProperties* properties) {
        properties->optimalTilingFeatures = ~VkFormatFeatureFlags{0};
    };
    vk.CreateDescriptorSetLayout = [](VkDevice, const VkDescriptorSetLayoutCreateInfo* info,
                                      const VkAllocationCallbacks*, VkDescriptorSetLayout*) {
        calls()["bindings"] = static_cast<int>(info->bindingCount);
        return VK_SUCCESS;
    };
    vk.CreatePipelineLayout = [](VkDevice, const VkPipelineLayoutCreateInfo*, const VkAllocationCallbacks*,
                                 VkPipelineLayout*) { return VK_SUCCESS; };
    vk.CreateShaderModule = [](VkDevice, const VkShaderModuleCreateInfo*, const VkAllocationCallbacks*,
                               VkShaderModule* out) {
        *out = reinterpret_cast<VkShaderModule>(std::uintptr_t{1});
        ++calls()["module"];
        return VK_SUCCESS;
    };
    vk.DestroyShaderModule = [](VkDevice, VkShaderModule, const VkAllocationCallbacks*) { --calls()["module"]; };
    vk.CreateComputePipelines = [](VkDevice, VkPipelineCache, std::uint32_t, const VkComputePipelineCreateInfo*,
                                   const VkAllocationCallbacks*, VkPipeline*) { return VK_SUCCESS; };
    vk.CreateGraphicsPipelines = [](VkDevice, VkPipelineCache, std::uint32_t, const VkGraphicsPipelineCreateInfo*,
                                    const VkAllocationCallbacks*, VkPipeline*) { return VK_ERROR_DEVICE_LOST; };
    vk.DestroyPipeline = [](VkDevice, VkPipeline, const VkAllocationCallbacks*) {};
    vk.DestroyPipelineLayout = [](VkDevice, VkPipelineLayout, const VkAllocationCallbacks*) {};
    vk.DestroyDescriptorSetLayout = [](VkDevice, VkDescriptorSetLayout, const VkAllocationCallbacks*) {};
    vk.UpdateDescriptorSets = [](VkDevice, std::uint32_t count, const VkWriteDescriptorSet*, std::uint32_t,
                                 const VkCopyDescriptorSet*) { calls()["writes"] = static_cast<int>(count); };
    vk.CmdBindPipeline = [](VkCommandBuffer, VkPipelineBindPoint, VkPipeline) { ++calls()["bind"]; };
    vk.CmdBindDescriptorSets = [](VkCommandBuffer, VkPipelineBindPoint, VkPipelineLayout, std::uint32_t, std::uint32_t,
                                  const VkDescriptorSet*, std::uint32_t, const std::uint32_t*) {};
    vk.CmdDispatch = [](VkCommandBuffer, std::uint32_t x, std::uint32_t y, std::uint32_t) {
        calls()["groups"] = static_cast<int>(100 * x + y);
    };
}

TEST(GpuDispatch, AKernelNeedsNoDevice) {
    calls().clear();
    Context context;
    fill_null(context.vk);
    context.shaders = std::make_unique<ShaderCompiler>(std::filesystem::path());
    const KernelSpec spec{.name = "null",
                          .images = {{.name = "scene"}},
                          .outputs = {VK_FORMAT_R8G8B8A8_UNORM},
                          .members = {{BlockMember::Type::Float, "gain"}},
                          .body = "vec4 shade(Pixel pixel) { return load(scene, pixel.texel) * gain; }"};
    const Result<std::unique_ptr<Kernel>> kernel = Kernel::create(context, spec, Stage::Compute);
    ASSERT_TRUE(kernel) << kernel.error().text;
    EXPECT_EQ(context.pipelines_created, 1U);
    const Binding scene;
    const Binding output{.region = {.extent = {33, 16}, .image = {33, 16}}};
    (*kernel)->write_set({.images = {&scene, 1}, .outputs = {&output, 1}});
    (*kernel)->record(VK_NULL_HANDLE, VK_NULL_HANDLE, {&output, 1});
    EXPECT_EQ(calls()["bindings"], 3);
    EXPECT_EQ(calls()["writes"], 3);
    EXPECT_EQ(calls()["bind"], 1);
    EXPECT_EQ(calls()["groups"], 302);
    EXPECT_EQ(calls()["module"], 0) << "modules are destroyed";

    const Result<std::unique_ptr<Kernel>> failing = Kernel::create(context, spec, Stage::Raster);
    ASSERT_FALSE(failing);
    EXPECT_EQ(failing.error().text, "creating the raster pipeline of \"null\" failed: VK_ERROR_DEVICE_LOST");
    EXPECT_EQ(calls()["module"], 0) << "modules are destroyed";
}

TEST(GpuDispatch, NamesMissingFunctions) {
    Dispatch vk;
    vk.GetDeviceProcAddr = [](VkDevice, const char* name) -> PFN_vkVoidFunction {
        const std::string_view wanted(name);
        if (wanted == "vkCmdDispatch" || wanted == "vkCmdBeginRendering") return nullptr;
        return [] {};
    };
    const Result<> loaded = vk.load_device(VK_NULL_HANDLE, false);
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().text, "the Vulkan driver lacks the functions vkCmdDispatch, vkCmdBeginRendering");
    EXPECT_EQ(vk.SetDebugUtilsObjectNameEXT, nullptr);
}

TEST(GpuDispatch, PromotedFunctionsAreAskedForByTheNamesThatTheDeviceHas) {
    for (const PromotedNames names : {PromotedNames::Core, PromotedNames::Khr}) {
        static std::set<std::string> asked;
        asked.clear();
        Dispatch vk;
        vk.GetDeviceProcAddr = [](VkDevice, const char* name) -> PFN_vkVoidFunction {
            asked.insert(name);
            return [] {};
        };
        ASSERT_TRUE(vk.load_device(VK_NULL_HANDLE, false, names));
        for (const std::string name : {"vkQueueSubmit2", "vkCmdPipelineBarrier2", "vkCmdWriteTimestamp2",
                                       "vkCmdBeginRendering", "vkCmdEndRendering"}) {
            EXPECT_EQ(asked.contains(name), names == PromotedNames::Core) << name;
            EXPECT_EQ(asked.contains(name + "KHR"), names == PromotedNames::Khr) << name;
        }
    }
}

}  // namespace

}  // namespace darkroom::gpu
