// SPDX-License-Identifier: MIT
// Each refusal of the smallest device is seen once: what it reports would prove nothing if the driver below took more.
#include <fmt/format.h>

#include <string_view>

#include "gpu/shader/shader.hpp"
#include "gpu/test_run.hpp"
#include "gpu/test_smallest/facts.hpp"

namespace darkroom::gpu {

namespace {

class GpuSmallestDevice : public ::testing::Test {
  protected:
    /// One refusal, that says this.
    void expect_refused(std::string_view text) {
        const std::vector<std::string> texts = refusals_->texts();
        ASSERT_EQ(texts.size(), 1U) << text;
        EXPECT_EQ(texts.front(), text);
        refusals_.reset();
        refusals_ = std::make_unique<test::Refusals>();
    }
    void expect_refused(VkResult result, std::string_view text) {
        EXPECT_NE(result, VK_SUCCESS) << text;
        expect_refused(text);
    }
    /// A recording with this in it cannot be ended.
    void expect_refused(const std::function<void(VkCommandBuffer)>& commands, std::string_view text) {
        EXPECT_FALSE(submit_and_wait(context, "recording", commands)) << text;
        expect_refused(text);
    }
    VkResult create(VkImageCreateInfo info) {
        info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
        if (info.extent.width == 0) info.extent = {16, 16, 1};
        info.mipLevels = std::max(info.mipLevels, 1U);
        info.arrayLayers = std::max(info.arrayLayers, 1U);
        if (info.samples == 0) info.samples = VK_SAMPLE_COUNT_1_BIT;
        if (info.imageType == VK_IMAGE_TYPE_1D) info.imageType = VK_IMAGE_TYPE_2D;
        if (info.usage == 0) info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
        VkImage image = VK_NULL_HANDLE;
        const VkResult result = vk.CreateImage(context.device, &info, nullptr, &image);
        if (result == VK_SUCCESS) vk.DestroyImage(context.device, image, nullptr);
        return result;
    }
    VkResult create(VkSamplerCreateInfo info) {
        info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
        VkSampler sampler = VK_NULL_HANDLE;
        return vk.CreateSampler(context.device, &info, nullptr, &sampler);
    }
    /// The result, and what was made; destroyed by the caller.
    std::pair<VkResult, VkShaderModule> module_of(std::string text, ShaderStage stage) {
        const auto words =
            test::must(context.shaders->compile({.name = "test", .text = std::move(text), .stage = stage}));
        const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = words.size() * sizeof(std::uint32_t),
                                            .pCode = words.data()};
        VkShaderModule module = VK_NULL_HANDLE;
        const VkResult result = vk.CreateShaderModule(context.device, &info, nullptr, &module);
        return {result, module};
    }
    VkResult compute(const std::string& text, const VkSpecializationInfo* specialization = nullptr) {
        const VkShaderModule module = module_of(text, ShaderStage::Compute).second;
        const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                               .stage = {.stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                         .module = module,
                                                         .pName = "main",
                                                         .pSpecializationInfo = specialization}};
        VkPipeline pipeline = VK_NULL_HANDLE;
        const VkResult result = vk.CreateComputePipelines(context.device, nullptr, 1, &info, nullptr, &pipeline);
        vk.DestroyShaderModule(context.device, module, nullptr);
        return result;
    }
    VkResult layout(VkDescriptorType type, std::uint32_t count, std::uint32_t sets = 1, std::uint32_t pushed = 0,
                    VkShaderStageFlags stages = VK_SHADER_STAGE_COMPUTE_BIT) {
        const VkDescriptorSetLayoutBinding binding{
            .descriptorType = type, .descriptorCount = count, .stageFlags = stages};
        const VkDescriptorSetLayoutCreateInfo set_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                       .bindingCount = count > 0 ? 1U : 0U,
                                                       .pBindings = &binding};
        VkDescriptorSetLayout set = VK_NULL_HANDLE;
        const VkResult made = vk.CreateDescriptorSetLayout(context.device, &set_info, nullptr, &set);
        if (made != VK_SUCCESS) return made;
        const std::vector<VkDescriptorSetLayout> all(sets, set);
        const VkPushConstantRange range{.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT, .size = pushed};
        const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                              .setLayoutCount = sets,
                                              .pSetLayouts = all.data(),
                                              .pushConstantRangeCount = pushed > 0 ? 1U : 0U,
                                              .pPushConstantRanges = &range};
        VkPipelineLayout pipeline_layout = VK_NULL_HANDLE;
        const VkResult result = vk.CreatePipelineLayout(context.device, &info, nullptr, &pipeline_layout);
        if (result == VK_SUCCESS) vk.DestroyPipelineLayout(context.device, pipeline_layout, nullptr);
        vk.DestroyDescriptorSetLayout(context.device, set, nullptr);
        return result;
    }

    /// All that a raster pipeline is made of, to be changed by a test.
    struct Raster {
        VkPipelineVertexInputStateCreateInfo vertices{.sType =
                                                          VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
        VkPipelineRasterizationStateCreateInfo rasterization{
            .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
        VkPipelineMultisampleStateCreateInfo samples{.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                     .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
        VkPipelineDepthStencilStateCreateInfo depth{.sType =
                                                        VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
        VkPipelineViewportStateCreateInfo viewport{.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                                                   .viewportCount = 1};
        std::vector<VkPipelineColorBlendAttachmentState> blends{{}};
        std::vector<VkFormat> formats{VK_FORMAT_R8G8B8A8_UNORM};
        bool has_logic = false;
        std::string fragment = "#version 460\nvoid main() {}\n";
        VkShaderStageFlagBits stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    };
    VkResult raster(const Raster& made_of) {
        const VkShaderModule module = module_of(made_of.fragment, ShaderStage::Fragment).second;
        const VkPipelineShaderStageCreateInfo stage{.stage = made_of.stage, .module = module, .pName = "main"};
        const VkPipelineColorBlendStateCreateInfo blend{
            .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
            .logicOpEnable = made_of.has_logic,
            .attachmentCount = static_cast<std::uint32_t>(made_of.blends.size()),
            .pAttachments = made_of.blends.data()};
        const VkPipelineRenderingCreateInfo rendering{
            .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
            .colorAttachmentCount = static_cast<std::uint32_t>(made_of.formats.size()),
            .pColorAttachmentFormats = made_of.formats.data()};
        const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                                .pNext = &rendering,
                                                .stageCount = 1,
                                                .pStages = &stage,
                                                .pVertexInputState = &made_of.vertices,
                                                .pViewportState = &made_of.viewport,
                                                .pRasterizationState = &made_of.rasterization,
                                                .pMultisampleState = &made_of.samples,
                                                .pDepthStencilState = &made_of.depth,
                                                .pColorBlendState = &blend};
        VkPipeline pipeline = VK_NULL_HANDLE;
        const VkResult result = vk.CreateGraphicsPipelines(context.device, nullptr, 1, &info, nullptr, &pipeline);
        vk.DestroyShaderModule(context.device, module, nullptr);
        return result;
    }

    Context& context = test::shared_device.smallest().context();
    const Dispatch& vk = context.vk;

  private:
    std::unique_ptr<test::Refusals> refusals_ = std::make_unique<test::Refusals>();
};

TEST_F(GpuSmallestDevice, SaysTheLeastOfItself) {
    EXPECT_EQ(context.traits.max_image_dimension, 4096U);
    EXPECT_EQ(context.traits.max_workgroup_invocations, 128U);
    EXPECT_EQ(context.traits.max_storage_images, 4U);
    EXPECT_EQ(context.traits.max_sampled_images, 16U);
    EXPECT_EQ(context.traits.timestamp_valid_bits, 0U);
    EXPECT_FALSE(context.traits.has_extended_storage_formats);
    EXPECT_FALSE(context.is_filterable(VK_FORMAT_R32G32B32A32_SFLOAT));
    EXPECT_TRUE(context.is_filterable(VK_FORMAT_R16G16B16A16_SFLOAT));
    EXPECT_FALSE(context.supports(VK_FORMAT_B10G11R11_UFLOAT_PACK32, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT));
}

TEST_F(GpuSmallestDevice, RefusesFeaturesAndExtensions) {
    VkPhysicalDeviceFeatures core{.samplerAnisotropy = VK_TRUE};
    VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, .pEnabledFeatures = &core};
    VkDevice device = VK_NULL_HANDLE;
    const auto created = [&] { return vk.CreateDevice(context.physical_device, &info, nullptr, &device); };
    expect_refused(created(), "a device feature that is optional");
    VkPhysicalDeviceVulkan12Features later{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                           .shaderFloat16 = VK_TRUE};
    info.pEnabledFeatures = nullptr;
    info.pNext = &later;
    expect_refused(created(), "a device feature that is optional");
    const char* const extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
            .enabledExtensionCount = 1,
            .ppEnabledExtensionNames = &extension};
    expect_refused(created(), "the device extension VK_KHR_swapchain");
    const VkQueryPoolCreateInfo statistics{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                           .queryType = VK_QUERY_TYPE_PIPELINE_STATISTICS,
                                           .queryCount = 1};
    VkQueryPool pool = VK_NULL_HANDLE;
    expect_refused(vk.CreateQueryPool(context.device, &statistics, nullptr, &pool), "a query of pipeline statistics");
}

