// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <darkroom/composer.hpp>
#include <darkroom/device.hpp>
#include <darkroom/look.hpp>
#include <darkroom/temporal_check.hpp>
#include <numbers>
#include <optional>
#include <system_error>

#include "image/frame/frame_file.hpp"
#include "image/frame/layer_file.hpp"
#include "image/table/table_file.hpp"
#include "info_documents.hpp"
#include "programs/darkroom/run/frames.hpp"

namespace app::info {

using darkroom::FrameFile;
using darkroom::LayerFile;
using darkroom::Result;

namespace {

Json parts_of(std::span<const darkroom::FilePart> parts) {
    Json out = Json::array();
    for (const darkroom::FilePart& part : parts) {
        Json row = Json::object();
        if (!part.name.empty()) row["name"] = part.name;
        if (!part.view.empty()) row["view"] = part.view;
        if (!part.compression.empty()) row["compression"] = part.compression;
        row.update({{"data_size", {part.width, part.height}},
                    {"data_offset", {part.x, part.y}},
                    {"display_size", {part.display_width, part.display_height}},
                    {"channels", part.channels.size()}});
        out.push_back(std::move(row));
    }
    return out;
}

std::string samples_of(const darkroom::FilePart& part, const darkroom::FileLayer& layer) {
    std::string out;
    for (const std::uint32_t channel : layer.channels) {
        const std::string_view kind = darkroom::name_of(part.kinds[channel]);
        if (out.find(kind) == std::string::npos) out += fmt::format("{}{}", out.empty() ? "" : " and ", kind);
    }
    return out;
}

/// Of those that are listed. A file of a few bytes a layer would ask for thousands each.
constexpr std::size_t max_layers = 1024;

Result<Json> layers_of(LayerFile& file) {
    const auto parts = file.decoder().parts();
    std::vector<std::vector<darkroom::SampleRange>> ranges;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        DARKROOM_TRY_VALUE(std::vector<darkroom::SampleRange> found, file.ranges(part));
        ranges.push_back(std::move(found));
    }
    Json out = Json::array();
    for (const darkroom::FileLayer& layer :
         file.layers().first(std::min<std::size_t>(file.layers().size(), max_layers))) {
        darkroom::SampleRange range;
        for (const std::uint32_t channel : layer.channels) range.add(ranges[layer.part][channel]);
        // Numbers of objects have all their digits.
        const auto end = [&](double value) {
            const bool is_whole = std::ranges::any_of(layer.channels, [&](std::uint32_t channel) {
                return parts[layer.part].kinds[channel] == darkroom::SampleKind::Integer32;
            });
            return is_whole && value >= 0 && value == std::floor(value) ? Json(static_cast<std::uint64_t>(value))
                                                                        : Json(value);
        };
        out.push_back({{"layer", layer.name},
                       {"part", layer.part},
                       {"channels", file.channel_names(layer)},
                       {"samples", samples_of(parts[layer.part], layer)},
                       {"min", range.has_finite() ? end(range.least) : Json()},
                       {"max", range.has_finite() ? end(range.most) : Json()},
                       {"nan", range.nan},
                       {"infinite", range.infinite}});
    }
    return out;
}

/// What the file says of itself, whatever it is for.
Result<Json> file_of(const std::filesystem::path& path) {
    DARKROOM_TRY_VALUE(LayerFile file, LayerFile::open(path));
    const auto parts = file.decoder().parts();
    std::error_code ignored;
    Json out{{"kind", "picture"},
             {"format", file.decoder().format().name},
             {"bytes", std::filesystem::file_size(path, ignored)},
             {"size", {parts.front().display_width, parts.front().display_height}},
             {"parts", parts_of(parts)}};
    DARKROOM_TRY_VALUE(Json layers, layers_of(file));
    out["layers"] = std::move(layers);
    if (file.layers().size() > max_layers) out["more_layers"] = file.layers().size() - max_layers;
    return out;
}

Json camera_of(const darkroom::FrameCamera& camera) {
    Json out = Json::object();
    if (camera.world_to_camera) {
        // The inverse of a rotation and a translation; the rows of the rotation are the camera's axes.
        const darkroom::Matrix& m = *camera.world_to_camera;
        Json position = Json::array(), direction = Json::array();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            position.push_back(-(m[4 * axis] * m[12] + m[4 * axis + 1] * m[13] + m[4 * axis + 2] * m[14]));
            direction.push_back(-m[4 * axis + 2]);
        }
        out.update({{"position", position}, {"direction", direction}});
    }
    if (camera.projection) {
        const darkroom::Matrix& m = *camera.projection;
        const bool is_perspective = m[11] != 0;
        out["projection"] = is_perspective ? "perspective" : "orthographic";
        if (is_perspective && m[5] != 0)
            out["vertical_field_of_view_degrees"] =
                2 * std::atan(1 / std::abs(static_cast<double>(m[5]))) * 180 / std::numbers::pi;
    }
    if (camera.near_distance) out["near"] = json_number(*camera.near_distance);
    if (camera.far_distance) out["far"] = json_number(*camera.far_distance);
    if (camera.jitter) out["jitter"] = *camera.jitter;
    if (!out.empty()) out["has_previous_frame"] = camera.previous_world_to_camera.has_value();
    return out;
}

Json lights_of(std::span<const darkroom::FrameLight> lights) {
    Json out = Json::array();
    for (const darkroom::FrameLight& light : lights) {
        Json row{{"toward", light.direction},
                 {"color", light.color},
                 {"volumetric_intensity", light.volumetric_intensity},
                 {"cascades", light.cascades.size()}};
        if (!light.cascades.empty()) row["reach"] = json_number(light.cascades.back().split);
        out.push_back(std::move(row));
    }
    return out;
}

