// SPDX-License-Identifier: MIT
#include "frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/text/param_text.hpp"
#include "report.hpp"

namespace app {

using darkroom::Camera;
using darkroom::DevelopedPicture;
using darkroom::DevelopInput;
using darkroom::DevelopTarget;
using darkroom::ReferenceImage;
using darkroom::ReferenceLight;
using darkroom::Result;

namespace {

ReferenceImage reference_image(std::span<const float> values, VkExtent2D extent, std::size_t channels) {
    ReferenceImage out(extent.width, extent.height);
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        std::array<double, 4> texel{0, 0, 0, 1};
        for (std::size_t c = 0; c < channels; ++c) texel[c] = values[i * channels + c];
        out.pixels[i] = {texel[0], texel[1], texel[2], texel[3]};
    }
    return out;
}

Camera camera_of(const darkroom::FrameCamera& stored) {
    Camera camera{.depth = darkroom::DepthKind::Planar};
    if (stored.world_to_camera) camera.view = *stored.world_to_camera;
    if (stored.projection) camera.projection = *stored.projection;
    camera.previous_view = stored.previous_world_to_camera.value_or(camera.view);
    camera.previous_projection = stored.previous_projection.value_or(camera.projection);
    camera.jitter = stored.jitter.value_or(camera.jitter);
    camera.previous_jitter = stored.previous_jitter.value_or(camera.previous_jitter);
    if (stored.near_distance) camera.near_distance = *stored.near_distance;
    if (stored.far_distance) camera.far_distance = *stored.far_distance;
    return camera;
}

darkroom::FrameCamera stored_camera(const Camera& camera) {
    const bool is_jittered = camera.jitter != Camera().jitter || camera.previous_jitter != Camera().previous_jitter;
    const auto stored_jitter = [&](const std::array<float, 2>& jitter) {
        return is_jittered ? std::optional(jitter) : std::nullopt;
    };
    return {.world_to_camera = camera.view,
            .projection = camera.projection,
            .previous_world_to_camera = camera.previous_view,
            .previous_projection = camera.previous_projection,
            .jitter = stored_jitter(camera.jitter),
            .previous_jitter = stored_jitter(camera.previous_jitter),
            .near_distance = camera.near_distance,
            .far_distance = camera.far_distance};
}

darkroom::FrameLight stored_light(ReferenceLight light) {
    darkroom::FrameLight out{.direction = light.light.direction,
                             .color = light.light.color,
                             .volumetric_intensity = light.light.volumetric_intensity,
                             .volumetric_color = light.light.volumetric_color};
    for (std::size_t i = 0; i < light.cascades.size(); ++i) {
        darkroom::FrameCascade& cascade = out.cascades.emplace_back(darkroom::FrameCascade{
            .world_to_cascade = light.light.world_to_cascade[i], .split = light.light.splits[i]});
        cascade.depth.width = cascade.depth.height = light.resolution;
        cascade.depth.values = std::move(light.cascades[i]);
    }
    return out;
}

template <std::uint32_t channels>
std::optional<darkroom::Plane<channels>> plane(VkExtent2D extent, std::vector<float> values) {
    if (values.empty()) return std::nullopt;
    darkroom::Plane<channels> out;
    out.width = extent.width;
    out.height = extent.height;
    out.values = std::move(values);
    return out;
}

}  // namespace

Camera as_stored(const Camera& camera) { return camera_of(stored_camera(camera)); }

Result<darkroom::FrameFile> read_frame(const darkroom::NumberedFile& file, darkroom::FrameOptions options) {
    options.camera_file = darkroom::numbered(options.camera_file, file.number);
    return darkroom::read_frame(file.path, options);
}

std::vector<ReferenceLight> take_lights(darkroom::FrameFile& frame) {
    std::vector<ReferenceLight> lights;
    for (darkroom::FrameLight& stored : frame.lights) {
        ReferenceLight& light =
            lights.emplace_back(ReferenceLight{.light = {.direction = stored.direction,
                                                         .color = stored.color,
                                                         .volumetric_intensity = stored.volumetric_intensity,
                                                         .volumetric_color = stored.volumetric_color}});
        for (std::size_t i = 0; i < stored.cascades.size(); ++i) {
            darkroom::FrameCascade& cascade = stored.cascades[i];
            if (cascade.depth.empty()) break;
            light.light.world_to_cascade[i] = cascade.world_to_cascade;
            light.light.splits[i] = cascade.split;
            light.light.cascade_count = static_cast<std::uint32_t>(i + 1);
            light.resolution = cascade.depth.width;
            light.cascades.push_back(std::move(cascade.depth.values));
        }
    }
    return lights;
}

