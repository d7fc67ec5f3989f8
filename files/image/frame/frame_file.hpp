// SPDX-License-Identifier: MIT
#pragma once
// A frame as a file: the picture a renderer made with, where the file has them, depth, normals, motion, camera and the
// lights with their shadows. Any image file is a frame with a picture alone. What is read is finite and in one
// convention whatever wrote it; tone mapping, scaling and everything else that changes a picture is left to effects.

#include <array>
#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/color_coding.hpp"
#include "image/codec/decoder.hpp"
#include "image/frame/channels.hpp"
#include "image/picture/finite.hpp"
#include "image/picture/picture.hpp"
#include "image/table/color_chain.hpp"

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
    /// How far `projection` moves the picture, in pixels, y down; and the previous one. Unknown: 0.
    std::optional<std::array<float, 2>> jitter, previous_jitter;
    std::optional<float> near_distance, far_distance;  ///< far may be infinite
    /// Of the world that a camera file's matrix is told in. Of a frame that was read, y is up.
    bool is_z_up = false;
};

/// What stands in for a field of view that nobody told: vertical, degrees.
inline constexpr double assumed_field_of_view = 45;

/// What a file's normals are told in. Of the camera: x right, y up, z toward the viewer.
enum class NormalsSpace : std::uint8_t { World, View };
enum class UpAxis : std::uint8_t { Y, Z };

/// A square depth map that a light sees its shadows by, row-major, top row first.
struct FrameCascade {
    Matrix world_to_cascade{};  ///< to x, y in [-1, 1] (y down) and depth in [0, 1]
    float split = 0;            ///< how far it reaches along the view axis of the camera
    Plane<1> depth;             ///< 0 near the light .. 1: nothing there; empty: see FrameOptions::has_shadow_depths
    [[nodiscard]] bool operator==(const FrameCascade&) const = default;
};

/// A directional light, numbered as darkroom::Light. Without cascades it casts no shadow.
struct FrameLight {
    static constexpr std::size_t max_cascades = 4;
    std::array<float, 3> direction{0, 1, 0};
    std::array<float, 3> color{1, 1, 1};
    float volumetric_intensity = 0;
    std::array<float, 3> volumetric_color{1, 1, 1};
    std::vector<FrameCascade> cascades;  ///< of one size
    [[nodiscard]] bool operator==(const FrameLight&) const = default;
};

/// What a file holds at most: lights, those with cascades, texels of a cascade's side, and of all cascades together
/// (4 GiB here).
inline constexpr std::size_t max_frame_lights = 16, max_frame_shadows = 4;
inline constexpr std::uint32_t max_cascade_side = 16384;
inline constexpr std::uint64_t max_cascade_texels = std::uint64_t{1} << 30;

struct FrameOptions {
    LayerNames names;                              ///< go before the known names; see add_mapping
    std::string view;                              ///< of a stereo picture; empty: the first
    std::optional<double> vertical_field_of_view;  ///< degrees; goes before the file's projection
    std::optional<double> depth_scale;             ///< metres for each unit of the file; goes before the known names
    bool is_depth_inverse = false;                 ///< the file has 1 / distance, and 0 where nothing is
    std::optional<NormalsSpace> normals_space;     ///< else it is measured, as far as there is depth
    std::optional<UpAxis> up;                      ///< of the file's world; goes before what a camera file says
    /// See read_camera; goes before what the frame's own file says. Of a camera that is not the file's, the previous
    /// place and the distances are not known either.
    std::filesystem::path camera_file;
    /// False: these stay in the file, for those who do not need them.
    bool has_depth = true, has_normals = true, has_velocity = true, has_reactive = true, has_transparency = true;
    std::optional<InputSpace> input_space;          ///< goes before what the file says of its colour
    std::shared_ptr<const ColorChain> input_chain;  ///< goes before that: from the file's numbers to linear Rec. 709
    /// False: so do the depths of cascades, which are most of a file.
    bool has_shadow_depths = true;
    /// The picture is as large as the data window where that is larger than the display window, and the camera sees as
    /// much more; see FrameFile::display.
    bool keeps_overscan = false;
    /// Layers that are halves in the file, and are what they should be, come in FrameFile::halves.
    bool keeps_halves = false;
    std::size_t max_threads = 0;  ///< that decode, 0: as many as there are processors
};

