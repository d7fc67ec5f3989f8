// SPDX-License-Identifier: MIT
#include "gpu/shader/flat_values.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "gpu/test_run.hpp"

namespace darkroom::gpu {

namespace {

using enum BlockMember::Type;
using Vectors = std::vector<std::uint32_t>;

constexpr VkFormat float4 = VK_FORMAT_R32G32B32A32_SFLOAT;

KernelSpec spec_of(std::string body) {
    return {.name = "test",
            .images = {{.name = "scene"}},
            .outputs = {float4},
            .is_whole = true,
            .is_software = true,
            .members = {{Float, "gain"}, {Int, "shift"}, {Uint, "mask"}, {Float, "unused"}, {Vec4, "tint"}},
            .custom_vectors = 2,
            .body = std::move(body)};
}

Vectors own_of(const KernelSpec& spec) {
    WordsOfBlocks words(spec);
    GlslScanner scanner(spec.body);
    for (Token token = scanner.next_word(); token.kind != Token::Kind::End; token = scanner.next_word())
        words.visit(token.text, scanner);
    return flat_values(spec, words).own;
}

TEST(GpuFlatValues, AreTheVectorsThatTheBodyNames) {
    EXPECT_EQ(own_of(spec_of("custom[1] * tint")), (Vectors{0, 1, 8, 5, 6})) << "members begin at vector 7";
    EXPECT_EQ(own_of(spec_of("gain + size(scene)")), (Vectors{0, 1, 4, 7, 5, 6}));
    KernelSpec part = spec_of("gain");
    part.is_whole = false;
    EXPECT_EQ(own_of(part), (Vectors{0, 1, 2, 3, 4, 7, 5, 6})) << "a region has a place and bounds";
}

TEST(GpuFlatValues, LeaveCustomVectorsWhereTheirIndexIsNoLiteral) {
    for (const char* const body :
         {"custom[i]", "custom[1 + 2 * i]", "custom[1 + i]", "fog_custom_e1(i)", "fog_custom(1) + fog_custom(2 + i)"})
        EXPECT_EQ(own_of(spec_of(body)), (Vectors{0, 1})) << body;
    for (const char* const body : {"custom[1]", "custom /* */ [ 1 ]", "fog_custom_e1(1)",
                                   "vec4 fog_custom_e1(int index) { return custom[1 + index]; }"})
        EXPECT_EQ(own_of(spec_of(body)), (Vectors{0, 1, 5, 6})) << body;
    KernelSpec many = spec_of("custom[1]");
    many.custom_vectors = 30;
    EXPECT_EQ(own_of(many), (Vectors{0, 1})) << "all or none";
}

TEST(GpuFlatValues, AreNoneForComputeAndForGpus) {
    KernelSpec spec = spec_of("gain");
    EXPECT_TRUE(takes_flat_values(spec, Stage::Raster));
    EXPECT_FALSE(takes_flat_values(spec, Stage::Compute));
    spec.is_software = false;
    EXPECT_FALSE(takes_flat_values(spec, Stage::Raster));
}

std::vector<std::byte> bits_of(const KernelSpec& spec, const test::Run& values) {
    const std::unique_ptr<Kernel> kernel = test::must(Kernel::create(test::context(), spec, Stage::Raster));
    test::Picture in =
        test::upload(test::context(),
                     test::make_pixels(40, 30,
                                       [](std::uint32_t x, std::uint32_t y) {
                                           return std::array{static_cast<float>(x), static_cast<float>(y), 3.0F, 4.0F};
                                       }),
                     float4);
    test::Picture out = test::blank(test::context(), {37, 23}, float4);
    test::Run run = values;
    run.inputs = {&in};
    run.outputs = {&out};
    if (!spec.is_whole) {
        run.output_region = {.offset = {5, 3}, .extent = {31, 17}, .image = {37, 23}};
        run.input_regions = {{.offset = {2, 7}, .extent = {25, 14}, .image = {40, 30}}};
    }
    test::run_kernel(test::context(), *kernel, run);
    return test::download_bytes(test::context(), out);
}

TEST(GpuFlatValues, AreTheBitsOfTheBlock) {
    if (!writes_flat_values(test::context())) GTEST_SKIP() << "this device's vertices write too little";
    // Integers that are denormal or NaN as numbers among them.
    const test::Run values{.custom = {{1.5F, -2, 3e-39F, 4}, {5, 6, 7, 8}},
                           .words = {std::bit_cast<std::uint32_t>(0.3F), 0xFFFFFFFDU, 0x7F812345U, 0,
                                     std::bit_cast<std::uint32_t>(9.0F), 1, 2, 0x80000001U}};
    for (const std::string index : {"1", "pixel.texel.x & 1"}) {
        KernelSpec spec =
            spec_of("vec4 shade(Pixel pixel) {\n    vec4 a = custom[0], b = custom[" + index +
                    "];\n"
                    "    vec4 bits = uintBitsToFloat(uvec4(mask ^ 0x41000000u, shift, mask, 0) & 0x7FFFFFu "
                    "| 0x3F800000u);\n"
                    "    vec4 color = load(scene, pixel.texel * size(scene) / pixel.size);\n"
                    "    return a * gain + b + bits + color + tint.x + vec4(pixel.uv, tint.yz * 1e38);\n"
                    "}\n");
        for (const bool is_whole : {true, false}) {
            spec.is_whole = is_whole;
            spec.is_software = true;
            ASSERT_TRUE(takes_flat_values(spec, Stage::Raster));
            const std::vector<std::byte> flat = bits_of(spec, values);
            spec.is_software = false;
            EXPECT_EQ(flat, bits_of(spec, values)) << index << (is_whole ? ", whole" : ", regions");
        }
    }
}

// What is too much stays in the block; the validation layer knows the limit.
TEST(GpuFlatValues, AreNoMoreThanVerticesMayWrite) {
    if (!writes_flat_values(test::context())) GTEST_SKIP() << "this device's vertices write too little";
    KernelSpec spec = spec_of("");
    test::Run values{.custom = {{}, {}}};
    spec.members.clear();
    std::string sum;
    for (std::uint32_t i = 0; i < 160; ++i) {
        spec.members.push_back({Float, "number_" + std::to_string(i)});
        values.words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(i)));
        sum += " + number_" + std::to_string(i) + " * " + std::to_string(i % 7);
    }
    spec.body = "vec4 shade(Pixel pixel) { return custom[1]" + sum + "; }";
    ASSERT_EQ(own_of(spec).size(), (128U - 7U) / 4U) << "components, less those of position, point size and distances";
    const std::vector<std::byte> flat = bits_of(spec, values);
    spec.is_software = false;
    EXPECT_EQ(flat, bits_of(spec, values));
}

}  // namespace

}  // namespace darkroom::gpu