void tell_of_assumed_view(const darkroom::FrameFile& frame, std::string_view shown) {
    if (frame.depth && !frame.camera.projection)
        warn(
            fmt::format("{}: has depth and no projection: a vertical field of view of {} degrees is assumed; --fov or "
                        "--camera sets another",
                        shown, darkroom::assumed_field_of_view));
}

DevelopInput develop_input(const darkroom::FrameFile& frame, std::span<const ReferenceLight> lights) {
    const auto [width, height] = std::pair(frame.color.width, frame.color.height);
    DevelopInput input{.extent = {width, height},
                       .color = frame.color.pixels,
                       .color_halves = frame.halves.color,
                       .normal_halves = frame.halves.normals,
                       .velocity_halves = frame.halves.velocity,
                       .lights = lights};
    if (frame.depth) input.depth = frame.depth->values;
    if (frame.normals) input.normals = frame.normals->values;
    if (frame.velocity) input.velocity = frame.velocity->values;
    if (frame.reactive) input.reactive = frame.reactive->values;
    if (frame.transparency) input.transparency = frame.transparency->values;
    if (frame.exposure) input.exposure = {&*frame.exposure, 1};
    darkroom::FrameCamera camera = frame.camera;
    if (!camera.projection)
        camera.projection = darkroom::perspective(darkroom::assumed_field_of_view, static_cast<double>(width) / height);
    input.camera = camera_of(camera);
    if (frame.time) input.time = *frame.time;
    if (frame.delta_time) input.delta_time = *frame.delta_time;
    if (frame.frame_index) input.frame_index = *frame.frame_index;
    return input;
}

darkroom::FrameFile frame_file(const darkroom::Frame& frame, darkroom::FrameLayers layers) {
    darkroom::FrameFile out;
    const auto [width, height] = layers.extent;
    out.color.width = width;
    out.color.height = height;
    out.color.pixels = std::move(layers.color);
    out.has_alpha = true;
    out.depth = plane<1>(layers.extent, std::move(layers.depth));
    out.normals = plane<3>(layers.extent, std::move(layers.normals));
    out.velocity = plane<2>(layers.extent, std::move(layers.velocity));
    out.transparency = plane<3>(layers.extent, std::move(layers.transparency));
    for (ReferenceLight& light : layers.lights) out.lights.push_back(stored_light(std::move(light)));
    out.camera = stored_camera(frame.camera);
    out.time = frame.time;
    out.delta_time = frame.delta_time;
    out.frame_index = frame.frame_index;
    const bool is_half = frame.color.format == VK_FORMAT_R16G16B16A16_SFLOAT;
    out.samples = is_half ? darkroom::SampleKind::Half : darkroom::SampleKind::Float;
    return out;
}

Result<std::uint32_t> add_needs(const darkroom::Look& look, double delta_time, Timeline timeline,
                                darkroom::FrameOptions& frame) {
    darkroom::Composer composer(darkroom::Device::assumed());
    DARKROOM_TRY(darkroom::apply(look, composer, {.keeps = timeline.entries()}));
    constexpr VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT;
    DARKROOM_TRY_VALUE(const darkroom::Plan plan,
                       composer.plan({.max_extent = {64, 64},
                                      .color = {VK_FORMAT_R16G16B16A16_SFLOAT, sampled},
                                      .depth = {VK_FORMAT_R32_SFLOAT, sampled},
                                      .is_depth_planar = true,
                                      .normals = {VK_FORMAT_R16G16B16A16_SFLOAT, sampled},
                                      .velocity = {VK_FORMAT_R32G32_SFLOAT, sampled},
                                      .is_velocity_plain = true,
                                      .ui = {VK_FORMAT_R8G8B8A8_UNORM, sampled},
                                      .reactive = {VK_FORMAT_R16_SFLOAT, sampled},
                                      .transparency = {VK_FORMAT_R16G16B16A16_SFLOAT, sampled},
                                      .exposure = {VK_FORMAT_R32_SFLOAT, sampled},
                                      .has_shadows = true}));
    const auto is_read = [&](std::string_view image) {
        return std::ranges::find(plan.frame_images, image) != plan.frame_images.end();
    };
    frame.has_depth = is_read("depth");
    frame.has_normals = is_read("normals");
    frame.has_velocity = is_read("velocity");
    frame.has_reactive = is_read("reactive");
    frame.has_transparency = is_read("transparency");
    frame.has_shadow_depths = is_read("shadows");
    std::uint32_t frames = composer.pre_roll(delta_time);
    for (const double time : timeline.times()) {
        DARKROOM_TRY(timeline.advance(composer, time));
        frames = std::max(frames, composer.pre_roll(delta_time));
    }
    return frames;
}

