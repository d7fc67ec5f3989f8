// SPDX-License-Identifier: MIT
#pragma once
// For tests only: shaders/mesh/mesh_fragment.glsl drawn with frame, lights and one material of a test's choice on one
// of two shapes, seen from where their closed forms are simple, without the passes that draw scenes.

#include <array>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "draw/pipeline.hpp"
#include "render/frame_set.hpp"
#include "render/light/shading_test_support.hpp"
#include "scene/model.hpp"

namespace darkroom::render::test {

/// constant_id 0 .. 7 of mesh_fragment.glsl, and 13.
struct Switches {
    std::uint32_t has_textures = 0, has_shadows = 0, has_environment = 0, is_masked = 0;
    std::uint32_t output = 0, debug = 0, is_tone_mapped = 0, is_transparent = 0;
    std::uint32_t layers = 0;
    friend auto operator<=>(const Switches&, const Switches&) = default;
};

enum class Shape : std::uint32_t {
    Plane,          ///< y = 0, x and z in [-1, 1], seen from above; x to the right, z down; (u, v) from its top left
    PlaneFromBack,  ///< the same, but its front is below
    Sphere,         ///< of radius 1 around 0, seen from +z; x to the right, y up; it touches the picture's edges
};

/// What all vertices of the shape have.
struct VertexAttributes {
    vec4 tangent{0};
    vec4 color{1};
    vec4 uv{1, 1, 0, 0};  ///< of the first set: scale, offset
};

/// Without perspective, so that the direction to the camera is the same everywhere. Made from the vertex's number.
inline constexpr const char* bench_vertex = R"(
layout(push_constant) uniform Push { vec4 tangent; vec4 color; vec4 uv_change; uint shape; };

void place_on_plane() {
    uint far_corner = shape == 0u ? 1u : 2u;
    vec2 place = gl_VertexIndex == 0 ? vec2(0) : gl_VertexIndex == far_corner ? vec2(0, 2) : vec2(2, 0);
    world_position = vec3(place.x * 2 - 1, 0, place.y * 2 - 1);
    world_normal = vec3(0, 2, 0);
    uv = vec4(place, place.yx);
    gl_Position = vec4(world_position.xz, 0.5, 1);
}

void place_on_sphere() {
    const uint rings = 96u;
    uint corner = uint(gl_VertexIndex) % 6u;
    uint quad = uint(gl_VertexIndex) / 6u;
    // Of two triangles: (0, 0), (1, 0), (0, 1) and (0, 1), (1, 0), (1, 1).
    uvec2 step = uvec2(0x32u >> corner, 0x2Cu >> corner) & 1u;
    vec2 angles = vec2(uvec2(quad % rings, quad / rings) + step) * 3.14159265358979 / float(rings) * vec2(2, 1);
    world_position = vec3(sin(angles.y) * cos(angles.x), cos(angles.y), sin(angles.y) * sin(angles.x));
    world_normal = world_position * 3.0;
    uv = vec4(angles, angles);
    gl_Position = vec4(world_position.x, -world_position.y, world_position.z * 0.4 + 0.5, 1);
}

void main() {
    if (shape == 2u) {
        place_on_sphere();
    } else {
        place_on_plane();
    }
    world_tangent = tangent;
    vertex_color = color;
    uv.xy = uv.xy * uv_change.xy + uv_change.zw;
    clip_position = gl_Position;
    previous_clip_position = gl_Position + vec4(0.5, 0.25, 0, 0);
    material_index = 1u;
}
)";

/// Ready to be drawn: white, lit by nothing.
class FragmentBench {
  public:
    static constexpr std::uint32_t size = 64;  ///< of the picture, squared

    blocks::Frame frame{};
    blocks::Lights lights{};
    blocks::Material material{};
    std::array<gpu::test::Pixels, scene::material_textures> textures;
    gpu::test::Pixels environment = one(vec4(0));  ///< equirectangular, for every roughness
    vec4 scale_and_bias{0};                        ///< the split sum, for every angle and roughness
    VertexAttributes vertex;

    explicit FragmentBench(Shape shape) : shape_(shape) {
        const scene::vec3 toward_camera = shape == Shape::Sphere ? scene::vec3(0, 0, 1) : scene::vec3(0, 1, 0);
        frame.camera_position = vec4(toward_camera * 10.0F, 0);
        frame.camera_forward = vec4(-toward_camera, 0);
        frame.target_size = vec4(size, size, 1.0F / size, 1.0F / size);
        frame.planes = vec4(1, 100, 0, 1);
        material.base_color = vec4(1);
        material.factors = vec4(0, 1, 1, 1);
        for (std::size_t i = 0; i < textures.size(); ++i) {
            material.uv_rows[2 * i] = vec4(1, 0, 0, 0);
            material.uv_rows[2 * i + 1] = vec4(0, 1, 0, 0);
            textures[i] = one(vec4(1));
        }
    }