TEST_F(GpuSmallestDevice, RefusesImages) {
    constexpr VkFormat color = VK_FORMAT_R8G8B8A8_UNORM;
    EXPECT_EQ(create(VkImageCreateInfo{.format = color, .extent = {4096, 1, 1}}), VK_SUCCESS);
    expect_refused(create(VkImageCreateInfo{.format = color, .extent = {4097, 1, 1}}),
                   "an image of 4097 texels a side");
    expect_refused(create(VkImageCreateInfo{.imageType = VK_IMAGE_TYPE_3D, .format = color, .extent = {1, 1, 257}}),
                   "an image of 257 texels a side");
    expect_refused(create(VkImageCreateInfo{.format = color, .arrayLayers = 257}), "an image of 257 layers");
    expect_refused(create(VkImageCreateInfo{.format = color, .mipLevels = 6}), "an image of 6 mip levels");
    expect_refused(create(VkImageCreateInfo{.format = color, .samples = VK_SAMPLE_COUNT_8_BIT}),
                   "an image of 8 samples");
    expect_refused(create(VkImageCreateInfo{.format = color, .tiling = VK_IMAGE_TILING_LINEAR}),
                   "an image of format R8G8B8A8_UNORM with linear tiling");
    expect_refused(create(VkImageCreateInfo{.format = VK_FORMAT_R16G16B16A16_UNORM}),
                   "an image of format R16G16B16A16_UNORM");
    expect_refused(create(VkImageCreateInfo{.format = VK_FORMAT_R16G16_SFLOAT, .usage = VK_IMAGE_USAGE_STORAGE_BIT}),
                   "an image of format R16G16_SFLOAT for features 0x2");
    expect_refused(create(VkImageCreateInfo{.format = VK_FORMAT_B10G11R11_UFLOAT_PACK32,
                                            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}),
                   "an image of format B10G11R11_UFLOAT_PACK32 for features 0x80");
    expect_refused(create(VkImageCreateInfo{.imageType = VK_IMAGE_TYPE_3D, .format = VK_FORMAT_D16_UNORM}),
                   "a depth image that is not 2D");
    const VkImageViewCreateInfo cubes{
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, .viewType = VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, .format = color};
    VkImageView view = VK_NULL_HANDLE;
    expect_refused(vk.CreateImageView(context.device, &cubes, nullptr, &view), "a view of an array of cubes");
    const VkImageViewCreateInfo unknown{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = VK_FORMAT_R8_SRGB};
    expect_refused(vk.CreateImageView(context.device, &unknown, nullptr, &view), "a view of format R8_SRGB");
}

