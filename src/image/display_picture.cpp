// SPDX-License-Identifier: MIT
#include "image/display_picture.hpp"

#include <cmath>

#include "image/frame_file.hpp"

namespace darkroom {

namespace {

// What read_frame decoded (IEC 61966-2-1), back to the very steps of the file.
float encoded(float linear, double steps) {
    const double v = linear;
    const double curve = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return static_cast<float>(std::round(curve * steps) / steps);
}

}  // namespace

Result<ComparablePicture> read_comparable(const std::filesystem::path& path) {
    Result<FrameFile> frame = read_frame(path, {.has_shadow_depths = false});
    if (!frame) return failure(std::move(frame));
    ComparablePicture out{.picture = std::move(frame->color)};
    if (frame->samples == SampleKind::Half || frame->samples == SampleKind::Float) {
        out.encoding = PictureEncoding::SceneLinear;
        return out;
    }
    const double steps = frame->samples == SampleKind::Integer8 ? 255.0 : 65535.0;
    for (std::size_t i = 0; i < out.picture.pixels.size(); ++i)
        if (i % 4 != 3) out.picture.pixels[i] = encoded(out.picture.pixels[i], steps);
    return out;
}

}  // namespace darkroom
