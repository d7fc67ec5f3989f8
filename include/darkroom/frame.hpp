// SPDX-License-Identifier: MIT
#pragma once
// What a host hands over every frame: images it owns, the camera, lights, time. Everything is a reference: the library
// keeps none of it after `record`, and leaves each image in the layout that its reference asks for.

#include <vulkan/vulkan.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <darkroom/color_state.hpp>
#include <span>

namespace darkroom {

/// 4x4, column-major, applied to column vectors: clip = projection * view * world.
using Matrix = std::array<float, 16>;
inline constexpr Matrix identity_matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// An image of the host's, as it is when the recorded commands start. Single-sampled: a multi-sampled picture is to be
/// resolved first.
struct ImageRef {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;  ///< one mip level, one layer, colour or depth aspect
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};            ///< of the whole mip level that the view shows
    VkRect2D region{};              ///< the part that holds the picture; extent (0,0): all of it
    std::uint32_t mip_level = 0;    ///< that the view shows
    std::uint32_t array_layer = 0;  ///< first layer that the view shows
    std::uint32_t layer_count = 1;  ///< that the view shows: of pictures 1, of cascades at least their count
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< that it is in; UNDEFINED only for a target, whose texels go
    /// Of the host's last use. NONE, with NONE for the access: the host has placed a barrier for what PlanImage tells.
    VkPipelineStageFlags2 last_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkAccessFlags2 last_access = VK_ACCESS_2_MEMORY_WRITE_BIT;
    /// How to leave it, and for which use; UNDEFINED: as it came, or, of a target whose layout is UNDEFINED, too, as
    /// Darkroom last used it.
    VkImageLayout final_layout = VK_IMAGE_LAYOUT_UNDEFINED;
    /// NONE: the host places a barrier after the uses that PlanImage tells.
    VkPipelineStageFlags2 final_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkAccessFlags2 final_access = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

    [[nodiscard]] bool is_given() const { return view != VK_NULL_HANDLE; }
    [[nodiscard]] VkRect2D used_region() const { return region.extent.width == 0 ? VkRect2D{{0, 0}, extent} : region; }
};

/// What every frame's image of one kind is, as the host made it: its view's format and the usage of the image.
struct ImageUse {
    VkFormat format = VK_FORMAT_UNDEFINED;  ///< UNDEFINED: not given
    /// Inputs need SAMPLED; with STORAGE own pixels are read cheaper. A target needs COLOR_ATTACHMENT or STORAGE.
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    friend bool operator==(const ImageUse&, const ImageUse&) = default;
};

/// Extent of an entry's output relative to its input: floored, at least 1.
struct OutputScale {
    std::uint32_t numerator = 1;
    std::uint32_t denominator = 1;
};

/// What the numbers of a depth image mean.
enum class DepthKind : std::uint32_t {
    Standard,  ///< device depth, 0 near .. 1 far
    Reversed,  ///< device depth, 1 near .. 0 far
    Planar,    ///< distance along the view axis, in scene units; 1e9 and more is sky
};

/// What the numbers of a velocity image mean. The default is the library's own convention.
struct VelocityKind {
    enum class Sign : std::uint32_t { PreviousMinusCurrent, CurrentMinusPrevious };
    enum class Unit : std::uint32_t {
        Pixels,
        Uv,   ///< the picture is 1 wide and 1 high
        Ndc,  ///< the picture is 2 wide and 2 high
    };
    Sign sign = Sign::PreviousMinusCurrent;
    Unit unit = Unit::Pixels;
    bool is_y_down = true;
    /// Made from the jittered projections, so that a still point moves as the jitter changes.
    bool has_jitter = false;
    friend bool operator==(const VelocityKind&, const VelocityKind&) = default;
};

/// Camera conventions are data: any projection, y up or down in clip space, finite or infinite far plane.
struct Camera {
    Matrix view = identity_matrix;        ///< world to camera; the camera looks along -z, y up
    Matrix projection = identity_matrix;  ///< camera to clip space, with jitter
    Matrix previous_view = identity_matrix;
    Matrix previous_projection = identity_matrix;
    float near_distance = 0.1f;
    float far_distance = 1000.0f;  ///< infinite: std::numeric_limits<float>::infinity()
    DepthKind depth = DepthKind::Standard;
    bool is_y_down = true;  ///< clip space as Vulkan has it; false: y up (a flipped viewport)
    VelocityKind velocity;
    /// How far the projection moves this frame's picture, in pixels of Frame::color, y down: see Composer::jitter.
    std::array<float, 2> jitter{};
    std::array<float, 2> previous_jitter{};  ///< the same of the view's last frame, in pixels of its own picture
    bool is_cut = false;                     ///< nothing of the last frame is related to this one: histories are reset
    // A camera that moved or turned by more than this since the view's last frame is taken for a cut. Infinite: never.
    float jump_distance = 30;  ///< in scene units, of the eye; 30 m a frame are 720 m/s at 24 frames a second
    float jump_angle =
        1.0471976f;  ///< radians, about any axis; at 60 degrees two views share little more than a corner
};

