// SPDX-License-Identifier: MIT
#include "render/renderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <vector>

#include "core/assert.hpp"
#include "render/frame_buffers.hpp"
#include "render/pass/accumulate.hpp"
#include "render/pass/billboard_pass.hpp"
#include "render/pass/mesh_pass.hpp"
#include "render/pass/resolve.hpp"
#include "render/pass/sky_pass.hpp"
#include "render/renderer_blocks.hpp"
#include "render/shadow/shadow_pass.hpp"
#include "render/targets.hpp"
#include "render/upload/scene_on_device.hpp"

namespace darkroom::render {

namespace {

std::string counts_of(const gpu::Traits& traits) {
    std::string out;
    for (std::uint32_t count = 1; count <= VK_SAMPLE_COUNT_64_BIT; count *= 2)
        if ((traits.sample_counts & count) != 0) out += fmt::format("{}{}", out.empty() ? "" : ", ", count);
    return out;
}

Result<> check(const gpu::Context& context, VkExtent2D extent) {
    const std::uint32_t limit = context.traits.max_image_dimension;
    const auto [width, height] = extent;
    if (width != 0 && height != 0 && width <= limit && height <= limit) return {};
    return user_error(
        fmt::format("size {}x{}: {} allows 1x1 to {}x{}", width, height, context.info.name, limit, limit));
}

Result<> check(const gpu::Context& context, const DrawOptions& options, Output output) {
    if (options.debug != DebugView::None && output == Output::Hdr)
        return user_error("debug view: it is a picture of its own and needs the display output, not hdr");
    const bool has_edges = options.has_wireframe_overlay || options.debug == DebugView::Wireframe;
    if (!has_edges || context.traits.has_wireframe) return {};
    return user_error(fmt::format("{}: {} cannot draw the edges of triangles",
                                  options.has_wireframe_overlay ? "wireframe overlay" : "debug view wireframe",
                                  context.info.name));
}

Result<> check(const gpu::Context& context, const RenderDesc& desc) {
    DARKROOM_TRY(check(context, desc.extent));
    const std::uint32_t counts = context.traits.sample_counts;
    if (!std::has_single_bit(desc.samples) || (desc.samples & counts) == 0)
        return user_error(
            fmt::format("samples {}: {} has {}", desc.samples, context.info.name, counts_of(context.traits)));
    if (desc.positions < 1 || desc.positions > scene::max_samples)
        return user_error(
            fmt::format("positions in a pixel: {}, [1, {}] are allowed", desc.positions, scene::max_samples));
    if (desc.lens.f_stop > 0 && desc.positions == 1)
        return user_error(fmt::format("lens at f/{}: seen from one place; positions in a pixel: [2, {}] are allowed",
                                      desc.lens.f_stop, scene::max_samples));
    if (desc.has_transparency && (desc.samples != 1 || desc.positions != 1 || desc.output != Output::Hdr))
        return user_error(
            fmt::format("colour before transparency: with {} samples, {} positions and the {} output; allowed is 1, 1 "
                        "and hdr",
                        desc.samples, desc.positions, desc.output == Output::Hdr ? "hdr" : "display"));
    return check(context, desc.draw, desc.output);
}

/// Moves the value into `out`, or passes the error on.
template <class T, class Out>
Result<> take(Result<T>&& made, Out& out) {
    if (!made) return failure(std::move(made));
    out = std::move(*made);
    return {};
}

}  // namespace

struct Renderer::State {
    gpu::Context* context = nullptr;
    RenderDesc desc;
    std::shared_ptr<SceneOnDevice> scene;
    FrameSettings settings;
    std::unique_ptr<SetAllocator> sets;
    std::optional<ShadowPass> shadows;
    std::optional<MeshPass> meshes;
    std::optional<SkyPass> sky;
    std::optional<BillboardPass> billboards;
    Targets targets;
    std::optional<Resolve> resolve;        ///< Output::Hdr
    std::optional<Accumulate> accumulate;  ///< where there is more than one position
    std::vector<scene::vec2> positions;    ///< in a pixel, of accumulate
    std::vector<FrameBuffers> slots;

    // Of the prepared frame.
    std::uint32_t slot = 0;
    const scene::Snapshot* snapshot = nullptr;
    FrameJitter jitter;
    DrawList list;
    std::vector<Light> lights;
    Frame frame;
    ImageRef picture;
    RenderCounters counters;

