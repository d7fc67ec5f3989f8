// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/lens_flare.hpp>

#include "lens_flare/lens_flare_reference.hpp"

namespace darkroom {

namespace {

constexpr auto lens_flare_rows = describe(
    field<&LensFlare::intensity>("Amount of the flare added to the picture.", {0, 16}).as_amount(),
    field<&LensFlare::threshold>("Light above this value makes flares.", {0, 65504}),
    field<&LensFlare::ghosts>("Number of ghosts of each light, on both sides of the centre by turns.", {0, 16}),
    field<&LensFlare::spacing>("Step by which each ghost is smaller and nearer to the centre than the one before.",
                               {0, 2}),
    field<&LensFlare::halo>("Strength of the halo relative to a ghost.", {0, 4}),
    field<&LensFlare::halo_radius>("Radius of the halo of a light in the centre, in heights of the picture.", {0, 1}),
    field<&LensFlare::dispersion>("Share by which ghosts are larger in red and smaller in blue.", {0, 0.2}),
    field<&LensFlare::blades>(
        "Number of the aperture's blades: an even number gives as many rays, an odd one twice as many.", {3, 16}),
    field<&LensFlare::starburst>("Share of the flare in the rays of the aperture.", {0, 1}),
    field<&LensFlare::tint>("Colour that multiplies the flare.", {0, 4}));

constexpr std::uint32_t max_ghosts = 16;

const LensFlare& flare_of(const void* parameters) { return *static_cast<const LensFlare*>(parameters); }

void bright_constants(const void* parameters, const PassContext&, std::span<PassVector> out) {
    out[0] = {flare_of(parameters).threshold, 0, 0, 0};
}

void aperture_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const double aspect = static_cast<double>(context.frame_extent.width) / context.frame_extent.height;
    for (std::size_t i = 0; i < lens_flare_places; ++i) {
        const auto [right, down] = lens_flare_place(flare_of(parameters), i);
        out[i / 2][i % 2 * 2] = static_cast<float>(right / aspect);
        out[i / 2][i % 2 * 2 + 1] = static_cast<float>(down);
    }
}

void part_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const LensFlare& flare = flare_of(parameters);
    out[0] = {static_cast<float>(context.frame_extent.width) / static_cast<float>(context.frame_extent.height),
              static_cast<float>(flare.ghosts), static_cast<float>(lens_flare_rays(flare)), flare.dispersion};
    out[1] = {flare.halo_radius, flare.halo, flare.starburst, 0};
    for (std::int32_t ghost = 0; ghost < flare.ghosts; ++ghost) {
        const auto [r, g, b] = lens_flare_color(flare, ghost);
        out[static_cast<std::size_t>(2 + ghost)] = {static_cast<float>(lens_flare_scale(flare, ghost)),
                                                    static_cast<float>(r), static_cast<float>(g),
                                                    static_cast<float>(b)};
    }
}

void build(PassBuilder& builder) {
    const std::uint32_t part = builder.from_max_extent(bright_part);
    const PassImage bright = add_bright_light(builder, builder.source(), part, bright_constants);
    const PassImage light =
        builder.add({.name = "aperture",
                     .shader = "lens_flare.glsl#aperture",
                     .inputs = {{.name = "lens_flare_bright", .image = add_quarter_light(builder, bright, 2 * part)}},
                     .output = builder.create({.name = "light", .denominator = 2 * part}),
                     .custom_vectors = lens_flare_places / 2,
                     .constants = aperture_constants});
    const PassImage flare = builder.add({.name = "parts",
                                         .shader = "lens_flare.glsl#parts",
                                         .inputs = {{.name = "lens_flare_light", .image = light}},
                                         .output = builder.create({.name = "flare", .denominator = part}),
                                         .custom_vectors = 2 + max_ghosts,
                                         .constants = part_constants});
    builder.side("lens_flare_flare", flare, {0, 0, 0, 0});
}

}  // namespace

const EffectInfo& effect_info(const LensFlare&) {
    static const EffectInfo info{
        .name = "lens_flare",
        .doc = "Adds ghosts and a halo of bright light, as lenses reflect them.",
        .parameters = lens_flare_rows.table(),
        .files = embedded_files("lens_flare"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .flat = {.documented = 62, .scene_linear = 61},
        .build = build,
        .reference = lens_flare_reference,
        .is_identity =
            [](const void* parameters) {
                const LensFlare& flare = flare_of(parameters);
                return flare.intensity == 0.0f || (flare.ghosts == 0 && flare.halo == 0.0f);
            },
        .threshold = [](const void* parameters) -> std::optional<float> {
            const LensFlare& flare = flare_of(parameters);
            if (flare.intensity == 0.0f || (flare.ghosts == 0 && flare.halo == 0.0f)) return {};
            return flare.threshold;
        },
    };
    return info;
}

}  // namespace darkroom
