// SPDX-License-Identifier: MIT
// Tables and pictures that a host defines, and what pointwise ends have from the CPU.

#include <cmath>
#include <limits>

#include <darkroom/describe.hpp>
#include "compose/test_stacks/host.hpp"
#include "compose/test_stacks/support.hpp"

namespace darkroom {
namespace {

struct Tinted {
    Resource table;
    float amount = 1;
};
constexpr auto tinted_rows =
    describe(field<&Tinted::table>("Its first colour is added."), field<&Tinted::amount>("How much of it.", {0, 8}));
constexpr EffectFile tinted_files[] = {
    {"tinted.glsl",
     "vec4 tinted(vec4 color, Pixel pixel, Tinted parameters) {\n"
     "    return vec4(color.rgb + tinted_custom(1).rgb + texelFetch(tinted_table, ivec2(0), 0).rgb, color.a);\n}\n"},
};
void tinted_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const auto amount = static_cast<const Tinted*>(parameters)->amount;
    out[0] = {99, 99, 99, 99};
    out[1] = {amount, 2 * amount, static_cast<float>(context.frame_extent.width), 0};
}
const EffectInfo& effect_info(const Tinted&) {
    static const EffectInfo info{.name = "tinted",
                                 .doc = "Adds a table's first colour, and what the CPU says.",
                                 .parameters = tinted_rows.table(),
                                 .files = tinted_files,
                                 .build = [](PassBuilder& builder) {
                                     std::array<float, 4> color{};
                                     const Resource table = static_cast<const Tinted*>(builder.parameters())->table;
                                     if (const ResourceData* const data = builder.resource(table))
                                         std::ranges::copy_n(std::get<ColorTable>(*data).shaper.begin(), 3,
                                                             color.begin());
                                     TableDesc desc{.name = "tint", .format = VK_FORMAT_R32G32B32A32_SFLOAT};
                                     desc.data.resize(sizeof color);
                                     std::memcpy(desc.data.data(), color.data(), sizeof color);
                                     builder.side("tinted_table", builder.table(desc), {});
                                     builder.end_constants(2, tinted_constants);
                                 }};
    return info;
}

ColorTable table_of(float r, float g, float b) { return {.shaper_size = 1, .shaper = {r, g, b}}; }

TEST(ComposeResources, EntriesOfOneKernelHaveTheirOwnTablesAndVectors) {
    for (const bool fuse : {true, false}) {
        const ReferenceImage out = test::develop(
            [](Composer& composer) {
                const auto red = composer.define(table_of(10, 0, 0)), green = composer.define(table_of(0, 20, 0));
                ASSERT_TRUE(red && green);
                composer.add(Tinted{.table = *red, .amount = 1});
                composer.add(Tinted{.table = *green, .amount = 3});
                composer.add(Tinted{.amount = 0});
            },
            test::uniform(5, 3, {0.5, 0.25, 0.125, 1}), {.fuse = fuse, .target_domain = Domain::SceneLinear});
        ASSERT_EQ(out.pixels.size(), 15u);
        const Rgba& pixel = out.at(4, 2);
        EXPECT_EQ(pixel.r, 0.5 + 1 + 3 + 10);
        EXPECT_EQ(pixel.g, 0.25 + 2 + 6 + 20);
        EXPECT_EQ(pixel.b, 0.125 + 3 * 5) << "each got the extent";
    }
}

TEST(ComposeResources, WhatDoesNotFitIsRefused) {
    Composer composer(gpu::test::device());
    const auto refusal = [&](ResourceData data) {
        const auto made = composer.define(std::move(data));
        return made ? std::string("taken") : made.error().text;
    };
    EXPECT_EQ(refusal(ColorTable{.shaper_size = 2, .shaper = {0, 0, 0}}),
              "a shaper of 2 entries: 3 numbers are given; allowed is 6");
    EXPECT_EQ(refusal(ColorTable{.size = 257}), "the edge of a cube of 257 entries: allowed is at most 256");
    EXPECT_EQ(refusal(ColorTable{.size = 2, .cube = {0}}),
              "the edge of a cube of 2 entries: 1 numbers are given; allowed is 24");
    EXPECT_EQ(refusal(ResourceImage{.width = 1, .height = 0}), "a picture of 1x0: allowed is 1x1 to 16384x16384");
    EXPECT_EQ(refusal(ResourceImage{.width = 1, .height = 1, .rgba = {0}}),
              "a picture of 1 entries: 1 numbers are given; allowed is 4");
}

TEST(ComposeResources, OneThatWasForgottenIsAnErrorOfCompile) {
    Composer composer(gpu::test::device());
    const auto table = composer.define(table_of(1, 1, 1));
    ASSERT_TRUE(table);
    composer.add(Tinted{.table = *table});
    const CompileDesc desc{.max_extent = {8, 8}};
    EXPECT_TRUE(composer.compile(desc));
    composer.forget(*table);
    const auto again = composer.compile(desc);
    ASSERT_FALSE(again);
    EXPECT_EQ(
        again.error().text,
        fmt::format("tinted.table = resource {}: the composer has none of this number; it may have been forgotten",
                    table->id));
}

}  // namespace
}  // namespace darkroom