TEST_F(GpuSmallestDevice, RefusesMemory) {
    VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .memoryTypeIndex = 2};
    VkDeviceMemory memory = VK_NULL_HANDLE;
    const auto allocate = [&] { return vk.AllocateMemory(context.device, &info, nullptr, &memory); };
    expect_refused(allocate(), "memory type 2");
    info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = (VkDeviceSize{1} << 30U) + 1};
    expect_refused(allocate(), "an allocation of 1073741825 bytes, beyond 1073741824");
    info.allocationSize = 4096;
    ASSERT_EQ(allocate(), VK_SUCCESS);
    void* mapped = nullptr;
    expect_refused(vk.MapMemory(context.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped),
                   "mapping memory that the CPU does not reach");

    const Buffer buffer = test::must(
        Buffer::create(context, 256, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Memory::Kind::Upload, "test buffer"));
    const Image image = test::must(Image::create(context, {.name = "test image",
                                                           .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                           .extent = {1, 1, 1},
                                                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT}));
    expect_refused(vk.BindImageMemory(context.device, image.handle, buffer.memory.piece.memory, 0),
                   "an image beside a buffer, within bufferImageGranularity");
    expect_refused(vk.BindBufferMemory(context.device, buffer.handle, image.memory.piece.memory, 0),
                   "a buffer beside an image, within bufferImageGranularity");
    info.memoryTypeIndex = test::smallest_host_type;
    VkDeviceMemory host = VK_NULL_HANDLE;
    ASSERT_EQ(vk.AllocateMemory(context.device, &info, nullptr, &host), VK_SUCCESS);
    expect_refused(vk.BindImageMemory(context.device, image.handle, host, 0),
                   "an image in memory of a type that it cannot have");
    vk.FreeMemory(context.device, host, nullptr);

    std::vector<VkDeviceMemory> all{memory};
    while (all.size() < 5000 && allocate() == VK_SUCCESS) all.push_back(memory);
    EXPECT_LT(all.size(), 4097U);
    expect_refused("more than 4096 allocations");
    for (const VkDeviceMemory one : all) vk.FreeMemory(context.device, one, nullptr);

    const VkBufferCreateInfo large{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                   .size = (VkDeviceSize{1} << 30U) + 1,
                                   .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
    VkBuffer too_large = VK_NULL_HANDLE;
    expect_refused(vk.CreateBuffer(context.device, &large, nullptr, &too_large),
                   "a buffer of 1073741825 bytes, beyond 1073741824");
}

