// SPDX-License-Identifier: MIT
#include "gpu/resource/resources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/assert.hpp"
#include "gpu/device/assumed_device.hpp"
#include "gpu/device/cleared.hpp"
#include "gpu/resource/formats.hpp"

namespace darkroom::gpu {

namespace {

constexpr VkImageUsageFlags viewable_usage =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
    VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
VkImageViewType view_type(const ImageInfo& info) {
    if (info.type == VK_IMAGE_TYPE_3D) return VK_IMAGE_VIEW_TYPE_3D;
    if (info.type == VK_IMAGE_TYPE_1D) return VK_IMAGE_VIEW_TYPE_1D;
    return info.array_layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
}

Result<VkImage> create_image(Context& context, const ImageInfo& info) {
    const VkImageCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = info.type,
        .format = info.format,
        .extent = info.extent,
        .mipLevels = info.mip_levels,
        .arrayLayers = info.array_layers,
        .samples = info.samples,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = info.usage,
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
    };
    // No exception comes between the image and its owner, here and below.
    const std::string what =
        fmt::format("creating the image \"{}\", {} x {}", info.name, info.extent.width, info.extent.height);
    VkImage image = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreateImage(context.device, &create_info, context.allocator, &image);
    DARKROOM_TRY(context.check(result, what));
    name_object(context, VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(image), info.name);
    return image;
}

/// What an image or a buffer asks of its memory.
struct Needed {
    DeviceMemoryRequest request;
    std::uint32_t type_bits = 0;
};

struct Requirements {
    VkMemoryDedicatedRequirements dedicated{.sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_REQUIREMENTS};
    VkMemoryRequirements2 all{.sType = VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2, .pNext = &dedicated};
    [[nodiscard]] Needed needed() const {
        const VkMemoryRequirements& plain = all.memoryRequirements;
        return {.request = {.size = plain.size,
                            .alignment = plain.alignment,
                            .prefers_dedicated = dedicated.prefersDedicatedAllocation == VK_TRUE,
                            .requires_dedicated = dedicated.requiresDedicatedAllocation == VK_TRUE},
                .type_bits = plain.memoryTypeBits};
    }
};

Needed needed_by(const Context& context, VkImage image) {
    const VkImageMemoryRequirementsInfo2 info{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_REQUIREMENTS_INFO_2,
                                              .image = image};
    Requirements asked;
    context.vk.GetImageMemoryRequirements2(context.device, &info, &asked.all);
    Needed out = asked.needed();
    out.request.image = image;
    return out;
}

Needed needed_by(const Context& context, VkBuffer buffer) {
    const VkBufferMemoryRequirementsInfo2 info{.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_REQUIREMENTS_INFO_2,
                                               .buffer = buffer};
    Requirements asked;
    context.vk.GetBufferMemoryRequirements2(context.device, &info, &asked.all);
    Needed out = asked.needed();
    out.request.buffer = buffer;
    return out;
}

struct ViewPart {
    std::uint32_t first_mip = 0, mip_count = 1;
    std::uint32_t first_layer = 0, layer_count = 1;
};

Result<VkImageView> create_view(Context& context, const Image& image, VkImageViewType type, const ViewPart& part) {
    const VkImageViewCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image.handle,
        .viewType = type,
        .format = image.info.format,
        .subresourceRange = {.aspectMask = sampled_aspect(image.info.format),
                             .baseMipLevel = part.first_mip,
                             .levelCount = part.mip_count,
                             .baseArrayLayer = part.first_layer,
                             .layerCount = part.layer_count},
    };
    const std::string what = fmt::format("creating a view of the image \"{}\"", image.info.name);
    VkImageView view = VK_NULL_HANDLE;
    const VkResult result = context.vk.CreateImageView(context.device, &create_info, context.allocator, &view);
    DARKROOM_TRY(context.check(result, what));
    return view;
}

/// The image is bound to its memory already.
Result<> create_views(Context& context, Image& image) {
    if ((image.info.usage & viewable_usage) == 0) return {};
    const VkImageViewType type = view_type(image.info);
    const std::uint32_t mips = image.info.mip_levels, layers = image.info.array_layers;
    image.mip_views.reserve(mips);
    image.layer_views.reserve(layers > 1 ? layers : 0);
    DARKROOM_TRY_VALUE(image.view, create_view(context, image, type, {.mip_count = mips, .layer_count = layers}));
    for (std::uint32_t mip = 0; mip < mips; ++mip) {
        DARKROOM_TRY_VALUE(VkImageView view,
                           create_view(context, image, type, {.first_mip = mip, .layer_count = layers}));
        image.mip_views.push_back(view);
    }
    for (std::uint32_t layer = 0; layers > 1 && layer < layers; ++layer) {
        DARKROOM_TRY_VALUE(VkImageView view,
                           create_view(context, image, VK_IMAGE_VIEW_TYPE_2D, {.first_layer = layer}));
        image.layer_views.push_back(view);
    }
    return {};
}

