// SPDX-License-Identifier: MIT
#pragma once
// For tests only: snapshots of boxes and one directional light or more, and a rig that draws their shadow maps and then
// evaluates shaders/light/shadow.glsl on a grid of points, without anything else of the renderer.

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "gpu/test_run.hpp"
#include "render/shader_text.hpp"
#include "render/shadow/shadow_pass.hpp"
#include "render/upload/gpu_scene.hpp"
#include "scene/assets.hpp"

namespace darkroom::render::test {

using gpu::test::must;
using scene::mat4;
using scene::vec3;
using scene::vec4;

/// Points first + x * right + y * down of a plane, evaluated row by row.
struct Grid {
    std::uint32_t width = 1, height = 1;
    vec3 first{0}, right{0}, down{0}, normal{0, 1, 0};
    [[nodiscard]] vec3 point(std::uint32_t x, std::uint32_t y) const {
        return first + right * static_cast<float>(x) + down * static_cast<float>(y);
    }
};

/// What shadow.glsl says at the points of a grid.
struct Visibility {
    std::uint32_t width = 0;
    std::vector<float> filtered, one_tap;
    [[nodiscard]] float at(std::uint32_t x, std::uint32_t y) const { return filtered[y * width + x]; }
};

inline scene::CameraState look(vec3 eye, vec3 target, float field_of_view = 45, float far = 1000) {
    constexpr float near = 0.1F;
    mat4 reversed(1);
    reversed[1][1] = -1;
    reversed[2][2] = -1;
    reversed[3][2] = 1;
    return {.view = glm::lookAt(eye, target, vec3(0, 1, 0)),
            .projection = reversed * glm::perspective(glm::radians(field_of_view), 1.5F, near, far),
            .position = eye,
            .field_of_view = field_of_view,
            .near_distance = near,
            .far_distance = far};
}

/// Made of boxes; material 0 is opaque.
inline scene::Snapshot empty_scene(const scene::CameraState& camera) {
    scene::Snapshot snapshot{.camera = camera};
    snapshot.materials.emplace_back();
    return snapshot;
}

inline void add_box(scene::Snapshot& snapshot, vec3 low, vec3 high) {
    scene::Instance box{.world = glm::scale(glm::translate(mat4(1), low), high - low)};
    box.previous_world = box.world;
    box.bounds.add(low);
    box.bounds.add(high);
    snapshot.instances.push_back(box);
}

inline void add_light(scene::Snapshot& snapshot, vec3 toward, const std::string& name = "sun") {
    scene::LightState light{.name = name, .direction = glm::normalize(toward)};
    light.light.direction = light.direction;
    snapshot.lights.push_back(light);
}

class ShadowRig {
  public:
    /// `shader_lights`: the constant of shadow.glsl.
    explicit ShadowRig(const CascadeDesc& desc, std::uint32_t lights = 1, std::uint32_t shader_lights = 0,
                       const scene::Assets& assets = {})
        : context_(gpu::test::context()),
          scene(must(GpuScene::create(context_, assets))),
          layout_(must(create_frame_layout(context_))),
          pass(must(ShadowPass::create(context_, layout_.handle, scene, desc, {.lights = lights}))) {
        frame_ = make_buffer(sizeof(blocks::Frame), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
        lights_ = make_buffer(sizeof(blocks::Lights), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
        shadows_ = make_buffer(sizeof(blocks::Shadows), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
        environment_ =
            gpu::test::upload(context_, gpu::test::make_pixels(1, 1, [](auto, auto) { return std::array<float, 4>{}; }),
                              VK_FORMAT_R8G8B8A8_UNORM);
        sets_ = must(gpu::DescriptorSets::create(context_, {&layout_.handle, 1}));
        evaluation_ =
            must(gpu::Pipeline::create(context_, evaluation(shader_lights, desc.filter == ShadowFilter::Soft)));
    }

    /// Cascades and casters of the snapshot, and everything that set 0 needs.
    void prepare(const scene::Snapshot& snapshot) {
        snapshot_ = &snapshot;
        must(pass.prepare(snapshot));
        blocks::Frame frame{};
        frame.camera_position = vec4(snapshot.camera.position, 1);
        frame.camera_forward = -vec4(vec3(glm::transpose(snapshot.camera.view)[2]), 0);
        frame.planes = vec4(snapshot.camera.near_distance, snapshot.camera.far_distance, 0, 1);
        std::memcpy(frame_.memory.mapped, &frame, sizeof frame);
        blocks::Shadows shadows{};
        pass.fill(shadows);
        std::memcpy(shadows_.memory.mapped, &shadows, sizeof shadows);
        write_arrays(snapshot);
        write_set();
    }

    void record(VkCommandBuffer commands) { must(pass.record(commands, sets_.sets[0], *snapshot_, scene, 0)); }

    Visibility evaluate(const Grid& grid, std::uint32_t light = 0) { return evaluate(grid, light, true); }
    /// Of the maps that the last evaluate() drew.
    Visibility evaluate_again(const Grid& grid, std::uint32_t light = 0) { return evaluate(grid, light, false); }

    Visibility run(const scene::Snapshot& snapshot, const Grid& grid, std::uint32_t light = 0) {
        prepare(snapshot);
        return evaluate(grid, light);
    }

  private:
    struct Push {
        vec4 first, right, down, normal;
        std::uint32_t light = 0;
    };

    Visibility evaluate(const Grid& grid, std::uint32_t light, bool draws_maps) {
        gpu::test::Picture picture{
            .image = must(gpu::Image::create(
                context_, {.name = "visibility",
                           .format = VK_FORMAT_R32G32_SFLOAT,
                           .extent = {grid.width, grid.height, 1},
                           .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT})),
            .layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        must(gpu::submit_and_wait(context_, "evaluating shadows", [&](VkCommandBuffer commands) {
            if (draws_maps) record(commands);
            gpu::transition(context_, commands, picture.image, VK_IMAGE_LAYOUT_UNDEFINED, picture.layout);
            record_evaluation(commands, picture.image, grid, light);
        }));
        const gpu::test::Pixels pixels = gpu::test::download(context_, picture);
        Visibility out{.width = grid.width};
        for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
            out.filtered.push_back(pixels.rgba[i]);
            out.one_tap.push_back(pixels.rgba[i + 1]);
        }
        return out;
    }

    [[nodiscard]] gpu::Buffer make_buffer(VkDeviceSize size, VkBufferUsageFlags usage) const {
        return must(gpu::Buffer::create(context_, size, usage, gpu::Memory::Kind::Upload, "shadow test"));
    }

    [[nodiscard]] gpu::PipelineDesc evaluation(std::uint32_t shader_lights, bool is_soft) const {
        gpu::PipelineDesc desc{.name = "shadow evaluation"};
        desc.vertex = R"(#version 460
            void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0, 1); })";
        desc.fragment = shader_text("light/shadow.glsl") + R"(
            layout(push_constant) uniform Push { vec4 first; vec4 right; vec4 down; vec4 normal; uint light; };
            layout(location = 0) out vec2 visibility;
            void main() {
                vec2 place = floor(gl_FragCoord.xy);
                vec3 point = first.xyz + right.xyz * place.x + down.xyz * place.y;
                float view_distance = dot(point - frame.camera_position.xyz, frame.camera_forward.xyz);
                visibility = vec2(shadow_visibility(light, point, normal.xyz, view_distance),
                                  shadow_visibility_point(light, point, view_distance));
            })";
        desc.sets = {layout_.handle};
        desc.push_constant_size = sizeof(Push);
        desc.specialization.assign(10, 0);
        desc.specialization[8] = shader_lights;
        desc.specialization[9] = is_soft ? 1 : 0;
        desc.colors = {{.format = VK_FORMAT_R32G32_SFLOAT}};
        return desc;
    }