    Result<> create();
    Result<> create_passes();
    Result<> create_targets(VkExtent2D extent);
    void apply(const DrawOptions& options);
    Result<> warm_up();
    Result<> prepare(const scene::Snapshot& next, const FrameJitter& next_jitter);
    Result<> fill_buffers(FrameBuffers& buffers);
    void fill_frame();
    Result<> record(VkCommandBuffer commands);
    /// From every position, the centre last, so that depth, normals and velocity are of it.
    Result<> record_positions(VkCommandBuffer commands);
    Result<> record_position(VkCommandBuffer commands);
    Result<> record_scene(VkCommandBuffer commands);

    [[nodiscard]] TargetFormats formats() const;
    [[nodiscard]] MeshDraw mesh_draw(const scene::Snapshot& drawn, const DrawList& drawn_list) const;
    /// Views of one property show meshes alone.
    [[nodiscard]] bool shows_surroundings() const {
        return desc.draw.debug == DebugView::None || desc.draw.debug == DebugView::Unlit;
    }
    [[nodiscard]] ResolveUse resolve_use() const { return resolve ? resolve->use() : ResolveUse{}; }
    /// The linear picture, as record() leaves it.
    [[nodiscard]] ImageRef drawn_color() const {
        return accumulate ? targets.written(targets.color, accumulate->use())
                          : targets.drawn(targets.color, resolve->use());
    }
};

Result<> Renderer::State::create() {
    settings = {.output = desc.output,
                .environment = scene->surroundings,
                .irradiance = scene->environment.irradiance,
                .environment_levels = scene->environment.levels};
    apply(desc.draw);
    if (desc.output == Output::Hdr) {
        Result<> made = take(Resolve::create(*context, formats(), desc.frames_in_flight), resolve);
        if (!made) return made;
        if (desc.positions > 1)
            made =
                take(Accumulate::create(*context, formats().color, desc.positions, desc.is_mean_weighed), accumulate);
        if (!made) return made;
        positions = positions_in_pixel(desc.positions);
    }
    DARKROOM_TRY(create_targets(desc.extent));
    DARKROOM_TRY(create_passes());
    sets = std::make_unique<SetAllocator>(*context, frame_set_sizes(), desc.frames_in_flight);
    for (std::uint32_t i = 0; i < desc.frames_in_flight; ++i) {
        DARKROOM_TRY_VALUE(FrameBuffers made, FrameBuffers::create(*context, *sets, scene->frame_layout.handle));
        slots.push_back(std::move(made));
    }
    const DrawList all = draw_list(scene->first);
    return meshes->prepare(mesh_draw(scene->first, all), scene->meshes);
}

void Renderer::State::apply(const DrawOptions& options) {
    desc.draw = options;
    settings.debug = options.debug;
    settings.mip_bias = options.mip_bias;
    settings.is_tone_mapped = desc.is_tone_mapped && options.debug == DebugView::None;
    settings.exposure = options.debug == DebugView::None ? options.exposure : 1;
}

Result<> Renderer::State::warm_up() {
    scene::Snapshot all = scene->first;
    all.camera.projection = scene::mat4(0);  // nothing lies outside its planes
    const DrawList everything = draw_list(all);
    const bool has_edges = context->traits.has_wireframe;
    std::vector<DebugView> views{DebugView::None};
    if (desc.output == Output::Display) views.insert(views.end(), {DebugView::Unlit, DebugView::Normals});
    if (desc.output == Output::Display && has_edges) views.push_back(DebugView::Wireframe);
    for (const DebugView view : views) {
        MeshDraw draw = mesh_draw(all, everything);
        draw.look = {.debug = view, .has_edges = has_edges, .has_normal_arrows = true};
        DARKROOM_TRY(meshes->prepare(draw, scene->meshes));
    }
    return shadows->make_pipelines(all);
}

TargetFormats Renderer::State::formats() const {
    TargetFormats out{.samples = static_cast<VkSampleCountFlagBits>(desc.samples),
                      .has_layers = desc.output == Output::Hdr,
                      .has_alpha_layer = scene->has_alpha_layer};
    if (desc.output == Output::Display) out.color = desc.display_format;
    return out;
}

Result<> Renderer::State::create_targets(VkExtent2D extent) {
    DARKROOM_TRY_VALUE(
        Targets made,
        Targets::create(*context, {.extent = extent, .formats = formats(), .has_transparency = desc.has_transparency}));
    if (accumulate) DARKROOM_TRY(accumulate->resize(made));
    targets = std::move(made);
    desc.extent = settings.extent = extent;
    picture = resolve ? drawn_color() : targets.copied_picture();
    frame = {};
    snapshot = nullptr;
    return {};
}

Result<> Renderer::State::create_passes() {
    const auto directional = directional_lights(scene->first);
    const auto casting = static_cast<std::uint32_t>(std::ranges::count_if(directional, is_caster));
    const std::uint32_t maps = desc.draw.has_shadows ? casting : 0;
    const VkDescriptorSetLayout layout = scene->frame_layout.handle;
    const std::uint32_t tiles = desc.draw.has_shadows ? tiles_needed(scene->first) : 0;
    Result<> made = take(
        ShadowPass::create(*context, layout, scene->meshes, desc.cascades, {.lights = maps, .tiles = tiles}), shadows);
    if (!made) return made;
    const PassSetup setup{.frame_layout = layout,
                          .formats = formats(),
                          .output = desc.output,
                          .is_tone_mapped = desc.is_tone_mapped,
                          .shadow_maps = maps,
                          .has_soft_shadows = desc.cascades.filter == ShadowFilter::Soft,
                          .has_lamp_shadows = tiles > 0,
                          .has_environment = scene->environment.is_given};
    meshes = MeshPass::create(*context, setup, scene->meshes);
    if (made = take(SkyPass::create(*context, setup), sky); !made) return made;
    return take(BillboardPass::create(*context, setup, scene->meshes), billboards);
}

MeshDraw Renderer::State::mesh_draw(const scene::Snapshot& drawn, const DrawList& drawn_list) const {
    return {.frame_set = slots[slot].set,
            .snapshot = &drawn,
            .list = &drawn_list,
            .look = {.debug = desc.draw.debug,
                     .has_edges = desc.draw.has_wireframe_overlay,
                     .has_normal_arrows = desc.draw.has_normal_arrows}};
}

Result<> Renderer::State::prepare(const scene::Snapshot& next, const FrameJitter& next_jitter) {
    snapshot = &next;
    jitter = next_jitter;
    settings.jitter = jitter.now;
    slot = (slot + 1) % desc.frames_in_flight;
    // From beside the camera more is seen, and what is near moves the farthest: then nothing lies outside.
    list = draw_list(next, desc.lens.f_stop > 0 ? scene::mat4(0) : jitter_matrix(jitter.now, desc.extent));
    Result<> done;
    if (desc.draw.has_shadows && desc.draw.debug == DebugView::None) {
        done = shadows->prepare(next);
    } else {
        shadows->clear();
    }
    if (done) done = meshes->prepare(mesh_draw(next, list), scene->meshes);
    if (done) done = billboards->prepare(next, scene->meshes, slot);
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
    DARKROOM_TRY(buffers.reserve(*context, counts));

    buffers.frame() = frame_block(*snapshot, settings);
    if (accumulate) {
        DARKROOM_TRY(buffers.reserve_positions(*context, positions.size()));
        const scene::CameraState& camera = snapshot->camera;
        const Aperture aperture =
            aperture_of(desc.lens, camera.projection, glm::distance(camera.position, camera.target));
        for (std::uint32_t i = 0; i < desc.positions; ++i)
            buffers.position(i) =
                seen_from(moved_block(buffers.frame(), positions[i]),
                          aperture.radius * place_in_aperture(i, desc.positions), aperture.focus_distance);
    }
    buffers.lights() = light_block(*snapshot, shadows->casting_lights(), shadows->lamps());
    shadows->fill(buffers.shadows());
    std::ranges::transform(snapshot->materials, buffers.materials(), material_block);
    blocks::Instance* instance = buffers.instances();
    const auto write = [&](const DrawList& drawn) {
        for (const std::uint32_t index : drawn.order) {
            const scene::Instance& source = snapshot->instances[index];
            *instance++ = instance_block(source, scene->meshes.mesh(source.mesh));
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
    buffers.write_set(*context, scene->meshes, *shadows, scene->environment);
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
    frame = {.color = drawn_color(),
             .depth = targets.drawn(targets.planar_depth, use),
             .normals = targets.drawn(targets.normals, use),
             .velocity = targets.drawn(targets.velocity, use),
             .ui = {},
             .transparency = targets.copied_transparency(),
             .camera = frame_camera(snapshot->camera, desc.extent, jitter),
             .lights = lights,
             .time = snapshot->time,
             .target = {}};
}

Result<> Renderer::State::record(VkCommandBuffer commands) {
    DARKROOM_ASSERT(snapshot != nullptr);
    gpu::begin_label(*context, commands, "scene");
    const auto first_caster = static_cast<std::uint32_t>(list.order.size());
    Result<> done = shadows->record(commands, slots[slot].set, *snapshot, scene->meshes, first_caster);
    if (done) done = accumulate ? record_positions(commands) : record_position(commands);
    gpu::end_label(*context, commands);
    return done;
}

Result<> Renderer::State::record_positions(VkCommandBuffer commands) {
    for (std::uint32_t i = 0; i < desc.positions; ++i) {
        slots[slot].use_position(*context, commands, desc.positions - 1 - i);
        DARKROOM_TRY(record_position(commands));
        accumulate->record(commands, targets.color, targets.drawn(targets.color, resolve->use()).layout, i);
    }
    accumulate->record_mean(commands, targets.color);
    return {};
}

Result<> Renderer::State::record_position(VkCommandBuffer commands) {
    // A display picture is cleared to what has no code of its own; the sky pass fills it.
    const scene::vec3 clear = desc.output == Output::Hdr ? settings.environment.background : scene::vec3(0);
    targets.begin(commands, {clear.r, clear.g, clear.b, scene->has_alpha_layer ? 0.0F : 1.0F}, resolve_use());
    Result<> done = record_scene(commands);
    if (resolve) {
        targets.end_for_resolve(commands, resolve->use());
        resolve->record(commands, targets, slot);
        ++counters.resolves;
    } else {
        targets.end_for_copy(commands);
    }
    return done;
}

Result<> Renderer::State::record_scene(VkCommandBuffer commands) {
    const VkDescriptorSet set = slots[slot].set;
    const MeshDraw draw = mesh_draw(*snapshot, list);
    DARKROOM_TRY(meshes->record_opaque(commands, draw, scene->meshes));
    if (shows_surroundings()) {
        billboards->record_sprites(commands, set, slot);
        sky->record_sky(commands, set);
    }
    // The grid is blended, too.
    if (desc.has_transparency) targets.copy_before_transparency(commands);
    if (shows_surroundings() && desc.draw.has_grid) sky->record_grid(commands, set);
    DARKROOM_TRY(meshes->record_transparent(commands, draw, scene->meshes));
    if (shows_surroundings()) billboards->record_particles(commands, set, slot);
    return meshes->record_overlays(commands, draw, scene->meshes);
}

Renderer::Renderer() : state_(std::make_unique<State>()) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create(Device& device, const scene::Scene& scene, const scene::Assets& assets,
                                  const RenderDesc& desc) {
    gpu::Context& context = device.context();
    DARKROOM_TRY(check(context, desc));
    DARKROOM_TRY_VALUE(std::shared_ptr<SceneOnDevice> uploaded, SceneOnDevice::create(context, scene, assets));
    return create(context, std::move(uploaded), desc);
}

Result<Renderer> Renderer::create(gpu::Context& context, std::shared_ptr<SceneOnDevice> scene, const RenderDesc& desc) {
    Renderer out;
    out.state_->context = &context;
    out.state_->scene = std::move(scene);
    out.state_->desc = desc;
    out.state_->desc.frames_in_flight = std::max(desc.frames_in_flight, 1U);
    DARKROOM_TRY(out.state_->create());
    return out;
}

Result<Renderer> Renderer::sharing(const RenderDesc& desc) const {
    DARKROOM_TRY(check(*state_->context, desc));
    return create(*state_->context, state_->scene, desc);
}

Result<> Renderer::resize(VkExtent2D extent) {
    DARKROOM_TRY(check(*state_->context, extent));
    return state_->create_targets(extent);
}

Result<> Renderer::set(const DrawOptions& options) {
    DARKROOM_TRY(check(*state_->context, options, state_->desc.output));
    state_->apply(options);
    return {};
}

Result<> Renderer::warm_up() { return state_->warm_up(); }
Result<> Renderer::prepare(const scene::Snapshot& snapshot, const FrameJitter& jitter) {
    return state_->prepare(snapshot, jitter);
}
Result<> Renderer::record(VkCommandBuffer commands) { return state_->record(commands); }
Frame Renderer::frame() const { return state_->frame; }
VkImageUsageFlags Renderer::layer_usage() const {
    const Targets& targets = state_->targets;
    return targets.planar_depth.info.usage & targets.normals.info.usage & targets.velocity.info.usage;
}
const ImageRef& Renderer::picture() const { return state_->picture; }
const RenderCounters& Renderer::counters() const { return state_->counters; }
const RenderDesc& Renderer::desc() const { return state_->desc; }

std::string sample_counts(const Device& device) { return counts_of(device.context().traits); }

}  // namespace darkroom::render
