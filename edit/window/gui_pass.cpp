// SPDX-License-Identifier: MIT
#include "window/gui_pass.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

#include "core/assert.hpp"
#include "draw/pipeline.hpp"
#include "gpu/device/context.hpp"
#include "gpu/resource/formats.hpp"
#include "gpu/resource/resources.hpp"
#include "panels/show/false_color.hpp"
#include "window/texture_address.hpp"

namespace darkroom::window {

namespace {

// The GLSL of GuiPass, whole: the files of shaders/ with what they share before them.

struct File {
    std::string_view name;
    std::string_view text;
};

constexpr File files[] = {
#include "gui_shader_texts.inc"
};

std::string numbered(std::string_view name) {
    const auto file = std::ranges::find(files, name, &File::name);
    DARKROOM_ASSERT(file != std::end(files));
    return fmt::format("#line 1 \"{}\"\n{}", file->name, file->text);
}

std::string whole(std::string_view generated, std::string_view name) {
    return fmt::format("#version 460\n#extension GL_GOOGLE_cpp_style_line_directive : require\n{}{}{}",
                       numbered("gui_common.glsl"), generated, numbered(name));
}

/// vec3 NAME(float value, float grey)
std::string band_function(std::string_view name, std::span<const panels::FalseColorBand> bands) {
    std::string out = fmt::format("vec3 {}(float value, float grey) {{\n", name);
    for (std::size_t i = bands.size(); i-- > 0;) {
        const panels::FalseColorBand& band = bands[i];
        const auto& [r, g, b] = band.color;
        if (i > 0) out += fmt::format("if (value >= {:.9f}) ", band.from);
        out += band.is_grey ? "return vec3(clamp(grey, 0.0, 1.0));\n"
                            : fmt::format("return vec3({:.9f}, {:.9f}, {:.9f});\n", r, g, b);
    }
    return out + "}\n";
}

std::string gui_vertex_shader() { return whole({}, "gui_vertex.glsl"); }

/// A texture times a colour.
std::string gui_fragment_shader() { return whole({}, "gui_fragment.glsl"); }

/// A Pane.
std::string pane_fragment_shader() {
    return whole(band_function("stop_color", panels::stop_bands) + band_function("code_color", panels::code_bands),
                 "pane_fragment.glsl");
}

/// The push constants, as shaders/gui_common.glsl has them.
struct View {
    std::array<float, 4> region{0, 0, 1, 1};
    PaneTransfer transfer = PaneTransfer::Encoded;
    float low = 0, high = 1, unused = 0;
};
struct Block {
    std::array<float, 2> scale{}, offset{};
    View first, second;
    float divider = 0.5f;
    float exposure = 1;
    PaneChannels channels = PaneChannels::Rgb;
    std::uint32_t flags = 0;
};
static_assert(sizeof(Block) == 96, "Vulkan promises 128 bytes");
enum Flags : std::uint32_t { HasSecond = 1, IsFalseColor = 2, IsClippingMarked = 4 };

constexpr VkShaderStageFlags both_stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

/// Without a second view the first one again: descriptors are never empty.
const PaneView& second_view(const Pane& pane) {
    return pane.second && pane.second->image.is_given() ? *pane.second : pane.view;
}

View view_block(const PaneView& view) {
    const VkRect2D region = view.image.used_region();
    const float width = static_cast<float>(view.image.extent.width);
    const float height = static_cast<float>(view.image.extent.height);
    return {
        .region = {static_cast<float>(region.offset.x) / width, static_cast<float>(region.offset.y) / height,
                   static_cast<float>(region.extent.width) / width, static_cast<float>(region.extent.height) / height},
        .transfer = view.transfer,
        .low = view.low,
        .high = view.high};
}

void set_pane(Block& block, const Pane& pane) {
    block.first = view_block(pane.view);
    block.second = view_block(second_view(pane));
    block.divider = pane.divider;
    block.exposure = std::exp2(pane.exposure);
    block.channels = pane.channels;
    block.flags = (&second_view(pane) != &pane.view ? HasSecond : 0U) | (pane.is_false_color ? IsFalseColor : 0U) |
                  (pane.is_clipping_marked ? IsClippingMarked : 0U);
}

/// Memory that the host writes and vertex input reads.
struct GrowingBuffer {
    gpu::Buffer buffer;
    VkDeviceSize capacity = 0;

