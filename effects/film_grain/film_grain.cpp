// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/film_grain.hpp>

#include <cstddef>
#include <cstring>

#include "film_grain/film_grain_reference.hpp"

namespace darkroom {

namespace {

constexpr auto film_grain_rows = describe(
    field<&FilmGrain::amount>(
        "Standard deviation of the grain on mid-grey, in a picture of 1080 lines, in units of the encoded range.",
        {0, 0.25})
        .as_amount(),
    field<&FilmGrain::size>("Size of a grain, in a picture of 1080 lines.", {0.5, 16, Scale::Log}, unit::pixels),
    field<&FilmGrain::color>("Share of coloured grain: at 0 all channels have the same grain, at 1 each has its own.",
                             {0, 1}),
    field<&FilmGrain::shadows>("Factor of the grain at a quarter of the encoded range.", {0, 4}),
    field<&FilmGrain::midtones>("Factor of the grain at half of the encoded range.", {0, 4}),
    field<&FilmGrain::highlights>("Factor of the grain at three quarters of the encoded range.", {0, 4}),
    field<&FilmGrain::model>("Model of the grain: film draws overlapping discs, av1 filters Gaussian noise.")
        .at_compile(),
    field<&FilmGrain::animated>("Changes the grain in each frame."));

const FilmGrain& grain_of(const void* parameters) { return *static_cast<const FilmGrain*>(parameters); }

void grain_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const FilmGrain& grain = grain_of(parameters);
    const FilmGrainTile& tile = film_grain_tile(grain.model);
    const FilmGrainFrame frame = film_grain_frame(grain, context.frame_extent.height);
    out[0] = {frame.texels_a_pixel, static_cast<float>(film_grain_number(grain, context.frame_index)),
              static_cast<float>(2 * (1 - tile.across)), static_cast<float>(2 * (1 - tile.down))};
    for (std::size_t tone = 0; tone < 3; ++tone) {
        out[1][tone] = static_cast<float>(frame.gains[tone]);
        out[2][tone] = static_cast<float>(tile.means[tone]);
    }
}

void build(PassBuilder& builder) {
    const FilmGrainTile& tile = film_grain_tile(grain_of(builder.parameters()).model);
    // A texel more on each side, so that what is read between the last and the first is between them.
    constexpr std::uint32_t side = film_grain_tile_size + 2;
    TableDesc desc{.name = "film_grain_tile",
                   .format = VK_FORMAT_R8G8B8A8_UNORM,
                   .extent = {side, side, 1},
                   .data = std::vector<std::byte>(std::size_t{side} * side * 4)};
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t row = (y + film_grain_tile_size - 1) % film_grain_tile_size;
            const std::uint32_t column = (x + film_grain_tile_size - 1) % film_grain_tile_size;
            std::memcpy(&desc.data[(std::size_t{y} * side + x) * 4],
                        tile.texels[std::size_t{row} * film_grain_tile_size + column].data(), 4);
        }
    builder.side("film_grain_tile", builder.table(desc), {});
    builder.end_constants(3, grain_constants);
}

}  // namespace

const EffectInfo& effect_info(const FilmGrain&) {
    static const EffectInfo info{
        .name = "film_grain",
        .doc = "Adds the grain of film, which keeps the mean of each tone.",
        .parameters = film_grain_rows.table(),
        .files = embedded_files("film_grain"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::DisplayLinear) | Domains::only(Domain::Encoded),
        .flat = {.documented = 98, .scene_linear = 98},
        .works = {.in = WorkingSpace::Encoded},
        .build = build,
        .reference = film_grain_reference,
        .is_identity =
            [](const void* parameters) {
                const FilmGrain& grain = grain_of(parameters);
                return grain.amount == 0.0f ||
                       (grain.shadows == 0.0f && grain.midtones == 0.0f && grain.highlights == 0.0f);
            },
    };
    return info;
}

}  // namespace darkroom
