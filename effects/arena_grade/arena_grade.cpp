// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/arena_grade.hpp>

#include <array>
#include <cmath>

#include "arena_grade/arena_grade_reference.hpp"

namespace darkroom {

namespace {

constexpr auto arena_grade_rows = describe(
    field<&ArenaGrade::table>("Table that grades, read at 16 steps of each channel; without one the preset grades."),
    field<&ArenaGrade::preset>("Built-in table that is used where no table is given.").at_compile());

constexpr std::size_t entry_count = std::size_t{arena_edge} * arena_edge * arena_edge;

/// One channel of the game's table; an identity would be 17 i.
constexpr std::array<std::uint8_t, arena_edge> arena_curve{0,   15,  30,  46,  64,  82,  101, 121,
                                                           140, 158, 176, 193, 209, 224, 240, 255};
constexpr std::array<std::uint8_t, entry_count * 3> sepia{
#include "arena_grade/sepia.inc"
};

void build(PassBuilder& builder) {
    const ArenaGrade& values = *static_cast<const ArenaGrade*>(builder.parameters());
    const ResourceData* const data = builder.resource(values.table);
    const auto codes = arena_codes(values.preset, data == nullptr ? nullptr : std::get_if<ColorTable>(data));
    TableDesc desc{.name = "arena_grade_table",
                   .format = VK_FORMAT_R8G8B8A8_UNORM,
                   .extent = {arena_edge * arena_edge, arena_edge, 1},
                   .is_load_only = true,
                   .data = std::vector<std::byte>(entry_count * 4)};
    for (std::size_t i = 0; i < entry_count; ++i) {
        const std::size_t r = i % arena_edge, g = i / arena_edge % arena_edge, b = i / arena_edge / arena_edge;
        std::byte* const texel = &desc.data[(g * arena_edge * arena_edge + b * arena_edge + r) * 4];
        for (std::size_t c = 0; c < 3; ++c) texel[c] = std::byte{codes[i * 3 + c]};
    }
    builder.side("arena_grade_table", builder.table(desc), {});
}

}  // namespace

std::vector<std::uint8_t> arena_codes(ArenaTable preset, const ColorTable* given) {
    std::vector<std::uint8_t> out;
    for (std::size_t i = 0; i < entry_count; ++i) {
        const std::array<std::size_t, 3> place{i % arena_edge, i / arena_edge % arena_edge,
                                               i / arena_edge / arena_edge};
        TableColor color{};
        for (std::size_t c = 0; c < 3; ++c) color[c] = static_cast<double>(place[c]) / (arena_edge - 1.0);
        if (given != nullptr) color = evaluate(*given, color);
        for (std::size_t c = 0; c < 3; ++c) {
            if (given == nullptr && preset == ArenaTable::Arena)
                out.push_back(arena_curve[place[c]]);
            else if (given == nullptr && preset == ArenaTable::Sepia)
                out.push_back(sepia[i * 3 + c]);
            else
                out.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(color[c], 0.0, 1.0))));
        }
    }
    return out;
}

const EffectInfo& effect_info(const ArenaGrade&) {
    static const EffectInfo info{
        .name = "arena_grade",
        .doc = "Grades by a small table, masked by alpha, as in a fighting game.",
        .parameters = arena_grade_rows.table(),
        .files = embedded_files("arena_grade"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear) | Domains::only(Domain::DisplayLinear),
        .makes =
            [](ColorState before, const void*) {
                return ColorState{
                    .domain = Domain::DisplayLinear, .white_nits = before.white_nits, .peak_nits = before.white_nits};
            },
        .flat = {.documented = 71, .scene_linear = 72},
        .works = {.in = WorkingSpace::Straight},
        .build = build,
        .reference = arena_grade_reference,
    };
    return info;
}

}  // namespace darkroom