    /// What was there is lost where it grows.
    Result<> reserve(gpu::Context& context, VkDeviceSize size, VkBufferUsageFlags usage, std::string_view name) {
        if (size <= capacity) return {};
        const VkDeviceSize wanted = size + size / 2;
        DARKROOM_TRY_VALUE(buffer, gpu::Buffer::create(context, wanted, usage, gpu::Memory::Kind::Upload, name));
        capacity = wanted;
        return {};
    }
};

struct DrawSlot {
    GrowingBuffer vertices, indices;
    gpu::DescriptorSets sets;        ///< max_panes
    std::vector<const Pane*> panes;  ///< of the recording that is made; sets in the same order
};

/// The constants of shaders/gui_common.glsl.
std::vector<std::uint32_t> target_constants(const GuiPass::Desc& desc) {
    const auto kind = [&]() -> std::uint32_t {
        if (desc.color.transfer == Transfer::Scrgb) return 2;
        if (desc.color.transfer == Transfer::Pq) return 3;
        if (desc.color.transfer == Transfer::Hlg) return 4;
        return gpu::format_traits(desc.format).is_srgb ? 1 : 0;
    };
    return {kind(), std::bit_cast<std::uint32_t>(desc.color.peak_nits)};
}

bool is_empty(const ImDrawData& data) {
    return data.TotalVtxCount == 0 || data.DisplaySize.x <= 0 || data.DisplaySize.y <= 0;
}

/// Does a pane show the codes of one view as they are?
bool is_plain(const Pane& pane) {
    return &second_view(pane) == &pane.view && pane.view.transfer == PaneTransfer::Encoded && pane.exposure == 0 &&
           pane.channels == PaneChannels::Rgb && !pane.is_false_color && !pane.is_clipping_marked;
}

gpu::PipelineDesc pipeline_desc(std::string name, std::string fragment, const GuiPass::Desc& desc,
                                VkDescriptorSetLayout layout, bool is_plain = false) {
    std::vector<std::uint32_t> constants = target_constants(desc);
    constants.push_back(is_plain ? 1 : 0);
    return {.name = std::move(name),
            .vertex = gui_vertex_shader(),
            .fragment = std::move(fragment),
            .bindings = {{0, sizeof(ImDrawVert), VK_VERTEX_INPUT_RATE_VERTEX}},
            .attributes = {{0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, pos)},
                           {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, uv)},
                           {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(ImDrawVert, col)}},
            .sets = {layout},
            .push_constant_size = sizeof(Block),
            .specialization = std::move(constants),
            .colors = {{.format = desc.format,
                        .is_blended = true,
                        .source = VK_BLEND_FACTOR_SRC_ALPHA,
                        .destination = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
                        .source_alpha = VK_BLEND_FACTOR_ONE,
                        .destination_alpha = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA}},
            .tests_depth = false,
            .writes_depth = false};
}

void write_set(const gpu::Context& context, VkDescriptorSet set, const std::array<VkDescriptorImageInfo, 2>& images) {
    std::array<VkWriteDescriptorSet, 2> writes{};
    for (std::uint32_t i = 0; i < writes.size(); ++i)
        writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                     .dstSet = set,
                     .dstBinding = i,
                     .descriptorCount = 1,
                     .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                     .pImageInfo = &images[i]};
    context.vk.UpdateDescriptorSets(context.device, static_cast<std::uint32_t>(writes.size()), writes.data(), 0,
                                    nullptr);
}

VkDescriptorImageInfo sampled(const gpu::Context& context, const ImageRef& image, bool is_nearest) {
    const bool is_linear = !is_nearest && context.is_filterable(image.format);
    return {is_linear ? context.linear_sampler : context.nearest_sampler, image.view, image.layout};
}

/// The part of a command's clip rectangle that is on the target and in the part; nothing where it is empty.
VkRect2D scissor_of(const ImDrawCmd& command, const ImDrawData& data, const VkRect2D& part) {
    const auto pixel = [](float place, float origin, float scale, float size) {
        return static_cast<std::int32_t>(std::clamp((place - origin) * scale, 0.0F, size * scale));
    };
    const ImVec2 origin = data.DisplayPos, scale = data.FramebufferScale, size = data.DisplaySize;
    const auto end_of = [](std::int32_t at, std::uint32_t extent) { return at + static_cast<std::int32_t>(extent); };
    const VkOffset2D first{std::max(pixel(command.ClipRect.x, origin.x, scale.x, size.x), part.offset.x),
                           std::max(pixel(command.ClipRect.y, origin.y, scale.y, size.y), part.offset.y)};
    const VkOffset2D end{
        std::min(pixel(command.ClipRect.z, origin.x, scale.x, size.x), end_of(part.offset.x, part.extent.width)),
        std::min(pixel(command.ClipRect.w, origin.y, scale.y, size.y), end_of(part.offset.y, part.extent.height))};
    return {first,
            {static_cast<std::uint32_t>(std::max(end.x - first.x, 0)),
             static_cast<std::uint32_t>(std::max(end.y - first.y, 0))}};
}

}  // namespace