/// A projection that moves the picture by Camera::jitter, in pixels of a picture of `extent`, y down. Of any
/// projection: what is added to x and y of clip space is a multiple of w.
[[nodiscard]] constexpr Matrix jittered(const Matrix& projection, const std::array<float, 2>& jitter, VkExtent2D extent,
                                        bool is_y_down = true) {
    const float x = 2 * jitter[0] / static_cast<float>(extent.width);
    const float y = (is_y_down ? 2 : -2) * jitter[1] / static_cast<float>(extent.height);
    Matrix out = projection;
    for (std::size_t column = 0; column < out.size(); column += 4) {
        out[column] += x * projection[column + 3];
        out[column + 1] += y * projection[column + 3];
    }
    return out;
}

/// One directional light of the frame, with its shadow cascades where it casts.
struct Light {
    static constexpr std::size_t max_cascades = 4;
    std::array<float, 3> direction{0, 1, 0};  ///< toward the light, world space
    std::array<float, 3> color{1, 1, 1};      ///< linear Rec. 709, times intensity
    float volumetric_intensity = 0;
    std::array<float, 3> volumetric_color{1, 1, 1};
    /// D32_SFLOAT array of squares, a layer a cascade, its view a 2D_ARRAY of layer_count layers; depth is 0 near the
    /// light and 1 far from it. Not given: casts no shadow.
    ImageRef cascades;
    std::uint32_t cascade_count = 0;  ///< [0, max_cascades]; 0: casts no shadow
    /// To x, y in [-1, 1] (y down) and depth in [0, 1].
    std::array<Matrix, max_cascades> world_to_cascade{identity_matrix, identity_matrix, identity_matrix,
                                                      identity_matrix};
    std::array<float, max_cascades> splits{};  ///< far distance of each cascade, along the view axis
};
inline constexpr std::uint32_t max_shadow_lights = 4;
/// The lights whose shadows effects can read: the first four of the frame that have cascades. Null: there are fewer.
[[nodiscard]] inline const Light* shadow_light(std::span<const Light> lights, std::uint32_t number) {
    for (const Light& light : lights)
        if (light.cascades.is_given() && light.cascade_count > 0 && number-- == 0) return &light;
    return nullptr;
}

/// What a frame wants of a watch: see darkroom/watch.hpp.
struct Watched {
    std::uint32_t id = 0;  ///< Watch::id; one that the plan does not have is passed over
    /// The part of the frame's picture that is shown, in pixels of Frame::color; an image of another size shows the
    /// part that lies there. Extent (0,0): all of it.
    VkRect2D region{};
    ImageRef target;  ///< gets the nearest texels, their numbers as they are
};

/// What a frame may bring beside its colour: what effects name in their needs. What each is like, what stands in for
/// one that is not given, and how it is brought to another size is in engine/plan/frame_inputs.hpp.
enum class FrameImage : std::uint8_t { Depth, Normals, Velocity, Shadows, Ui, Reactive, Transparency, Exposure };
inline constexpr std::size_t frame_image_count = 8;

/// What `delta_time` means to effects: 0 is 1/60, so that a host that is paused, or says nothing, keeps its histories.
[[nodiscard]] constexpr double seconds_between_frames(double delta_time) {
    return delta_time == 0 ? 1.0 / 60 : delta_time;
}

/// One frame of one view.
struct Frame {
    ImageRef color;  ///< scene-linear Rec. 709
    ImageRef depth;
    ImageRef normals;   ///< world space, -1..1; of no length: nothing that occludes or is occluded, as a sprite
    ImageRef velocity;  ///< as Camera::velocity says
    ImageRef ui;        ///< sRGB-encoded, premultiplied after encoding
    /// Red, 0 .. 1: how little earlier frames tell of a pixel (glass, particles, screens in the scene). Without it: 0.
    ImageRef reactive;
    /// Red, green, blue: the colour before anything transparent was drawn, such as glass and particles, which depth and
    /// velocity know nothing of. Without it: 0.
    ImageRef transparency;
    /// One texel, red: what the host multiplies light by before it shows it. Without it: 1.
    ImageRef exposure;
    Camera camera;
    std::span<const Light> lights;
    double time = 0;        ///< seconds
    double delta_time = 0;  ///< seconds since the frame before; 0: 1/60; below 0 resets histories
    std::uint64_t frame_index = 0;
    std::uint32_t view = 0;  ///< whose histories: 0 .. CompileDesc::views - 1
    ImageRef target;
    std::span<const Watched> watched;
};

}  // namespace darkroom
