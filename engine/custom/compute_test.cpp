// SPDX-License-Identifier: MIT
// Files with compute passes, buffers, values and passes of several images: as they are read, and run by a Composer.
#include <gtest/gtest.h>

#include <cmath>
#include <darkroom/custom_effect.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "compose/test_stacks/host.hpp"
#include "compose/test_stacks/support.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

using gpu::test::must;

const std::filesystem::path source_tree{test::source_folder};

std::string file_text(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
}

std::string compute_error(const std::string& text) {
    const auto effect = CustomEffect::parse(text, "my.glsl");
    return effect ? "" : effect.error().text;
}
/// The error of a file of these lines and of the functions that they ask for.
std::string compute_error_of_lines(const std::string& lines) {
    return compute_error("// @effect mine: Mine.\n" + lines + "\nmine( mine_one( mine_two(\n");
}

/// Greys, each exactly a code of 8 bits.
ReferenceImage codes_of(std::uint32_t width, std::uint32_t height) {
    ReferenceImage out(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const double grey = ((x * 7 + y * x * 3 + y) % 256) / 255.0;
            out.at(x, y) = {grey, grey, grey, 1};
        }
    return test::round_to_float(out);
}

}  // namespace

TEST(ComposeCustomCompute, TheHistogramOfThePageCountsAsTheCpuDoes) {
    const CustomEffect effect = must(CustomEffect::load(source_tree / "examples/histogram.glsl"));
    for (const auto& [width, height] : {std::pair{256u, 100u}, {53u, 37u}, {1u, 1u}}) {
        const ReferenceImage picture = codes_of(width, height);
        std::vector<float> counts(256, 0.0F);
        for (const Rgba& pixel : picture.pixels) ++counts[static_cast<std::size_t>(std::lround(pixel.g * 255))];
        const double most = *std::ranges::max_element(counts);
        const test::Host host(picture);
        for (const bool is_fused : {true, false}) {
            Composer composer(host.device, {.frames_in_flight = 1});
            composer.add(effect.info(), nullptr);
            CompileDesc desc = host.compile_desc();
            desc.fuse = is_fused;
            must(composer.compile(desc));
            for (int i = 0; i < 2; ++i) must(host.record(composer, host.frame()));
            const auto read = composer.value("histogram.levels").numbers;
            EXPECT_EQ(std::vector<float>(read.begin(), read.end()), counts);
            const ReferenceImage out = host.read_target();
            for (std::uint32_t y = 0; y < height; ++y)
                for (std::uint32_t x = 0; x < width; ++x) {
                    const double u = (x + 0.5) / width, up = 1 - (y + 0.5) / height;
                    const double bar = 0.5 * double{counts[static_cast<std::size_t>(u * 256)]} / most;
                    if (std::abs(up - bar) < 1e-5 || std::abs(u * 256 - std::round(u * 256)) < 1e-3) continue;
                    EXPECT_NEAR(out.at(x, y).b, up < bar ? 0.3 : picture.at(x, y).b, 1e-6) << x << " " << y;
                }
        }
    }
}

TEST(ComposeCustomCompute, ThePageShowsWhatTheFileHolds) {
    std::istringstream page(file_text(source_tree / "docs/custom_effects.md"));
    const std::string file = file_text(source_tree / "examples/histogram.glsl");
    std::size_t lines = 0;
    bool is_inside = false;
    for (std::string line; std::getline(page, line);) {
        if (line == "```") is_inside = false;
        if (line.starts_with("// @effect histogram:")) is_inside = true;
        if (!is_inside || line.empty() || line.find("...") != std::string::npos) continue;
        ++lines;
        EXPECT_NE(file.find(line + "\n"), std::string::npos) << line;
    }
    EXPECT_GT(lines, 15u);
}

