// SPDX-License-Identifier: MIT
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/assert.hpp"
#include "image/exr/write.hpp"
#include "image/frame/frame_file.hpp"
#include "image/frame/frame_lights.hpp"
#include "image/picture/write.hpp"

namespace darkroom {
namespace {

void add_matrix(Imf::Header& header, const char* name, const std::optional<Matrix>& matrix) {
    if (!matrix) return;
    Imath::M44f value;
    std::copy(matrix->begin(), matrix->end(), value.getValue());
    header.insert(name, Imf::M44fAttribute(value));
}

void add_vector(Imf::Header& header, const char* name, const std::optional<std::array<float, 2>>& vector) {
    if (vector) header.insert(name, Imf::V2fAttribute({(*vector)[0], (*vector)[1]}));
}

template <class Number>
void add_number(Imf::Header& header, const char* name, const std::optional<Number>& number) {
    if (number) header.insert(name, Imf::DoubleAttribute(static_cast<double>(*number)));
}

}  // namespace

Result<> write_frame(const std::filesystem::path& path, const FrameFile& frame, std::size_t max_threads) {
    DARKROOM_TRY_VALUE(const FileFormat* const format, written_format(path));
    if (format != &exr_format())
        return user_error(
            fmt::format("{}: {} holds no depth and no camera; a frame needs .exr", path.string(), format->name));
    const std::size_t pixel_count = std::size_t{frame.color.width} * frame.color.height;
    if (pixel_count == 0) return user_error(fmt::format("{}: the frame is empty", path.string()));
    if (const auto checked = check_lights(frame.lights); !checked)
        return user_error(fmt::format("{}: {}", path.string(), checked.error().text));

    std::vector<ExrPart> parts(1);
    ExrPart& part = parts.front();
    part.header = exr_header(frame.color.width, frame.color.height);
    const auto add = [&](std::initializer_list<const char*> names, SampleKind samples, const std::vector<float>& values,
                         std::size_t stride) {
        DARKROOM_ASSERT(values.size() == pixel_count * stride);
        for (const float* first = values.data(); const char* name : names)
            part.channels.push_back({.name = name, .kind = samples, .values = first++, .stride = stride});
    };
    const SampleKind color = frame.samples == SampleKind::Float ? SampleKind::Float : SampleKind::Half;
    if (frame.has_alpha)
        add({"R", "G", "B", "A"}, color, frame.color.pixels, 4);
    else
        add({"R", "G", "B"}, color, frame.color.pixels, 4);
    if (frame.depth) add({"Z"}, SampleKind::Float, frame.depth->values, 1);
    if (frame.normals) add({"N.X", "N.Y", "N.Z"}, SampleKind::Half, frame.normals->values, 3);
    if (frame.velocity) add({"velocity.X", "velocity.Y"}, SampleKind::Float, frame.velocity->values, 2);

    if (frame.reactive) add({"reactive"}, SampleKind::Half, frame.reactive->values, 1);
    if (frame.transparency)
        add({"transparency.R", "transparency.G", "transparency.B"}, color, frame.transparency->values, 3);

    Imf::Header& header = part.header;
    add_primaries(header, {});
    add_matrix(header, "worldToCamera", frame.camera.world_to_camera);
    add_matrix(header, "darkroom:projection", frame.camera.projection);
    add_matrix(header, "darkroom:previousWorldToCamera", frame.camera.previous_world_to_camera);
    add_matrix(header, "darkroom:previousProjection", frame.camera.previous_projection);
    add_vector(header, "darkroom:jitter", frame.camera.jitter);
    add_vector(header, "darkroom:previousJitter", frame.camera.previous_jitter);
    add_number(header, "darkroom:near", frame.camera.near_distance);
    add_number(header, "darkroom:far", frame.camera.far_distance);
    add_number(header, "darkroom:time", frame.time);
    add_number(header, "darkroom:deltaTime", frame.delta_time);
    add_number(header, "darkroom:frameIndex", frame.frame_index);
    add_number(header, "darkroom:exposure", frame.exposure);
    add_lights(header, frame.lights);
    for (ExrPart& shadow : shadow_parts(header, frame.lights)) parts.push_back(std::move(shadow));
    if (parts.size() > 1) parts.front().header.setName("frame");
    return write_exr(path, parts, max_threads, false);
}

}  // namespace darkroom
