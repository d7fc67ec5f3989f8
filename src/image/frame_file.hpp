// SPDX-License-Identifier: MIT
#pragma once
// A frame as a file: the picture a renderer made with, where the file has them, depth, normals, motion and camera. Any
// image file is a frame with a picture alone. What is read is finite and in one convention whatever wrote it; tone
// mapping, scaling and everything else that changes a picture is left to effects.

#include <array>
#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/channels.hpp"
#include "image/decoder.hpp"
#include "image/picture.hpp"

namespace darkroom {

/// 4x4, column-major, applied to column vectors (as in darkroom/frame.hpp). OpenEXR stores the same sixteen numbers in
/// the same order, read as rows and applied to row vectors.
using Matrix = std::array<float, 16>;

/// What the depth of a pixel without a surface is read as. In files, 1e9 and more, infinity and NaN mean the same.
inline constexpr float sky_depth = 1e10f;

/// Where the frame was seen from, as far as it is known.
struct FrameCamera {
    std::optional<Matrix> world_to_camera;  ///< the camera looks along -z, y up
    std::optional<Matrix> projection;       ///< camera to clip space
    /// Given with a field of view, the projection is made from it: y down, depth 0 at 0.1 and 1 at 1000.
    std::optional<double> vertical_field_of_view;  ///< degrees
    std::optional<Matrix> previous_world_to_camera, previous_projection;
    std::optional<float> near_distance, far_distance;  ///< far may be infinite
};

struct FrameOptions {
    LayerNames names;                              ///< go before the known names; see add_mapping
    std::optional<double> vertical_field_of_view;  ///< degrees; goes before the file's projection
    /// See read_camera; goes before what the frame's own file says. Of a camera that is not the file's, the previous
    /// place and the distances are not known either.
    std::filesystem::path camera_file;
};

/// Pixels that were not finite, and are now: NaN became 0, an infinity +-65504 (the largest half); alpha 1.
struct PixelCounts {
    std::size_t nan_color = 0;
    std::size_t infinite_color = 0;
    std::size_t nan_alpha = 0;
    std::size_t infinite_alpha = 0;
    std::size_t not_finite_other = 0;  ///< normals and motion (became 0), depth that is NaN (became sky)
    [[nodiscard]] bool operator==(const PixelCounts&) const = default;
};

struct FrameFile {
    /// Scene-linear Rec. 709. As large as the display window; pixels outside the data window are 0, alpha included.
    /// Alpha is carried as the file has it: colour is neither multiplied nor divided by it.
    Picture color;
    bool has_alpha = false;            ///< false: alpha is 1 wherever there are data
    std::optional<Plane<1>> depth;     ///< distance along the view axis; sky_depth where there is no surface
    std::optional<Plane<3>> normals;   ///< world space; 0 where there is no surface
    std::optional<Plane<2>> velocity;  ///< previous minus current position, pixels, y down
    FrameCamera camera;
    std::optional<double> time, delta_time;    ///< seconds
    std::optional<std::uint64_t> frame_index;  ///< at most 2^53
    FileKind kind = FileKind::OpenExr;
    SampleKind samples = SampleKind::Half;  ///< of the colour, in the file
    PixelCounts counts;
    std::vector<std::string> warnings;  ///< one line each, without the file name
    std::vector<std::string> channels;  ///< all that the file has, used or not
};

/// Reads any known image file. Integers are decoded as sRGB; floats are linear, and converted if the file names
/// primaries other than Rec. 709. The error text begins with the path.
[[nodiscard]] Result<FrameFile> read_frame(const std::filesystem::path& path, const FrameOptions& options = {});

/// Writes an OpenEXR file that read_frame gives back: R G B (A), Z, N.X N.Y N.Z, velocity.X velocity.Y, worldToCamera,
/// and as attributes of our own darkroom:projection, previousWorldToCamera, previousProjection, near, far, time,
/// deltaTime and frameIndex, bit for bit. Colour is half, or float if `frame.samples` is; depth and motion are float,
/// normals half.
[[nodiscard]] Result<> write_frame(const std::filesystem::path& path, const FrameFile& frame);

/// A camera in a TOML file: `world_to_camera` or `camera_to_world` (16 numbers, row by row as one writes a matrix for
/// column vectors), `projection` (16 numbers) or `fov` (vertical, degrees). All are optional; other keys are refused.
[[nodiscard]] Result<FrameCamera> read_camera(const std::filesystem::path& path);

/// Adds "depth=NAME", "normals=PREFIX", "velocity=PREFIX" or "color=PREFIX".
[[nodiscard]] Result<> add_mapping(LayerNames& names, std::string_view mapping);

/// The projection of FrameCamera's field of view; `aspect` is width over height.
[[nodiscard]] Matrix perspective(double vertical_field_of_view, double aspect);

}  // namespace darkroom
