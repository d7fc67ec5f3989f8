// SPDX-License-Identifier: MIT
#include "hand_written.hpp"

#include <fmt/format.h>

#include <array>

#include "bench/upload.hpp"
#include "full_screen.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom::bench {

namespace {

constexpr std::string_view head = R"(
layout(push_constant) uniform Values {
    ivec2 extent;
    vec2 texel_size;
    ivec2 shift;
    float exposure, vignette_intensity, vignette_smoothness, dither_intensity;
};
layout(set = 0, binding = 0, rgba16f) uniform readonly image2D scene;
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D tile;
)";

constexpr std::string_view copy_source = R"(
vec4 shade(ivec2 texel) { return imageLoad(scene, texel); }
)";

// Formulas as in hand_written.cpp.
constexpr std::string_view tail_source = R"(
vec4 shade(ivec2 texel) {
    vec4 color = imageLoad(scene, texel);
    vec3 light = max(color.rgb * exposure, 0.0);
    light = min(light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14), 1.0);

    vec2 offset = (vec2(texel) + 0.5) * texel_size - 0.5;
    light *= max(0.0, 1.0 - pow(2.0 * dot(offset, offset), 0.5 * vignette_smoothness) * vignette_intensity);

    vec3 t = 1.0 - sqrt(sqrt(light));
    vec3 power = 1.0 - t * (1.75715567 + t * (-0.571225668 + t * (-0.127878612 + t * (0.0903737166 - t * 0.0879412007))));
    vec3 code = mix(power, 12.92 * light, lessThanEqual(light, vec3(0.0031308)));

    vec3 noise = imageLoad(tile, (texel + shift) & 63).rgb;
    vec3 width = max(min(vec3(0.5 * dither_intensity), min(code, 1.0 - code)), 0.0);
    return vec4(code + noise * width, color.a);
}
)";

constexpr std::string_view compute_main = R"(
layout(set = 0, binding = 2, rgba8) uniform writeonly image2D result;
void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, extent))) imageStore(result, texel, shade(texel));
}
)";

constexpr std::string_view fragment_main = R"(
layout(location = 0) out vec4 result;
void main() { result = shade(ivec2(gl_FragCoord.xy)); }
)";

constexpr std::string_view vertex_source = R"(#version 460
void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0); }
)";

/// The block of push constants.
struct Values {
    std::array<std::int32_t, 2> extent{};
    std::array<float, 2> texel_size{};
    std::array<std::int32_t, 2> shift{};
    TailValues tail;
};

class Plain {
  public:
    [[nodiscard]] static Result<std::shared_ptr<Plain>> create(Bed& bed, PlainPass pass, gpu::Stage stage,
                                                               const TailValues& values, const TableDesc& tile);
    Plain(const Plain&) = delete;
    Plain& operator=(const Plain&) = delete;
    ~Plain();
    void record(VkCommandBuffer commands) const;

  private:
    Plain(Bed& bed, PlainPass pass, gpu::Stage stage)
        : bed_(bed),
          shade_(pass == PlainPass::Copy ? copy_source : tail_source),
          is_compute_(stage == gpu::Stage::Compute),
          workgroup_(gpu::usual_workgroup(bed.context)) {}
    [[nodiscard]] Result<> create_layouts();
    [[nodiscard]] Result<VkPipelineShaderStageCreateInfo> load(VkShaderStageFlagBits stage, gpu::ShaderStage kind,
                                                               std::string text);
    [[nodiscard]] Result<> create_pipeline();
    void write_set();
    void draw(VkCommandBuffer commands) const;