struct GuiPass::State {
    gpu::Context* context = nullptr;
    gpu::SetLayout layout;
    gpu::Pipeline lists, panes, plain_panes;
    gpu::Image font;
    gpu::DescriptorSets font_set;
    void* font_texture = nullptr;
    std::vector<DrawSlot> slots;

    Result<> write_vertices(const ImDrawData& data, DrawSlot& slot) const;
    Result<VkDescriptorSet> pane_set(const Pane& pane, DrawSlot& slot) const;
    void bind(VkCommandBuffer commands, const ImDrawData& data, const DrawSlot& slot) const;
    Result<> draw(VkCommandBuffer commands, const ImDrawData& data, const ImDrawCmd& command, Block& block,
                  DrawSlot& slot, std::int32_t first_vertex, std::uint32_t first_index, const VkRect2D& part) const;
};

Result<GuiPass> GuiPass::create(gpu::Context& context, const Desc& desc, ImFontAtlas& atlas) {
    GuiPass pass;
    pass.state_ = std::make_shared<State>();
    State& state = *pass.state_;
    state.context = &context;
    DARKROOM_TRY_VALUE(state.layout, gpu::SetLayout::create(context, std::array<gpu::SetLayout::Binding, 2>{}));
    DARKROOM_TRY_VALUE(state.lists, gpu::Pipeline::create(context, pipeline_desc("interface", gui_fragment_shader(),
                                                                                 desc, state.layout.handle)));
    DARKROOM_TRY_VALUE(state.panes, gpu::Pipeline::create(context, pipeline_desc("pane", pane_fragment_shader(), desc,
                                                                                 state.layout.handle)));
    DARKROOM_TRY_VALUE(state.plain_panes,
                       gpu::Pipeline::create(context, pipeline_desc("plain pane", pane_fragment_shader(), desc,
                                                                    state.layout.handle, true)));
    state.slots.resize(desc.slots);
    const std::vector<VkDescriptorSetLayout> layouts(max_panes, state.layout.handle);
    for (DrawSlot& slot : state.slots) {
        DARKROOM_TRY_VALUE(slot.sets, gpu::DescriptorSets::create(context, layouts));
    }
    DARKROOM_TRY_VALUE(state.font_set, gpu::DescriptorSets::create(context, {&state.layout.handle, 1}));
    DARKROOM_TRY(pass.upload_fonts(atlas));
    return pass;
}

Result<> GuiPass::upload_fonts(ImFontAtlas& atlas) {
    gpu::Context& context = *state_->context;
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    atlas.GetTexDataAsRGBA32(&texels, &width, &height);
    const VkExtent3D extent{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 1};
    DARKROOM_TRY_VALUE(gpu::Image image, gpu::Image::create(context, {.name = "font atlas",
                                                                      .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                                      .extent = extent,
                                                                      .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                                                               VK_IMAGE_USAGE_TRANSFER_DST_BIT}));
    const std::size_t size = std::size_t{extent.width} * extent.height * 4;
    DARKROOM_TRY_VALUE(const gpu::Buffer staging, gpu::Buffer::create(context, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                                      gpu::Memory::Kind::Upload, "font atlas"));
    std::memcpy(staging.memory.mapped, texels, size);
    Result<> done = gpu::submit_and_wait(context, "uploading the font atlas", [&](VkCommandBuffer commands) {
        const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, .imageExtent = extent};
        gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        context.vk.CmdCopyBufferToImage(commands, staging.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                                        &copy);
        gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    });
    if (!done) return done;
    // The wait was for everything before it on the queue, so that no frame reads the old one any more.
    state_->font = std::move(image);
    state_->font_texture = address_of(atlas.TexID);
    const VkDescriptorImageInfo font{context.linear_sampler, state_->font.view,
                                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    write_set(context, state_->font_set.sets[0], {font, font});
    return {};
}

Result<> GuiPass::State::write_vertices(const ImDrawData& data, DrawSlot& slot) const {
    DARKROOM_TRY(slot.vertices.reserve(*context, sizeof(ImDrawVert) * data.TotalVtxCount,
                                       VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "vertices of the interface"));
    DARKROOM_TRY(slot.indices.reserve(*context, sizeof(ImDrawIdx) * data.TotalIdxCount,
                                      VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "indices of the interface"));
    std::byte* vertex = slot.vertices.buffer.memory.mapped;
    std::byte* index = slot.indices.buffer.memory.mapped;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        std::memcpy(vertex, list.VtxBuffer.Data, list.VtxBuffer.size_in_bytes());
        std::memcpy(index, list.IdxBuffer.Data, list.IdxBuffer.size_in_bytes());
        vertex += list.VtxBuffer.size_in_bytes();
        index += list.IdxBuffer.size_in_bytes();
    }
    return {};
}