    static gpu::test::Pixels one(const vec4& value) {
        return gpu::test::make_pixels(1, 1, [&](std::uint32_t, std::uint32_t) {
            return std::array{value.x, value.y, value.z, value.w};
        });
    }

    struct Targets {
        gpu::test::Pixels color, normal, velocity;
    };
    [[nodiscard]] Targets draw(const Switches& switches);

    /// Where a pixel's centre is on the plane or on the sphere.
    [[nodiscard]] dvec3 position(std::uint32_t x, std::uint32_t y) const { return position_at(x + 0.5, y + 0.5); }
    [[nodiscard]] dvec3 position_at(double x, double y) const {
        const double right = x / size * 2 - 1, down = y / size * 2 - 1;
        if (shape_ != Shape::Sphere) return {right, 0, down};
        return {right, -down, std::sqrt(std::max(1 - right * right - down * down, 0.0))};
    }

  private:
    struct Sets;
    Shape shape_;
    std::map<Switches, gpu::Pipeline> pipelines_;
};

/// The two descriptor sets and everything in them.
struct FragmentBench::Sets {
    gpu::Context& context = gpu::test::context();
    gpu::SetLayout frame_layout = gpu::test::must(create_frame_layout(context));
    gpu::SetLayout texture_layout = gpu::test::must(
        gpu::SetLayout::create(context, std::array<gpu::SetLayout::Binding, scene::material_textures>{}));
    std::array<VkDescriptorSetLayout, 2> layouts{frame_layout.handle, texture_layout.handle};
    gpu::DescriptorSets sets = gpu::test::must(gpu::DescriptorSets::create(context, layouts));
    std::vector<gpu::Buffer> buffers;
    std::vector<gpu::test::Picture> pictures;
    gpu::Image shadow_map = gpu::test::must(gpu::Image::create(
        context, {.name = "no shadow map",
                  .format = VK_FORMAT_D32_SFLOAT,
                  .array_layers = 2,
                  .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT}));
    VkSampler comparing = VK_NULL_HANDLE;