    Bed& bed_;
    std::string_view shade_;
    bool is_compute_;
    std::array<std::uint32_t, 2> workgroup_;
    Values values_;
    gpu::Image tile_;
    gpu::DescriptorSets sets_;
    std::vector<VkShaderModule> modules_;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

Plain::~Plain() {
    const gpu::Dispatch& vk = bed_.context.vk;
    const VkDevice device = bed_.context.device;
    vk.DestroyPipeline(device, pipeline_, nullptr);
    vk.DestroyPipelineLayout(device, layout_, nullptr);
    vk.DestroyDescriptorSetLayout(device, set_layout_, nullptr);
    for (const VkShaderModule module : modules_) vk.DestroyShaderModule(device, module, nullptr);
}

Result<> Plain::create_layouts() {
    gpu::Context& context = bed_.context;
    const VkShaderStageFlags stages = is_compute_ ? VK_SHADER_STAGE_COMPUTE_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (std::uint32_t binding = 0; binding < (is_compute_ ? 3u : 2u); ++binding)
        bindings.push_back({.binding = binding,
                            .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                            .descriptorCount = 1,
                            .stageFlags = stages});
    const VkDescriptorSetLayoutCreateInfo set_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                   .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                                   .pBindings = bindings.data()};
    VkResult result = context.vk.CreateDescriptorSetLayout(context.device, &set_info, nullptr, &set_layout_);
    DARKROOM_TRY(context.check(result, "creating a set layout"));
    const VkPushConstantRange range{.stageFlags = stages, .size = sizeof(Values)};
    const VkPipelineLayoutCreateInfo layout_info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                                 .setLayoutCount = 1,
                                                 .pSetLayouts = &set_layout_,
                                                 .pushConstantRangeCount = 1,
                                                 .pPushConstantRanges = &range};
    result = context.vk.CreatePipelineLayout(context.device, &layout_info, nullptr, &layout_);
    DARKROOM_TRY(context.check(result, "creating a pipeline layout"));
    DARKROOM_TRY_VALUE(sets_, gpu::DescriptorSets::create(context, {&set_layout_, 1}));
    return {};
}

Result<VkPipelineShaderStageCreateInfo> Plain::load(VkShaderStageFlagBits stage, gpu::ShaderStage kind,
                                                    std::string text) {
    gpu::Context& context = bed_.context;
    DARKROOM_TRY_VALUE(const auto words,
                       context.shaders->compile({.name = "plain pass", .text = std::move(text), .stage = kind}));
    const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = words.size() * sizeof(std::uint32_t),
                                        .pCode = words.data()};
    VkShaderModule module = VK_NULL_HANDLE;
    DARKROOM_TRY(context.check(context.vk.CreateShaderModule(context.device, &info, nullptr, &module),
                               "creating a shader module"));
    modules_.push_back(module);
    return VkPipelineShaderStageCreateInfo{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                           .stage = stage,
                                           .module = module,
                                           .pName = "main"};
}

Result<> Plain::create_pipeline() {
    gpu::Context& context = bed_.context;
    if (is_compute_) {
        DARKROOM_TRY_VALUE(const auto shader,
                           load(VK_SHADER_STAGE_COMPUTE_BIT, gpu::ShaderStage::Compute,
                                fmt::format("#version 460\nlayout(local_size_x = {}, local_size_y = {}) in;\n{}{}{}",
                                            workgroup_[0], workgroup_[1], head, shade_, compute_main)));
        const VkComputePipelineCreateInfo info{
            .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO, .stage = shader, .layout = layout_};
        return context.check(
            context.vk.CreateComputePipelines(context.device, context.pipeline_cache, 1, &info, nullptr, &pipeline_),
            "creating a pipeline");
    }
    DARKROOM_TRY_VALUE(const auto vertex,
                       load(VK_SHADER_STAGE_VERTEX_BIT, gpu::ShaderStage::Vertex, std::string(vertex_source)));
    DARKROOM_TRY_VALUE(const auto fragment, load(VK_SHADER_STAGE_FRAGMENT_BIT, gpu::ShaderStage::Fragment,
                                                 fmt::format("#version 460\n{}{}{}", head, shade_, fragment_main)));
    const std::array stages{vertex, fragment};
    return context.check(
        create_full_screen_pipeline(
            context.vk, context.device, context.pipeline_cache,
            {.layout = layout_, .stages = stages, .output = bed_.target.info.format, .blend = {.colorWriteMask = 0xF}},
            pipeline_),
        "creating a pipeline");
}