/// Layers as halves, row-major, top row first. Those that are not empty stand for the numbers of the frame's layer of
/// that name, which has its size and no numbers then.
struct HalfLayers {
    std::vector<std::uint16_t> color;     ///< red, green, blue, alpha
    std::vector<std::uint16_t> normals;   ///< x, y, z, 1
    std::vector<std::uint16_t> velocity;  ///< x, y
};

struct FrameFile {
    /// Scene-linear Rec. 709. As large as the display window; pixels outside the data window are 0, alpha included.
    Picture color;
    /// Where overscan was kept: the display window, in pixels of this picture.
    std::optional<PixelWindow> display;
    bool has_alpha = false;            ///< false: alpha is 1 wherever there are data
    bool is_associated = false;        ///< the colour is multiplied by alpha, as the file has it; else it is straight
    std::optional<Plane<1>> depth;     ///< distance along the view axis; sky_depth where there is no surface
    std::optional<Plane<3>> normals;   ///< world space; 0 where there is no surface
    std::optional<Plane<2>> velocity;  ///< previous minus current position, pixels, y down
    std::optional<Plane<1>> reactive;  ///< 0 .. 1: how little earlier frames tell of a pixel
    std::optional<Plane<3>> transparency;  ///< the colour before anything transparent was drawn
    FrameCamera camera;
    HalfLayers halves;  ///< see FrameOptions::keeps_halves
    std::vector<FrameLight> lights;
    std::optional<double> time, delta_time;    ///< seconds
    std::optional<float> exposure;             ///< what light is multiplied by before it is shown; above 0
    std::optional<std::uint64_t> frame_index;  ///< at most 2^53
    std::string color_said;                    ///< by what the file says which colours it has; empty: it does not
    SampleKind samples = SampleKind::Half;     ///< of the colour, in the file
    PixelCounts counts;
    std::vector<std::string> warnings;                ///< one line each, without the file name
    std::vector<std::string> channels;                ///< all that the file has, used or not
    std::shared_ptr<const ExrAttributes> attributes;  ///< what else an OpenEXR file says; else null
};

/// Gives the layers of `halves` their numbers as floats, and leaves no halves.
void widen(FrameFile& frame);

/// Reads any known image file. Where neither the options nor the file say otherwise, integers are decoded as sRGB and
/// floats are linear Rec. 709; other primaries are converted. The error text begins with the path.
[[nodiscard]] Result<FrameFile> read_frame(const std::filesystem::path& path, const FrameOptions& options = {});

/// FrameFile::time of a file, whose pixels stay undecoded.
[[nodiscard]] Result<std::optional<double>> read_frame_time(const std::filesystem::path& path, const LayerNames& names);

/// Writes an OpenEXR file that read_frame gives back: R G B (A), Z, N.X N.Y N.Z, velocity.X velocity.Y, reactive,
/// transparency.R transparency.G transparency.B, worldToCamera, and as attributes of our own darkroom:projection,
/// previousWorldToCamera, previousProjection, jitter, previousJitter, near, far, time, deltaTime, frameIndex and
/// exposure, bit for bit. Colour is half, or float if `frame.samples` is; depth and motion are float, normals and the
/// reactive mask half, the rest as the colour. Lights are attributes as well, and their cascades parts of their own
/// beside the frame's: see docs/conventions.md. `max_threads`: that compress, 0: as many as there are processors.
[[nodiscard]] Result<> write_frame(const std::filesystem::path& path, const FrameFile& frame,
                                   std::size_t max_threads = 0);

/// A camera in a TOML file: `world_to_camera` or `camera_to_world` (16 numbers, row by row as one writes a matrix for
/// column vectors), `projection` (16 numbers) or `fov` (vertical, degrees), and `up`, the world's axis that points up:
/// "y" or "z". All are optional; other keys are refused.
[[nodiscard]] Result<FrameCamera> read_camera(const std::filesystem::path& path);

/// The same projection for a picture of this size, in which what it saw is the window.
[[nodiscard]] Matrix widened(const Matrix& projection, const PixelWindow& window, std::uint32_t width,
                             std::uint32_t height);

/// The projection of FrameCamera's field of view; `aspect` is width over height.
[[nodiscard]] Matrix perspective(double vertical_field_of_view, double aspect);

}  // namespace darkroom
