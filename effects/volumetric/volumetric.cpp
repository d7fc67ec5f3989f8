// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/volumetric.hpp>
#include <string>

#include "shared/blue_noise.hpp"
#include "shared/camera.hpp"
#include "shared/scene_images.hpp"
#include "volumetric/volumetric_reference.hpp"

namespace darkroom {

namespace {

constexpr auto volumetric_rows = describe(
    field<&Volumetric::density>("Light that the haze scatters toward the camera, in hundredths a metre.", {0, 1000})
        .as_amount(),
    field<&Volumetric::samples>("Number of steps of the march. Brightness does not depend on it, smoothness does.",
                                {1, 256}),
    field<&Volumetric::max_distance>("Length of the march; the sky is marched as far.", {0.01, 1e6}, unit::metres),
    field<&Volumetric::decay>(
        "Share of the light that is left after each metre, or after each thirty-second of the march.", {0.01, 1}),
    field<&Volumetric::decay_form>("Length that `decay` counts for: a metre, or a thirty-second of the march."));

const Volumetric& volumetric_of(const void* parameters) { return *static_cast<const Volumetric*>(parameters); }

/// Does its haze show at all?
bool is_volumetric(const Light* light) {
    return light != nullptr && light->volumetric_intensity > 0 &&
           std::ranges::any_of(light->volumetric_color, [](float channel) { return channel > 0; });
}

/// Is there a light worth marching for from this one on?
bool is_lit(const void*, const PassContext& context, std::uint32_t first) {
    for (std::uint32_t number = first; number < max_shadow_lights; ++number)
        if (is_volumetric(shadow_light(context.lights, number))) return true;
    return false;
}

constexpr std::size_t fixed_vectors = 4, vectors_per_cascade = 4;

/// A point of the world, or the coordinates in a cascade, as it depends on a half-size pixel and its planar distance:
/// linear in the distance, and in the pixel where the camera turns its rays, or moves them, with it.
struct Ramp {
    Vector3 start{}, slope{}, per_x{}, per_y{};
};

Ramp world_ramp(const PassContext& context) {
    const SolvedCamera camera(*context.camera);
    const auto point = [&](double x, double y, double planar) {
        const Vector3 view = camera.view_position((x * 2 + 0.5) / context.frame_extent.width,
                                                  (y * 2 + 0.5) / context.frame_extent.height, planar);
        const Vector3 turned = camera.world_direction(view);
        return Vector3{camera.eye[0] + turned[0], camera.eye[1] + turned[1], camera.eye[2] + turned[2]};
    };
    const auto minus = [](const Vector3& a, const Vector3& b) {
        return Vector3{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    };
    const double planar = camera.is_perspective() ? 1 : 0;
    Ramp out{.start = point(0, 0, 0)};
    out.slope = minus(point(0, 0, 1), out.start);
    out.per_x = minus(point(1, 0, planar), point(0, 0, planar));
    out.per_y = minus(point(0, 1, planar), point(0, 0, planar));
    return out;
}

/// The world's ramp as u, v and depth in a cascade; the bias keeps what is lit off its own shadow.
void write_cascade(const Matrix& m, std::uint32_t resolution, const Ramp& world, std::span<PassVector> out) {
    const double bias = volumetric_bias(m, resolution);
    const auto row = [&](std::size_t index, const Vector3& v) {
        return double{m[index]} * v[0] + double{m[4 + index]} * v[1] + double{m[8 + index]} * v[2];
    };
    for (std::size_t index = 0; index < 3; ++index) {
        const double scale = index == 2 ? 1 : 0.5, offset = index == 2 ? -bias : 0.5;
        out[0][index] = static_cast<float>((row(index, world.start) + double{m[12 + index]}) * scale + offset);
        out[1][index] = static_cast<float>(row(index, world.slope) * scale);
        out[2][index] = static_cast<float>(row(index, world.per_x) * scale);
        out[3][index] = static_cast<float>(row(index, world.per_y) * scale);
    }
}

/// What volumetric.glsl#march says of its vectors.
template <std::uint32_t number>
void march_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    std::ranges::fill(out, PassVector{});
    out[2][3] = number == 0 ? 1.0f : 0.0f;
    const Light* const light = shadow_light(context.lights, number);
    // A light that does not show, before one that does, is marched in no steps.
    if (!is_volumetric(light) || context.camera == nullptr) return;
    const Volumetric& volumetric = volumetric_of(parameters);
    const auto samples = static_cast<float>(volumetric.samples);
    const bool is_per_metre = volumetric.decay_form == VolumetricDecay::PerMetre;
    out[0] = {samples, volumetric.max_distance, is_per_metre ? 1.0f : std::pow(volumetric.decay, 32.0f / samples),
              volumetric.density * 0.01f * light->volumetric_intensity};
    const Ramp world = world_ramp(context);
    const SolvedCamera camera(*context.camera);
    const bool turns = camera.is_perspective();
    const Vector3 x = camera.view_direction(world.per_x), y = camera.view_direction(world.per_y),
                  first = camera.view_direction(world.slope);
    out[1] = {turns ? static_cast<float>(x[0]) : 0.0f, static_cast<float>(first[0]),
              turns ? static_cast<float>(y[1]) : 0.0f, static_cast<float>(first[1])};
    const auto& d = light->direction;
    const double length = std::max(std::hypot(double{d[0]}, double{d[1]}, double{d[2]}), 1e-6);
    const auto toward_light = [&](const Vector3& v) {
        return static_cast<float>((v[0] * double{d[0]} + v[1] * double{d[1]} + v[2] * double{d[2]}) / length);
    };
    out[2][0] = toward_light(world.slope);
    if (turns) {
        out[2][1] = toward_light(world.per_x);
        out[2][2] = toward_light(world.per_y);
    }
    const auto& c = light->volumetric_color;
    out[3] = {std::max(c[0], 0.0f), std::max(c[1], 0.0f), std::max(c[2], 0.0f), turns ? 1.0f : 0.0f};
    const std::size_t cascades = std::min<std::size_t>(light->cascade_count, Light::max_cascades);
    for (std::size_t cascade = 0; cascade < cascades; ++cascade) {
        const auto vectors = out.subspan(fixed_vectors + cascade * vectors_per_cascade, vectors_per_cascade);
        write_cascade(light->world_to_cascade[cascade], light->cascades.extent.width, world, vectors);
        vectors[0][3] = light->splits[cascade];
    }
    out[fixed_vectors + 1][3] = static_cast<float>(cascades);
    out[fixed_vectors + 2][3] = is_per_metre ? std::log2(volumetric.decay) : 0.0f;
}

void build(PassBuilder& builder) {
    constexpr std::array<ConstantsFunction, max_shadow_lights> constants{march_constants<0>, march_constants<1>,
                                                                         march_constants<2>, march_constants<3>};
    TableDesc tile{.name = "blue noise",
                   .format = VK_FORMAT_R32_SFLOAT,
                   .extent = {blue_noise_size, blue_noise_size, 1},
                   .is_load_only = true};
    const auto& ranks = blue_noise_ranks();
    tile.data.resize(ranks.size() * sizeof(float));
    for (std::size_t i = 0; i < ranks.size(); ++i) {
        const float share = (static_cast<float>(ranks[i]) + 0.5f) / static_cast<float>(ranks.size());
        std::memcpy(tile.data.data() + i * sizeof share, &share, sizeof share);
    }
    const PassImage noise = builder.table(tile), distance = half_depth(builder, is_lit);
    PassImage light = builder.create({.name = "light", .denominator = 2});
    for (std::uint32_t number = 0; number < max_shadow_lights; ++number)
        light = builder.add({.name = "march " + std::to_string(number),
                             .shader = "volumetric.glsl#march",
                             .inputs = {{.name = "volumetric_distance", .image = distance},
                                        {.name = "volumetric_noise", .image = noise},
                                        {.name = "volumetric_shadow", .image = builder.shadow_map(number)}},
                             .output = light,
                             .is_additive = number > 0,
                             .custom_vectors = fixed_vectors + Light::max_cascades * vectors_per_cascade,
                             .constants = constants[number],
                             .condition = is_lit,
                             .argument = number});
    const auto blur = [&](const char* name, const char* shader, PassImage from) {
        return builder.add({.name = name,
                            .shader = shader,
                            .inputs = {{.name = "volumetric_light", .image = from}},
                            .output = builder.create({.name = name, .denominator = 2}),
                            .condition = is_lit});
    };
    const PassImage half_done = blur("blur across", "volumetric.glsl#blur_x", light);
    builder.side("volumetric_depth", builder.frame_image(FrameImage::Depth), {});
    builder.end_constants(2, depth_vectors);
    builder.side("volumetric_shafts", blur("blur down", "volumetric.glsl#blur_y", half_done), {0, 0, 0, 0});
}

}  // namespace

const EffectInfo& effect_info(const Volumetric&) {
    static const EffectInfo info{
        .name = "volumetric",
        .doc = "Draws shafts of light in haze, by the shadows of each light.",
        .parameters = volumetric_rows.table(),
        .files = embedded_files("volumetric"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .needs = {FrameImage::Depth, FrameImage::Shadows},
        .flat = {.documented = 40, .scene_linear = 20, .starts_on = false, .toggle_key = 10},
        .is_in_traced_light = true,
        .build = build,
        .reference = volumetric_reference,
        .is_identity = [](const void* parameters) { return volumetric_of(parameters).density == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
