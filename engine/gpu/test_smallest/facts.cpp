// SPDX-License-Identifier: MIT
#include "gpu/test_smallest/facts.hpp"

#include <algorithm>
#include <array>

namespace darkroom::gpu::test {

namespace {

constexpr VkSampleCountFlags one_or_four = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_4_BIT;

// A letter for a column of the tables: Sampled (and read by a blit, which goes with it), Linear filter, sTorage, Colour
// attachment, wRitten by a blit, Blended, Depth attachment, Vertex buffer.
struct Row {
    VkFormat format;
    const char* features;
};

constexpr std::array rows{
    Row{VK_FORMAT_B4G4R4A4_UNORM_PACK16, "SL"},
    Row{VK_FORMAT_R5G6B5_UNORM_PACK16, "SLCRB"},
    Row{VK_FORMAT_A1R5G5B5_UNORM_PACK16, "SLCRB"},
    Row{VK_FORMAT_R8_UNORM, "SLCRBV"},
    Row{VK_FORMAT_R8_SNORM, "SLV"},
    Row{VK_FORMAT_R8_UINT, "SCRV"},
    Row{VK_FORMAT_R8_SINT, "SCRV"},
    Row{VK_FORMAT_R8G8_UNORM, "SLCRBV"},
    Row{VK_FORMAT_R8G8_SNORM, "SLV"},
    Row{VK_FORMAT_R8G8_UINT, "SCRV"},
    Row{VK_FORMAT_R8G8_SINT, "SCRV"},
    Row{VK_FORMAT_R8G8B8A8_UNORM, "SLTCRBV"},
    Row{VK_FORMAT_R8G8B8A8_SNORM, "SLTV"},
    Row{VK_FORMAT_R8G8B8A8_UINT, "STCRV"},
    Row{VK_FORMAT_R8G8B8A8_SINT, "STCRV"},
    Row{VK_FORMAT_R8G8B8A8_SRGB, "SLCRB"},
    Row{VK_FORMAT_B8G8R8A8_UNORM, "SLCRBV"},
    Row{VK_FORMAT_B8G8R8A8_SRGB, "SLCRB"},
    Row{VK_FORMAT_A8B8G8R8_UNORM_PACK32, "SLCRBV"},
    Row{VK_FORMAT_A8B8G8R8_SNORM_PACK32, "SLV"},
    Row{VK_FORMAT_A8B8G8R8_UINT_PACK32, "SCRV"},
    Row{VK_FORMAT_A8B8G8R8_SINT_PACK32, "SCRV"},
    Row{VK_FORMAT_A8B8G8R8_SRGB_PACK32, "SLCRB"},
    Row{VK_FORMAT_A2B10G10R10_UNORM_PACK32, "SLCRBV"},
    Row{VK_FORMAT_A2B10G10R10_UINT_PACK32, "SCR"},
    Row{VK_FORMAT_R16_UNORM, "V"},
    Row{VK_FORMAT_R16_SNORM, "V"},
    Row{VK_FORMAT_R16_UINT, "SCRV"},
    Row{VK_FORMAT_R16_SINT, "SCRV"},
    Row{VK_FORMAT_R16_SFLOAT, "SLCRBV"},
    Row{VK_FORMAT_R16G16_UNORM, "V"},
    Row{VK_FORMAT_R16G16_SNORM, "V"},
    Row{VK_FORMAT_R16G16_UINT, "SCRV"},
    Row{VK_FORMAT_R16G16_SINT, "SCRV"},
    Row{VK_FORMAT_R16G16_SFLOAT, "SLCRBV"},
    Row{VK_FORMAT_R16G16B16A16_UNORM, "V"},
    Row{VK_FORMAT_R16G16B16A16_SNORM, "V"},
    Row{VK_FORMAT_R16G16B16A16_UINT, "STCRV"},
    Row{VK_FORMAT_R16G16B16A16_SINT, "STCRV"},
    Row{VK_FORMAT_R16G16B16A16_SFLOAT, "SLTCRBV"},
    Row{VK_FORMAT_R32_UINT, "STCRV"},
    Row{VK_FORMAT_R32_SINT, "STCRV"},
    Row{VK_FORMAT_R32_SFLOAT, "STCRV"},
    Row{VK_FORMAT_R32G32_UINT, "STCRV"},
    Row{VK_FORMAT_R32G32_SINT, "STCRV"},
    Row{VK_FORMAT_R32G32_SFLOAT, "STCRV"},
    Row{VK_FORMAT_R32G32B32_UINT, "V"},
    Row{VK_FORMAT_R32G32B32_SINT, "V"},
    Row{VK_FORMAT_R32G32B32_SFLOAT, "V"},
    Row{VK_FORMAT_R32G32B32A32_UINT, "STCRV"},
    Row{VK_FORMAT_R32G32B32A32_SINT, "STCRV"},
    Row{VK_FORMAT_R32G32B32A32_SFLOAT, "STCRV"},
    Row{VK_FORMAT_B10G11R11_UFLOAT_PACK32, "SL"},
    Row{VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, "SL"},
    Row{VK_FORMAT_D16_UNORM, "SD"},
    // Of each two of these, one can be an attachment.
    Row{VK_FORMAT_D32_SFLOAT, "SD"},
    Row{VK_FORMAT_D32_SFLOAT_S8_UINT, "D"},
};

VkFormatFeatureFlags features_of_letter(char letter) {
    switch (letter) {
        case 'S':
            return VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_BLIT_SRC_BIT;
        case 'L':
            return VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
        case 'T':
            return VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
        case 'C':
            return VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
        case 'R':
            return VK_FORMAT_FEATURE_BLIT_DST_BIT;
        case 'B':
            return VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
        case 'D':
            return VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
        default:
            return 0;
    }
}

const char* letters_of(VkFormat format) {
    const auto* const found = std::ranges::find(rows, format, &Row::format);
    return found == rows.end() ? "" : found->features;
}

/// Clears every VkBool32 of a structure of features.
template <class Features>
void clear(Features& features) {
    void* const next = features.pNext;
    features = {.sType = features.sType, .pNext = next};
}

void limit_version(VkPhysicalDeviceVulkan11Features& features) {
    clear(features);
    features.multiview = VK_TRUE;
}

void limit_version(VkPhysicalDeviceVulkan12Features& features) {
    clear(features);
    features.uniformBufferStandardLayout = VK_TRUE;
    features.subgroupBroadcastDynamicId = VK_TRUE;
    features.imagelessFramebuffer = VK_TRUE;
    features.separateDepthStencilLayouts = VK_TRUE;
    features.hostQueryReset = VK_TRUE;
    features.timelineSemaphore = VK_TRUE;
    features.shaderSubgroupExtendedTypes = VK_TRUE;
    features.vulkanMemoryModel = VK_TRUE;
    features.vulkanMemoryModelDeviceScope = VK_TRUE;
    features.bufferDeviceAddress = VK_TRUE;
}

void limit_version(VkPhysicalDeviceVulkan13Features& features) {
    clear(features);
    features.robustImageAccess = VK_TRUE;
    features.inlineUniformBlock = VK_TRUE;
    features.pipelineCreationCacheControl = VK_TRUE;
    features.privateData = VK_TRUE;
    features.shaderDemoteToHelperInvocation = VK_TRUE;
    features.shaderTerminateInvocation = VK_TRUE;
    features.subgroupSizeControl = VK_TRUE;
    features.computeFullSubgroups = VK_TRUE;
    features.synchronization2 = VK_TRUE;
    features.shaderZeroInitializeWorkgroupMemory = VK_TRUE;
    features.dynamicRendering = VK_TRUE;
    features.shaderIntegerDotProduct = VK_TRUE;
    features.maintenance4 = VK_TRUE;
}

}  // namespace

void limit(VkPhysicalDeviceLimits& limits) {
    limits.maxImageDimension1D = limits.maxImageDimension2D = limits.maxImageDimensionCube = 4096;
    limits.maxImageDimension3D = 256;
    limits.maxImageArrayLayers = 256;
    limits.maxTexelBufferElements = 65536;
    limits.maxUniformBufferRange = 16384;
    limits.maxStorageBufferRange = 1U << 27U;
    limits.maxPushConstantsSize = 128;
    limits.maxMemoryAllocationCount = 4096;
    limits.maxSamplerAllocationCount = 4000;
    limits.bufferImageGranularity = 131072;
    limits.sparseAddressSpaceSize = 0;
    limits.maxBoundDescriptorSets = 4;
    limits.maxPerStageDescriptorSamplers = limits.maxPerStageDescriptorSampledImages = 16;
    limits.maxPerStageDescriptorUniformBuffers = 12;
    limits.maxPerStageDescriptorStorageBuffers = limits.maxPerStageDescriptorStorageImages = 4;
    limits.maxPerStageDescriptorInputAttachments = 4;
    limits.maxPerStageResources = 128;
    limits.maxDescriptorSetSamplers = limits.maxDescriptorSetSampledImages = 96;
    limits.maxDescriptorSetUniformBuffers = 72;
    limits.maxDescriptorSetUniformBuffersDynamic = 8;
    limits.maxDescriptorSetStorageBuffers = limits.maxDescriptorSetStorageImages = 24;
    limits.maxDescriptorSetStorageBuffersDynamic = limits.maxDescriptorSetInputAttachments = 4;
    limits.maxVertexInputAttributes = limits.maxVertexInputBindings = 16;
    limits.maxVertexInputAttributeOffset = 2047;
    limits.maxVertexInputBindingStride = 2048;
    limits.maxVertexOutputComponents = limits.maxFragmentInputComponents = 64;
    limits.maxTessellationGenerationLevel = limits.maxTessellationPatchSize = limits.maxGeometryShaderInvocations = 0;
    limits.maxFragmentOutputAttachments = limits.maxFragmentCombinedOutputResources = limits.maxColorAttachments = 4;
    limits.maxFragmentDualSrcAttachments = 0;
    limits.maxComputeSharedMemorySize = 16384;
    std::ranges::fill(limits.maxComputeWorkGroupCount, 65535);
    limits.maxComputeWorkGroupInvocations = 128;
    std::ranges::copy(std::array{128, 128, 64}, limits.maxComputeWorkGroupSize);
    limits.subPixelPrecisionBits = limits.subTexelPrecisionBits = limits.mipmapPrecisionBits = 4;
    limits.maxDrawIndexedIndexValue = (1U << 24U) - 1;
    limits.maxDrawIndirectCount = 1;
    limits.maxSamplerLodBias = 2;
    limits.maxSamplerAnisotropy = 1;
    limits.maxViewports = 1;
    std::ranges::fill(limits.maxViewportDimensions, 4096);
    std::ranges::copy(std::array{-8192.0F, 8191.0F}, limits.viewportBoundsRange);
    limits.viewportSubPixelBits = 0;
    limits.minMemoryMapAlignment = 64;
    limits.minTexelBufferOffsetAlignment = limits.minUniformBufferOffsetAlignment = 256;
    limits.minStorageBufferOffsetAlignment = 256;
    limits.minTexelOffset = -8;
    limits.maxTexelOffset = 7;
    limits.minTexelGatherOffset = 0;
    limits.maxTexelGatherOffset = 0;
    limits.maxFramebufferWidth = limits.maxFramebufferHeight = 4096;
    limits.maxFramebufferLayers = 256;
    limits.framebufferColorSampleCounts = limits.framebufferDepthSampleCounts = one_or_four;
    limits.framebufferStencilSampleCounts = limits.framebufferNoAttachmentsSampleCounts = one_or_four;
    limits.sampledImageColorSampleCounts = limits.sampledImageDepthSampleCounts = one_or_four;
    limits.sampledImageStencilSampleCounts = one_or_four;
    limits.sampledImageIntegerSampleCounts = limits.storageImageSampleCounts = VK_SAMPLE_COUNT_1_BIT;
    limits.maxSampleMaskWords = 1;
    limits.timestampComputeAndGraphics = VK_FALSE;
    limits.maxClipDistances = limits.maxCullDistances = limits.maxCombinedClipAndCullDistances = 0;
    limits.discreteQueuePriorities = 2;
    std::ranges::fill(limits.pointSizeRange, 1.0F);
    std::ranges::fill(limits.lineWidthRange, 1.0F);
    limits.nonCoherentAtomSize = 256;
}

void limit_chain(void* chain) {
    for (auto* link = static_cast<VkBaseOutStructure*>(chain); link != nullptr; link = link->pNext) {
        void* const structure = link;
        if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES) {
            auto& properties = *static_cast<VkPhysicalDeviceMaintenance3Properties*>(structure);
            properties.maxMemoryAllocationSize = smallest_max_allocation;
            properties.maxPerSetDescriptors = smallest_set_descriptors;
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES) {
            static_cast<VkPhysicalDeviceMaintenance4Properties*>(structure)->maxBufferSize = smallest_max_buffer;
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES) {
            auto& properties = *static_cast<VkPhysicalDeviceVulkan11Properties*>(structure);
            properties.maxMemoryAllocationSize = smallest_max_allocation;
            properties.maxPerSetDescriptors = smallest_set_descriptors;
            properties.subgroupSupportedStages = VK_SHADER_STAGE_COMPUTE_BIT;
            properties.subgroupSupportedOperations = VK_SUBGROUP_FEATURE_BASIC_BIT;
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES) {
            static_cast<VkPhysicalDeviceVulkan13Properties*>(structure)->maxBufferSize = smallest_max_buffer;
        }
    }
}

