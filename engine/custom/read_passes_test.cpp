// SPDX-License-Identifier: MIT
// Files that declare passes, images, histories and tables, as they are read.
#include <gtest/gtest.h>

#include <darkroom/custom_effect.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "gpu/test_run.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

using gpu::test::must;

const std::filesystem::path example_files = std::filesystem::path(test::source_folder) / "examples";

std::string error_of_file(const std::string& text) {
    const auto effect = CustomEffect::parse(text, "my.glsl");
    return effect ? "" : effect.error().text;
}
/// The error of a file of these lines and of the functions that they ask for.
std::string error_of_lines(const std::string& lines) {
    return error_of_file("// @effect mine: Mine.\n" + lines + "\nmine( mine_one( mine_two(\n");
}

TEST(CustomPasses, AreReadWithTheirImagesAndTheirCode) {
    const CustomEffect effect = must(CustomEffect::load(example_files / "two_pass_blur.glsl"));
    const EffectInfo& info = effect.info();
    EXPECT_EQ(info.touch, Touch::Neighbourhood);
    ASSERT_EQ(info.files.size(), 2u);
    EXPECT_EQ(info.files[0].name, "two_pass_blur_across.glsl");
    EXPECT_NE(info.files[0].text.find("two_pass_blur_reach"), std::string_view::npos);
    EXPECT_EQ(info.files[0].text.find("two_pass_blur_down("), std::string_view::npos);
    EXPECT_FALSE(info.pre_roll);

    const CustomEffect trail = must(CustomEffect::load(example_files / "feedback_trail.glsl"));
    EXPECT_EQ(trail.info().touch, Touch::Pointwise);
    ASSERT_TRUE(trail.info().pre_roll);
    EXPECT_EQ(trail.info().pre_roll(trail.info().parameters.defaults.data(), 1.0 / 60), 110u);
}

TEST(CustomPasses, ErrorsNameTheLineTheThingAndWhatIsAllowed) {
    const std::string image = "// @image one: 1 rgba16f\n", pass = "// @pass one: picture -> one\n";
    EXPECT_EQ(error_of_lines(image + "// @pass one: picture two -> one"),
              "my.glsl:3: pass one reads 'two': there is no such image, there are picture, source, one");
    EXPECT_EQ(error_of_lines(image + "// @pass one: one -> one"),
              "my.glsl:3: pass one reads 'one', which no pass before it writes");
    EXPECT_EQ(error_of_lines(image + "// @image two: 1 r8\n// @pass one: two -> one\n// @pass two: one -> two"),
              "my.glsl:4: pass one reads 'two', which no pass before it writes")
        << "a cycle";
    EXPECT_EQ(error_of_lines(image + pass + "// @pass two: one -> one"),
              "my.glsl:4: pass two writes 'one', which a pass before it writes");
    EXPECT_EQ(error_of_lines(image + pass + "// @pass two: picture -> one"),
              "my.glsl:4: pass two writes 'one', which a pass before it writes");
    EXPECT_EQ(error_of_lines(image + "// @pass one: picture -> two"),
              "my.glsl:3: pass one writes 'two': expected an image or a history of the file");
    EXPECT_EQ(error_of_lines(image + "// @pass one: picture picture -> one"),
              "my.glsl:3: pass one reads 'picture' twice");
    EXPECT_EQ(error_of_lines(image + "// @pass one picture"),
              "my.glsl:3: one picture: a name is made of lower-case "
              "letters, digits and single underscores, and begins with "
              "a letter");
    EXPECT_EQ(error_of_lines(image + "// @pass one: picture"),
              "my.glsl:3: pass one: expected `@pass one: IMAGE IMAGE -> IMAGE`");
    EXPECT_EQ(error_of_lines(image + pass),
              "my.glsl:1: passes without an end or a result: expected `// @end IMAGE` above the function mine, or `// "
              "@result "
              "IMAGE`");
    EXPECT_EQ(error_of_lines(image + pass + "// @end two"),
              "my.glsl:4: @end reads 'two': there is no such image, there are picture, source, one");
    EXPECT_EQ(error_of_lines(image + "// @result one\n" + pass + "// @end one"),
              "my.glsl:5: @end: the effect's picture is @result one, it has no end");
    EXPECT_EQ(error_of_lines(image), "my.glsl:1: image one: no pass writes it");
    EXPECT_EQ(error_of_file("// @effect mine: Mine.\n// @image one: 1 r8\n// @result one\n// @pass one: -> one\nmine("),
              "my.glsl:4: no function mine_one: expected `vec4 mine_one(Pixel pixel, Mine parameters)`");
    EXPECT_EQ(error_of_lines("// @image one: 1/2 rgba17f"),
              "my.glsl:2: one: format rgba17f: allowed is rgba16f, rgba32f, rgba8, rg16f, rg32f, rg8, r16f, r32f, r8, "
              "r11f_g11f_b10f");
    for (const char* const size : {"0", "1/0", "3", "-1", "1e9", "99999999999", "x", "1/2/3"})
        EXPECT_EQ(error_of_lines(std::string("// @image one: ") + size + " r8"),
                  std::string("my.glsl:2: one: size ") + size +
                      ": expected its share of the picture, as 1, 1/2 or 3/4, at most 2");
    EXPECT_EQ(error_of_lines(image + image), "my.glsl:3: one: declared twice");
    for (const char* const name : {"picture", "source", "frame_depth", "load", "one_previous", "color"})
        EXPECT_EQ(error_of_lines(std::string("// @image ") + name + ": 1 r8"),
                  std::string("my.glsl:2: ") + name + ": is taken by the notation or by GLSL; choose another name");
    EXPECT_EQ(error_of_lines("// @image half: 1 r8"), "my.glsl:2: half: a keyword of GLSL");
    EXPECT_EQ(error_of_lines("// @image mine_one: 1 r8\n// @pass one: -> mine_one\n// @end mine_one"),
              "my.glsl:1: image mine_one: names that begin with the effect's name are for functions");
    EXPECT_EQ(
        error_of_lines("// @history one: 1 r8\n" + pass + "// @end one"),
        "my.glsl:1: a history without `@pre_roll FRAMES`, the number of earlier frames that a right picture needs");
    EXPECT_EQ(error_of_lines("// @pre_roll 3"), "my.glsl:1: @pre_roll: the file has no history");
    EXPECT_EQ(error_of_lines("// @pre_roll 9999"),
              "my.glsl:2: @pre_roll 9999: expected a number of frames in [0, 1000]");
    EXPECT_EQ(error_of_lines("// @result one"),
              "my.glsl:2: @result one: expected an image or a history that a line before it declares");
    EXPECT_EQ(error_of_file("// @effect mine: Mine.\nvec4 mine(vec4 color, Pixel pixel, Mine parameters) { return "
                            "load(frame_depth, x); }"),
              "my.glsl:1: frame_depth: read without `@needs depth`");
    EXPECT_EQ(error_of_lines(image + pass + "// @param toggle a = on: A."),
              "my.glsl:4: @param: stands above the code, the passes and the end");
    EXPECT_EQ(error_of_lines("// @touch warp\n" + image + "// @result one\n" + pass),
              "my.glsl:1: @touch warp: with @result the passes make the picture");
}

