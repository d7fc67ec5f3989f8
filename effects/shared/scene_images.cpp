// SPDX-License-Identifier: MIT
#include "shared/scene_images.hpp"

namespace darkroom {

namespace {

PassImage make_linear_depth(PassBuilder& builder) {
    return builder.add({.name = "linear depth",
                        .shader = "shared/linear_depth.glsl",
                        .inputs = {{.name = "shared_depth", .image = builder.frame_image(FrameImage::Depth)}},
                        .output = builder.create({.name = "linear depth", .format = VK_FORMAT_R32_SFLOAT}),
                        .custom_vectors = 2,
                        .constants = depth_vectors});
}

PassImage make_half_depth(PassBuilder& builder) {
    return builder.add(
        {.name = "half depth",
         .shader = "shared/half_depth.glsl",
         .inputs = {{.name = "shared_depth", .image = builder.frame_image(FrameImage::Depth)}},
         .output = builder.create({.name = "half depth", .format = VK_FORMAT_R32_SFLOAT, .denominator = 2}),
         .custom_vectors = 2,
         .constants = depth_vectors});
}

template <std::uint32_t step>
PassImage make_surface_distance(PassBuilder& builder) {
    const char* const name = step == 1 ? "surface distance" : "half surface distance";
    return builder.add({.name = name,
                        .shader = "shared/surface_distance.glsl",
                        .inputs = {{.name = "shared_depth", .image = builder.frame_image(FrameImage::Depth)},
                                   {.name = "shared_normals", .image = builder.frame_image(FrameImage::Normals)}},
                        .output = builder.create({.name = name, .format = VK_FORMAT_R32_SFLOAT, .denominator = step}),
                        .custom_vectors = 2,
                        .constants = [](const void* parameters, const PassContext& context, std::span<PassVector> out) {
                            depth_vectors(parameters, context, out);
                            out[1][1] = step == 1 ? 0.0f : 1.0f;
                        }});
}

/// An image that an effect before asked for; else none.
PassImage if_made(PassBuilder& builder, std::string_view name, ConditionFunction condition) {
    return builder.shared(
        name, [](PassBuilder&) { return PassImage{}; }, condition);
}
bool is_given(PassImage image) { return image.index != PassImage{}.index; }

void velocity_constants(const void*, const PassContext& context, std::span<PassVector> out) {
    const Camera& camera = *context.camera;
    const VelocityKind& kind = camera.velocity;
    const std::array<float, 2> pixels{static_cast<float>(context.frame_extent.width),
                                      static_cast<float>(context.frame_extent.height)};
    // Jitter is told in pixels of the scene.
    const std::array<float, 2> jitter_scale{pixels[0] / static_cast<float>(context.scene_extent.width),
                                            pixels[1] / static_cast<float>(context.scene_extent.height)};
    const float sign = kind.sign == VelocityKind::Sign::PreviousMinusCurrent ? 1.0f : -1.0f;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const float unit = kind.unit == VelocityKind::Unit::Pixels ? 1.0f
                           : kind.unit == VelocityKind::Unit::Uv   ? pixels[axis]
                                                                   : pixels[axis] / 2;
        const float direction = axis == 1 && !kind.is_y_down ? -1.0f : 1.0f;
        out[0][axis] = sign * unit * direction;
        // A point that stands still moves in the picture as its jitter changes.
        out[0][axis + 2] =
            kind.has_jitter ? (camera.jitter[axis] - camera.previous_jitter[axis]) * jitter_scale[axis] : 0.0f;
    }
}

PassImage make_velocity(PassBuilder& builder) {
    return builder.add({.name = "velocity",
                        .shader = "shared/velocity.glsl",
                        .inputs = {{.name = "shared_velocity", .image = builder.frame_image(FrameImage::Velocity)}},
                        .output = builder.create({.name = "velocity", .format = VK_FORMAT_R16G16_SFLOAT}),
                        .custom_vectors = 1,
                        .constants = velocity_constants});
}

template <NormalSource source, std::uint32_t step>
void normal_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    if (source == NormalSource::Image) {
        out[0] = {step == 1 ? 0.0f : 1.0f, 0, 0, 0};
        return;
    }
    const auto [ray, flat] = ray_constants(*context.camera, context.frame_extent, 1);
    out[0] = ray;
    out[1] = flat;
    if (step == 2) depth_vectors(parameters, context, out.subspan(2));
}

template <std::uint32_t step>
PassImage make_given_normals(PassBuilder& builder) {
    const char* const name = step == 1 ? "view normals" : "half view normals";
    return builder.add({.name = name,
                        .shader = "shared/view_normals.glsl",
                        .inputs = {{.name = "shared_normals", .image = builder.frame_image(FrameImage::Normals)}},
                        .output = builder.create({.name = name, .denominator = step}),
                        .custom_vectors = 1,
                        .constants = normal_constants<NormalSource::Image, step>});
}