Result<VkDescriptorSet> GuiPass::State::pane_set(const Pane& pane, DrawSlot& slot) const {
    const auto known = std::ranges::find(slot.panes, &pane);
    const auto index = static_cast<std::size_t>(known - slot.panes.begin());
    if (known != slot.panes.end()) return slot.sets.sets[index];
    if (index == max_panes)
        return machine_error(fmt::format("the interface shows more than {} pictures at once", max_panes));
    slot.panes.push_back(&pane);
    write_set(*context, slot.sets.sets[index],
              {sampled(*context, pane.view.image, pane.is_nearest),
               sampled(*context, second_view(pane).image, pane.is_nearest)});
    return slot.sets.sets[index];
}

void GuiPass::State::bind(VkCommandBuffer commands, const ImDrawData& data, const DrawSlot& slot) const {
    constexpr VkDeviceSize offset = 0;
    const VkViewport viewport{
        0, 0, data.DisplaySize.x * data.FramebufferScale.x, data.DisplaySize.y * data.FramebufferScale.y, 0, 1};
    context->vk.CmdSetViewport(commands, 0, 1, &viewport);
    context->vk.CmdBindVertexBuffers(commands, 0, 1, &slot.vertices.buffer.handle, &offset);
    context->vk.CmdBindIndexBuffer(commands, slot.indices.buffer.handle, 0,
                                   sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
}

Result<> GuiPass::State::draw(VkCommandBuffer commands, const ImDrawData& data, const ImDrawCmd& command, Block& block,
                              DrawSlot& slot, std::int32_t first_vertex, std::uint32_t first_index,
                              const VkRect2D& part) const {
    const VkRect2D scissor = scissor_of(command, data, part);
    if (scissor.extent.width == 0 || scissor.extent.height == 0) return {};
    void* const texture = address_of(command);
    const bool is_font = texture == nullptr || texture == font_texture;
    VkDescriptorSet set = font_set.sets[0];
    const gpu::Pipeline* pipeline = &lists;
    if (!is_font) {
        const Pane& pane = *static_cast<const Pane*>(texture);
        if (!pane.view.image.is_given()) return {};
        DARKROOM_TRY_VALUE(set, pane_set(pane, slot));
        set_pane(block, pane);
        pipeline = is_plain(pane) ? &plain_panes : &panes;
    }
    const gpu::Dispatch& vk = context->vk;
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->handle);
    vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->layout, 0, 1, &set, 0, nullptr);
    vk.CmdPushConstants(commands, pipeline->layout, both_stages, 0, sizeof block, &block);
    vk.CmdSetScissor(commands, 0, 1, &scissor);
    vk.CmdDrawIndexed(commands, command.ElemCount, 1, first_index + command.IdxOffset,
                      first_vertex + static_cast<std::int32_t>(command.VtxOffset), 0);
    return {};
}

Result<> GuiPass::record(VkCommandBuffer commands, const ImDrawData& data, std::uint32_t slot) {
    DARKROOM_TRY(begin(data, slot));
    const VkExtent2D whole{static_cast<std::uint32_t>(std::max(data.DisplaySize.x * data.FramebufferScale.x, 0.0F)),
                           static_cast<std::uint32_t>(std::max(data.DisplaySize.y * data.FramebufferScale.y, 0.0F))};
    return record_part(commands, data, slot, {{0, 0}, whole});
}

Result<> GuiPass::begin(const ImDrawData& data, std::uint32_t slot) {
    DARKROOM_ASSERT(slot < state_->slots.size());
    DrawSlot& own = state_->slots[slot];
    own.panes.clear();
    return is_empty(data) ? Result<>() : state_->write_vertices(data, own);
}

Result<> GuiPass::record_part(VkCommandBuffer commands, const ImDrawData& data, std::uint32_t slot,
                              const VkRect2D& part) {
    DrawSlot& own = state_->slots[slot];
    if (is_empty(data)) return {};
    Block block;
    block.scale = {2 / data.DisplaySize.x, 2 / data.DisplaySize.y};
    block.offset = {-1 - data.DisplayPos.x * block.scale[0], -1 - data.DisplayPos.y * block.scale[1]};
    state_->bind(commands, data, own);
    std::int32_t first_vertex = 0;
    std::uint32_t first_index = 0;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            if (command.UserCallback == nullptr) {
                DARKROOM_TRY(state_->draw(commands, data, command, block, own, first_vertex, first_index, part));
                continue;
            }
            if (command.UserCallback != ImDrawCallback_ResetRenderState) command.UserCallback(&list, &command);
            state_->bind(commands, data, own);
        }
        first_vertex += list.VtxBuffer.Size;
        first_index += static_cast<std::uint32_t>(list.IdxBuffer.Size);
    }
    return {};
}

}  // namespace darkroom::window
