// SPDX-License-Identifier: MIT
#include "shared/scene_images.hpp"

namespace darkroom {

namespace {

/// From clip.z = p10 z + p14 and clip.w = p11 z + p15, with z = -distance, solved for the distance.
void depth_constants(const void*, const PassContext& context, std::span<PassVector> out) {
    const Camera& camera = *context.camera;
    const Matrix& p = camera.projection;
    const bool is_planar = camera.depth == DepthKind::Planar;
    out[0] = is_planar ? PassVector{1, 0, 0, 1} : PassVector{-p[15], p[14], -p[11], p[10]};
    out[1] = {is_planar ? 1e10f : camera.depth == DepthKind::Reversed ? 0.0f : 1.0f, 0, 0, 0};
}

PassImage make_linear_depth(PassBuilder& builder) {
    return builder.add(
        {.name = "linear depth",
         .shader = "shared/linear_depth.glsl",
         .inputs = {{.name = "shared_depth", .image = builder.frame_image(FrameImage::Depth), .is_loaded = true}},
         .output = builder.create({.name = "linear depth", .format = VK_FORMAT_R32_SFLOAT}),
         .custom_vectors = 2,
         .constants = depth_constants});
}

PassImage make_half_depth(PassBuilder& builder) {
    return builder.add(
        {.name = "half depth",
         .shader = "shared/half_depth.glsl",
         .inputs = {{.name = "shared_linear_depth", .image = linear_depth(builder), .is_loaded = true}},
         .output = builder.create({.name = "half depth", .format = VK_FORMAT_R32_SFLOAT, .denominator = 2})});
}

void one(const void*, const PassContext&, std::span<PassVector> out) { out[0] = {1, 0, 0, 0}; }
void two(const void*, const PassContext&, std::span<PassVector> out) { out[0] = {2, 0, 0, 0}; }

template <NormalSource source, std::uint32_t step>
PassImage make_normals(PassBuilder& builder) {
    constexpr bool is_given = source == NormalSource::Image;
    const char* const name = step == 1 ? "view normals" : "half view normals";
    const PassImage input = is_given ? builder.frame_image(FrameImage::Normals) : linear_depth(builder);
    return builder.add(
        {.name = name,
         .shader = is_given ? "shared/view_normals.glsl" : "shared/normals_from_depth.glsl",
         .inputs = {{.name = is_given ? "shared_normals" : "shared_linear_depth", .image = input, .is_loaded = true}},
         .output = builder.create({.name = name, .denominator = step}),
         .custom_vectors = 1,
         .constants = step == 1 ? one : two});
}

}  // namespace

PassImage linear_depth(PassBuilder& builder) {
    if (builder.is_depth_planar()) return builder.frame_image(FrameImage::Depth);
    return builder.shared("linear depth", make_linear_depth);
}

PassImage half_depth(PassBuilder& builder, ConditionFunction condition) {
    return builder.shared("half depth", make_half_depth, condition);
}

PassImage view_normals(PassBuilder& builder, NormalSource source, ConditionFunction condition) {
    if (source == NormalSource::Image)
        return builder.shared("view normals", make_normals<NormalSource::Image, 1>, condition);
    return builder.shared("view normals from depth", make_normals<NormalSource::Depth, 1>, condition);
}

PassImage half_view_normals(PassBuilder& builder, NormalSource source, ConditionFunction condition) {
    if (source == NormalSource::Image)
        return builder.shared("half view normals", make_normals<NormalSource::Image, 2>, condition);
    return builder.shared("half view normals from depth", make_normals<NormalSource::Depth, 2>, condition);
}

}  // namespace darkroom