PassImage make_normals(PassBuilder& builder) {
    return builder.add({.name = "view normals",
                        .shader = "shared/normals_from_depth.glsl",
                        .inputs = {{.name = "shared_linear_depth", .image = linear_depth(builder)}},
                        .output = builder.create({.name = "view normals"}),
                        .custom_vectors = 2,
                        .constants = normal_constants<NormalSource::Depth, 1>});
}

PassImage make_half_normals(PassBuilder& builder) {
    return builder.add({.name = "half view normals",
                        .shader = "shared/half_normals_from_depth.glsl",
                        .inputs = {{.name = "shared_depth", .image = builder.frame_image(FrameImage::Depth)}},
                        .output = builder.create({.name = "half view normals", .denominator = 2}),
                        .custom_vectors = 4,
                        .constants = normal_constants<NormalSource::Depth, 2>});
}

}  // namespace

DepthConstants depth_constants(const Camera& camera) {
    // From clip.z = p10 z + p14 and clip.w = p11 z + p15, with z = -distance, solved for the distance.
    const Matrix& p = camera.projection;
    if (camera.depth == DepthKind::Planar) return {};
    return {.distance = {-p[15], p[14], -p[11], p[10]}, .sky = camera.depth == DepthKind::Reversed ? 0.0f : 1.0f};
}

void depth_vectors(const void*, const PassContext& context, std::span<PassVector> out) {
    const DepthConstants depth = depth_constants(*context.camera);
    out[0] = depth.distance;
    out[1] = {depth.sky, 0, 0, 0};
}

RayConstants ray_constants(const Camera& camera, VkExtent2D frame, float step) {
    const Matrix& p = camera.projection;
    const float down = camera.is_y_down ? 1.0f : -1.0f;
    const std::array<float, 2> scale{p[0], p[5] * down}, shear{p[8], p[9] * down}, offset{p[12], p[13] * down};
    const std::array<float, 2> pixels{static_cast<float>(frame.width), static_cast<float>(frame.height)};
    RayConstants out;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        // x and y of clip space at texel 0, and from one to the next.
        const float first = 1.0f / pixels[axis] - 1.0f, next = 2.0f * step / pixels[axis];
        out.ray[axis] = -p[11] * next / scale[axis];
        out.ray[axis + 2] = (shear[axis] - p[11] * first) / scale[axis];
        out.flat[axis] = p[15] * next / scale[axis];
        out.flat[axis + 2] = (p[15] * first - offset[axis]) / scale[axis];
    }
    return out;
}

PassImage linear_depth(PassBuilder& builder) {
    if (builder.is_depth_planar()) return builder.frame_image(FrameImage::Depth);
    return builder.shared("linear depth", make_linear_depth);
}

PassImage half_depth(PassBuilder& builder, ConditionFunction condition) {
    const PassImage surface = if_made(builder, "half surface distance", condition);
    return is_given(surface) ? surface : builder.shared("half depth", make_half_depth, condition);
}

PassImage half_depth_if_made(PassBuilder& builder) {
    const PassImage surface = if_made(builder, "half surface distance", nullptr);
    return is_given(surface) ? surface : if_made(builder, "half depth", nullptr);
}

PassImage surface_distance(PassBuilder& builder, ConditionFunction condition) {
    return builder.shared("surface distance", make_surface_distance<1>, condition);
}

PassImage half_surface_distance(PassBuilder& builder, ConditionFunction condition) {
    return builder.shared("half surface distance", make_surface_distance<2>, condition);
}

PassImage velocity(PassBuilder& builder, ConditionFunction condition) {
    if (builder.is_velocity_plain()) return builder.frame_image(FrameImage::Velocity);
    return builder.shared("velocity", make_velocity, condition);
}

PassImage view_normals(PassBuilder& builder, NormalSource source, ConditionFunction condition) {
    if (source == NormalSource::Image) return builder.shared("view normals", make_given_normals<1>, condition);
    return builder.shared("view normals from depth", make_normals, condition);
}

PassImage half_view_normals(PassBuilder& builder, NormalSource source, ConditionFunction condition) {
    if (source == NormalSource::Image) return builder.shared("half view normals", make_given_normals<2>, condition);
    return builder.shared("half view normals from depth", make_half_normals, condition);
}

PassImage plain_image(PassBuilder& builder, FrameImage which) {
    switch (which) {
        case FrameImage::Depth:
            return linear_depth(builder);
        case FrameImage::Normals:
            return view_normals(builder, NormalSource::Image);
        case FrameImage::Velocity:
            return velocity(builder);
        case FrameImage::Shadows:
            return builder.shadow_map(0);
        default:
            return builder.frame_image(which);
    }
}

}  // namespace darkroom
