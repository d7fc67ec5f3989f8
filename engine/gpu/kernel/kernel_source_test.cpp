// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gpu/kernel/kernel.hpp"
#include "gpu/shader/glsl_scan.hpp"
#include "gpu/shader/rewrite.hpp"

namespace darkroom::gpu {

namespace {

constexpr std::array<std::string_view, 3> functions{"sample_linear", "load", "size"};
constexpr std::array<std::string_view, 2> images{"scene", "bloom"};

std::string rewritten(std::string_view body) { return rewrite_image_calls(body, functions, images); }

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(GpuRewrite, NamesTheImageInTheFunction) {
    EXPECT_EQ(rewritten("sample_linear(scene, uv)"), "sample_linear_scene(uv)");
    EXPECT_EQ(rewritten("size ( bloom )"), "size_bloom (  )");
    EXPECT_EQ(rewritten("load(scene, ivec2(load(bloom, t).xy))"), "load_scene(ivec2(load_bloom(t).xy))");
    EXPECT_EQ(rewritten("load/* of */(scene,t)"), "load_scene/* of */(t)");
}

TEST(GpuRewrite, KeepsLines) {
    const std::string body = "load(\n    scene, // the picture\n    texel)\n";
    EXPECT_EQ(std::ranges::count(rewritten(body), '\n'), std::ranges::count(body, '\n'));
    EXPECT_EQ(rewritten(body), "load_scene(\n    // the picture\n    texel)\n");
}

TEST(GpuRewrite, LeavesEverythingElseAlone) {
    for (const std::string_view text :
         {"// load(scene, t)\n", "/* load(scene, t) */", "load(other, t)", "load(scene.x, t)", "my_load(scene, t)",
          "pixel.size", "a.load(scene, t)", "load", "load(", "load(scene", "1load(scene, t)", "/* load(scene, t)",
          "#line 3 \"a/b.glsl\"\n"}) {
        EXPECT_EQ(rewritten(text), text);
    }
}

TEST(GpuBlock, ScalarsFollowEachOtherAndVectorsStartAtAMultipleOfFour) {
    using enum BlockMember::Type;
    const std::vector<BlockMember> members{{Float, "a"}, {Vec4, "b"}, {Int, "c"}, {Uint, "flags"}, {Vec4, "d"}};
    EXPECT_EQ(block_source(members, 4),
              "    layout(offset = 16) float a;\n    layout(offset = 32) vec4 b;\n    layout(offset = 48) int c;\n"
              "    layout(offset = 52) uint flags;\n    layout(offset = 64) vec4 d;\n");
    EXPECT_EQ(word_count(members), 16u);
    EXPECT_EQ(word_count({}), 0u);
}

TEST(GpuKernelSource, DoesNotDependOnNames) {
    KernelSpec one{.name = "bloom.downsample 1",
                   .images = {{.name = "above"}},
                   .outputs = {VK_FORMAT_R8G8B8A8_UNORM},
                   .body = "body"};
    KernelSpec other = one;
    other.name = "bloom#2 \"quoted\"\n.downsample 2";
    for (const Stage stage : {Stage::Compute, Stage::Raster})
        EXPECT_EQ(kernel_source(one, stage), kernel_source(other, stage));
}

TEST(GpuKernelSource, DiffersByStageOnlyWhereItMust) {
    const KernelSpec spec{
        .name = "test",
        .images = {{.name = "scene"}, {.name = "own", .storage_format = VK_FORMAT_R16G16B16A16_SFLOAT}},
        .outputs = {VK_FORMAT_R8G8B8A8_UNORM},
        .body = "vec4 shade(Pixel pixel) { return sample_linear(scene, pixel.uv); }"};
    const std::string compute = kernel_source(spec, Stage::Compute);
    EXPECT_TRUE(has(compute, "local_size_x = 16, local_size_y = 8"));
    EXPECT_TRUE(has(compute, "textureLod(scene, darkroom_place_scene(uv), 0.0)"));
    EXPECT_TRUE(has(compute, "binding = 3, rgba16f) uniform readonly image2D own;"));
    EXPECT_TRUE(has(compute, "binding = 4, rgba8) uniform writeonly image2D result_0;"));
    const std::string raster = kernel_source(spec, Stage::Raster);
    EXPECT_FALSE(has(raster, "local_size_x"));
    EXPECT_TRUE(has(raster, "texture(scene, darkroom_place_scene(uv))"));
    EXPECT_TRUE(has(raster, "layout(location = 0) out vec4 result_0;"));
    EXPECT_TRUE(has(raster, "return sample_linear_scene(pixel.uv);"));
    EXPECT_FALSE(has(raster, "DarkroomFrame"));
}

TEST(GpuKernelSource, FormatsWithoutAGlslNameAreWrittenWithoutOne) {
    const KernelSpec spec{.name = "test", .outputs = {VK_FORMAT_B8G8R8A8_UNORM}, .body = ""};
    EXPECT_TRUE(has(kernel_source(spec, Stage::Compute), "binding = 2) uniform writeonly image2D result_0;"));
}

TEST(GpuOwnBlock, DescribesRegionsAndHoldsMembers) {
    const KernelSpec spec{.name = "test",
                          .images = {{.name = "scene"}},
                          .members = {{BlockMember::Type::Float, "gain"}, {BlockMember::Type::Uint, "mode"}},
                          .custom_vectors = 1};
    ASSERT_EQ(own_block_size(spec), 112U);
    std::array<std::byte, 112> block{};
    const Binding scene{.region = {.offset = {16, 0}, .extent = {32, 64}, .image = {64, 64}}};
    const std::array<float, 4> custom{1, 2, 3, 4};
    const std::array<std::uint32_t, 2> words{41, 42};
    write_own_block(spec, {.offset = {1, 2}, .extent = {3, 4}, .image = {9, 9}}, {&scene, 1}, {&custom, 1}, words,
                    block);
    std::array<std::int32_t, 28> integers{};
    std::array<float, 28> floats{};
    std::memcpy(integers.data(), block.data(), block.size());
    std::memcpy(floats.data(), block.data(), block.size());
    EXPECT_TRUE(std::ranges::equal(std::span(integers).first(4), std::array{1, 2, 3, 4}));
    EXPECT_TRUE(
        std::ranges::equal(std::span(floats).subspan(4, 4), std::array{1.0F / 3, 0.25F, 0.5F - 1.0F / 3, 0.125F}));
    EXPECT_TRUE(std::ranges::equal(std::span(floats).subspan(8, 4), std::array{0.5F, 1.0F, 0.25F, 0.0F}));
    // A step inside the edge texels' centres: 1/16 of a texel unless the device says more.
    EXPECT_EQ(floats[12], (16.5F + 0x1p-4F) / 64);
    EXPECT_EQ(floats[13], 0.0F) << "the region touches the image's top, where the sampler clamps";
    EXPECT_EQ(floats[14], (47.5F - 0x1p-4F) / 64);
    EXPECT_EQ(floats[15], 1.0F);
    EXPECT_TRUE(std::ranges::equal(std::span(integers).subspan(16, 4), std::array{16, 0, 32, 64}));
    EXPECT_TRUE(std::ranges::equal(std::span(floats).subspan(20, 4), custom));
    EXPECT_EQ(integers[24], 41);
    EXPECT_EQ(integers[25], 42);
}

// However the driver rounds: an effect may be singular there.
TEST(GpuOwnBlock, TheMiddleTexelOfEveryOddSizeLiesAtOneHalf) {
    const KernelSpec spec{.name = "test", .body = ""};
    std::array<std::byte, 32> block{};
    for (std::uint32_t size = 1; size <= 16384; size += 2) {
        write_own_block(spec, {.extent = {size, 1}, .image = {size, 1}}, {}, {}, {}, block);
        std::array<float, 8> floats{};
        std::memcpy(floats.data(), block.data(), block.size());
        const float texel = static_cast<float>(size / 2);
        const volatile float product = texel * floats[4];
        ASSERT_EQ(product + floats[6], 0.5F) << size;
        ASSERT_EQ(std::fma(texel, floats[4], floats[6]), 0.5F) << size;
    }
}

}  // namespace

}  // namespace darkroom::gpu