TEST(ComposeCustomCompute, APassWritesSeveralImages) {
    const CustomEffect effect = must(CustomEffect::parse(
        "// @effect apart: Exchanges red and blue.\n"
        "// @image low: 1 rgba32f\n// @image high: 1 rgba32f\n"
        "// @pass parts: picture -> low high\n"
        "void apart_parts(Pixel pixel, Apart parameters, out vec4 result[2]) {\n"
        "    vec4 color = load(picture, pixel.texel);\n    result[0] = color.bgra;\n    result[1] = 2.0 * color;\n}\n"
        "// @end low high\n"
        "vec4 apart(vec4 color, Pixel pixel, Apart parameters) {\n"
        "    return load(high, pixel.texel) - vec4(load(low, pixel.texel).bgr, 1.0);\n}\n",
        "apart.glsl"));
    const ReferenceImage picture = test::round_to_float(test::random_display(21, 13, 2));
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(effect.info(), nullptr); },
                                                 picture, {.kernels = stage});
        EXPECT_LE(test::worst_difference(out, picture), 1e-6);
    }
}

TEST(ComposeCustomCompute, ImagesAreWrittenByStore) {
    const CustomEffect effect =
        must(CustomEffect::parse("// @effect turn: Turns the picture by half a turn.\n"
                                 "// @image turned: 1 rgba32f\n// @result turned\n"
                                 "// @compute whole 8x8: picture -> turned\n"
                                 "void turn_whole(Turn parameters) {\n"
                                 "    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);\n"
                                 "    if (any(greaterThanEqual(texel, size(turned)))) return;\n"
                                 "    store(turned, size(turned) - 1 - texel, load(picture, texel));\n}\n",
                                 "turn.glsl"));
    const ReferenceImage picture = test::round_to_float(test::random_display(21, 13, 2));
    ReferenceImage turned = picture;
    std::ranges::reverse(turned.pixels);
    const ReferenceImage out =
        test::develop([&](Composer& composer) { composer.add(effect.info(), nullptr); }, picture);
    EXPECT_EQ(test::worst_difference(out, turned), 0);
}