TEST(CustomPasses, TablesAreReadAndCounted) {
    EXPECT_EQ(error_of_lines("// @table one: 2x1 r32f = 1,\n//   2e3\n// @end one"), "");
    EXPECT_EQ(error_of_lines("// @table one: 2x1 rgba8 = 0, 1, 0.5, 1, 0, 0, 0,\n// 1\n// @end one"), "");
    EXPECT_EQ(error_of_lines("// @table one: 2x1 r32f = 1, 2, 3"),
              "my.glsl:2: one: 3 values, its 2 x 1 texels of one take 2");
    EXPECT_EQ(error_of_lines("// @table one: 2x1 rgba8 ="),
              "my.glsl:2: one: 0 values, its 2 x 1 texels of four take 8");
    EXPECT_EQ(error_of_lines("// @table one: 1x1 r8 = 1.5"), "my.glsl:2: one: value 1.5: expected a number in [0, 1]");
    EXPECT_EQ(error_of_lines("// @table one: 1x1 r32f = nan"), "my.glsl:2: one: value nan: expected a number");
    EXPECT_EQ(error_of_lines("// @table one: 1x1 r32f = 1e39"), "my.glsl:2: one: value 1e39: expected a number");
    EXPECT_EQ(error_of_lines("// @table one: 1x1 rgba16f = 1"),
              "my.glsl:2: one: rgba16f: allowed is r32f, rgba32f, r8, rgba8");
    for (const char* const size : {"0x1", "1", "65536x65536", "4097x1", "1x", "ax1"})
        EXPECT_EQ(error_of_lines(std::string("// @table one: ") + size + " r8 = 1"),
                  std::string("my.glsl:2: one: ") + size + ": expected WIDTHxHEIGHT, at most 4096 texels");
}

TEST(CustomPasses, CountsHaveBounds) {
    std::string images, passes, parameters;
    for (int i = 0; i < 40; ++i) {
        images += "// @image a" + std::to_string(i) + ": 1 r8\n";
        passes += "// @pass a" + std::to_string(i) + ": -> a" + std::to_string(i) + "\n";
    }
    for (int i = 0; i < 100; ++i) parameters += "// @param toggle a" + std::to_string(i) + " = on: A.\n";
    EXPECT_EQ(error_of_lines(images), "my.glsl:18: a16: a file has at most 16 images");
    EXPECT_EQ(error_of_lines(parameters), "my.glsl:66: a64: a file has at most 64 parameters");
    std::string reads = "// @end";
    for (int i = 0; i < 9; ++i) reads += " a" + std::to_string(i);
    std::string some = images.substr(0, images.find("// @image a9")),
                writers = passes.substr(0, passes.find("// @pass a9"));
    EXPECT_EQ(error_of_lines(some + writers + reads), "my.glsl:20: @end reads more than 8 images");
    EXPECT_EQ(error_of_file(std::string(CustomEffect::max_bytes + 1, ' ')),
              "my.glsl: 65537 bytes, the file of an effect has at most 65536");
}