    explicit Sets(const FragmentBench& bench) {
        const VkSamplerCreateInfo sampler{
            .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO, .compareEnable = VK_TRUE, .maxLod = VK_LOD_CLAMP_NONE};
        gpu::test::must(context.check(context.vk.CreateSampler(context.device, &sampler, nullptr, &comparing),
                                      "creating a sampler"));
        gpu::test::must(gpu::submit_and_wait(context, "readying a shadow map", [&](VkCommandBuffer commands) {
            gpu::transition(context, commands, shadow_map, VK_IMAGE_LAYOUT_UNDEFINED,
                            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        }));
        // The material that is drawn is the second, to see that its number is looked at.
        const std::array materials{blocks::Material{}, bench.material};
        set_buffer(0, &bench.frame, sizeof bench.frame);
        set_buffer(1, &bench.lights, sizeof bench.lights);
        const blocks::Shadows shadows{};
        set_buffer(2, &shadows, sizeof shadows);
        for (std::uint32_t binding = 3; binding < 8; ++binding) set_buffer(binding, materials.data(), sizeof materials);
        for (std::uint32_t map = 0; map < shadow_images; ++map) set_image(0, 8, map, shadow_map.view, comparing);
        set_picture(0, 9, bench.environment);
        set_picture(0, 10, bench.environment);
        set_picture(0, 11, one(bench.scale_and_bias));
        for (std::uint32_t i = 0; i < bench.textures.size(); ++i) set_picture(1, i, bench.textures[i]);
    }
    Sets(const Sets&) = delete;
    Sets& operator=(const Sets&) = delete;
    ~Sets() { context.vk.DestroySampler(context.device, comparing, nullptr); }

    void set_buffer(std::uint32_t binding, const void* data, std::size_t bytes) {
        const bool is_uniform = binding < 3;
        buffers.push_back(gpu::test::must(gpu::Buffer::create(
            context, bytes, is_uniform ? VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::Memory::Kind::Upload, "test block")));
        std::memcpy(buffers.back().memory.mapped, data, bytes);
        const VkDescriptorBufferInfo info{.buffer = buffers.back().handle, .range = VK_WHOLE_SIZE};
        update({.dstSet = sets.sets[0],
                .dstBinding = binding,
                .descriptorType = is_uniform ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                .pBufferInfo = &info});
    }
    void set_picture(std::size_t set, std::uint32_t binding, const gpu::test::Pixels& pixels) {
        pictures.push_back(gpu::test::upload(context, pixels, VK_FORMAT_R32G32B32A32_SFLOAT));
        set_image(set, binding, 0, pictures.back().image.view, context.linear_sampler);
    }
    void set_image(std::size_t set, std::uint32_t binding, std::uint32_t element, VkImageView view, VkSampler sampler) {
        const VkDescriptorImageInfo info{
            .sampler = sampler, .imageView = view, .imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        update({.dstSet = sets.sets[set],
                .dstBinding = binding,
                .dstArrayElement = element,
                .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                .pImageInfo = &info});
    }
    void update(VkWriteDescriptorSet write) {
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.descriptorCount = 1;
        context.vk.UpdateDescriptorSets(context.device, 1, &write, 0, nullptr);
    }
};

inline FragmentBench::Targets FragmentBench::draw(const Switches& switches) {
    gpu::Context& context = gpu::test::context();
    frame.modes.z = switches.debug;
    const Sets sets(*this);
    const bool has_layers = switches.output == static_cast<std::uint32_t>(Output::Hdr);
    constexpr VkFormat wide = VK_FORMAT_R32G32B32A32_SFLOAT;
    const TargetFormats formats{
        .color = wide, .normals = wide, .velocity = VK_FORMAT_R32G32_SFLOAT, .has_layers = has_layers};
    struct {
        VertexAttributes vertex;
        Shape shape;
    } const push{vertex, shape_};
    gpu::Pipeline& pipeline = pipelines_[switches];
    if (pipeline.handle == VK_NULL_HANDLE) {
        pipeline = gpu::test::must(gpu::Pipeline::create(
            context,
            {.name = "fragment bench",
             .vertex = shader_text("mesh/mesh_varyings_out.glsl") + bench_vertex,
             .fragment = shader_text("mesh/mesh_fragment.glsl"),
             .sets = {sets.layouts.begin(), sets.layouts.end()},
             .push_constant_size = sizeof push,
             .specialization = {switches.has_textures, switches.has_shadows, switches.has_environment,
                                switches.is_masked, switches.output, switches.debug != 0 ? 1U : 0U,
                                switches.is_tone_mapped, switches.is_transparent, 0, 0, 0, 0, 0, switches.layers},
             .colors = formats.colors({}, TargetFormats::Layers::Written),
             .depth = VK_FORMAT_D32_SFLOAT}));
    }

    constexpr VkExtent2D extent{size, size};
    std::array targets{gpu::test::blank(context, extent, formats.color),
                       gpu::test::blank(context, extent, formats.normals),
                       gpu::test::blank(context, extent, formats.velocity)};
    const gpu::Image depth =
        gpu::test::must(gpu::Image::create(context, {.name = "test depth",
                                                     .format = VK_FORMAT_D32_SFLOAT,
                                                     .extent = {size, size, 1},
                                                     .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT}));
    gpu::test::must(gpu::submit_and_wait(context, "drawing on the fragment bench", [&](VkCommandBuffer commands) {
        std::vector<VkRenderingAttachmentInfo> colors;
        for (gpu::test::Picture& target : targets) {
            gpu::transition(context, commands, target.image, target.layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
            target.layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
            colors.push_back({.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                              .imageView = target.image.view,
                              .imageLayout = target.layout,
                              .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                              .storeOp = VK_ATTACHMENT_STORE_OP_STORE});
        }
        gpu::transition(context, commands, depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
        const VkRenderingAttachmentInfo depth_target{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                                     .imageView = depth.view,
                                                     .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                     .storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE};
        const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                        .renderArea = {{0, 0}, extent},
                                        .layerCount = 1,
                                        .colorAttachmentCount = has_layers ? 3U : 1U,
                                        .pColorAttachments = colors.data(),
                                        .pDepthAttachment = &depth_target};
        const VkViewport viewport{0, 0, size, size, 0, 1};
        const VkRect2D scissor{{0, 0}, extent};
        context.vk.CmdBeginRendering(commands, &rendering);
        context.vk.CmdSetViewport(commands, 0, 1, &viewport);
        context.vk.CmdSetScissor(commands, 0, 1, &scissor);
        context.vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
        context.vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout, 0, 2,
                                         sets.sets.sets.data(), 0, nullptr);
        context.vk.CmdPushConstants(commands, pipeline.layout,
                                    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
        constexpr std::uint32_t sphere_vertices = 96 * 96 * 6;
        context.vk.CmdDraw(commands, shape_ == Shape::Sphere ? sphere_vertices : 3, 1, 0, 0);
        context.vk.CmdEndRendering(commands);
    }));
    return {gpu::test::download(context, targets[0]), gpu::test::download(context, targets[1]),
            gpu::test::download(context, targets[2])};
}

}  // namespace darkroom::render::test
