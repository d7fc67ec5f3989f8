// SPDX-License-Identifier: MIT
// Tables on the command line: `darkroom lut`, and tables as values of looks.
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "image/table/table_file.hpp"
#include "tables/evaluate.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

class CliLut : public test::CliFixture {
  protected:
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(64, 48);
        std::mt19937 random(4);
        std::uniform_real_distribution<float> stops(-9, 6);
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i)
            frame.color.pixels[i] = i % 4 == 3 ? 1.0f : 0.18f * std::exp2(stops(random));
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
        write("bad.cube", "LUT_3D_SIZE 2\n0 0 0\n");
        write("half.cube", "LUT_1D_SIZE 2\n0 0 0\n0.5 0.5 0.5\n");
    }
    void expect_done(const std::vector<std::string>& arguments, const std::string& err = "") const {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        if (err.empty())
            EXPECT_EQ(outcome.err, "");
        else
            EXPECT_NE(outcome.err.find(err), std::string::npos) << outcome.err;
    }
    /// Largest difference of two pictures.
    [[nodiscard]] double apart(const std::string& a, const std::string& b) const {
        const Picture one = picture(a), other = picture(b);
        EXPECT_EQ(one.pixels.size(), other.pixels.size());
        double worst = 0;
        for (std::size_t i = 0; i < std::min(one.pixels.size(), other.pixels.size()); ++i)
            worst = std::max(worst, double{std::abs(one.pixels[i] - other.pixels[i])});
        return worst;
    }
};

TEST_F(CliLut, WhatIsReadIsNotOverwritten) {
    Picture table(64, 64);  // a HaldCLUT, which is a mask, too
    for (std::size_t i = 0; i < table.pixels.size(); ++i)
        table.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>(i % 32) / 31;
    ASSERT_TRUE(write_picture(path("table.png"), table));
    write("table.toml", "[post_process]\nlut = \"table.png\"\n");
    write("only.toml", "[[stack]]\neffect = \"lut\"\nlut = \"half.cube\"\n");
    write("mask.toml", "[[stack]]\neffect = \"lut\"\nlut = \"half.cube\"\nmask = \"table.png\"\n");
    const std::string png = path("table.png"), cube = path("half.cube"), frame = path("frame.exr");
    const std::string before = content(png), half = content(cube);
    const std::string as_png = "table.png: is also an input, and would be overwritten";
    const std::string as_cube = "half.cube: is also an input, and would be overwritten";
    expect_refused({"develop", frame, "--lut", png, "-o", png}, 1, as_png);
    expect_refused({"develop", frame, "--look", path("table.toml"), "-o", png}, 1, as_png);
    expect_refused({"develop", frame, "--look", path("mask.toml"), "-o", png}, 1, as_png);
    expect_refused({"develop", frame, "--layer", path("table.toml"), "-o", png}, 1, as_png);
    expect_refused({"lut", "convert", cube, "-o", cube}, 1, as_cube);
    expect_refused({"lut", "export", path("only.toml"), "-o", cube}, 1, as_cube);
    expect_refused({"lut", "export", "--lut", cube, "-o", cube}, 1, as_cube);
    EXPECT_EQ(content(png), before);
    EXPECT_EQ(content(cube), half);
}

// Half the code is what half of a table says: 188 becomes 94.
TEST_F(CliLut, TheFlagLooksColoursUp) {
    write("look.toml", "[[stack]]\neffect = \"encode\"\n");
    write("with.toml", "[[stack]]\neffect = \"lut\"\nlut = \"half.cube\"\n[[stack]]\neffect = \"encode\"\n");
    const std::string frame = path("frame.exr");
    expect_done({"develop", frame, "--look", path("look.toml"), "-o", path("plain.png")});
    expect_done({"develop", frame, "--look", path("with.toml"), "-o", path("look.png")});
    const Picture plain = picture("plain.png"), look = picture("look.png");
    ASSERT_EQ(look.pixels.size(), plain.pixels.size());
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
        ASSERT_NEAR(look.pixels[i], i % 4 == 3 ? 1 : plain.pixels[i] / 2, 1.01 / 255);
    const std::vector<std::string> common{"--bloom-enabled", "off", "--ssao-enabled",   "off",
                                          "--fxaa-enabled",  "off", "--dither-enabled", "off"};
    const auto develop = [&](std::vector<std::string> arguments, const std::string& out) {
        arguments.insert(arguments.begin(), {"develop", frame, "-o", path(out)});
        arguments.insert(arguments.end(), common.begin(), common.end());
        expect_done(arguments);
    };
    develop({}, "a.png");
    develop({"--lut", path("half.cube"), "--lut-strength", "0"}, "b.png");
    develop({"--lut", path("half.cube")}, "c.png");
    develop({"--lut", path("half.cube"), "--reference"}, "d.png");
    EXPECT_EQ(apart("a.png", "b.png"), 0);
    EXPECT_GT(apart("a.png", "c.png"), 0.4);
    EXPECT_LE(apart("c.png", "d.png"), 1.01 / 255);
}

