// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/dither.hpp>

#include <bit>
#include <cstddef>
#include <cstring>

#include "dither/dither_reference.hpp"
#include "shared/blue_noise.hpp"

namespace darkroom {

namespace {

constexpr auto dither_rows = describe(
    field<&Dither::intensity>("Width of the noise, in units of the encoded range; 2/255 hides the steps of 8 bits.",
                              {0, 1})
        .as_amount(),
    field<&Dither::ends>(
        "Mean that is kept near black and white: that of the rounded picture, or that before rounding."),
    field<&Dither::moves>("Changes the noise in each frame while time runs, for filters that average frames."));

static_assert(dither_tile_size == blue_noise_size);
constexpr std::size_t texel_count = std::size_t{dither_tile_size} * dither_tile_size;

/// Far apart on the tile, which is nearly uncorrelated over such distances: three points of the R2 sequence.
constexpr std::array<DitherOffset, 3> channel_offsets{{{0, 0}, {48, 36}, {32, 8}}};

float triangular(std::uint16_t rank) {
    const double t = 2.0 * (rank + 0.5) / texel_count - 1.0;
    return static_cast<float>(std::copysign(1.0 - std::sqrt(1.0 - std::abs(t)), t));
}

void shift_tile(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Toggle moves = static_cast<const Dither*>(parameters)->moves;
    const DitherOffset offset = moves ? dither_offset(context.time, context.frame_index) : DitherOffset{};
    out[0] = {std::bit_cast<float>(offset.y << 6u | offset.x), 0, 0, 0};
}

void build(PassBuilder& builder) {
    const auto& tile = dither_tile();
    // Single precision, because half would lose ranks, and three channels in one texel, because a load costs more than
    // all else here.
    TableDesc desc{.name = "dither_tile",
                   .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                   .extent = {dither_tile_size, dither_tile_size, 1},
                   .is_load_only = true,
                   .data = std::vector<std::byte>(sizeof tile)};
    std::memcpy(desc.data.data(), tile.data(), sizeof tile);
    builder.side("dither_tile", builder.table(desc), {});
    builder.end_constants(1, shift_tile);
}

}  // namespace

const std::array<DitherTexel, texel_count>& dither_tile() {
    static const std::array<DitherTexel, texel_count> tile = [] {
        const auto& ranks = blue_noise_ranks();
        std::array<DitherTexel, texel_count> texels{};
        for (std::uint32_t y = 0; y < dither_tile_size; ++y) {
            for (std::uint32_t x = 0; x < dither_tile_size; ++x) {
                DitherTexel& texel = texels[y * dither_tile_size + x];
                for (std::size_t channel = 0; channel < channel_offsets.size(); ++channel) {
                    const auto [dx, dy] = channel_offsets[channel];
                    const std::size_t row = (y + dy) % dither_tile_size;
                    texel[channel] = triangular(ranks[row * dither_tile_size + (x + dx) % dither_tile_size]);
                }
            }
        }
        return texels;
    }();
    return tile;
}

const EffectInfo& effect_info(const Dither&) {
    static const EffectInfo info{
        .name = "dither",
        .doc = "Hides the steps of an integer target with blue noise.",
        .parameters = dither_rows.table(),
        .files = embedded_files("dither"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::Encoded),
        .flat = {.documented = 100, .scene_linear = 100, .starts_on = true, .toggle_key = 9},
        .is_last_step = true,
        .build = build,
        .reference = dither_image_reference,
        .is_identity = [](const void* parameters) { return static_cast<const Dither*>(parameters)->intensity == 0.0f; },
    };
    return info;
}

}  // namespace darkroom