TEST_F(GpuSmallestDevice, RefusesSamplers) {
    expect_refused(create(VkSamplerCreateInfo{.anisotropyEnable = VK_TRUE, .maxAnisotropy = 2}),
                   "a sampler with anisotropy");
    expect_refused(create(VkSamplerCreateInfo{.mipLodBias = 2.5F}), "a sampler with a bias of 2.5");
    expect_refused(create(VkSamplerCreateInfo{.addressModeV = VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE}),
                   "a sampler that mirrors once");
    const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    std::vector<VkSampler> all;
    VkSampler sampler = VK_NULL_HANDLE;
    while (all.size() < 5000 && vk.CreateSampler(context.device, &info, nullptr, &sampler) == VK_SUCCESS)
        all.push_back(sampler);
    EXPECT_LT(all.size(), 4001U);
    expect_refused("more than 4000 samplers");
    for (const VkSampler one : all) vk.DestroySampler(context.device, one, nullptr);
}

TEST_F(GpuSmallestDevice, RefusesShaders) {
    const auto stores = [&](std::string_view qualifier) {
        return fmt::format(
            "#version 460\nlayout(local_size_x = 8) in;\nlayout(binding = 0{}) uniform writeonly image2D a;\n"
            "void main() {{ imageStore(a, ivec2(0), vec4(1)); }}\n",
            qualifier);
    };
    expect_refused(module_of(stores(", rg16f"), ShaderStage::Compute).first, "SPIR-V with capability 49");
    expect_refused(module_of(stores(""), ShaderStage::Compute).first, "SPIR-V with capability 56");
    expect_refused(module_of("#version 460\nlayout(binding = 0) uniform sampler2D a; layout(location = 0) out vec4 c;\n"
                             "layout(location = 0) flat in ivec2 o;\n"
                             "void main() { c = textureGatherOffset(a, vec2(0), o); }\n",
                             ShaderStage::Fragment)
                       .first,
                   "SPIR-V with capability 25");
}