Result<Image> bind_image(Context& context, Image image, const DeviceMemory& piece, VkDeviceSize offset) {
    const VkResult bound =
        context.vk.BindImageMemory(context.device, image.handle, piece.memory, piece.offset + offset);
    Result<> result = context.check(bound, fmt::format("binding memory to the image \"{}\"", image.info.name));
    if (result) result = create_views(context, image);
    if (!result) return failure(std::move(result));
    return image;
}

}  // namespace

Result<Memory> Memory::create(Context& context, DeviceMemoryRequest wanted, std::uint32_t type_bits, Kind kind,
                              std::string_view what) {
    Memory memory;
    memory.context = &context;
    Result<> allocated = machine_error(fmt::format("no memory type of the device suits {}", what));
    wanted.is_mapped = kind != Kind::Device;
    // If a heap is full, another memory type may still do.
    for (const std::uint32_t type : memory_types_for(context.memory, type_bits, kind)) {
        wanted.memory_type = type;
        allocated = context.allocate_memory(wanted, what, memory.piece);
        if (allocated) break;
    }
    if (!allocated) return failure(std::move(allocated));
    memory.size = wanted.size;
    memory.mapped = static_cast<std::byte*>(memory.piece.mapped);
    return memory;
}

Memory::Memory(Memory&& other) noexcept { *this = std::move(other); }
Memory& Memory::operator=(Memory&& other) noexcept {
    std::swap(piece, other.piece);
    std::swap(mapped, other.mapped);
    std::swap(size, other.size);
    std::swap(context, other.context);
    return *this;
}
Memory::~Memory() {
    if (piece.memory != VK_NULL_HANDLE) context->free_memory(piece);
}

Result<Image> Image::create(Context& context, const ImageInfo& info) {
    DARKROOM_TRY_VALUE(VkImage handle, create_image(context, info));
    Image image;
    image.context = &context;
    image.handle = handle;
    image.info = info;
    const Needed needed = needed_by(context, image.handle);
    DARKROOM_TRY_VALUE(image.memory, Memory::create(context, needed.request, needed.type_bits, Memory::Kind::Device,
                                                    fmt::format("the image \"{}\"", info.name)));
    const DeviceMemory piece = image.memory.piece;
    return bind_image(context, std::move(image), piece, 0);
}

Result<Image> Image::place(Context& context, const ImageInfo& info, const Memory& memory, VkDeviceSize offset) {
    DARKROOM_TRY_VALUE(VkImage handle, create_image(context, info));
    Image image;
    image.context = &context;
    image.handle = handle;
    image.info = info;
    return bind_image(context, std::move(image), memory.piece, offset);
}

Result<std::vector<Image>> Image::create_together(Context& context, std::span<const ImageInfo> infos,
                                                  std::string_view what, Memory& memory) {
    std::vector<Image> out;
    std::vector<VkDeviceSize> offsets;
    DeviceMemoryRequest all;
    std::uint32_t type_bits = ~0u;
    out.reserve(infos.size());
    for (const ImageInfo& info : infos) {
        DARKROOM_TRY_VALUE(VkImage handle, create_image(context, info));
        Image& image = out.emplace_back();
        image.context = &context;
        image.handle = handle;
        image.info = info;
        const Needed needed = needed_by(context, image.handle);
        const VkDeviceSize alignment = std::max<VkDeviceSize>(needed.request.alignment, 1);
        offsets.push_back((all.size + alignment - 1) / alignment * alignment);
        all.size = offsets.back() + needed.request.size;
        all.alignment = std::max(all.alignment, alignment);
        type_bits &= needed.type_bits;
    }
    if (out.empty()) return out;
    DARKROOM_TRY_VALUE(memory, Memory::create(context, all, type_bits, Memory::Kind::Device, what));
    for (std::size_t i = 0; i < out.size(); ++i) {
        DARKROOM_TRY_VALUE(Image bound, bind_image(context, std::move(out[i]), memory.piece, offsets[i]));
        out[i] = std::move(bound);
    }
    return out;
}

Result<VkMemoryRequirements> Image::measure(Context& context, const ImageInfo& info) {
    if (context.is_assumed || context.compiles_only) return assumed_requirements(info);
    DARKROOM_TRY_VALUE(const VkImage handle, create_image(context, info));
    const Needed needed = needed_by(context, handle);
    context.vk.DestroyImage(context.device, handle, context.allocator);
    return VkMemoryRequirements{needed.request.size, needed.request.alignment, needed.type_bits};
}

Image::Image(Image&& other) noexcept { *this = std::move(other); }
Image& Image::operator=(Image&& other) noexcept {
    std::swap(handle, other.handle);
    std::swap(view, other.view);
    std::swap(mip_views, other.mip_views);
    std::swap(layer_views, other.layer_views);
    std::swap(info, other.info);
    std::swap(memory, other.memory);
    std::swap(context, other.context);
    return *this;
}
Image::~Image() {
    if (handle == VK_NULL_HANDLE) return;
    for (const VkImageView mip_view : mip_views)
        context->vk.DestroyImageView(context->device, mip_view, context->allocator);
    for (const VkImageView layer_view : layer_views)
        context->vk.DestroyImageView(context->device, layer_view, context->allocator);
    context->vk.DestroyImageView(context->device, view, context->allocator);
    context->vk.DestroyImage(context->device, handle, context->allocator);
}

