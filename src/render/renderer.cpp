// SPDX-License-Identifier: MIT
#include "render/renderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <vector>

#include "core/assert.hpp"
#include "render/billboard_pass.hpp"
#include "render/environment.hpp"
#include "render/frame_buffers.hpp"
#include "render/gpu_scene.hpp"
#include "render/mesh_pass.hpp"
#include "render/renderer_blocks.hpp"
#include "render/resolve.hpp"
#include "render/shadow_pass.hpp"
#include "render/sky_pass.hpp"
#include "render/targets.hpp"

namespace darkroom::render {

namespace {

Result<> check(const Device& device, const RenderDesc& desc) {
    const gpu::Traits& traits = device.context().traits;
    const std::string& name = device.info().name;
    const std::uint32_t limit = traits.max_image_dimension;
    const auto [width, height] = desc.extent;
    if (width == 0 || height == 0 || width > limit || height > limit)
        return user_error(fmt::format("size {}x{}: {} allows 1x1 to {}x{}", width, height, name, limit, limit));
    const bool is_count = std::has_single_bit(desc.samples) && (desc.samples & traits.sample_counts) != 0;
    if (!is_count) return user_error(fmt::format("samples {}: {} has {}", desc.samples, name, sample_counts(device)));
    if (desc.debug != DebugView::None && desc.output == Output::Hdr)
        return user_error("debug view: it is a picture of its own and needs the display output, not hdr");
    if (desc.has_wireframe_overlay && !traits.has_wireframe)
        return user_error(fmt::format("wireframe overlay: {} cannot draw the edges of triangles", name));
    return {};
}

TargetFormats formats_of(const RenderDesc& desc, bool has_alpha_layer) {
    TargetFormats formats{.samples = static_cast<VkSampleCountFlagBits>(desc.samples),
                          .has_layers = desc.output == Output::Hdr,
                          .has_alpha_layer = has_alpha_layer};
    if (desc.output == Output::Display) formats.color = desc.display_format;
    return formats;
}

/// Moves the value into `out`, or passes the error on.
template <class T>
Result<> take(Result<T>&& made, T& out) {
    if (!made) return failure(std::move(made));
    out = std::move(*made);
    return {};
}

}  // namespace

struct Renderer::State {
    gpu::Context* context = nullptr;
    RenderDesc desc;
    bool has_alpha_layer = false;
    FrameSettings settings;
    gpu::SetLayout frame_layout;
    std::unique_ptr<SetAllocator> sets;
    std::optional<GpuScene> scene;
    std::optional<GpuEnvironment> environment;
    std::optional<ShadowPass> shadows;
    std::optional<MeshPass> meshes;
    std::optional<SkyPass> sky;
    std::optional<BillboardPass> billboards;
    Targets targets;
    std::optional<Resolve> resolve;  ///< Output::Hdr
    std::vector<FrameBuffers> slots;

    // Of the prepared frame.
    std::uint32_t slot = 0;
    const scene::Snapshot* snapshot = nullptr;
    DrawList list;
    std::vector<Light> lights;
    Frame frame;
    ImageRef picture;
    RenderCounters counters;

    Result<> create(Device& device, const scene::Scene& source, const scene::Assets& assets);
    Result<> create_passes(const scene::Snapshot& first);
    Result<> create_targets();
    Result<> prepare(const scene::Snapshot& next);
    Result<> fill_buffers(FrameBuffers& buffers);
    void fill_frame();
    Result<> record(VkCommandBuffer commands);
    Result<> record_scene(VkCommandBuffer commands);