TEST_F(GpuSmallestDevice, RefusesWorkgroups) {
    expect_refused(compute("#version 460\nlayout(local_size_x = 129) in;\nvoid main() {}\n"),
                   "a workgroup of 129 x 1 x 1");
    expect_refused(compute("#version 460\nlayout(local_size_x = 16, local_size_y = 16) in;\nvoid main() {}\n"),
                   "a workgroup of 16 x 16 x 1");
    const std::uint32_t size = 200;
    const VkSpecializationMapEntry entry{.constantID = 3, .size = sizeof size};
    const VkSpecializationInfo specialization{
        .mapEntryCount = 1, .pMapEntries = &entry, .dataSize = sizeof size, .pData = &size};
    expect_refused(compute("#version 460\nlayout(local_size_x_id = 3) in;\nvoid main() {}\n", &specialization),
                   "a workgroup of 200 x 1 x 1");
    expect_refused(compute("#version 460\nlayout(local_size_x = 8) in;\nshared vec4 a[1025];\n"
                           "layout(binding = 0) buffer Out { vec4 result; };\n"
                           "void main() {\n"
                           "    a[gl_LocalInvocationIndex] = vec4(gl_LocalInvocationIndex);\n"
                           "    barrier();\n"
                           "    result = a[gl_LocalInvocationIndex + 1];\n"
                           "}\n"),
                   "16400 bytes of shared memory, beyond 16384");
}

TEST_F(GpuSmallestDevice, RefusesLayouts) {
    EXPECT_EQ(layout(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 16), VK_SUCCESS);
    expect_refused(layout(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 17), "17 samplers of a stage, beyond 16");
    expect_refused(layout(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 17), "17 sampled images of a stage, beyond 16");
    expect_refused(layout(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 5), "5 storage images of a stage, beyond 4");
    expect_refused(layout(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 5), "5 storage buffers of a stage, beyond 4");
    expect_refused(layout(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 13), "13 uniform buffers of a stage, beyond 12");
    expect_refused(layout(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 9),
                   "9 dynamic uniform buffers of a pipeline layout, beyond 8");
    expect_refused(layout(VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 97, 1, 0, VK_SHADER_STAGE_GEOMETRY_BIT),
                   "97 sampled images of a pipeline layout, beyond 96");
    expect_refused(layout(VK_DESCRIPTOR_TYPE_SAMPLER, 1025), "1025 descriptors of a set");
    expect_refused(layout(VK_DESCRIPTOR_TYPE_SAMPLER, 1, 5), "5 sets of a pipeline layout, beyond 4");
    expect_refused(layout(VK_DESCRIPTOR_TYPE_SAMPLER, 0, 0, 132), "132 bytes of push constants, beyond 128");
    const VkDescriptorSetLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                               .flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT};
    VkDescriptorSetLayout set = VK_NULL_HANDLE;
    expect_refused(vk.CreateDescriptorSetLayout(context.device, &info, nullptr, &set),
                   "a descriptor set layout with flags");
}