TEST_F(CliLut, ExportedLooksDoWhatTheirEffectsDo) {
    // With what depends on the place, which is left out by name.
    const std::string kept =
        "[[stack]]\neffect = \"exposure\"\nexposure = 1.5\n[[stack]]\neffect = \"tonemap\"\ncurve = \"agx\"\n"
        "opacity = 0.8\n[[stack]]\neffect = \"grayscale\"\namount = 0.4\n[[stack]]\neffect = \"encode\"\n";
    write("kept.toml", kept);
    write("all.toml", kept + "[[stack]]\neffect = \"vignette\"\nname = \"corners\"\n[[stack]]\neffect = \"dither\"\n");
    expect_done({"lut", "export", path("all.toml"), "-o", path("look.cube")},
                "left out: corners: depends on the place");
    const Result<FoundTable> table = read_table_file(path("look.cube"));
    ASSERT_TRUE(table) << table.error().text;
    EXPECT_EQ(table->file.table.size, 65u);
    const std::string comments = test::content(path("look.cube")).substr(0, 800);
    for (const char* const part :
         {"# Input: scene-linear Rec. 709", "-10 to +6.5 stops", "# Error on 20000 random colours: largest 0.0",
          "# Left out: corners: depends on the place", "# Left out: dither: ", "result = \"display\""})
        EXPECT_NE(comments.find(part), std::string::npos) << part << " is not in " << comments;

    write("table.toml",
          "[[stack]]\neffect = \"lut\"\nlut = \"look.cube\"\nspace = \"scene_linear\"\nresult = \"display\"\n"
          "[[stack]]\neffect = \"encode\"\n");
    expect_done({"develop", path("frame.exr"), "--look", path("kept.toml"), "-o", path("effects.png")});
    expect_done({"develop", path("frame.exr"), "--look", path("table.toml"), "-o", path("table.png")});
    // Saturated colours at the ends of the range are the worst; the file says how far they are off.
    const std::string mark = "largest ";
    const std::size_t at = comments.find(mark);
    ASSERT_NE(at, std::string::npos);
    const double largest = std::stod(comments.substr(at + mark.size()));
    EXPECT_LT(largest, 0.03);
    EXPECT_LE(apart("effects.png", "table.png"), largest + 1.01 / 255);
    const Picture effects = picture("effects.png"), in_table = picture("table.png");
    ASSERT_EQ(in_table.pixels.size(), effects.pixels.size());
    double sum = 0;
    for (std::size_t i = 0; i < effects.pixels.size(); ++i) sum += std::abs(effects.pixels[i] - in_table.pixels[i]);
    EXPECT_LT(sum / static_cast<double>(effects.pixels.size()), 0.5 / 255);
}

// Without a tone mapping what comes out is light, too.
TEST_F(CliLut, ExportedGradesGiveLight) {
    write("grade.toml", "[[stack]]\neffect = \"exposure\"\nexposure = 0.5\n");
    expect_done({"lut", "export", path("grade.toml"), "-o", path("grade.cube")});
    EXPECT_NE(test::content(path("grade.cube")).find("result = \"same\""), std::string::npos);
    write("table.toml", "[[stack]]\neffect = \"lut\"\nlut = \"grade.cube\"\nspace = \"scene_linear\"\n");
    expect_done(
        {"develop", path("frame.exr"), "--look", path("grade.toml"), "-o", path("effects.exr"), "--bits", "float"});
    expect_done(
        {"develop", path("frame.exr"), "--look", path("table.toml"), "-o", path("table.exr"), "--bits", "float"});
    const Picture effects = picture("effects.exr"), table = picture("table.exr");
    ASSERT_FALSE(effects.empty());
    ASSERT_EQ(table.pixels.size(), effects.pixels.size());
    for (std::size_t i = 0; i < effects.pixels.size(); ++i)
        ASSERT_NEAR(table.pixels[i], effects.pixels[i], 1e-3 * effects.pixels[i] + 1e-5) << i;
}

