// SPDX-License-Identifier: MIT
// Passes that write more than one image, on the device and in the plan.
#include <gtest/gtest.h>

#include <array>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

struct Split {
    float amount = 1;
};

constexpr std::array<EffectFile, 2> split_files{{
    {"split_parts.glsl",
     "void shade(Pixel pixel, out vec4 result[3]) {\n"
     "    vec4 color = load(split_in, pixel.texel);\n"
     "    result[0] = vec4(color.rgb * 2.0, 1.0);\n"
     "    result[1] = vec4(color.gbr, 0.0);\n"
     "    result[2] = vec4(pixel.texel, pixel.size);\n}\n"},
    {"split.glsl",
     "vec4 split(vec4 color, Pixel pixel, Split parameters) {\n"
     "    vec4 place = load(split_third, pixel.texel);\n"
     "    vec3 sum = load(split_first, pixel.texel).rgb + load(split_second, pixel.texel).rgb;\n"
     "    return vec4(sum * parameters.amount, place.x + place.y * place.z);\n}\n"},
}};

constexpr auto split_rows = describe(field<&Split::amount>("How much of both is seen.", {0, 1}));

PassImage part(PassBuilder& builder, const char* name, std::uint32_t denominator = 1) {
    return builder.create({.name = name, .format = VK_FORMAT_R32G32B32A32_SFLOAT, .denominator = denominator});
}

void build_split(PassBuilder& builder) {
    const std::vector<PassImage> parts =
        builder.add_all({.name = "parts",
                         .shader = "split_parts.glsl",
                         .inputs = {{.name = "split_in", .image = builder.picture()}},
                         .output = part(builder, "first"),
                         .more_outputs = {part(builder, "second"), part(builder, "third")}});
    if (parts.size() != 3) return;
    builder.side("split_first", parts[0], {});
    builder.side("split_second", parts[1], {});
    builder.side("split_third", parts[2], {});
}

EffectInfo split_with(void (*build)(PassBuilder&)) {
    return {.name = "split",
            .doc = "Parts the picture.",
            .parameters = split_rows.table(),
            .files = split_files,
            .build = build};
}

class ComposePasses : public test::StackTest {};

}  // namespace

TEST_F(ComposePasses, OneWritesSeveralImagesInBothStages) {
    static const EffectInfo split = split_with(build_split);
    const ReferenceImage picture = test::round_to_float(test::random_display(37, 19, 5));
    const test::Host host(picture);
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        Composer composer(host.device);
        composer.add(split, nullptr);
        CompileDesc desc = host.compile_desc();
        desc.kernels = stage;
        const auto plan = composer.compile(desc);
        ASSERT_TRUE(plan) << plan.error().text;
        ASSERT_EQ(plan->passes.size(), 2u);
        EXPECT_EQ(plan->passes[0].more_writes.size(), 2u);
        EXPECT_EQ(plan->passes[0].bytes_written, 3u * 16 * 37 * 19);
        const ReferenceImage out = host.run(composer);
        for (std::uint32_t y = 0; y < out.height; ++y) {
            for (std::uint32_t x = 0; x < out.width; ++x) {
                const Rgba &p = picture.at(x, y), &q = out.at(x, y);
                ASSERT_EQ(q.r, static_cast<float>(2 * p.r + p.g)) << x << ", " << y;
                ASSERT_EQ(q.g, static_cast<float>(2 * p.g + p.b));
                ASSERT_EQ(q.b, static_cast<float>(2 * p.b + p.r));
                ASSERT_EQ(q.a, x + y * 37.0);
            }
        }
    }
}

// While it is off, each of its images has the neutral one in its place.
TEST_F(ComposePasses, WhatIsOffIsNeutralImageByImage) {
    static const EffectInfo split = split_with(build_split);
    const ReferenceImage picture = test::round_to_float(test::random_display(16, 8, 6));
    const test::Host host(picture);
    Composer composer(host.device);
    const Handle handle = composer.add(split, nullptr);
    test::must(composer.compile(host.compile_desc()));
    static_cast<void>(host.run(composer));
    test::must(composer.set_enabled(handle, false));
    EXPECT_EQ(test::worst_difference(host.run(composer), picture), 0);
}

TEST_F(ComposePasses, SeveralPackedImagesAreWrittenByOne) {
    static const EffectInfo split = split_with([](PassBuilder& builder) {
        const auto packed = [&](const char* name) {
            return builder.create({.name = name, .format = VK_FORMAT_B10G11R11_UFLOAT_PACK32});
        };
        const std::vector<PassImage> parts =
            builder.add_all({.name = "parts",
                             .shader = "split_parts.glsl",
                             .inputs = {{.name = "split_in", .image = builder.picture()}},
                             .output = packed("first"),
                             .more_outputs = {packed("second"), packed("third")}});
        for (std::size_t i = 0; i < parts.size(); ++i)
            builder.side(std::array{"split_first", "split_second", "split_third"}[i], parts[i], {});
    });
    const test::Host host(test::uniform(16, 8, {0.5, 0.25, 0.125, 1}));
    Composer composer(host.device);
    composer.add(split, nullptr);
    CompileDesc desc = host.compile_desc();
    desc.kernels = KernelStage::Compute;
    if (!host.device.context().traits.has_extended_storage_formats) {
        const auto plan = composer.compile(desc);
        ASSERT_FALSE(plan);
        EXPECT_TRUE(plan.error().text.ends_with("the device has no shaderStorageImageExtendedFormats"))
            << plan.error().text;
        return;
    }
    test::must(composer.compile(desc));
    const Rgba pixel = host.run(composer).at(3, 2);
    EXPECT_EQ(pixel.r, 1.25);
    EXPECT_EQ(pixel.g, 0.625);
    EXPECT_EQ(pixel.b, 0.75);
}

TEST_F(ComposePasses, OutputsHaveOneExtentAndAreAtMostFour) {
    const test::Host host(test::uniform(16, 8, {}));
    const auto error = [&](void (*build)(PassBuilder&)) {
        const EffectInfo info = split_with(build);
        Composer composer(host.device);
        composer.add(info, nullptr);
        const auto plan = composer.compile(host.compile_desc());
        return plan ? std::string() : plan.error().text;
    };
    const auto add = [](PassBuilder& builder, std::vector<PassImage> more) {
        static_cast<void>(builder.add_all({.name = "parts",
                                           .shader = "split_parts.glsl",
                                           .inputs = {{.name = "split_in", .image = builder.picture()}},
                                           .output = part(builder, "first"),
                                           .more_outputs = std::move(more)}));
    };
    static const auto add_parts = add;
    EXPECT_EQ(error([](PassBuilder& builder) { add_parts(builder, {part(builder, "half", 2)}); }),
              "effect 'split': pass 'parts' writes 'split.first' and 'split.half', which differ in extent");
    EXPECT_EQ(error([](PassBuilder& builder) {
                  add_parts(builder, {part(builder, "b"), part(builder, "c"), part(builder, "d"), part(builder, "e")});
              }),
              "effect 'split': pass 'parts' writes 5 images; at most 4 are allowed");
}

}  // namespace darkroom
