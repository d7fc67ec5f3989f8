// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/lut.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "lut/lut_reference.hpp"

namespace darkroom {

namespace {

constexpr auto lut_rows =
    describe(field<&Lut::lut>("Table that colours are looked up in.").as_amount(),
             field<&Lut::fade_to>("Second table for the same space, which `fade` fades to."),
             field<&Lut::fade>("Share of the second table in the result.", {0, 1}),
             field<&Lut::strength>("Share of the result that goes over the picture.", {0, 1}),
             field<&Lut::space>("Colours that the tables expect: sRGB code values, or scene-linear light, as it is "
                                "(`linear`), in stops or through a curve of a camera."),
             field<&Lut::result>(
                 "Colours that the tables give: the same kind that they expect, or sRGB code values for a display."),
             field<&Lut::interpolation>("Interpolation between the entries of a 3D table."));

using Texel = std::array<float, 4>;

/// As wide as every device allows; a cube of 256 is then a little higher.
constexpr std::uint32_t row_length = 4096;

/// A cube that changes nothing between the least and the greatest entry of a shaper: what a 1D table has for a cube.
ColorTable with_cube(ColorTable table) {
    if (table.size > 0) return table;
    table.size = 2;
    for (std::size_t i = 0; i < table.shaper.size(); ++i) {
        float& low = table.min[i % 3];
        float& high = table.max[i % 3];
        low = i < 3 ? table.shaper[i] : std::min(low, table.shaper[i]);
        high = i < 3 ? table.shaper[i] : std::max(high, table.shaper[i]);
    }
    for (std::size_t i = 0; i < 3; ++i)
        if (!(table.min[i] < table.max[i])) table.max[i] = table.min[i] + 1;
    for (std::size_t corner = 0; corner < 8; ++corner)
        for (std::size_t i = 0; i < 3; ++i) table.cube.push_back((corner >> i & 1) != 0 ? table.max[i] : table.min[i]);
    return table;
}

/// coordinate = value * scale + offset, 0 at `min` and count - 1 at `max`.
void add_inputs(std::vector<Texel>& list, const std::array<float, 3>& min, const std::array<float, 3>& max,
                std::uint32_t count) {
    Texel scale{}, offset{};
    for (std::size_t i = 0; i < 3 && count > 0; ++i) {
        const double step = (count - 1.0) / (double{max[i]} - double{min[i]});
        scale[i] = static_cast<float>(step);
        offset[i] = static_cast<float>(-double{min[i]} * step);
    }
    scale[3] = static_cast<float>(count);
    list.push_back(scale);
    list.push_back(offset);
}

TableDesc image_of(std::string name, VkExtent3D extent, std::vector<Texel> texels) {
    texels.resize(std::size_t{extent.width} * extent.height * extent.depth);
    // Single precision: in half, entries would be off by a code of 10 bits.
    TableDesc desc{.name = std::move(name),
                   .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                   .extent = extent,
                   .data = std::vector<std::byte>(texels.size() * sizeof(Texel))};
    std::memcpy(desc.data.data(), texels.data(), desc.data.size());
    return desc;
}

TableDesc cube_image(std::string name, const ColorTable& table) {
    std::vector<Texel> texels;
    texels.reserve(table.cube.size() / 3);
    for (std::size_t i = 0; i < table.cube.size(); i += 3)
        texels.push_back({table.cube[i], table.cube[i + 1], table.cube[i + 2]});
    // What lies beyond the last entry is loaded, too.
    const std::uint32_t edge = table.size, loaded = edge * edge * edge + edge * edge + edge + 1;
    TableDesc desc = image_of(std::move(name), {row_length, loaded / row_length + 1, 1}, std::move(texels));
    desc.is_load_only = true;
    return desc;
}

/// Two slices of rows of 256: texel `number` of the list is where lut_listed() looks for it.
TableDesc shaper_image(std::string name, const ColorTable& table) {
    std::vector<Texel> list;
    add_inputs(list, table.shaper_min, table.shaper_max, table.shaper_size);
    add_inputs(list, table.min, table.max, table.size);
    for (std::size_t i = 0; i < table.shaper.size(); i += 3)
        list.push_back({table.shaper[i], table.shaper[i + 1], table.shaper[i + 2]});
    const VkExtent3D extent{256, static_cast<std::uint32_t>(list.size() / 512) + 1, 2};
    const std::size_t slice = std::size_t{extent.width} * extent.height;
    std::vector<Texel> texels(slice * 2);
    for (std::size_t number = 0; number < list.size(); ++number)
        texels[(number & 1) * slice + (number >> 1)] = list[number];
    return image_of(std::move(name), extent, std::move(texels));
}

void add_sides(PassBuilder& builder, const std::string& cube, const std::string& shaper, const ColorTable& table,
               bool has_shaper) {
    builder.side(cube, builder.table(cube_image(cube, table)), {});
    builder.side(
        shaper, builder.table(has_shaper ? shaper_image(shaper, table) : image_of(shaper, {table.size, 1, 1}, {})), {});
}

const ColorTable* table_of(const PassBuilder& builder, Resource resource) {
    const ResourceData* const data = builder.resource(resource);
    return data == nullptr ? nullptr : std::get_if<ColorTable>(data);
}

void build(PassBuilder& builder) {
    const Lut& values = *static_cast<const Lut*>(builder.parameters());
    const ColorTable* const named = table_of(builder, values.lut);
    const ColorTable table = with_cube(named == nullptr ? lut_identity() : *named);
    const ColorTable plain;
    add_sides(builder, "lut_table", "lut_shaper", table,
              table.shaper_size > 0 || table.min != plain.min || table.max != plain.max);
    const ColorTable* const next = table_of(builder, values.fade_to);
    add_sides(builder, "lut_next", "lut_next_shaper", next == nullptr ? lut_identity() : with_cube(*next),
              next != nullptr);
}

ColorState makes(ColorState before, const void* parameters) {
    const Lut& values = *static_cast<const Lut*>(parameters);
    const bool is_display = values.space == LutSpace::Display || values.result == LutResult::Display;
    if (!is_display) return before;
    return {.domain = Domain::DisplayLinear, .white_nits = before.white_nits, .peak_nits = before.white_nits};
}

}  // namespace

const EffectInfo& effect_info(const Lut&) {
    static const EffectInfo info{
        .name = "lut",
        .doc = "Looks colours up in a table.",
        .parameters = lut_rows.table(),
        .files = embedded_files("lut"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear) | Domains::only(Domain::DisplayLinear),
        .accepts_now =
            [](const void* parameters) {
                const bool is_display = static_cast<const Lut*>(parameters)->space == LutSpace::Display;
                return Domains::only(Domain::SceneLinear) |
                       (is_display ? Domains::only(Domain::DisplayLinear) : Domains());
            },
        .makes = makes,
        .flat = {.documented = 87, .scene_linear = 78, .starts_on = false},
        .works = {.in = WorkingSpace::Straight},
        .build = build,
        .reference = lut_reference,
        .is_identity =
            [](const void* parameters) {
                const Lut& values = *static_cast<const Lut*>(parameters);
                return values.lut.id == 0 || values.strength == 0.0f;
            },
    };
    return info;
}

}  // namespace darkroom