TEST_F(CliLut, ConvertedTablesAreTheSame) {
    write("line.spi1d", "Version 1\nFrom -0.5 2.0\nLength 3\nComponents 1\n{\n0\n0.25\n1\n}\n");
    expect_done({"lut", "convert", path("line.spi1d"), "-o", path("line.cube")});
    const Outcome told = run({"lut", "info", path("line.cube"), "--json"});
    EXPECT_EQ(run({"info", path("line.cube"), "--json"}).out, told.out);
    const nlohmann::json document = nlohmann::json::parse(told.out, nullptr, false);
    ASSERT_TRUE(document.is_object()) << told.out << told.err;
    EXPECT_EQ(document.at("kind"), "table");
    EXPECT_EQ(document.at("table_1d").at("entries"), 3);
    EXPECT_EQ(document.at("table_1d").at("inputs_from"), -0.5);
    EXPECT_EQ(document.at("table_1d").at("greatest"), 1.0);
    EXPECT_NE(document.at("comments").at(0).get<std::string>().find("Sampled from .spi1d"), std::string::npos);

    Picture strip(16, 256);
    for (std::uint32_t y = 0; y < 256; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) {
            const std::array<std::uint32_t, 3> place{x, y % 16, y / 16};
            for (std::uint32_t i = 0; i < 3; ++i) strip.at(x, y)[i] = static_cast<float>(place[i] * 17) / 255;
        }
    ASSERT_TRUE(write_picture(path("strip.png"), strip));
    expect_done({"lut", "convert", path("strip.png"), "-o", path("strip.cube")});
    const Result<FoundTable> cube = read_table_file(path("strip.cube"));
    ASSERT_TRUE(cube) << cube.error().text;
    EXPECT_EQ(cube->file.table.size, 16u);
    EXPECT_EQ(cube->file.table.cube[3], 17.0f / 255);
}

/// Steps of CLF, in 32 bits: curves of five entries, and a matrix.
std::string clf_of(const std::string& steps) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<ProcessList compCLFversion=\"3\" id=\"a\">\n" + steps +
           "</ProcessList>\n";
}
std::string clf_curve(const std::string& entries) {
    return "<LUT1D inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"5 1\">" + entries + "</Array></LUT1D>\n";
}
const std::string clf_matrix =
    "<Matrix inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"3 3\">0.8 0.1 0.1 0.2 0.7 0.1 0 0.3 "
    "0.7</Array></Matrix>\n";

TEST_F(CliLut, LinearTablesTakeLightAsItIs) {
    write("light.cube", "LUT_1D_SIZE 2\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 8 8 8\n0 0 0\n4 2 1\n");
    write("plain.toml", "format = 1\n[[stack]]\neffect = \"exposure\"\n");
    const auto develop = [&](std::vector<std::string> flags, const std::string& out) {
        flags.insert(flags.begin(), {"develop", path("frame.exr"), "--look", path("plain.toml"), "--bits", "float"});
        flags.insert(flags.end(), {"-o", path(out)});
        expect_done(flags);
        return picture(out);
    };
    const Picture light = develop({}, "light.exr");
    write("plain.toml", "format = 1\n[[stack]]\neffect = \"lut\"\nlut = \"light.cube\"\nspace = \"linear\"\n");
    const Picture found = develop({}, "found.exr"), reference = develop({"--reference"}, "reference.exr");
    ASSERT_EQ(found.pixels.size(), light.pixels.size());
    for (std::size_t i = 0; i < light.pixels.size(); ++i) {
        const double expected = i % 4 == 3 ? 1 : std::min(double{light.pixels[i]}, 8.0) / std::exp2(i % 4 + 1);
        ASSERT_NEAR(double{found.pixels[i]}, expected, 1e-3 * expected) << i;
        ASSERT_NEAR(double{reference.pixels[i]}, expected, 1e-6 * expected) << i;
    }
}

