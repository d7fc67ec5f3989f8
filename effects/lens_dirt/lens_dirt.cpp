// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/lens_dirt.hpp>

#include <cstring>
#include <random>

#include "lens_dirt/lens_dirt_reference.hpp"

namespace darkroom {

namespace {

constexpr auto lens_dirt_rows = describe(
    field<&LensDirt::intensity>("Share of the surrounding light that shines in white dirt.", {0, 64}).as_amount(),
    field<&LensDirt::threshold>("Light above this value makes dirt shine.", {0, 65504}),
    field<&LensDirt::radius>("Standard deviation of the surrounding light, in a picture of 1080 lines.", {20, 128},
                             unit::pixels),
    field<&LensDirt::dirt>(
        "Picture of the dirt from 0 to 1, stretched over the whole; without one there are discs of dust.")
        .as_picture());

const LensDirt& dirt_of(const void* parameters) { return *static_cast<const LensDirt*>(parameters); }

void bright_constants(const void* parameters, const PassContext&, std::span<PassVector> out) {
    out[0] = {dirt_of(parameters).threshold, 0, 0, 0};
}

template <bool is_down>
void line_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    fill_light_line(out, context.output_extent, is_down,
                    lens_dirt_variance(dirt_of(parameters), context.output_extent.height));
}

PassImage dirt_image(PassBuilder& builder) {
    const ResourceData* const data = builder.resource(dirt_of(builder.parameters()).dirt);
    const LensDirtTable table = lens_dirt_table(data == nullptr ? nullptr : std::get_if<ResourceImage>(data));
    TableDesc desc{.name = "dirt",
                   .format = VK_FORMAT_R8G8B8A8_UNORM,
                   .extent = {table.width, table.height, 1},
                   .data = std::vector<std::byte>(table.rgba.size())};
    std::memcpy(desc.data.data(), table.rgba.data(), table.rgba.size());
    return builder.table(desc);
}

void build(PassBuilder& builder) {
    const std::uint32_t part = builder.from_max_extent(bright_part);
    PassImage light = add_bright_light(builder, builder.source(), part, bright_constants);
    light = add_quarter_light(builder, light, 4 * part);
    light = add_light_line(builder, light, "across", 4 * part, line_constants<false>);
    light = add_light_line(builder, light, "down", 4 * part, line_constants<true>);
    builder.side("lens_dirt_light", light, {0, 0, 0, 0});
    builder.side("lens_dirt_dirt", dirt_image(builder), {});
}

}  // namespace

const std::vector<LensDirtDisc>& lens_dirt_discs() {
    static const std::vector<LensDirtDisc> discs = [] {
        // Few large ones, many small ones. The numbers of this engine are the same everywhere.
        std::mt19937 random(1880);
        const auto number = [&] { return static_cast<double>(random()) * 0x1p-32; };
        std::vector<LensDirtDisc> out(160);
        for (LensDirtDisc& disc : out) {
            const double size = number();
            disc = {.x = number() * 16 / 9, .y = number(), .radius = 0.006 + 0.06 * std::pow(size, 6)};
            disc.brightness = 0.1 + 0.6 * number() * (1 - size * size);
        }
        return out;
    }();
    return discs;
}

LensDirtTable lens_dirt_table(const ResourceImage* picture) {
    const auto rounded = [](double value) { return static_cast<std::uint8_t>(std::lround(255 * value)); };
    if (picture != nullptr) {
        LensDirtTable out{.width = picture->width, .height = picture->height};
        for (const float value : picture->rgba)
            out.rgba.push_back(value > 0 ? rounded(std::min(double{value}, 1.0)) : std::uint8_t{0});
        return out;
    }
    LensDirtTable out{.width = lens_dirt_width, .height = lens_dirt_height};
    out.rgba.resize(std::size_t{lens_dirt_width} * lens_dirt_height * 4);
    for (const LensDirtDisc& disc : lens_dirt_discs()) {
        const auto cover = [](double from, std::uint32_t size) {
            return static_cast<std::uint32_t>(std::clamp(std::floor(from), 0.0, static_cast<double>(size)));
        };
        constexpr double texels = lens_dirt_height;
        for (std::uint32_t y = cover((disc.y - disc.radius) * texels, lens_dirt_height);
             y < cover((disc.y + disc.radius) * texels + 1, lens_dirt_height); ++y)
            for (std::uint32_t x = cover((disc.x - disc.radius) * texels, lens_dirt_width);
                 x < cover((disc.x + disc.radius) * texels + 1, lens_dirt_width); ++x) {
                const std::uint8_t value = rounded(
                    lens_dirt_profile(disc, std::hypot((x + 0.5) / texels - disc.x, (y + 0.5) / texels - disc.y)));
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    std::uint8_t& texel = out.rgba[(std::size_t{y} * lens_dirt_width + x) * 4 + channel];
                    texel = std::max(texel, value);
                }
            }
    }
    return out;
}

const EffectInfo& effect_info(const LensDirt&) {
    static const EffectInfo info{
        .name = "lens_dirt",
        .doc = "Lights up dust on the lens where bright light is near.",
        .parameters = lens_dirt_rows.table(),
        .files = embedded_files("lens_dirt"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .flat = {.documented = 63, .scene_linear = 66},
        .build = build,
        .reference = lens_dirt_reference,
        .is_identity = [](const void* parameters) { return dirt_of(parameters).intensity == 0.0f; },
        .threshold = [](const void* parameters) -> std::optional<float> {
            const LensDirt& dirt = dirt_of(parameters);
            if (dirt.intensity == 0.0f) return {};
            return dirt.threshold;
        },
    };
    return info;
}

}  // namespace darkroom