    template <class T>
    [[nodiscard]] gpu::Buffer make_array(std::vector<T> elements) const {
        elements.emplace_back();
        const std::size_t size = elements.size() * sizeof(T);
        gpu::Buffer buffer = make_buffer(size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        std::memcpy(buffer.memory.mapped, elements.data(), size);
        return buffer;
    }

    void write_arrays(const scene::Snapshot& snapshot) {
        std::vector<blocks::Instance> instances;
        for (const DrawList& list : pass.caster_lists()) {
            for (const std::uint32_t index : list.order) {
                const scene::Instance& from = snapshot.instances[index];
                const GpuMesh& mesh = scene.mesh(from.mesh);
                instances.push_back({.world = from.world,
                                     .previous_world = from.previous_world,
                                     .links = {from.material, from.first_joint, from.first_weight, from.weight_count},
                                     .morph = {mesh.first_morph_delta, mesh.vertex_count, 0, 0}});
            }
        }
        std::vector<blocks::Material> materials;
        for (const scene::SnapshotMaterial& from : snapshot.materials) {
            blocks::Material& material = materials.emplace_back();
            material.base_color = from.surface.base_color;
            material.emissive.w = from.surface.alpha_cutoff;
            material.uv_rows[0] = vec4(1, 0, 0, 0);
            material.uv_rows[1] = vec4(0, 1, 0, 0);
        }
        std::vector<mat4> joints;
        for (const mat4& joint : snapshot.joints) joints.insert(joints.end(), 2, joint);
        std::vector<scene::vec2> weights;
        for (const float weight : snapshot.weights) weights.emplace_back(weight);
        instances_ = make_array(instances);
        materials_ = make_array(materials);
        joints_ = make_array(joints);
        weights_ = make_array(weights);
    }

    void write_set() {
        const std::array<const gpu::Buffer*, 8> buffers{&frame_,     &lights_, &shadows_, &instances_,
                                                        &materials_, &joints_, &weights_, &scene.morph_deltas};
        std::array<VkDescriptorBufferInfo, 8> buffer_infos{};
        std::array<VkDescriptorImageInfo, shadow_images> maps{};
        std::vector<VkWriteDescriptorSet> writes;
        for (std::uint32_t i = 0; i < 8; ++i) {
            buffer_infos[i] = {buffers[i]->handle, 0, VK_WHOLE_SIZE};
            writes.push_back(
                {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                 .dstSet = sets_.sets[0],
                 .dstBinding = i,
                 .descriptorCount = 1,
                 .descriptorType = i < 3 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                 .pBufferInfo = &buffer_infos[i]});
        }
        for (std::uint32_t i = 0; i < shadow_images; ++i)
            maps[i] = {pass.sampler(), pass.map(i).view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        writes.push_back({.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                          .dstSet = sets_.sets[0],
                          .dstBinding = 8,
                          .descriptorCount = shadow_images,
                          .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                          .pImageInfo = maps.data()});
        // What the environment's textures are is nobody's matter here, but drivers look at whole sets.
        const VkDescriptorImageInfo environment{context_.nearest_sampler, environment_.image.view,
                                                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        for (std::uint32_t i = 9; i < frame_bindings; ++i) {
            writes.push_back({.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                              .dstSet = sets_.sets[0],
                              .dstBinding = i,
                              .descriptorCount = 1,
                              .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                              .pImageInfo = &environment});
        }
        context_.vk.UpdateDescriptorSets(context_.device, static_cast<std::uint32_t>(writes.size()), writes.data(), 0,
                                         nullptr);
    }

    void record_evaluation(VkCommandBuffer commands, const gpu::Image& image, const Grid& grid, std::uint32_t light) {
        const VkRenderingAttachmentInfo color{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                              .imageView = image.view,
                                              .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                              .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
        const VkRect2D area{.extent = {grid.width, grid.height}};
        const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                   .renderArea = area,
                                   .layerCount = 1,
                                   .colorAttachmentCount = 1,
                                   .pColorAttachments = &color};
        const VkViewport viewport{
            .width = static_cast<float>(grid.width), .height = static_cast<float>(grid.height), .maxDepth = 1};
        const Push push{vec4(grid.first, 0), vec4(grid.right, 0), vec4(grid.down, 0), vec4(grid.normal, 0), light};
        const gpu::Dispatch& vk = context_.vk;
        vk.CmdBeginRendering(commands, &info);
        vk.CmdSetViewport(commands, 0, 1, &viewport);
        vk.CmdSetScissor(commands, 0, 1, &area);
        vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, evaluation_.handle);
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, evaluation_.layout, 0, 1, &sets_.sets[0], 0,
                                 nullptr);
        vk.CmdPushConstants(commands, evaluation_.layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                            sizeof push, &push);
        vk.CmdDraw(commands, 3, 1, 0, 0);
        vk.CmdEndRendering(commands);
    }

    gpu::Context& context_;

  public:
    GpuScene scene;

  private:
    gpu::SetLayout layout_;

  public:
    ShadowPass pass;

  private:
    gpu::Buffer frame_, lights_, shadows_, instances_, materials_, joints_, weights_;
    gpu::test::Picture environment_;
    gpu::DescriptorSets sets_;
    gpu::Pipeline evaluation_;
    const scene::Snapshot* snapshot_ = nullptr;
};

}  // namespace darkroom::render::test