TEST(CustomCompute, ErrorsNameTheLineTheThingAndWhatIsAllowed) {
    const std::string value = "// @value one: 4\n", write = "// @compute one 1x1 1x1: -> one\n";
    EXPECT_EQ(compute_error_of_lines("// @value one"), "my.glsl:2: one: nothing: expected a count in [1, 4096]");
    EXPECT_EQ(compute_error_of_lines("// @value one: 4097"), "my.glsl:2: one: 4097: expected a count in [1, 4096]");
    EXPECT_EQ(compute_error_of_lines(value + value), "my.glsl:3: one: declared twice");
    EXPECT_EQ(compute_error_of_lines(value), "my.glsl:1: value one: no pass writes it");
    EXPECT_EQ(compute_error_of_lines("// @value mine_one: 1\n// @compute one 1x1 1x1: -> mine_one"),
              "my.glsl:1: value mine_one: names that begin with the effect's name are for functions");
    EXPECT_EQ(compute_error_of_lines("// @buffer one: 4"),
              "my.glsl:2: one: type nothing: allowed is uint, int, float, vec2, vec4, ivec2, ivec4, uvec4");
    EXPECT_EQ(compute_error_of_lines("// @buffer one: 4 uint\n" + write + "// @end one"),
              "my.glsl:4: @end reads 'one': a buffer is for @compute passes, a @value for all");
    EXPECT_EQ(compute_error_of_lines(value + "// @end one"),
              "my.glsl:3: @end reads 'one', which no pass before it writes");
    EXPECT_EQ(compute_error_of_lines(value + "// @compute one: -> one"),
              "my.glsl:3: pass one: workgroup nothing: expected WIDTHxHEIGHT, at most 128 together");
    EXPECT_EQ(compute_error_of_lines(value + "// @compute one 16x16: -> one"),
              "my.glsl:3: pass one: workgroup 16x16: expected WIDTHxHEIGHT, at most 128 together");
    EXPECT_EQ(compute_error_of_lines(value + "// @compute one 16x8 0x1: -> one"),
              "my.glsl:3: pass one: groups 0x1: expected WIDTHxHEIGHT, at most 128 together");
    EXPECT_EQ(compute_error_of_lines(value + "// @compute one 16x8: -> one"),
              "my.glsl:3: pass one: no image whose size says how many groups there are: give their number, as in "
              "`@compute one 64x1 1x1`");
    EXPECT_EQ(compute_error_of_lines(value + write + "// @compute two 1x1 1x1: one -> one"),
              "my.glsl:4: pass two names 'one' twice: what it writes it may read, too");
    EXPECT_EQ(compute_error_of_lines("// @image one: 1 rg8\n// @compute one 8x8: -> one"),
              "my.glsl:3: pass one writes 'one': allowed for @compute is rgba16f, rgba32f, rgba8, r32f");
    EXPECT_EQ(compute_error_of_lines("// @image one: 1 r8\n// @image two: 1/2 r8\n// @pass one: -> one two"),
              "my.glsl:4: pass one writes 'one' and 'two', which differ in size");
    EXPECT_EQ(compute_error_of_lines("// @pass one: -> a b c d e"),
              "my.glsl:2: pass one writes 5 images; at most 4 are allowed");
    EXPECT_EQ(
        compute_error("// @effect mine: Mine.\n" + value + write + "shared float x;\nmine_one(\n// @end one\nmine("),
        "");
    EXPECT_EQ(
        compute_error_of_lines(value + write + "\nshared bool x;\n// @end one"),
        "my.glsl:5: shared: expected `shared TYPE NAME[COUNT];`, TYPE one of uint, int, float, vec2, vec4, ivec2, "
        "ivec4, uvec4");
    EXPECT_EQ(compute_error_of_lines(value + write + "shared vec4 x[1024];\nshared float y;\n// @end one"),
              "my.glsl:5: shared: more than 16384 bytes; as many are allowed");
    EXPECT_EQ(compute_error_of_lines("shared float x;\n"),
              "my.glsl:2: shared: the code of a @compute pass alone has such variables");
    EXPECT_EQ(compute_error("// @effect mine: Mine.\n" + value + write + "// @end one\nmine("),
              "my.glsl:3: no function mine_one: expected `void mine_one(Mine parameters)`");
}

TEST(ComposeCustomCompute, AFaultIsThatOfTheFilesLine) {
    const CustomEffect effect =
        must(CustomEffect::parse("// @effect bad: Bad.\n// @value one: 1\n"
                                 "// @compute one 1x1 1x1: -> one\n"
                                 "void bad_one(Bad parameters) {\n    one[0] = nothing;\n}\n"
                                 "// @end one\n"
                                 "vec4 bad(vec4 color, Pixel pixel, Bad parameters) { return color * one[0]; }\n",
                                 "bad.glsl"));
    const test::Host host(test::uniform(4, 4, {}));
    Composer composer(host.device);
    composer.add(effect.info(), nullptr);
    const auto plan = composer.compile(host.compile_desc());
    ASSERT_FALSE(plan);
    EXPECT_NE(plan.error().text.find("bad.glsl:5"), std::string::npos) << plan.error().text;
    EXPECT_NE(plan.error().text.find("nothing"), std::string::npos) << plan.error().text;
}

TEST(ComposeCustomCompute, RunsOnTheSmallestDevice) {
    const CustomEffect effect = must(CustomEffect::load(source_tree / "examples/histogram.glsl"));
    const ReferenceImage picture = codes_of(61, 33);
    std::vector<ReferenceImage> out;
    for (Device* const device : {&gpu::test::device(), &gpu::test::shared_device.smallest()}) {
        const test::Host host(picture, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, *device);
        Composer composer(*device);
        composer.add(effect.info(), nullptr);
        must(composer.compile(host.compile_desc()));
        out.push_back(host.run(composer));
    }
    EXPECT_EQ(test::worst_difference(out[0], out[1]), 0);
}

}  // namespace darkroom