void suit(darkroom::Look& look, darkroom::DevelopTarget target, const darkroom::WriteOptions& options) {
    using darkroom::Domain;
    for (darkroom::LookEntry& entry : look.entries)
        if (options.view && entry.effect->makes != nullptr &&
            entry.effect->makes({}, entry.words.data()).domain == Domain::DisplayLinear)
            entry.state.enabled = false;
    // Into another space light is turned by the last kernel, behind all entries.
    const bool is_other_space = options.space && options.space->integers != darkroom::srgb_color;
    if (target == darkroom::DevelopTarget::Encoded8 && !is_other_space) return;
    for (darkroom::LookEntry& entry : look.entries)
        if (entry.effect->is_last_step && (entry.effect->makes == nullptr || is_other_space) && look.is_flat &&
            !entry.is_asked_for)
            entry.state.enabled = false;
}

darkroom::ColorState with_alpha(const std::optional<darkroom::ColorState>& color, darkroom::DevelopTarget target,
                                const darkroom::WriteOptions& options) {
    const bool is_light = target == darkroom::DevelopTarget::SceneLinear;
    darkroom::ColorState out = color.value_or(is_light ? darkroom::ColorState{} : darkroom::srgb_color);
    out.is_associated = is_light && !options.view;
    return out;
}

Result<> check_codes(const darkroom::Look& look, darkroom::DevelopTarget target,
                     const darkroom::WriteOptions& options) {
    if (target == darkroom::DevelopTarget::SceneLinear || options.space || options.view) return {};
    const std::vector<std::string> names = darkroom::entry_names(look);
    darkroom::ColorState codes = darkroom::srgb_color;
    std::string_view name;
    for (std::size_t i = 0; i < look.entries.size(); ++i) {
        const darkroom::LookEntry& entry = look.entries[i];
        if (entry.state.enabled.on == 0 || entry.effect->makes == nullptr) continue;
        const darkroom::ColorState made = entry.effect->makes({}, entry.words.data());
        if (made.domain != darkroom::Domain::Encoded) continue;
        codes = made;
        name = names[i];
    }
    if (codes.is_standard_code() && codes.primaries == darkroom::Primaries::Rec709) return {};
    return darkroom::user_error(
        fmt::format("{}: makes code values other than sRGB, and the file would be marked as sRGB: allowed is "
                    "--output-space {}, which encodes the picture and marks the file",
                    name, darkroom::output_space_names_of(true)));
}

// Linear targets skip the last steps by definition; that is no news.
std::size_t warn_of_what_is_left_out(const darkroom::Look& look, const darkroom::Composer& composer,
                                     std::span<const std::string> left_out, std::string_view frame) {
    std::size_t told = 0;
    const std::vector<std::string> names = darkroom::entry_names(look);
    for (const std::string& text : left_out) {
        const std::optional<darkroom::Handle> entry = composer.find(text.substr(0, text.find(':')));
        if (!entry) continue;
        const darkroom::EffectInfo& info = *composer.info(*entry);
        // What a table has on by itself, nobody asked for.
        const auto named = std::ranges::find(names, text.substr(0, text.find(':')));
        const bool is_asked_for = named != names.end() && look.entries[named - names.begin()].is_asked_for;
        const bool is_flat = (look.is_flat || look.was_flat) &&
                             darkroom::flat_entry(info, look.order).state.enabled.on != 0 && !is_asked_for;
        const bool is_usual = (is_flat || (look.ui && info.flat.is_of_ui())) &&
                              std::ranges::equal(composer.words(*entry), darkroom::flat_entry(info, look.order).words);
        if (!composer.desc(*entry)->enabled || info.is_last_step) continue;
        if (is_usual) {
            remark(fmt::format("{}left out: {}", frame, text));
            continue;
        }
        warn(fmt::format("{}left out: {}", frame, text));
        ++told;
    }
    return told;
}

long long step_of(std::span<const darkroom::NumberedFile> inputs) {
    long long least = 0;
    for (std::size_t i = 1; i < inputs.size(); ++i)
        if (const long long step = inputs[i].number - inputs[i - 1].number; step > 0)
            least = least == 0 ? step : std::min(least, step);
    return std::max(1LL, least);
}

std::vector<std::array<long long, 2>> ranges_of(const FrameNumbers& numbers) {
    std::vector<std::array<long long, 2>> out;
    for (const long long number : numbers)
        if (!out.empty() && out.back()[1] + 1 == number)
            out.back()[1] = number;
        else
            out.push_back({number, number});
    return out;
}

std::string shown(const FrameNumbers& numbers) {
    std::string out;
    for (const auto& [first, last] : ranges_of(numbers))
        out += fmt::format("{}{}", out.empty() ? "" : ", ",
                           first == last ? fmt::format("{}", first) : fmt::format("{}-{}", first, last));
    return out.empty() ? "none" : out;
}