TEST(CustomPasses, DamagedTextIsRefusedOrReadAndNeverTrusted) {
    for (const char* const name : {"two_pass_blur.glsl", "feedback_trail.glsl"}) {
        std::ifstream file(example_files / name);
        const std::string whole{std::istreambuf_iterator<char>(file), {}};
        ASSERT_EQ(error_of_file(whole), "");
        for (std::size_t i = 0; i < whole.size(); ++i) {
            static_cast<void>(error_of_file(whole.substr(0, i)));
            std::string other = whole;
            for (const char c : {'\n', '@', ':', '\0', '\xff'}) {
                other[i] = c;
                static_cast<void>(error_of_file(other));
            }
        }
    }
}

TEST(CustomPasses, CodeDeclaresNothingOfTheKernel) {
    const auto says = [](const std::string& code, const std::string& part) {
        const std::string text = error_of_file("// @effect mine: Mine.\n" + code + "\nmine(");
        EXPECT_TRUE(text.starts_with("my.glsl:2: " + part)) << code << " -> " << text;
    };
    says("layout(binding = 9) buffer Mine { float a; };", "layout: the kernel around");
    says("uniform float a;", "uniform: the kernel around");
    says("void main() {}", "main: the kernel around");
    says("#version 460", "#version 460: allowed is `#include");
    says("#extension GL_EXT_buffer_reference : require", "#extension");
    says("#include \"/etc/passwd\"", "#include");
    says("  #pragma x", "#pragma");
    says("#define A(x) x x", "#define A(x): expected a name without parameters");
    says("#define A " + std::string(500, 'x'), "#define A: a value of at most 120 characters");
    says("#define A 1\\\n", "a backslash");
    says("#define A uniform", "uniform: the kernel around");
    says("#define A #define pow min", "#define A: its value does not end in its line");
    says("#define A 1 /* begins", "#define A: its value does not end in its line");
    std::string sum = "float mine_sum(float x) { return x";
    for (int i = 0; i < 1000; ++i) sum += "+x";
    says(sum + "; }", "a statement of more than 2000 words and marks");
    const std::string half(100, '+');
    std::string halves = "#define A " + half + "\nfloat mine_sum(float x) { return x";
    for (int i = 0; i < 30; ++i) halves += " A";
    EXPECT_EQ(error_of_file("// @effect mine: Mine.\n" + halves + "; }\nmine("),
              "my.glsl:3: a statement of more than 2000 words and marks");
    // A compiler writes it out 2^20 times; a name that stands before its function, too.
    std::string calls = "float mine_0(float x) { return sin(x); }\n";
    for (int i = 1; i <= 20; ++i)
        calls = fmt::format(
            "float mine_{0}(float x);\n{1}float mine_{2}(float x) {{ return mine_{0}(x) + mine_{0}(-x); }}\n", i - 1,
            calls, i);
    const auto whole_file_says = [](const std::string& code, const std::string& part) {
        const std::string text = error_of_file("// @effect mine: Mine.\n" + code + "\nmine(");
        EXPECT_TRUE(text.starts_with("my.glsl:1: ") && text.find(part) != std::string::npos) << code << " -> " << text;
    };
    whole_file_says(calls, ": a function of more than 65536 words and marks, those of all that it calls included");
    const std::string array = "an array of more than 4096 elements, those of structs included";
    whole_file_says("float mine_0(float x) { float a[4097]; return a[int(x)]; }", array);
    whole_file_says("struct A { float x[64], y[2]; };\nstruct B { A a[32][2]; };\n", array);
    whole_file_says("struct A { float x[64]; };\nA[65] all;\n", array);
    EXPECT_EQ(error_of_file("// @effect mine: Mine.\nstruct A { float x[64]; };\nconst float w[4096] = all();\nmine("),
              "");
    EXPECT_EQ(error_of_file("// @effect mine: Mine.\n#define A 1\n#define B A A\nmine("),
              "my.glsl:3: #define B: its value names A, another one");
    EXPECT_EQ(error_of_file("// @effect mine: Mine.\n#define TAU (2.0 * 3.14159)\nmine("), "");
    EXPECT_EQ(error_of_file("// @effect bloom: Mine.\nbloom("),
              "my.glsl:1: bloom: the name of an effect that is built in; choose another");
}

}  // namespace
}  // namespace darkroom
