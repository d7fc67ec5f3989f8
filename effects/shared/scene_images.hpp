// SPDX-License-Identifier: MIT
#pragma once
// Images that scene-aware effects share: made once a frame, however many effects read them. For `build` functions of
// effects whose needs name depth. They are made while an effect that asked is on, and its `condition` holds.

#include <darkroom/effect.hpp>

namespace darkroom {

/// Planar distance, R32F; 1e10 is sky.
[[nodiscard]] PassImage linear_depth(PassBuilder& builder);
/// The same of every second pixel of every second row: half the size, floored. Its sign is as in surface_distance, so
/// that frames have one such image.
[[nodiscard]] PassImage half_depth(PassBuilder& builder, ConditionFunction condition = nullptr);
/// half_depth, where an effect before asked for it; else none, for whoever reads the frame's depth as cheaply.
[[nodiscard]] PassImage half_depth_if_made(PassBuilder& builder);

/// The distance, negative where the frame's normal has no length: no surface is there. For effects that know that the
/// frame has normals. Half: of the pixels of half_depth.
[[nodiscard]] PassImage surface_distance(PassBuilder& builder, ConditionFunction condition = nullptr);
[[nodiscard]] PassImage half_surface_distance(PassBuilder& builder, ConditionFunction condition = nullptr);

/// For what reads the depth image itself, by planar_distance.glsl: a depth d is at the planar distance
/// (d x + y) / (d z + w). One number a pixel costs less so than an image of distances.
struct DepthConstants {
    PassVector distance{1, 0, 0, 1};
    float sky = 1e10f;  ///< depth of the sky
};
[[nodiscard]] DepthConstants depth_constants(const Camera& camera);
/// The same as two vectors of a pass or an end: distance, and the sky in x.
void depth_vectors(const void* parameters, const PassContext& context, std::span<PassVector> out);

/// Previous minus current position, in pixels, y down, without jitter, whatever Camera::velocity says of the host's
/// image: red and green. For effects whose needs name velocity.
[[nodiscard]] PassImage velocity(PassBuilder& builder, ConditionFunction condition = nullptr);

/// View space of texels that are each the first of `step` x `step` pixels of the frame: at a planar distance, x and y
/// are (texel * ray.xy + ray.zw) * distance + texel * flat.xy + flat.zw, and z is -distance.
struct RayConstants {
    PassVector ray{}, flat{};
};
[[nodiscard]] RayConstants ray_constants(const Camera& camera, VkExtent2D frame, float step);

enum class NormalSource : std::uint8_t { Depth, Image };
/// View-space normals, RGBA16F: from the distance, or from the frame's own image, which the effect must know to be
/// there. Half: of the pixels of half_depth.
[[nodiscard]] PassImage view_normals(PassBuilder& builder, NormalSource source, ConditionFunction condition = nullptr);
[[nodiscard]] PassImage half_view_normals(PassBuilder& builder, NormalSource source,
                                          ConditionFunction condition = nullptr);

/// An image of the frame in the library's own convention: of Depth planar distance, of Normals view space, of Velocity
/// as above, of Shadows the first light's cascades, and the others as they are.
[[nodiscard]] PassImage plain_image(PassBuilder& builder, FrameImage which);

}  // namespace darkroom
