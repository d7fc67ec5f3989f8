// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/halation.hpp>

#include "halation/halation_reference.hpp"

namespace darkroom {

namespace {

constexpr auto halation_rows =
    describe(field<&Halation::intensity>("Share of the light that the film base throws back.", {0, 1}).as_amount(),
             field<&Halation::threshold>("Light above this value is thrown back.", {0, 65504}),
             field<&Halation::radius>(
                 "Standard deviation of the near glow, in a picture of 1080 lines; the far one is three times as wide.",
                 {4, 32}, unit::pixels),
             field<&Halation::spread>("Share of the far glow in the whole.", {0, 1}),
             field<&Halation::tint>("Colour of the light that comes back; red goes deepest into film.", {0, 1}),
             field<&Halation::conserves_energy>(
                 "Takes the light that comes back from the place it came from, so that the picture keeps its light."));

const Halation& halation_of(const void* parameters) { return *static_cast<const Halation*>(parameters); }

void bright_constants(const void* parameters, const PassContext&, std::span<PassVector> out) {
    out[0] = {halation_of(parameters).threshold, 0, 0, 0};
}

template <bool is_far, bool is_down>
void line_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const VkExtent2D extent = context.output_extent;
    const double texels = halation_near_texels(halation_of(parameters), is_far ? extent.height * 4 : extent.height);
    fill_light_line(out, extent, is_down, is_far ? halation_far_variance(texels) : halation_near_variance(texels));
}

template <bool is_far>
PassImage blurred(PassBuilder& builder, PassImage image, std::uint32_t part) {
    const std::string name = is_far ? "far" : "near";
    image = add_light_line(builder, image, name + " across", part, line_constants<is_far, false>);
    return add_light_line(builder, image, name + " down", part, line_constants<is_far, true>);
}

void build(PassBuilder& builder) {
    const std::uint32_t part = builder.from_max_extent(halation_part);
    const PassImage bright = add_bright_light(builder, builder.picture(), part, bright_constants);
    const PassImage near = blurred<false>(builder, bright, part);
    const PassImage quarter = add_quarter_light(builder, near, 4 * part);
    builder.side("halation_near", near, {0, 0, 0, 0});
    builder.side("halation_far", blurred<true>(builder, quarter, 4 * part), {0, 0, 0, 0});
}

}  // namespace

const EffectInfo& effect_info(const Halation&) {
    static const EffectInfo info{
        .name = "halation",
        .doc = "Throws bright light back as the base of a film does, red first.",
        .parameters = halation_rows.table(),
        .files = embedded_files("halation"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .flat = {.documented = 69, .scene_linear = 69},
        .build = build,
        .reference = halation_reference,
        .is_identity = [](const void* parameters) { return halation_of(parameters).intensity == 0.0f; },
        .threshold = [](const void* parameters) -> std::optional<float> {
            const Halation& halation = halation_of(parameters);
            if (halation.intensity == 0.0f) return {};
            return halation.threshold;
        },
    };
    return info;
}

}  // namespace darkroom