void limit_features(VkPhysicalDeviceFeatures2& features) {
    features.features = {.robustBufferAccess = VK_TRUE};
    for (auto* link = static_cast<VkBaseOutStructure*>(features.pNext); link != nullptr; link = link->pNext) {
        void* const structure = link;
        if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES) {
            limit_version(*static_cast<VkPhysicalDeviceVulkan11Features*>(structure));
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES) {
            limit_version(*static_cast<VkPhysicalDeviceVulkan12Features*>(structure));
        } else if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES) {
            limit_version(*static_cast<VkPhysicalDeviceVulkan13Features*>(structure));
        }
    }
}

VkFormatFeatureFlags smallest_image_features(VkFormat format) {
    VkFormatFeatureFlags features = 0;
    for (const char* letter = letters_of(format); *letter != '\0'; ++letter) features |= features_of_letter(*letter);
    // "Format Feature Dependent Usage Flags": copies go with any use of an image.
    if (features != 0) features |= VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    return features;
}

VkFormatFeatureFlags smallest_buffer_features(VkFormat format) {
    for (const char* letter = letters_of(format); *letter != '\0'; ++letter) {
        if (*letter == 'V') return VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT;
    }
    return 0;
}

void limit_memory(VkPhysicalDeviceMemoryProperties& memory) {
    memory.memoryTypeCount = 2;
    memory.memoryTypes[smallest_device_type] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
    memory.memoryTypes[smallest_host_type] = {
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, 0};
    memory.memoryHeapCount = 1;
}