darkroom::CompileDesc compile_desc(const FrameFile& frame) {
    darkroom::CompileDesc desc{.max_extent = {frame.color.width, frame.color.height}};
    if (frame.depth) desc.depth.format = VK_FORMAT_R32_SFLOAT;
    desc.is_depth_planar = true;
    if (frame.normals) desc.normals.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    if (frame.velocity) desc.velocity.format = VK_FORMAT_R16G16_SFLOAT;
    desc.has_shadows =
        std::ranges::any_of(frame.lights, [](const darkroom::FrameLight& light) { return !light.cascades.empty(); });
    return desc;
}

Result<Json> default_look_of(const FrameFile& frame) {
    darkroom::Device device = darkroom::Device::assumed();
    darkroom::Composer composer(device);
    DARKROOM_TRY(darkroom::apply(darkroom::default_look(), composer));
    DARKROOM_TRY_VALUE(const darkroom::Plan plan, composer.plan(compile_desc(frame)));
    Json left_out = Json::array(), left_out_if_on = Json::array();
    for (const std::string& text : plan.left_out) {
        const std::optional<darkroom::Handle> entry = composer.find(text.substr(0, text.find(':')));
        const bool is_on = entry && composer.desc(*entry)->enabled && !composer.info(*entry)->is_in_traced_light;
        (is_on ? left_out : left_out_if_on).push_back(text);
    }
    return Json{{"left_out", std::move(left_out)}, {"would_be_left_out_if_on", std::move(left_out_if_on)}};
}

/// What effects that gather frames would stumble over, of a frame that was drawn for them.
void add_mistakes(const FrameFile& frame, Json& out) {
    if (!frame.camera.jitter || !frame.velocity || !frame.camera.world_to_camera || !frame.camera.projection ||
        !frame.camera.previous_world_to_camera || !frame.camera.previous_projection)
        return;
    const darkroom::DevelopInput input = develop_input(frame, {});
    for (const std::string& mistake : darkroom::check_temporal(
             {.camera = input.camera, .extent = input.extent, .depth = input.depth, .velocity = input.velocity}))
        out["warnings"].push_back(mistake);
}

Result<> add_frame(const std::filesystem::path& path, Json& out) {
    Result<FrameFile> frame = darkroom::read_frame(path, {.has_shadow_depths = false});
    if (!frame) {
        if (frame.error().fault == darkroom::Fault::Machine) return failure(std::move(frame));
        const std::string prefix = path.string() + ": ";
        std::string why = frame.error().text;
        if (why.starts_with(prefix)) why.erase(0, prefix.size());
        out["warnings"] = {fmt::format("cannot be developed: {}", why)};
        return {};
    }
    if (frame->depth || frame->normals || frame->velocity || !frame->lights.empty()) out["kind"] = "frame";
    if (Json camera = camera_of(frame->camera); !camera.empty()) out["camera"] = std::move(camera);
    if (frame->time) out["time"] = json_number(*frame->time);
    if (frame->delta_time) out["delta_time"] = json_number(*frame->delta_time);
    if (frame->frame_index) out["frame_index"] = *frame->frame_index;
    out["color"] = !frame->color_said.empty()             ? "by " + frame->color_said
                   : darkroom::is_integer(frame->samples) ? "sRGB, the file says nothing that is known"
                                                          : "linear Rec. 709, the file says nothing that is known";
    if (!frame->lights.empty()) out["lights"] = lights_of(frame->lights);
    if (!frame->warnings.empty()) out["warnings"] = frame->warnings;
    add_mistakes(*frame, out);
    // A picture may be larger than what GPUs develop.
    if (const Result<Json> look = default_look_of(*frame))
        out["default_look"] = *look;
    else
        out["warnings"].push_back(fmt::format("cannot be developed: {}", look.error().text));
    return {};
}

}  // namespace

Result<Json> picture(const std::filesystem::path& path) {
    DARKROOM_TRY_VALUE(Json out, file_of(path));
    DARKROOM_TRY(add_frame(path, out));
    return out;
}

namespace {

/// One number where the channels agree.
Json channels_of(const std::array<float, 3>& values) {
    if (values[0] == values[1] && values[0] == values[2]) return values[0];
    return values;
}

Json part_of(std::uint32_t size, const std::array<float, 3>& min, const std::array<float, 3>& max,
             const std::vector<float>& entries) {
    const auto [least, greatest] = std::ranges::minmax(entries);
    return {{"entries", size},
            {"inputs_from", channels_of(min)},
            {"inputs_to", channels_of(max)},
            {"least", least},
            {"greatest", greatest}};
}

}  // namespace

Result<Json> table(const std::filesystem::path& path) {
    const bool is_named = darkroom::is_table_name(path);
    Result<darkroom::FoundTable> found = [&]() -> Result<darkroom::FoundTable> {
        if (is_named) return darkroom::read_table_file(path);
        DARKROOM_TRY_VALUE(auto file, darkroom::read_cube(path));
        return darkroom::FoundTable{.file = std::move(file), .format = ".cube"};
    }();
    if (!found) return failure(std::move(found));
    const darkroom::ColorTable& table = found->file.table;
    Json out{{"kind", "table"}, {"format", found->format}};
    if (!found->file.title.empty()) out["title"] = found->file.title;
    if (table.shaper_size > 0)
        out[table.size > 0 ? "shaper" : "table_1d"] =
            part_of(table.shaper_size, table.shaper_min, table.shaper_max, table.shaper);
    if (table.size > 0) out["table_3d"] = part_of(table.size, table.min, table.max, table.cube);
    if (found->error) out["largest_error"] = *found->error;
    if (!found->warnings.empty()) out["warnings"] = found->warnings;
    if (!found->file.comments.empty()) out["comments"] = found->file.comments;
    return out;
}

}  // namespace app::info