Result<Buffer> Buffer::create(Context& context, VkDeviceSize size, VkBufferUsageFlags usage, Memory::Kind kind,
                              std::string_view name) {
    const VkBufferCreateInfo create_info{
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = size,
        .usage = usage,
        .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
    };
    Buffer buffer;
    buffer.context = &context;
    Result<> checked = context.check(
        cleared_on_failure(context.vk.CreateBuffer(context.device, &create_info, context.allocator, &buffer.handle),
                           buffer.handle),
        fmt::format("creating the buffer \"{}\", {} bytes", name, size));
    if (!checked) return failure(std::move(checked));
    name_object(context, VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer.handle), std::string(name));
    const Needed needed = needed_by(context, buffer.handle);
    DARKROOM_TRY_VALUE(buffer.memory, Memory::create(context, needed.request, needed.type_bits, kind,
                                                     fmt::format("the buffer \"{}\"", name)));
    const VkResult bound = context.vk.BindBufferMemory(context.device, buffer.handle, buffer.memory.piece.memory,
                                                       buffer.memory.piece.offset);
    checked = context.check(bound, fmt::format("binding memory to the buffer \"{}\"", name));
    if (!checked) return failure(std::move(checked));
    return buffer;
}

Buffer::Buffer(Buffer&& other) noexcept { *this = std::move(other); }
Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(handle, other.handle);
    std::swap(memory, other.memory);
    std::swap(context, other.context);
    return *this;
}
Buffer::~Buffer() {
    if (handle != VK_NULL_HANDLE) context->vk.DestroyBuffer(context->device, handle, context->allocator);
}

Result<DescriptorSets> DescriptorSets::create(Context& context, std::span<const VkDescriptorSetLayout> layouts) {
    DescriptorSets result;
    result.context = &context;
    if (layouts.empty()) return result;
    const auto count = static_cast<std::uint32_t>(layouts.size());
    // Layouts cannot be asked for their sizes, so each set counts as the largest that a kernel may have, or a frame of
    // the renderer: one more of either kind of buffer.
    const std::array sizes{
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 5 * count},
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 3 * count},
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 16 * count},
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 16 * count},
    };
    const VkDescriptorPoolCreateInfo pool_info{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = count,
        .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
        .pPoolSizes = sizes.data(),
    };
    Result<> checked = context.check(
        cleared_on_failure(context.vk.CreateDescriptorPool(context.device, &pool_info, context.allocator, &result.pool),
                           result.pool),
        fmt::format("creating a pool of {} descriptor sets", count));
    if (!checked) return failure(std::move(checked));
    const VkDescriptorSetAllocateInfo allocate_info{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = result.pool,
        .descriptorSetCount = count,
        .pSetLayouts = layouts.data(),
    };
    result.sets.resize(count);
    checked = context.check(context.vk.AllocateDescriptorSets(context.device, &allocate_info, result.sets.data()),
                            fmt::format("allocating {} descriptor sets", count));
    if (!checked) return failure(std::move(checked));
    return result;
}

DescriptorSets::DescriptorSets(DescriptorSets&& other) noexcept { *this = std::move(other); }
DescriptorSets& DescriptorSets::operator=(DescriptorSets&& other) noexcept {
    std::swap(sets, other.sets);
    std::swap(pool, other.pool);
    std::swap(context, other.context);
    return *this;
}
DescriptorSets::~DescriptorSets() {
    if (pool != VK_NULL_HANDLE) context->vk.DestroyDescriptorPool(context->device, pool, context->allocator);
}

void name_object(Context& context, VkObjectType type, std::uint64_t handle, const std::string& name) {
    if (context.vk.SetDebugUtilsObjectNameEXT == nullptr) return;
    const VkDebugUtilsObjectNameInfoEXT info{
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
        .objectType = type,
        .objectHandle = handle,
        .pObjectName = name.c_str(),
    };
    // A name that cannot be given is missed in a debugger and nowhere else.
    static_cast<void>(context.vk.SetDebugUtilsObjectNameEXT(context.device, &info));
}

void begin_label(const Context& context, VkCommandBuffer commands, const char* name) {
    if (context.vk.CmdBeginDebugUtilsLabelEXT == nullptr) return;
    const VkDebugUtilsLabelEXT label{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = name};
    context.vk.CmdBeginDebugUtilsLabelEXT(commands, &label);
}

void end_label(const Context& context, VkCommandBuffer commands) {
    if (context.vk.CmdEndDebugUtilsLabelEXT != nullptr) context.vk.CmdEndDebugUtilsLabelEXT(commands);
}

}  // namespace darkroom::gpu
