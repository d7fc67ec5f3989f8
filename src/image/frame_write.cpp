// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/assert.hpp"
#include "image/encoder.hpp"
#include "image/frame_file.hpp"
#include "image/frame_lights.hpp"
#include "image/write.hpp"

namespace darkroom {
namespace {

// One plane among the interleaved samples of the file.
struct Source {
    const float* values;
    std::size_t stride;
    std::size_t count;
    float largest;
};

}  // namespace

Result<> write_frame(const std::filesystem::path& path, const FrameFile& frame) {
    const auto kind = file_kind(path);
    if (!kind) return failure(kind.error());
    if (*kind != FileKind::OpenExr)
        return user_error(
            fmt::format("{}: {} holds no depth and no camera; a frame needs .exr", path.string(), name_of(*kind)));
    const std::size_t pixel_count = std::size_t{frame.color.width} * frame.color.height;
    if (pixel_count == 0) return user_error(fmt::format("{}: the frame is empty", path.string()));
    DARKROOM_ASSERT(frame.color.pixels.size() == pixel_count * 4);
    if (const auto checked = check_lights(frame.lights); !checked)
        return user_error(fmt::format("{}: {}", path.string(), checked.error().text));

    constexpr float largest_float = std::numeric_limits<float>::max();
    constexpr float largest_half = 65504.0f;
    const bool is_float = frame.samples == SampleKind::Float;
    const OIIO::TypeDesc color_type = is_float ? OIIO::TypeFloat : OIIO::TypeHalf;
    OIIO::ImageSpec spec(static_cast<int>(frame.color.width), static_cast<int>(frame.color.height), 0, OIIO::TypeFloat);
    // OpenImageIO would write the time of day, and no file would be the same twice.
    spec.attribute("DateTime", "1970:01:01 00:00:00");
    spec.channelnames.clear();
    std::vector<Source> sources;
    const auto add = [&](std::initializer_list<const char*> names, OIIO::TypeDesc type,
                         const std::vector<float>& values, std::size_t stride) {
        DARKROOM_ASSERT(values.size() == pixel_count * stride);
        for (const char* name : names) {
            spec.channelnames.emplace_back(name);
            spec.channelformats.push_back(type);
        }
        sources.push_back({values.data(), stride, names.size(), type == OIIO::TypeHalf ? largest_half : largest_float});
    };
    if (frame.has_alpha)
        add({"R", "G", "B", "A"}, color_type, frame.color.pixels, 4);
    else
        add({"R", "G", "B"}, color_type, frame.color.pixels, 4);
    if (frame.depth) add({"Z"}, OIIO::TypeFloat, frame.depth->values, 1);
    if (frame.normals) add({"N.X", "N.Y", "N.Z"}, OIIO::TypeHalf, frame.normals->values, 3);
    if (frame.velocity) add({"velocity.X", "velocity.Y"}, OIIO::TypeFloat, frame.velocity->values, 2);
    spec.nchannels = static_cast<int>(spec.channelnames.size());
    spec.alpha_channel = frame.has_alpha ? 3 : -1;

    const auto samples = [&sources, pixel_count, channel_count = spec.channelnames.size()] {
        std::vector<float> values;
        values.reserve(pixel_count * channel_count);
        for (std::size_t pixel = 0; pixel < pixel_count; ++pixel)
            for (const Source& source : sources)
                for (std::size_t c = 0; c < source.count; ++c) {
                    const float value = source.values[pixel * source.stride + c];
                    values.push_back(std::isnan(value) ? 0.0f : std::clamp(value, -source.largest, source.largest));
                }
        return values;
    };

    spec.attribute("compression", "zip");
    constexpr std::array rec709{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), rec709.data());
    // OpenImageIO's name for the standard attribute worldToCamera.
    const auto add_matrix = [&](const char* name, const std::optional<Matrix>& matrix) {
        if (matrix) spec.attribute(name, OIIO::TypeMatrix44, matrix->data());
    };
    const auto add_number = [&](const char* name, const auto& number) {
        if (!number) return;
        const double value = static_cast<double>(*number);
        spec.attribute(name, OIIO::TypeDesc(OIIO::TypeDesc::DOUBLE), &value);
    };
    add_matrix("worldtocamera", frame.camera.world_to_camera);
    add_matrix("darkroom:projection", frame.camera.projection);
    add_matrix("darkroom:previousWorldToCamera", frame.camera.previous_world_to_camera);
    add_matrix("darkroom:previousProjection", frame.camera.previous_projection);
    add_number("darkroom:near", frame.camera.near_distance);
    add_number("darkroom:far", frame.camera.far_distance);
    add_number("darkroom:time", frame.time);
    add_number("darkroom:deltaTime", frame.delta_time);
    add_number("darkroom:frameIndex", frame.frame_index);
    add_lights(spec, frame.lights);
    std::vector<EncodedPart> parts = shadow_parts(spec, frame.lights);
    if (parts.empty()) return encode_to_file(path, FileKind::OpenExr, spec, OIIO::TypeFloat, samples().data());
    spec.attribute("oiio:subimagename", "frame");
    parts.insert(parts.begin(), EncodedPart{spec, samples});
    return encode_parts_to_file(path, parts);
}

}  // namespace darkroom