TEST_F(GpuSmallestDevice, RefusesRasterPipelines) {
    const auto refused = [&](const auto& change, std::string_view text) {
        Raster made_of;
        change(made_of);
        expect_refused(raster(made_of), text);
    };
    const std::vector<VkFormat> five(5, VK_FORMAT_R8G8B8A8_UNORM);
    refused([&](Raster& r) { r.formats = five; }, "rendering to 5 images");
    refused([](Raster& r) { r.formats = {VK_FORMAT_B10G11R11_UFLOAT_PACK32}; },
            "rendering to format B10G11R11_UFLOAT_PACK32");
    refused(
        [](Raster& r) {
            r.formats = {VK_FORMAT_R32_SFLOAT};
            r.blends = {{.blendEnable = VK_TRUE}};
        },
        "blending in format R32_SFLOAT");
    refused(
        [](Raster& r) {
            r.formats = {VK_FORMAT_R8_UNORM, VK_FORMAT_R8_UNORM};
            r.blends = {{}, {.blendEnable = VK_TRUE}};
        },
        "attachments that blend differently");
    refused([](Raster& r) { r.has_logic = true; }, "logical operations");
    refused([](Raster& r) { r.stage = VK_SHADER_STAGE_GEOMETRY_BIT; }, "a geometry or tessellation shader");
    refused([](Raster& r) { r.viewport.viewportCount = 2; }, "2 viewports");
    refused([](Raster& r) { r.samples.sampleShadingEnable = VK_TRUE; }, "shading of samples, or an alpha of one");
    refused([](Raster& r) { r.samples.rasterizationSamples = VK_SAMPLE_COUNT_2_BIT; }, "rendering with 2 samples");
    refused([](Raster& r) { r.depth.depthBoundsTestEnable = VK_TRUE; }, "bounds of depth");
    refused([](Raster& r) { r.rasterization.depthClampEnable = VK_TRUE; }, "clamping of depth");
    refused([](Raster& r) { r.rasterization.polygonMode = VK_POLYGON_MODE_LINE; }, "polygons that are not filled");
    refused([](Raster& r) { r.rasterization.lineWidth = 2; }, "wide lines");
    refused(
        [](Raster& r) {
            r.rasterization.depthBiasEnable = VK_TRUE;
            r.rasterization.depthBiasClamp = 0.5F;
        },
        "clamping of the bias of depth");
    refused([](Raster& r) { r.vertices.vertexAttributeDescriptionCount = 17; },
            "too many attributes or bindings of vertices");
    const VkVertexInputAttributeDescription far{.format = VK_FORMAT_R32_SFLOAT, .offset = 2048};
    const VkVertexInputAttributeDescription odd{.format = VK_FORMAT_R8G8B8A8_SRGB};
    const VkVertexInputBindingDescription wide{.stride = 2052};
    const auto attribute = [](const VkVertexInputAttributeDescription& one) {
        return [&](Raster& r) {
            r.vertices.vertexAttributeDescriptionCount = 1;
            r.vertices.pVertexAttributeDescriptions = &one;
        };
    };
    refused(attribute(far), "an attribute too far into a vertex");
    refused(attribute(odd), "vertices of format R8G8B8A8_SRGB");
    refused(
        [&](Raster& r) {
            r.vertices.vertexBindingDescriptionCount = 1;
            r.vertices.pVertexBindingDescriptions = &wide;
        },
        "vertices of 2052 bytes");
    const auto images = [](std::string_view access) {
        return fmt::format(
            "#version 460\nlayout(binding = 0, rgba8) uniform {} image2D a[4];\nlayout(location = 0) out vec4 c;\n"
            "void main() {{ c = imageLoad(a[0], ivec2(0)) + imageLoad(a[3], ivec2(0)); }}\n",
            access);
    };
    refused([&](Raster& r) { r.fragment = images(""); },
            "images or buffers that a vertex or fragment shader may write");
    refused([&](Raster& r) { r.fragment = images("readonly"); },
            "5 storage images, storage buffers and outputs of a fragment shader, beyond 4");
}