void Plain::write_set() {
    std::array<VkDescriptorImageInfo, 3> images{};
    std::array<VkWriteDescriptorSet, 3> writes{};
    const std::array views{bed_.scene.mip_views[0], tile_.mip_views[0], bed_.target.mip_views[0]};
    for (std::uint32_t i = 0; i < views.size(); ++i) {
        images[i] = {.imageView = views[i], .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
        writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                     .dstSet = sets_.sets[0],
                     .dstBinding = i,
                     .descriptorCount = 1,
                     .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                     .pImageInfo = &images[i]};
    }
    bed_.context.vk.UpdateDescriptorSets(bed_.context.device, is_compute_ ? 3 : 2, writes.data(), 0, nullptr);
}

Result<std::shared_ptr<Plain>> Plain::create(Bed& bed, PlainPass pass, gpu::Stage stage, const TailValues& values,
                                             const TableDesc& tile) {
    const std::shared_ptr<Plain> out(new Plain(bed, pass, stage));
    const auto [width, height] = bed.extent;
    out->values_ = {.extent = {static_cast<std::int32_t>(width), static_cast<std::int32_t>(height)},
                    .texel_size = {1.0f / static_cast<float>(width), 1.0f / static_cast<float>(height)},
                    .tail = values};
    DARKROOM_TRY_VALUE(out->tile_, upload_table(bed.context, tile));
    DARKROOM_TRY(out->create_layouts());
    DARKROOM_TRY(out->create_pipeline());
    out->write_set();
    return out;
}

void Plain::draw(VkCommandBuffer commands) const {
    const gpu::Dispatch& vk = bed_.context.vk;
    const VkRenderingAttachmentInfo attachment{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                               .imageView = bed_.target.mip_views[0],
                                               .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                               .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                               .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRect2D area{.extent = bed_.extent};
    const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                    .renderArea = area,
                                    .layerCount = 1,
                                    .colorAttachmentCount = 1,
                                    .pColorAttachments = &attachment};
    const VkViewport viewport{.width = static_cast<float>(bed_.extent.width),
                              .height = static_cast<float>(bed_.extent.height),
                              .maxDepth = 1};
    vk.CmdBeginRendering(commands, &rendering);
    vk.CmdSetViewport(commands, 0, 1, &viewport);
    vk.CmdSetScissor(commands, 0, 1, &area);
    vk.CmdDraw(commands, 3, 1, 0, 0);
    vk.CmdEndRendering(commands);
}

void Plain::record(VkCommandBuffer commands) const {
    const gpu::Dispatch& vk = bed_.context.vk;
    const VkImageLayout layout = is_compute_ ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkPipelineBindPoint point = is_compute_ ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
    gpu::transition(bed_.context, commands, bed_.target, VK_IMAGE_LAYOUT_GENERAL, layout);
    vk.CmdBindPipeline(commands, point, pipeline_);
    vk.CmdBindDescriptorSets(commands, point, layout_, 0, 1, sets_.sets.data(), 0, nullptr);
    vk.CmdPushConstants(commands, layout_, is_compute_ ? VK_SHADER_STAGE_COMPUTE_BIT : VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                        sizeof values_, &values_);
    if (is_compute_) {
        const auto groups = [](std::uint32_t size, std::uint32_t group) { return (size + group - 1) / group; };
        vk.CmdDispatch(commands, groups(bed_.extent.width, workgroup_[0]), groups(bed_.extent.height, workgroup_[1]),
                       1);
    } else {
        draw(commands);
    }
    gpu::transition(bed_.context, commands, bed_.target, layout, VK_IMAGE_LAYOUT_GENERAL);
}

}  // namespace

Result<Row> plain_row(Bed& bed, std::string name, PlainPass pass, gpu::Stage stage, const TailValues& values,
                      const TableDesc& tile) {
    auto plain = Plain::create(bed, pass, stage, values, tile);
    if (!plain) return failure(std::move(plain));
    return Row{.name = std::move(name),
               .record = [plain = std::move(*plain)](VkCommandBuffer commands) -> Result<> {
                   plain->record(commands);
                   return {};
               },
               .moved_bytes = one_pass_bytes(bed)};
}

}  // namespace darkroom::bench