void warn_of_missing_inputs(std::string_view typed, const darkroom::FrameSet& frames,
                            std::span<const darkroom::NumberedFile> inputs) {
    const long long step = step_of(inputs);
    FrameNumbers missing;
    for (const long long number : frames.numbers())
        if ((number - inputs.front().number) % step == 0) missing.insert(number);
    for (const darkroom::NumberedFile& input : inputs) missing.erase(input.number);
    if (!missing.empty())
        warn(fmt::format("--frames {}: no input has these numbers: {}", darkroom::printable(typed), shown(missing)));
}

void warn_of_what_is_misplaced(const darkroom::Plan& plan) {
    for (const std::string& text : plan.misplaced) warn(text);
}

Result<DevelopedPicture> develop_by_reference(const darkroom::Composer& composer, const DevelopInput& input,
                                              const darkroom::DevelopDesc& desc,
                                              darkroom::ReferenceHistories& histories,
                                              std::vector<std::string>& left_out) {
    const ReferenceImage color = reference_image(input.color, input.extent, 4);
    const auto layer = [&](std::span<const float> values, std::size_t channels) {
        return values.empty() ? ReferenceImage() : reference_image(values, input.extent, channels);
    };
    const ReferenceImage depth = layer(input.depth, 1), normals = layer(input.normals, 3),
                         velocity = layer(input.velocity, 2), reactive = layer(input.reactive, 1),
                         transparency = layer(input.transparency, 3);
    const ReferenceImage exposure =
        input.exposure.empty() ? ReferenceImage() : reference_image(input.exposure, {1, 1}, 1);
    const VkExtent2D output = desc.target_extent.width != 0 ? desc.target_extent : input.extent;
    ReferenceImage ui(input.ui.empty() ? 0 : output.width, input.ui.empty() ? 0 : output.height);
    const auto byte = [&](std::size_t i) { return input.ui[i] / 255.0; };
    for (std::size_t i = 0; i < ui.pixels.size(); ++i)
        ui.pixels[i] = {byte(4 * i), byte(4 * i + 1), byte(4 * i + 2), byte(4 * i + 3)};
    const auto given = [](const ReferenceImage& image) { return image.pixels.empty() ? nullptr : &image; };
    using darkroom::FrameImage;
    const darkroom::ReferenceImages images{{FrameImage::Depth, given(depth)},
                                           {FrameImage::Normals, given(normals)},
                                           {FrameImage::Velocity, given(velocity)},
                                           {FrameImage::Reactive, given(reactive)},
                                           {FrameImage::Transparency, given(transparency)},
                                           {FrameImage::Exposure, given(exposure)},
                                           {FrameImage::Ui, given(ui)}};
    const darkroom::Domain domain =
        desc.target == DevelopTarget::SceneLinear ? darkroom::Domain::SceneLinear : darkroom::Domain::Encoded;
    DARKROOM_TRY_VALUE(darkroom::ReferenceChainOutput made,
                       darkroom::run_reference(composer, {.color = &color,
                                                          .images = images,
                                                          .target_extent = desc.target_extent,
                                                          .lights = input.lights,
                                                          .camera = input.camera,
                                                          .time = input.time,
                                                          .delta_time = input.delta_time,
                                                          .frame_index = input.frame_index,
                                                          .histories = &histories,
                                                          .is_color_associated = input.is_color_associated,
                                                          .target_color = desc.color,
                                                          .target_domain = domain}));
    left_out = std::move(made.left_out);
    DevelopedPicture out{.extent = {made.picture.width, made.picture.height}};
    if (desc.target == DevelopTarget::Encoded8) {
        out.bytes = darkroom::round_to_bytes(made.picture);
        return out;
    }
    out.pixels.reserve(made.picture.pixels.size() * 4);
    for (const darkroom::Rgba& pixel : made.picture.pixels)
        for (const double channel : {pixel.r, pixel.g, pixel.b, pixel.a})
            out.pixels.push_back(static_cast<float>(channel));
    return out;
}

void tell_of_half_range(const darkroom::WriteOptions& options) {
    if (options.samples == darkroom::SampleKind::Float && options.compression.starts_with("dwa"))
        warn(fmt::format("--bits float: {} keeps red, green and blue as halves", options.compression));
}

Result<> write(const std::filesystem::path& path, DevelopedPicture picture, const darkroom::WriteOptions& options) {
    const auto [width, height] = picture.extent;
    if (!picture.bytes.empty()) return darkroom::write_bytes(path, width, height, picture.bytes, options);
    darkroom::Picture out;
    out.width = width;
    out.height = height;
    out.pixels = std::move(picture.pixels);
    if (const std::uint64_t count = darkroom::clamped_by_compression(path, out, options); count > 0)
        warn(fmt::format("{}: {} pixels are brighter than {} can hold, and are clamped",
                         darkroom::printable(path.string()), count, options.compression));
    return darkroom::write_picture(path, out, options);
}

}  // namespace app