TEST_F(GpuSmallestDevice, RefusesDescriptors) {
    test::Picture filtered = test::blank(context, {4, 4}, VK_FORMAT_R32_SFLOAT);
    test::Picture stored = test::blank(context, {4, 4}, VK_FORMAT_R8_UNORM);
    const Buffer buffer = test::must(
        Buffer::create(context, 1024, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Memory::Kind::Upload, "test buffer"));
    const auto update = [&](VkDescriptorType type, VkDescriptorImageInfo image, VkDescriptorBufferInfo bytes) {
        const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                         .descriptorCount = 1,
                                         .descriptorType = type,
                                         .pImageInfo = &image,
                                         .pBufferInfo = &bytes};
        vk.UpdateDescriptorSets(context.device, 1, &write, 0, nullptr);
    };
    update(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {context.linear_sampler, filtered.image.view}, {});
    expect_refused("a linear filter on format R32_SFLOAT");
    // Beyond the least of Vulkan: it may be missing in what has the portability subset.
    update(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {context.shadow_sampler, stored.image.view}, {});
    expect_refused("a comparing sampler that is not one of the layout");
    update(VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, {.imageView = stored.image.view}, {});
    expect_refused("a storage image of format R8_UNORM");
    update(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, {}, {buffer.handle, 64, 64});
    expect_refused("a buffer bound at byte 64");
    update(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, {}, {buffer.handle, 0, 16400});
    expect_refused("16400 bytes of a buffer bound, beyond 16384");
    update(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {}, {buffer.handle, 0, (1U << 27U) + 4});
    expect_refused("134217732 bytes of a buffer bound, beyond 134217728");
}

TEST_F(GpuSmallestDevice, RefusesCommands) {
    test::Picture full = test::blank(context, {4, 4}, VK_FORMAT_R32_SFLOAT);
    test::Picture snorm = test::blank(context, {4, 4}, VK_FORMAT_R8G8B8A8_UNORM);
    const auto refused = [&](const std::function<void(VkCommandBuffer)>& commands, std::string_view text) {
        expect_refused(commands, text);
    };
    refused([&](VkCommandBuffer c) { vk.CmdDispatch(c, 1, 65536, 1); }, "1 x 65536 x 1 workgroups");
    refused([&](VkCommandBuffer c) { vk.CmdBindDescriptorSets(c, {}, {}, 4, 1, nullptr, 0, nullptr); },
            "5 sets bound, beyond 4");
    const std::uint32_t offset = 64;
    refused([&](VkCommandBuffer c) { vk.CmdBindDescriptorSets(c, {}, {}, 0, 1, nullptr, 1, &offset); },
            "a buffer bound at byte 64");
    refused([&](VkCommandBuffer c) { vk.CmdPushConstants(c, {}, 0, 64, 68, nullptr); }, "132 bytes of push constants");
    refused([&](VkCommandBuffer c) { vk.CmdWriteTimestamp2(c, 0, {}, 0); }, "a timestamp");
    const VkViewport wide{.width = 4097, .height = 8};
    refused([&](VkCommandBuffer c) { vk.CmdSetViewport(c, 0, 1, &wide); }, "a viewport of 4097 x 8");
    refused([&](VkCommandBuffer c) { vk.CmdSetViewport(c, 0, 2, &wide); }, "2 viewports");
    const auto render = [&](VkRenderingInfo info) {
        return [this, info](VkCommandBuffer c) { vk.CmdBeginRendering(c, &info); };
    };
    refused(render({.colorAttachmentCount = 5}), "rendering to 5 images");
    refused(render({.renderArea = {{}, {8, 4097}}}), "rendering to 8 x 4097 pixels");
    refused(render({.layerCount = 257}), "rendering to 257 layers");
    constexpr VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL;
    const auto blit = [&](test::Picture& from, test::Picture& to, VkFilter filter) {
        return [this, &from, &to, filter](VkCommandBuffer c) {
            const VkImageBlit region{};
            vk.CmdBlitImage(c, from.image.handle, general, to.image.handle, general, 1, &region, filter);
        };
    };
    refused(blit(full, snorm, VK_FILTER_LINEAR), "a linear filter on format R32_SFLOAT");
    test::Picture shared = {.image = test::must(Image::create(context, {.name = "shared exponent",
                                                                        .format = VK_FORMAT_E5B9G9R9_UFLOAT_PACK32,
                                                                        .extent = {4, 4, 1},
                                                                        .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT}))};
    refused(blit(snorm, shared, VK_FILTER_NEAREST), "a blit from format R8G8B8A8_UNORM to E5B9G9R9_UFLOAT_PACK32");
}

}  // namespace

}  // namespace darkroom::gpu