// Names of the SPIR-V specification, "Capability".
bool is_smallest_capability(std::uint32_t capability) {
    enum : std::uint32_t {
        Matrix = 0,
        Shader = 1,
        InputAttachment = 40,
        Sampled1D = 43,
        Image1D = 44,
        SampledBuffer = 46,
        ImageBuffer = 47,
        ImageQuery = 50,
        DerivativeControl = 51,
        GroupNonUniform = 61,
        DeviceGroup = 4437,
        MultiView = 4439,
        VulkanMemoryModel = 5345,
        VulkanMemoryModelDeviceScope = 5346,
        PhysicalStorageBufferAddresses = 5347,
        DemoteToHelperInvocation = 5379,
    };
    constexpr std::array allowed{Matrix,
                                 Shader,
                                 InputAttachment,
                                 Sampled1D,
                                 Image1D,
                                 SampledBuffer,
                                 ImageBuffer,
                                 ImageQuery,
                                 DerivativeControl,
                                 GroupNonUniform,
                                 DeviceGroup,
                                 MultiView,
                                 VulkanMemoryModel,
                                 VulkanMemoryModelDeviceScope,
                                 PhysicalStorageBufferAddresses,
                                 DemoteToHelperInvocation};
    return std::ranges::find(allowed, capability) != allowed.end();
}

}  // namespace darkroom::gpu::test