// ffmpeg reads a table of one kind whose inputs begin at 0, as docs/recipes.md has it, and no shaper.
TEST_F(CliLut, WhatIsWrittenIsReadByFfmpeg) {
    if (run_lines("command -v ffmpeg").code != 0) GTEST_SKIP() << "there is no ffmpeg on this machine";
    std::mt19937 random(5);
    const auto number = [&] { return static_cast<float>(random() >> 8U) * 0x1p-24f; };
    const auto table = [&](std::uint32_t shaper, std::uint32_t size, float most) {
        ColorTable out;
        out.shaper_size = shaper;
        out.size = size;
        for (std::uint32_t i = 0; i < 3 * shaper; ++i) out.shaper.push_back(number());
        for (std::uint32_t i = 0; i < 3 * size * size * size; ++i) out.cube.push_back(number());
        (shaper > 0 ? out.shaper_max : out.max).fill(most);
        return out;
    };
    constexpr std::size_t side = 16, pixels = side * side;
    const auto by_ffmpeg = [&](const std::string& filter) {
        return run_lines("ffmpeg -v error -f rawvideo -pix_fmt gbrpf32le -s 16x16 -i in.raw -vf " + filter +
                         "=film.cube -f rawvideo -pix_fmt gbrpf32le -y out.raw");
    };
    for (const float most : {1.0f, 3.0f}) {
        std::vector<float> planes(3 * pixels);
        for (float& value : planes) value = number() * 1.1f * most;
        write("in.raw", {reinterpret_cast<const char*>(planes.data()), planes.size() * sizeof(float)});
        for (const bool is_cube : {false, true}) {
            const ColorTable expected = table(is_cube ? 0 : 9, is_cube ? 5 : 0, most);
            const Result<std::string> text = write_cube({.table = expected, .title = "film"});
            ASSERT_TRUE(text);
            write("made.cube", *text);
            expect_done({"lut", "convert", path("made.cube"), "-o", path("film.cube")});
            const Outcome outcome = by_ffmpeg(is_cube ? "lut3d" : "lut1d");
            ASSERT_EQ(outcome.code, 0) << outcome.err;
            const std::string raw = content(path("out.raw"));
            std::vector<float> found(raw.size() / sizeof(float));
            std::memcpy(found.data(), raw.data(), raw.size());
            ASSERT_EQ(found.size(), planes.size());
            constexpr std::array<std::size_t, 3> plane{2 * pixels, 0, pixels};  // of red, green, blue
            for (std::size_t i = 0; i < pixels; ++i) {
                TableColor color{};
                for (std::size_t c = 0; c < 3; ++c) color[c] = double{planes[plane[c] + i]};
                color = evaluate(expected, color);
                for (std::size_t c = 0; c < 3; ++c)
                    ASSERT_NEAR(double{found[plane[c] + i]}, color[c], 2e-6) << i << ' ' << is_cube << ' ' << most;
            }
        }
    }
    const Result<std::string> both = write_cube({.table = table(7, 5, 1)});
    ASSERT_TRUE(both);
    write("film.cube", *both);
    EXPECT_NE(by_ffmpeg("lut3d").code, 0) << "it is refused, not misread";
}

