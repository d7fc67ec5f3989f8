// SPDX-License-Identifier: MIT
#include "c/frame_of.hpp"

namespace darkroom::c {

namespace {

constexpr std::uint32_t max_lights = 1024;

bool is_zero(std::span<const float> numbers) {
    return std::ranges::all_of(numbers, [](float number) { return number == 0; });
}
/// A matrix; the identity where the numbers are all 0.
Matrix matrix_of(const float* numbers) {
    Matrix out = identity_matrix;
    if (!is_zero({numbers, out.size()})) std::copy_n(numbers, out.size(), out.begin());
    return out;
}
std::array<float, 3> triple_or(const float (&numbers)[3], std::array<float, 3> otherwise) {
    return is_zero(numbers) ? otherwise : std::array{numbers[0], numbers[1], numbers[2]};
}
float number_or(float number, float otherwise) { return number == 0 ? otherwise : number; }

Result<> image_of(const DarkroomImage* given, ImageRef& out) {
    if (given == nullptr) return {};
    DARKROOM_TRY_VALUE(const auto image, read(given, "DarkroomImage"));
    out = {.image = image.image,
           .view = image.view,
           .format = image.format,
           .extent = image.extent,
           .region = image.region,
           .mip_level = image.mip_level,
           .array_layer = image.array_layer,
           .layer_count = std::max(image.layer_count, 1u),
           .layout = image.layout,
           .final_layout = image.final_layout};
    const auto use = [](VkPipelineStageFlags2 stages, VkAccessFlags2 access, VkBool32 has_barrier,
                        VkPipelineStageFlags2& to_stages, VkAccessFlags2& to_access) {
        if (stages == 0 && access == 0 && has_barrier == 0) return;  // the default
        to_stages = has_barrier != 0 ? VK_PIPELINE_STAGE_2_NONE : stages;
        to_access = has_barrier != 0 ? VK_ACCESS_2_NONE : access;
    };
    use(image.last_stages, image.last_access, image.has_barrier_before, out.last_stages, out.last_access);
    use(image.final_stages, image.final_access, image.has_barrier_after, out.final_stages, out.final_access);
    return {};
}

Result<> light_of(const DarkroomLight& given, Light& out) {
    out = {};
    out.direction = triple_or(given.direction, out.direction);
    const bool has_colors = given.has_colors != 0;
    out.color = triple_or(given.color, has_colors ? std::array<float, 3>{} : out.color);
    out.volumetric_color =
        triple_or(given.volumetric_color, has_colors ? std::array<float, 3>{} : out.volumetric_color);
    out.volumetric_intensity = given.volumetric_intensity;
    out.cascade_count = given.cascade_count;
    for (std::size_t i = 0; i < Light::max_cascades; ++i) {
        out.splits[i] = given.splits[i];
        out.world_to_cascade[i] = matrix_of(given.world_to_cascade + 16 * i);
    }
    return image_of(given.cascades, out.cascades);
}

Result<> use_of(const DarkroomImageUse* given, VkImageUsageFlags default_usage, ImageUse& out) {
    if (given == nullptr) return {};
    DARKROOM_TRY_VALUE(const auto use, read(given, "DarkroomImageUse"));
    if (use.format != VK_FORMAT_UNDEFINED) out.format = use.format;
    out.usage = use.usage != 0 ? use.usage : default_usage;
    return {};
}

Result<ColorState> color_state_of(const DarkroomColorState* given) {
    DARKROOM_TRY_VALUE(const auto state, read(given, "DarkroomColorState"));
    DARKROOM_TRY_VALUE(const auto domain, enumerator<Domain>(state.domain, DARKROOM_DOMAIN_ENCODED, "domain"));
    DARKROOM_TRY_VALUE(const auto primaries,
                       enumerator<Primaries>(state.primaries, DARKROOM_PRIMARIES_P3, "primaries"));
    DARKROOM_TRY_VALUE(const auto transfer, enumerator<Transfer>(state.transfer, DARKROOM_TRANSFER_SCRGB, "transfer"));
    return ColorState{.domain = domain,
                      .primaries = primaries,
                      .transfer = transfer,
                      .white_nits = number_or(state.white_nits, 203),
                      .peak_nits = state.peak_nits,
                      .is_associated = state.is_associated != 0};
}

Result<Watch> watch_of(const DarkroomWatch& given) {
    Watch out{
        .id = given.id, .entry = handle_of(given.entry), .image = string(given.image), .mip_level = given.mip_level};
    DARKROOM_TRY(use_of(given.target, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, out.target));
    return out;
}

}  // namespace

Result<Camera> camera_of(const DarkroomCamera* given) {
    Camera out;
    if (given == nullptr) return out;
    DARKROOM_TRY_VALUE(const auto camera, read(given, "DarkroomCamera"));
    DARKROOM_TRY_VALUE(const auto depth, enumerator<DepthKind>(camera.depth, DARKROOM_DEPTH_PLANAR, "camera.depth"));
    DARKROOM_TRY_VALUE(const auto sign,
                       enumerator<VelocityKind::Sign>(camera.velocity_sign, DARKROOM_VELOCITY_CURRENT_MINUS_PREVIOUS,
                                                      "camera.velocity_sign"));
    DARKROOM_TRY_VALUE(const auto unit, enumerator<VelocityKind::Unit>(camera.velocity_unit, DARKROOM_VELOCITY_NDC,
                                                                       "camera.velocity_unit"));
    out.view = matrix_of(camera.view);
    out.projection = matrix_of(camera.projection);
    out.previous_view = matrix_of(camera.previous_view);
    out.previous_projection = matrix_of(camera.previous_projection);
    out.near_distance = number_or(camera.near_distance, out.near_distance);
    out.far_distance = number_or(camera.far_distance, out.far_distance);
    out.depth = depth;
    out.is_y_down = camera.is_y_up == 0;
    out.velocity = {.sign = sign,
                    .unit = unit,
                    .is_y_down = camera.is_velocity_y_up == 0,
                    .has_jitter = camera.velocity_has_jitter != 0};
    std::copy_n(camera.jitter, 2, out.jitter.begin());
    std::copy_n(camera.previous_jitter, 2, out.previous_jitter.begin());
    out.is_cut = camera.is_cut != 0;
    out.jump_distance = number_or(camera.jump_distance, out.jump_distance);
    out.jump_angle = number_or(camera.jump_angle, out.jump_angle);
    return out;
}

Result<Frame> frame_of(const DarkroomFrame* given, DarkroomComposerObject& composer) {
    DARKROOM_TRY_VALUE(const auto frame, read(given, "DarkroomFrame"));
    Frame out;
    const std::pair<const DarkroomImage*, ImageRef*> images[] = {
        {frame.color, &out.color},       {frame.target, &out.target},
        {frame.depth, &out.depth},       {frame.normals, &out.normals},
        {frame.velocity, &out.velocity}, {frame.ui, &out.ui},
        {frame.reactive, &out.reactive}, {frame.transparency, &out.transparency},
        {frame.exposure, &out.exposure}};
    for (const auto& [from, to] : images) DARKROOM_TRY(image_of(from, *to));
    DARKROOM_TRY_VALUE(out.camera, camera_of(frame.camera));
    if (frame.light_count > max_lights)
        return user_error(fmt::format("light_count = {}: allowed is at most {}", frame.light_count, max_lights));
    composer.lights.resize(frame.light_count);
    for (std::uint32_t i = 0; i < frame.light_count; ++i) {
        DARKROOM_TRY_VALUE(const auto light, read_at(frame.lights, i, "DarkroomLight"));
        DARKROOM_TRY(light_of(light, composer.lights[i]));
    }
    if (frame.watched_count > max_watches)
        return user_error(fmt::format("watched_count = {}: allowed is at most {}", frame.watched_count, max_watches));
    composer.watched.resize(frame.watched_count);
    for (std::uint32_t i = 0; i < frame.watched_count; ++i) {
        DARKROOM_TRY_VALUE(const auto watched, read_at(frame.watched, i, "DarkroomWatched"));
        composer.watched[i] = {.id = watched.id, .region = watched.region};
        DARKROOM_TRY(image_of(watched.target, composer.watched[i].target));
    }
    out.lights = composer.lights;
    out.watched = composer.watched;
    out.time = frame.time;
    out.delta_time = frame.delta_time;
    out.frame_index = frame.frame_index;
    out.view = frame.view;
    return out;
}

Result<CompileDesc> compile_desc_of(const DarkroomCompileDesc* given) {
    DARKROOM_TRY_VALUE(const auto desc, read(given, "DarkroomCompileDesc"));
    CompileDesc out;
    out.max_extent = desc.max_extent;
    out.target_extent = desc.target_extent;
    const std::pair<const DarkroomImageUse*, ImageUse*> uses[] = {{desc.color, &out.color},
                                                                  {desc.depth, &out.depth},
                                                                  {desc.normals, &out.normals},
                                                                  {desc.velocity, &out.velocity},
                                                                  {desc.ui, &out.ui},
                                                                  {desc.reactive, &out.reactive},
                                                                  {desc.transparency, &out.transparency},
                                                                  {desc.exposure, &out.exposure}};
    for (const auto& [from, to] : uses) DARKROOM_TRY(use_of(from, VK_IMAGE_USAGE_SAMPLED_BIT, *to));
    DARKROOM_TRY(use_of(desc.target, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, out.target));
    if (desc.target_color != nullptr) {
        DARKROOM_TRY_VALUE(out.target_color, color_state_of(desc.target_color));
    }
    const auto choice = [](DarkroomChoice value, std::string_view name) {
        return enumerator<DarkroomChoice>(value, DARKROOM_CHOICE_YES, name);
    };
    DARKROOM_TRY_VALUE(const auto is_encoded, choice(desc.target_is_encoded, "target_is_encoded"));
    if (is_encoded != DARKROOM_CHOICE_AUTO)
        out.target_domain = is_encoded == DARKROOM_CHOICE_YES ? Domain::Encoded : Domain::SceneLinear;
    DARKROOM_TRY_VALUE(const auto encodes, choice(desc.encodes_target, "encodes_target"));
    if (encodes != DARKROOM_CHOICE_AUTO) out.encodes_target = encodes == DARKROOM_CHOICE_YES;
    DARKROOM_TRY_VALUE(out.kernels, enumerator<KernelStage>(desc.kernels, DARKROOM_KERNEL_STAGE_RASTER, "kernels"));
    out.is_color_associated = desc.is_color_associated != 0;
    out.is_depth_planar = desc.is_depth_planar != 0;
    out.is_velocity_plain = desc.is_velocity_plain != 0;
    out.has_shadows = desc.has_shadows != 0;
    out.fuse = desc.no_fusion == 0;
    out.views = std::max(desc.views, 1u);
    if (desc.intermediate != VK_FORMAT_UNDEFINED) out.intermediate = desc.intermediate;
    DARKROOM_TRY_VALUE(const auto watches, read_all(desc.watches, desc.watch_count, "DarkroomWatch"));
    for (const DarkroomWatch& watch : watches) {
        DARKROOM_TRY_VALUE(auto one, watch_of(watch));
        out.watches.push_back(std::move(one));
    }
    return out;
}

Result<EntryDesc> entry_desc_of(const DarkroomEntryDesc& given) {
    DARKROOM_TRY_VALUE(const auto blend, enumerator<BlendMode>(given.blend, DARKROOM_BLEND_SOFT_LIGHT, "blend"));
    return EntryDesc{.input = handle_of(given.input),
                     .source = handle_of(given.source),
                     .second = handle_of(given.second),
                     .mask = handle_of(given.mask),
                     .is_ui = given.is_ui != 0,
                     .name = string(given.name),
                     .output = string(given.output),
                     .enabled = given.is_disabled == 0,
                     .opacity = given.has_opacity != 0 ? given.opacity : number_or(given.opacity, 1),
                     .blend = blend,
                     .scale = {std::max(given.scale_numerator, 1u), std::max(given.scale_denominator, 1u)},
                     .format = given.format};
}

}  // namespace darkroom::c