    /// Views of one property show meshes alone.
    [[nodiscard]] bool shows_surroundings() const {
        return desc.debug == DebugView::None || desc.debug == DebugView::Unlit;
    }
    [[nodiscard]] ResolveUse resolve_use() const { return resolve ? resolve->use() : ResolveUse{}; }
};

Result<> Renderer::State::create(Device& device, const scene::Scene& source, const scene::Assets& assets) {
    context = &device.context();
    has_alpha_layer = source.has_alpha_layer;
    Result<> done = take(create_frame_layout(*context), frame_layout);
    if (!done) return done;
    Result<GpuScene> uploaded = GpuScene::create(*context, assets);
    if (!uploaded) return failure(std::move(uploaded));
    scene.emplace(std::move(*uploaded));
    Result<GpuEnvironment> surroundings = GpuEnvironment::create(*context, assets.skybox);
    if (!surroundings) return failure(std::move(surroundings));
    environment.emplace(std::move(*surroundings));
    settings = {.extent = desc.extent,
                .output = desc.output,
                .is_tone_mapped = desc.is_tone_mapped && desc.debug == DebugView::None,
                .debug = desc.debug,
                .environment = source.environment,
                .irradiance = environment->irradiance,
                .environment_levels = environment->levels,
                .has_environment = environment->is_given};
    // What the scene is like at its start says how many shadow maps and which pipelines it needs.
    const scene::Snapshot first = scene::snapshot(source, assets, {});
    if (done = create_targets(); !done) return done;
    if (done = create_passes(first); !done) return done;
    sets = std::make_unique<SetAllocator>(*context, frame_set_sizes(), desc.frames_in_flight);
    for (std::uint32_t i = 0; i < desc.frames_in_flight; ++i) {
        Result<FrameBuffers> made = FrameBuffers::create(*context, *sets, frame_layout.handle);
        if (!made) return failure(std::move(made));
        slots.push_back(std::move(*made));
    }
    return meshes->prepare(first, draw_list(first), *scene);
}

Result<> Renderer::State::create_targets() {
    const TargetFormats formats = formats_of(desc, has_alpha_layer);
    Result<> done = take(Targets::create(*context, {.extent = desc.extent, .formats = formats}), targets);
    if (!done) return done;
    if (!formats.has_layers) {
        picture = targets.copied_picture();
        return {};
    }
    Result<Resolve> made = Resolve::create(*context, formats, desc.frames_in_flight);
    if (!made) return failure(std::move(made));
    resolve.emplace(std::move(*made));
    picture = targets.drawn(targets.color, resolve->use());
    return {};
}

Result<> Renderer::State::create_passes(const scene::Snapshot& first) {
    const auto directional = directional_lights(first);
    const auto casting = static_cast<std::uint32_t>(std::ranges::count_if(directional, is_caster));
    const std::uint32_t maps = desc.has_shadows ? casting : 0;
    Result<ShadowPass> made_shadows = ShadowPass::create(*context, frame_layout.handle, *scene, desc.cascades, maps);
    if (!made_shadows) return failure(std::move(made_shadows));
    shadows.emplace(std::move(*made_shadows));
    shadows->prepare(first);
    const PassSetup setup{.frame_layout = frame_layout.handle,
                          .formats = formats_of(desc, has_alpha_layer),
                          .output = desc.output,
                          .is_tone_mapped = settings.is_tone_mapped,
                          .shadow_maps = maps,
                          .has_environment = settings.has_environment};
    Result<MeshPass> made_meshes = MeshPass::create(*context, setup, *scene, desc.debug);
    if (!made_meshes) return failure(std::move(made_meshes));
    meshes.emplace(std::move(*made_meshes));
    Result<SkyPass> made_sky = SkyPass::create(*context, setup);
    if (!made_sky) return failure(std::move(made_sky));
    sky.emplace(std::move(*made_sky));
    Result<BillboardPass> made_billboards = BillboardPass::create(*context, setup, *scene);
    if (!made_billboards) return failure(std::move(made_billboards));
    billboards.emplace(std::move(*made_billboards));
    return {};
}

Result<> Renderer::State::prepare(const scene::Snapshot& next) {
    snapshot = &next;
    slot = (slot + 1) % desc.frames_in_flight;
    list = draw_list(next);
    shadows->prepare(next);
    Result<> done = meshes->prepare(next, list, *scene);
    if (done) done = billboards->prepare(next, *scene, slot);
    if (done) done = fill_buffers(slots[slot]);
    if (!done) return done;
    if (resolve) resolve->prepare(next.camera, targets, slot);
    counters.draw_calls = counters.instances = counters.culled = 0;
    const auto count = [&](const DrawList& drawn) {
        counters.draw_calls += drawn.opaque.size() + drawn.transparent.size() + drawn.wireframe.size();
        counters.instances += drawn.order.size();
        counters.culled += drawn.culled;
    };
    count(list);
    for (const DrawList& casters : shadows->caster_lists()) count(casters);
    if (resolve) fill_frame();
    return {};
}

Result<> Renderer::State::fill_buffers(FrameBuffers& buffers) {
    FrameBuffers::Counts counts{.instances = list.order.size(),
                                .materials = snapshot->materials.size(),
                                .joints = snapshot->joints.size(),
                                .weights = snapshot->weights.size()};
    for (const DrawList& casters : shadows->caster_lists()) counts.instances += casters.order.size();
    if (Result<> done = buffers.reserve(*context, counts); !done) return done;

    buffers.frame() = frame_block(*snapshot, settings);
    buffers.lights() = light_block(*snapshot, shadows->casting_lights());
    shadows->fill(buffers.shadows());
    std::ranges::transform(snapshot->materials, buffers.materials(), material_block);
    blocks::Instance* instance = buffers.instances();
    const auto write = [&](const DrawList& drawn) {
        for (const std::uint32_t index : drawn.order) {
            const scene::Instance& source = snapshot->instances[index];
            *instance++ = instance_block(source, scene->mesh(source.mesh));
        }
    };
    write(list);
    for (const DrawList& casters : shadows->caster_lists()) write(casters);
    // What has no past has not moved.
    for (std::size_t i = 0; i < counts.joints; ++i) {
        buffers.joints()[2 * i] = snapshot->joints[i];
        buffers.joints()[2 * i + 1] =
            i < snapshot->previous_joints.size() ? snapshot->previous_joints[i] : snapshot->joints[i];
    }
    for (std::size_t i = 0; i < counts.weights; ++i) {
        const float before =
            i < snapshot->previous_weights.size() ? snapshot->previous_weights[i] : snapshot->weights[i];
        buffers.weights()[i] = scene::vec2(snapshot->weights[i], before);
    }
    buffers.write_set(*context, *scene, *shadows, *environment);
    return {};
}

void Renderer::State::fill_frame() {
    lights.clear();
    std::uint32_t map = 0;
    for (const scene::LightState* state : directional_lights(*snapshot)) {
        Light& light = lights.emplace_back(frame_light(*state));
        if (!is_caster(state) || map >= shadows->casting_lights()) continue;
        const gpu::Image& image = shadows->map(map);
        const Cascades& cascades = shadows->cascades(map);
        light.cascades = {.image = image.handle,
                          .view = image.view,
                          .format = image.info.format,
                          .extent = {image.info.extent.width, image.info.extent.height},
                          .layer_count = image.info.array_layers,
                          .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                          .last_stages = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                          .last_access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
        light.cascade_count = cascades.count;
        for (std::size_t i = 0; i < cascades.count; ++i) {
            light.world_to_cascade[i] = matrix_of(cascades.world_to_cascade[i]);
            light.splits[i] = cascades.splits[i];
        }
        ++map;
    }
    const ResolveUse use = resolve->use();
    frame = {.color = targets.drawn(targets.color, use),
             .depth = targets.drawn(targets.planar_depth, use),
             .normals = targets.drawn(targets.normals, use),
             .velocity = targets.drawn(targets.velocity, use),
             .ui = {},
             .camera = frame_camera(snapshot->camera),
             .lights = lights,
             .time = snapshot->time,
             .target = {}};
}

Result<> Renderer::State::record(VkCommandBuffer commands) {
    DARKROOM_ASSERT(snapshot != nullptr);
    gpu::begin_label(*context, commands, "scene");
    const auto first_caster = static_cast<std::uint32_t>(list.order.size());
    Result<> done = shadows->record(commands, slots[slot].set, *snapshot, *scene, first_caster);
    if (done) {
        // A display picture is cleared to what has no code of its own; the sky pass fills it.
        const scene::vec3 clear = desc.output == Output::Hdr ? settings.environment.background : scene::vec3(0);
        targets.begin(commands, {clear.r, clear.g, clear.b, has_alpha_layer ? 0.0F : 1.0F}, resolve_use());
        done = record_scene(commands);
        if (resolve) {
            targets.end_for_resolve(commands, resolve->use());
            resolve->record(commands, targets, slot);
            ++counters.resolves;
        } else {
            targets.end_for_copy(commands);
        }
    }
    gpu::end_label(*context, commands);
    return done;
}

Result<> Renderer::State::record_scene(VkCommandBuffer commands) {
    const VkDescriptorSet set = slots[slot].set;
    const MeshDraw draw{.frame_set = set, .snapshot = snapshot, .list = &list};
    if (Result<> done = meshes->record_opaque(commands, draw, *scene); !done) return done;
    if (shows_surroundings()) {
        billboards->record_sprites(commands, set, slot);
        sky->record_sky(commands, set);
        if (desc.has_grid) sky->record_grid(commands, set);
    }
    if (Result<> done = meshes->record_transparent(commands, draw, *scene); !done) return done;
    if (shows_surroundings()) billboards->record_particles(commands, set, slot);
    if (desc.has_wireframe_overlay)
        if (Result<> done = meshes->record_wireframe_overlay(commands, draw, *scene); !done) return done;
    if (desc.has_normal_arrows) return meshes->record_normal_arrows(commands, draw, *scene);
    return {};
}

Renderer::Renderer() : state_(std::make_unique<State>()) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create(Device& device, const scene::Scene& scene, const scene::Assets& assets,
                                  const RenderDesc& desc) {
    if (Result<> checked = check(device, desc); !checked) return failure(std::move(checked));
    Renderer out;
    out.state_->desc = desc;
    out.state_->desc.frames_in_flight = std::max(desc.frames_in_flight, 1U);
    if (Result<> made = out.state_->create(device, scene, assets); !made) return failure(std::move(made));
    return out;
}

Result<> Renderer::prepare(const scene::Snapshot& snapshot) { return state_->prepare(snapshot); }
Result<> Renderer::record(VkCommandBuffer commands) { return state_->record(commands); }
Frame Renderer::frame() const { return state_->frame; }
VkImageUsageFlags Renderer::layer_usage() const {
    const Targets& targets = state_->targets;
    return targets.planar_depth.info.usage & targets.normals.info.usage & targets.velocity.info.usage;
}
const ImageRef& Renderer::picture() const { return state_->picture; }
const RenderCounters& Renderer::counters() const { return state_->counters; }
const RenderDesc& Renderer::desc() const { return state_->desc; }

std::string sample_counts(const Device& device) {
    std::string out;
    for (std::uint32_t count = 1; count <= VK_SAMPLE_COUNT_64_BIT; count *= 2)
        if ((device.context().traits.sample_counts & count) != 0)
            out += fmt::format("{}{}", out.empty() ? "" : ", ", count);
    return out;
}

}  // namespace darkroom::render