TEST_F(CliLut, WhatATableIsNotIsToldWhereItIsUsed) {
    // A curve of corners behind a matrix falls between the entries of every cube; a matrix alone has no end.
    write("bent.clf", clf_of(clf_matrix + clf_curve("0 0.9 0.1 0.9 1")));
    write("endless.clf", clf_of(clf_matrix));
    write("exact.clf", clf_of(clf_curve("0 0.4 0.7 0.9 1")));
    const auto told = [&](const std::string& table) {
        const Outcome outcome =
            run({"develop", path("frame.exr"), "-o", path("out.png"), "--lut", path(table), "--jobs", "1"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.err;
    };
    EXPECT_EQ(told("exact.clf"), "");
    EXPECT_EQ(told("endless.clf"), "darkroom: warning: " + path("endless.clf") +
                                       ": its operations go on below 0 and above 1, where it is held at its ends\n");
    const std::string bent = told("bent.clf");
    EXPECT_TRUE(
        bent.starts_with("darkroom: warning: " + path("bent.clf") + ": its operations are sampled, and up to 0.0"))
        << bent;
    EXPECT_EQ(std::ranges::count(bent, '\n'), 1) << bent;
    // The same of a look that names it, and of the table alone.
    write("bent.toml", "format = 1\n[post_process]\nlut = \"bent.clf\"\n");
    EXPECT_EQ(run({"develop", path("frame.exr"), "-o", path("out.png"), "--look", path("bent.toml")}).err, bent);
    for (const std::string name : {"bent.toml", "bent.clf"}) {
        const auto document = nlohmann::json::parse(run({"info", path(name), "--json"}).out, nullptr, false);
        ASSERT_TRUE(document.contains("warnings")) << document;
        EXPECT_NE(bent.find(document.at("warnings").at(0).get<std::string>()), std::string::npos) << document;
    }
    EXPECT_EQ(run({"lut", "convert", path("bent.clf"), "-o", path("bent.cube")}).err, bent);
}

TEST_F(CliLut, BitsOfA3dlAreSaidByTheFileOrByHand) {
    std::string entries = "0 341 682 1023\n";
    for (int r = 0; r < 4; ++r)
        for (int g = 0; g < 4; ++g)
            for (int b = 0; b < 4; ++b) entries += fmt::format("{} {} {}\n", r * 273, g * 273, b * 273);
    write("dark.3dl", entries);
    write("said.3dl", "3DMESH\nMesh 2 12\n" + entries);
    const auto greatest = [&](const std::string& name) {
        const Result<FoundTable> found = read_table_file(path(name));
        EXPECT_TRUE(found) << found.error().text;
        return found ? found->file.table.cube.back() : -1;
    };
    EXPECT_FLOAT_EQ(greatest("dark.3dl"), 819.0f / 1023) << "as OpenColorIO has it";
    EXPECT_FLOAT_EQ(greatest("said.3dl"), 819.0f / 4095);
    const std::string warning = "its largest number is 819: it is taken as of 10 bits";
    expect_done({"lut", "convert", path("dark.3dl"), "-o", path("a.cube")}, warning);
    EXPECT_FLOAT_EQ(greatest("a.cube"), 819.0f / 1023);
    expect_done({"lut", "convert", path("dark.3dl"), "-o", path("a.cube"), "--bits", "12"});
    EXPECT_FLOAT_EQ(greatest("a.cube"), 819.0f / 4095);
    expect_done({"develop", path("frame.exr"), "-o", path("out.png"), "--lut", path("said.3dl")});
    expect_done({"develop", path("frame.exr"), "-o", path("out.png"), "--lut", path("dark.3dl")}, warning);
    const Outcome told = run({"info", path("said.3dl")});
    EXPECT_NE(told.out.find("Its numbers are taken as of 12 bits, of which the largest is 819 of 4095"),
              std::string::npos)
        << told.out;
    expect_refused({"lut", "convert", path("half.cube"), "-o", path("b.cube"), "--bits", "12"}, 1, ".3dl alone");
    expect_refused({"lut", "convert", path("dark.3dl"), "-o", path("b.cube"), "--bits", "40"}, 1, "[8, 16]");
}

TEST_F(CliLut, WhatCannotBeDoneIsOneLine) {
    expect_refused({"lut", "convert", path("bad.cube"), "-o", path("out.cube")}, 1,
                   "bad.cube:2: the file ends after 1");
    expect_refused({"lut", "convert", path("frame.exr"), "-o", path("out.cube")}, 1, "64x48 is not a table");
    expect_refused({"lut", "convert", path("half.cube"), "-o", path("out.txt")}, 1, ".cube");
    expect_refused({"lut", "info", path("bad.cube")}, 1, "bad.cube:2: ");
    expect_refused({"lut", "inf"}, 1, "did you mean 'info'?");
    expect_refused({"lut"}, 1, "info, convert, export");
    expect_refused({"develop", path("frame.exr"), "-o", path("out.png"), "--lut", path("bad.cube")}, 1, "bad.cube:2: ");
    expect_refused({"develop", path("frame.exr"), "-o", path("out.png"), "--lut", path("none.cube")}, 1, "none.cube");
    write("blur.toml", "[[stack]]\neffect = \"gaussian_blur\"\n");
    expect_refused({"lut", "export", path("blur.toml"), "-o", path("out.cube")}, 1,
                   "none of its effects maps colour to colour alone");
}

}  // namespace
}  // namespace darkroom
