// SPDX-License-Identifier: MIT
#include "image/table/table_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <random>

#include "image/picture/write.hpp"
#include "image/table/color_chain.hpp"
#include "image/test_files.hpp"
#include "tables/evaluate.hpp"
#include "tables/test_tables.hpp"

namespace darkroom {
namespace {

using Colors = std::vector<std::array<float, 3>>;

/// Of the inputs that a table takes, and a tenth of them beyond each end.
Colors random_colors(const ColorTable& table, std::size_t count = 20000) {
    const auto& min = table.shaper_size > 0 ? table.shaper_min : table.min;
    const auto& max = table.shaper_size > 0 ? table.shaper_max : table.max;
    std::mt19937 random(11);
    std::uniform_real_distribution<float> part(-0.1f, 1.1f);
    Colors out(count);
    for (auto& color : out)
        for (std::size_t i = 0; i < 3; ++i) color[i] = min[i] + (max[i] - min[i]) * part(random);
    return out;
}

double worst(const ColorTable& table, const ColorChain& chain) {
    const Colors colors = random_colors(table);
    Colors expected = colors;
    chain.apply(expected);
    double out = 0;
    for (std::size_t n = 0; n < colors.size(); ++n)
        out = std::max(out, test::distance(evaluate(table, {colors[n][0], colors[n][1], colors[n][2]}),
                                           {expected[n][0], expected[n][1], expected[n][2]}));
    return out;
}

class ImageTables : public WithFolder {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text) {
        put(file(name), text);
        return file(name);
    }
    static std::unique_ptr<ColorChain> chain_of(const std::filesystem::path& path) {
        const auto chains = color_chains();
        EXPECT_TRUE(chains) << chains.error().text;
        auto chain = (*chains)->open(path);
        return chain ? std::move(*chain) : nullptr;
    }
    /// The file's table is what OpenColorIO makes of colours, as near as it says, and no further than `tolerance`.
    static ColorTable expect_same(const std::filesystem::path& path, double tolerance) {
        const Result<FoundTable> found = read_table_file(path);
        EXPECT_TRUE(found) << found.error().text;
        const auto chain = chain_of(path);
        if (!found || chain == nullptr) return {};
        const double error = worst(found->file.table, *chain);
        EXPECT_LE(error, tolerance) << path;
        EXPECT_TRUE(found->error && *found->error <= tolerance) << path;
        return found->file.table;
    }
};

/// Entries that are somewhere else than they were: n^3 of them, red or blue fastest.
std::string cube_rows(std::uint32_t size, bool has_red_fastest, bool has_indices, double scale = 1) {
    std::string out;
    for (std::uint32_t a = 0; a < size; ++a)
        for (std::uint32_t g = 0; g < size; ++g)
            for (std::uint32_t c = 0; c < size; ++c) {
                const std::uint32_t r = has_red_fastest ? c : a, b = has_red_fastest ? a : c;
                const double x = r / (size - 1.0), y = g / (size - 1.0), z = b / (size - 1.0);
                if (has_indices) out += fmt::format("{} {} {} ", r, g, b);
                const std::array<double, 3> color{0.2 + 0.7 * y, x * z, 1 - 0.5 * x - 0.4 * z};
                for (const double value : color)
                    out += scale == 1 ? fmt::format("{:.7f} ", value) : fmt::format("{:.0f} ", value * scale);
                out += "\n";
            }
    return out;
}

TEST_F(ImageTables, TablesOfEveryKindAreTheirOperations) {
    const ColorTable line =
        expect_same(write("a.spi1d",
                          "Version 1\nFrom -0.5 2.0\nLength 4\nComponents 3\n{\n0 0 0\n0.1 0.2 0.3\n"
                          "0.6 0.5 0.4\n1 1.5 2\n}\n"),
                    1e-5);
    EXPECT_EQ(line.shaper_size, 4u);
    EXPECT_EQ(line.size, 0u);
    EXPECT_NEAR(line.shaper_min[0], -0.5, 1e-6);
    EXPECT_NEAR(line.shaper_max[2], 2.0, 1e-6);

    const ColorTable cube = expect_same(write("a.spi3d", "SPILUT 1.0\n3 3\n4 4 4\n" + cube_rows(4, false, true)), 1e-5);
    EXPECT_EQ(cube.size, 4u);
    EXPECT_EQ(cube.shaper_size, 0u);

    const ColorTable lustre = expect_same(write("a.3dl", "0 341 682 1023\n" + cube_rows(4, false, false, 4095)), 1e-5);
    EXPECT_EQ(lustre.size, 4u);

    // A shaper whose entries are not spread evenly, before a cube.
    const ColorTable shaped = expect_same(
        write("a.csp", "CSPLUTV100\n3D\n\n3\n0 0.5 2\n0 0.8 1\n3\n0 0.5 2\n0 0.8 1\n3\n0 0.5 2\n0 0.8 1\n\n3 3 3\n" +
                           cube_rows(3, true, false)),
        1e-3);
    EXPECT_EQ(shaped.size, 3u);
    EXPECT_GT(shaped.shaper_size, 100u);
}

const std::string clf_head =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<ProcessList compCLFversion=\"3\" id=\"a\">\n";
const std::string clf_matrix =
    "<Matrix inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"3 3\">0.8 0.1 0.1 0.2 0.7 0.1 0 0.3 0.7</Array>"
    "</Matrix>\n";
const std::string clf_curve =
    "<LUT1D inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"5 1\">0 0.4 0.7 0.9 1</Array></LUT1D>\n";

TEST_F(ImageTables, ChainsAreSampledAndSayHowWell) {
    // Curve, matrix, curve: the first one is the shaper, the others a cube of 65.
    const ColorTable table =
        expect_same(write("a.clf", clf_head + clf_curve + clf_matrix + clf_curve + "</ProcessList>\n"), 0.01);
    EXPECT_EQ(table.shaper_size, 5u);
    EXPECT_EQ(table.size, 65u);
    const auto chain = chain_of(file("a.clf"));
    const Result<FoundTable> found = read_table_file(file("a.clf"));
    ASSERT_TRUE(found && found->error && chain);
    EXPECT_GT(*found->error, 1e-6) << "a curve behind a matrix is not exact";
    EXPECT_NEAR(*found->error, worst(table, *chain), 0.5 * *found->error);
}

std::string clf_of(const std::string& steps) { return clf_head + steps + "</ProcessList>\n"; }

std::string clf_cube(std::uint32_t size) {
    return fmt::format(
        "<LUT3D inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"{0} {0} {0} 3\">\n{1}</Array></LUT3D>\n", size,
        cube_rows(size, false, false));
}

std::string clf_range(double from, double to) {
    return fmt::format(
        "<Range inBitDepth=\"32f\" outBitDepth=\"32f\"><minInValue>{}</minInValue><maxInValue>{}</maxInValue>"
        "<minOutValue>0</minOutValue><maxOutValue>1</maxOutValue></Range>\n",
        from, to);
}

TEST_F(ImageTables, ARangeInFrontSaysWhichInputsThereAre) {
    const ColorTable curve = expect_same(write("a.clf", clf_of(clf_range(-0.1, 1.2) + clf_curve)), 1e-5);
    EXPECT_EQ(curve.shaper_size, 5u);
    const ColorTable cube = expect_same(write("a.clf", clf_of(clf_range(-0.1, 1.2) + clf_cube(4))), 1e-5);
    EXPECT_EQ(cube.size, 4u);
    const ColorTable both = expect_same(write("a.clf", clf_of(clf_range(-0.1, 1.2) + clf_curve + clf_cube(4))), 1e-5);
    for (const float min : {curve.shaper_min[0], cube.min[1], both.shaper_min[2]}) EXPECT_NEAR(min, -0.1, 1e-6);
    for (const float max : {curve.shaper_max[0], cube.max[1], both.shaper_max[2]}) EXPECT_NEAR(max, 1.2, 1e-6);
    // A range alone, and one that cuts the table behind it.
    expect_same(write("a.clf", clf_of(clf_range(-0.5, 4))), 1e-5);
    const ColorTable cut =
        expect_same(write("a.clf", clf_of(clf_range(-1, 3) +
                                          "<Range inBitDepth=\"32f\" outBitDepth=\"32f\"><minInValue>0.25"
                                          "</minInValue><maxInValue>0.75</maxInValue><minOutValue>0.25</minOutValue>"
                                          "<maxOutValue>0.75</maxOutValue></Range>" +
                                          clf_curve)),
                    1e-3);
    EXPECT_NEAR(cut.shaper_min[0], 0, 1e-6);
    EXPECT_NEAR(cut.shaper_max[0], 2, 1e-6);
}

TEST_F(ImageTables, StepsBehindACubeAreSampledBetweenItsEntries) {
    const ColorTable straight = expect_same(write("a.clf", clf_of(clf_cube(4) + clf_matrix)), 1e-5);
    EXPECT_EQ(straight.size, 4u) << "a matrix behind it bends nothing";
    const ColorTable curved = expect_same(write("a.clf", clf_of(clf_cube(9) + clf_curve)), 0.02);
    EXPECT_EQ((curved.size - 1) % 8, 0u) << "the entries are among the new ones";
    const Result<FoundTable> found = read_table_file(file("a.clf"));
    ASSERT_TRUE(found && found->error);
    EXPECT_LT(*found->error, 0.02);
}

// The curve of ACEScct (S-2016-001), as light of scenes comes.
TEST_F(ImageTables, ATableOfHalvesReachesBeyondOne) {
    const auto code_of = [](double value) {
        return std::max(
            value <= 0.0078125 ? 10.5402377416545 * value + 0.0729055341958355 : (std::log2(value) + 9.72) / 17.52,
            0.0);
    };
    std::string rows;
    for (std::uint32_t bits = 0; bits < 65536; ++bits) {
        const bool is_finite = (bits & 0x7c00U) != 0x7c00U;
        const double size = bits < 0x8000U ? 1 : -1;
        const auto exponent = static_cast<int>(bits >> 10 & 31U), mantissa = static_cast<int>(bits & 1023U);
        const double value =
            size * (exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25));
        rows += fmt::format("{:.9g}\n", is_finite ? code_of(value) : 0.0);
    }
    const std::string path = write("a.clf", clf_of("<LUT1D inBitDepth=\"32f\" outBitDepth=\"32f\" halfDomain=\"true\">"
                                                   "<Array dim=\"65536 1\">\n" +
                                                   rows + "</Array></LUT1D>\n"));
    const Result<FoundTable> found = read_table_file(path);
    ASSERT_TRUE(found) << found.error().text;
    const ColorTable& table = found->file.table;
    EXPECT_GE(table.shaper_max[0], 4.0f);
    EXPECT_LE(table.shaper_min[0], -0.006f) << "codes of 0 and more";
    EXPECT_LE(found->error.value_or(1), 1e-3);
    for (double value = -0.01; value < double{table.shaper_max[0]}; value += std::max(std::abs(value) / 16, 1e-5))
        EXPECT_NEAR(evaluate(table, {value, value, value})[1], code_of(value), 2e-3) << value;
    ASSERT_FALSE(found->file.comments.empty()) << "it goes on to 65504";
    EXPECT_NE(found->file.comments[0].find("held at its ends"), std::string::npos);
    // What ends with the table says nothing.
    const Result<FoundTable> curve = read_table_file(write("b.clf", clf_of(clf_curve)));
    ASSERT_TRUE(curve);
    EXPECT_TRUE(curve->file.comments.empty());
}

TEST_F(ImageTables, WhatIsWrittenIsReadByOpenColorIo) {
    std::mt19937 random(4);
    const auto fill = [&](std::vector<float>& entries, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) entries.push_back(static_cast<float>(random() >> 8U) * 0x1p-24f);
    };
    for (const bool has_title : {false, true})
        for (const std::uint32_t shaper : {0u, 7u})
            for (const std::uint32_t size : {0u, 5u})
                for (const float most : {1.0f, 3.0f}) {
                    if (shaper + size == 0) continue;
                    TableFile file{.title = has_title ? "a title" : "", .comments = {"a comment"}};
                    ColorTable& table = file.table;
                    table.shaper_size = shaper;
                    table.size = size;
                    fill(table.shaper, std::size_t{3} * shaper);
                    fill(table.cube, std::size_t{3} * size * size * size);
                    (shaper > 0 ? table.shaper_max : table.max).fill(most);
                    const Result<std::string> text = write_cube(file);
                    ASSERT_TRUE(text) << text.error().text;
                    const auto path = write("a.cube", *text);
                    const auto chain = chain_of(path);
                    ASSERT_TRUE(chain) << *text;
                    EXPECT_LT(worst(table, *chain), 1e-5) << text->substr(0, 200);
                    const Result<FoundTable> back = read_table_file(path);
                    ASSERT_TRUE(back) << back.error().text;
                    EXPECT_EQ(back->file.table.cube, table.cube);
                    EXPECT_EQ(back->file.table.shaper, table.shaper);
                }
}

TEST_F(ImageTables, FilesOfOtherProgramsAreReadByTheirSuffix) {
    const std::string rows = cube_rows(2, true, false);
    for (const auto& [name, text] :
         {std::pair("a.itx", "LUT_3D_SIZE 2\n" + rows),
          std::pair("a.cub",
                    "# Truelight Cube v2.0\n# iDims 3\n# oDims 3\n# width 2 2 2\n\n# Cube\n" + rows + "# end\n"),
          std::pair("a.lut",
                    "Version\t3\nFormat\tany\nType\t3D\nFrom\t0 1\nTo\t0 1\nBlack\t0\nWhite\t1\n"
                    "Length\t2\nLUT:\n3D {\n" +
                        rows + "}\n"),
          std::pair("a.ctf",
                    "<?xml version=\"1.0\"?>\n<ProcessList version=\"1.3\" id=\"a\">\n<LUT3D "
                    "inBitDepth=\"32f\" outBitDepth=\"32f\"><Array dim=\"2 2 2 3\">\n" +
                        cube_rows(2, false, false) + "</Array></LUT3D></ProcessList>\n")}) {
        const ColorTable table = expect_same(write(name, text), 1e-5);
        ASSERT_EQ(table.size, 2u) << name;
        // The entry of full blue.
        EXPECT_NEAR(table.cube[3 * 4], 0.2, 1e-5) << name;
        EXPECT_NEAR(table.cube[3 * 4 + 2], 0.6, 1e-5) << name;
    }
}

TEST_F(ImageTables, WhatIsNoTableIsOneLine) {
    const std::array files{
        std::pair(write("bomb.spi1d", "Version 1\nFrom 0 1\nLength 100000000000\nComponents 1\n{\n0\n1\n}\n"),
                  "Length"),
        std::pair(write("bomb.spi3d", "SPILUT 1.0\n3 3\n4000 4000 4000\n0 0 0 0 0 0\n"), "4000"),
        std::pair(write("bomb.clf", clf_head + "<LUT3D inBitDepth=\"32f\" outBitDepth=\"32f\">"
                                               "<Array dim=\"4000 4000 4000 3\">0 0 0</Array></LUT3D></ProcessList>"),
                  "4000"),
        std::pair(write("text.3dl", "nothing"), ".3dl"),
        std::pair(write("text.csp", "nothing"), "text.csp"),
        std::pair(write("text.cube", "nothing"), "text.cube:1: "),
        std::pair(write("text.png", "nothing"), "text.png"),
        std::pair(file("none.clf"), "none.clf"),
        std::pair(file("none.cube"), "none.cube")};
    for (const auto& [path, part] : files) {
        const Result<FoundTable> found = read_table_file(path);
        ASSERT_FALSE(found) << path;
        EXPECT_TRUE(found.error().text.starts_with(path.string())) << found.error().text;
        EXPECT_NE(found.error().text.find(part), std::string::npos) << found.error().text;
        EXPECT_EQ(found.error().text.find('\n'), std::string::npos) << found.error().text;
    }
}

TEST_F(ImageTables, PicturesAreTablesByTheirSize) {
    Picture strip(256, 16), hald(8, 8);
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 0; x < 256; ++x) {
            const std::array<std::uint32_t, 3> place{x % 16, y, x / 16};
            for (std::uint32_t i = 0; i < 3; ++i) strip.at(x, y)[i] = static_cast<float>(place[i] * 17) / 255;
        }
    for (std::uint32_t n = 0; n < 64; ++n)
        for (std::uint32_t i = 0; i < 3; ++i)
            hald.at(n % 8, n / 8)[i] = static_cast<float>((n >> 2 * i & 3) * 85) / 255;
    for (const auto& [name, picture, size] :
         {std::tuple("strip.png", &strip, 16u), std::tuple("hald.tif", &hald, 4u), std::tuple("hald.exr", &hald, 4u)}) {
        ASSERT_TRUE(
            write_picture(file(name), *picture,
                          {.samples = std::string(name).ends_with("exr") ? SampleKind::Float : SampleKind::Integer8}));
        const Result<FoundTable> found = read_table_file(file(name));
        ASSERT_TRUE(found) << found.error().text;
        EXPECT_EQ(found->file.table.size, size);
        // The codes are the entries: nothing was decoded.
        for (const TableColor color : {TableColor{0.1, 0.5, 0.9}, TableColor{0.7, 0.2, 0.3}})
            EXPECT_LE(test::distance(evaluate(found->file.table, color), color), 1e-6) << name;
    }
    ASSERT_TRUE(write_picture(file("photo.png"), Picture(40, 30)));
    const Result<FoundTable> photo = read_table_file(file("photo.png"));
    ASSERT_FALSE(photo);
    EXPECT_NE(photo.error().text.find("a picture of 40x30 is not a table"), std::string::npos) << photo.error().text;
}

class ImageTablesData : public WithData {};

// Our reader's tables against OpenColorIO's processor, on random colours: a code of 10 bits is 1 / 1023.
TEST_F(ImageTablesData, EveryFileThatOpenColorIOTakesIsItsTable) {
    std::size_t taken = 0;
    const auto chains = color_chains();
    ASSERT_TRUE(chains) << chains.error().text;
    std::vector<std::filesystem::path> paths{data_ / "lut/src/crosstalk.3dl"};
    for (const auto& entry : std::filesystem::directory_iterator(data_ / "lut"))
        if (entry.path().extension() == ".cube") paths.push_back(entry.path());
    EXPECT_EQ(paths.size(), 12u);
    for (const std::filesystem::path& path : paths) {
        const Result<FoundTable> found = read_table_file(path);
        ASSERT_TRUE(found) << found.error().text;
        const auto chain = (*chains)->open(path);
        if (!chain) continue;
        ++taken;
        EXPECT_LE(worst(found->file.table, **chain), 1 / 1023.0) << path;
    }
    // It refuses a TITLE before a shaper.
    EXPECT_EQ(taken, 11u);
}

std::string list_of(const std::string& inside) {
    return "<?xml version=\"1.0\"?>\n<ProcessList id=\"a\" compCLFversion=\"3.0\">\n" + inside + "</ProcessList>\n";
}
std::string range_to(double greatest) {
    return fmt::format(
        "<Range inBitDepth=\"32f\" outBitDepth=\"32f\"><minInValue>0</minInValue><maxInValue>1"
        "</maxInValue><minOutValue>0</minOutValue><maxOutValue>{}</maxOutValue></Range>\n",
        greatest);
}
std::string reference(const std::string& attribute) {
    return "<Reference " + attribute + " inBitDepth=\"32f\" outBitDepth=\"32f\"/>\n";
}

TEST_F(ImageTables, ATableMayNameOthersOfItsFolder) {
    write("half.clf", list_of(range_to(0.5)));
    std::filesystem::create_directory(file("more"));
    write("more/half.clf", list_of(range_to(0.5)));
    const auto greatest = [&](const std::string& inside) {
        const Result<FoundTable> found = read_table_file(write("a.clf", list_of(inside)));
        EXPECT_TRUE(found) << found.error().text;
        return found ? *std::ranges::max_element(found->file.table.shaper) : -1.0f;
    };
    EXPECT_NEAR(greatest(reference("path=\"half.clf\"")), 0.5, 1e-6);
    EXPECT_NEAR(greatest(reference("path=\"more/half.clf\"")), 0.5, 1e-6);
    EXPECT_NEAR(greatest(reference("path=\"" + file("half.clf").string() + "\"")), 0.5, 1e-6);
    EXPECT_NEAR(greatest(range_to(0.5) + reference("path=\"half.clf\"")), 0.5 * 0.5, 1e-6);
    // From another working folder, too: the name is of the table's.
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(file("more"));
    EXPECT_TRUE(read_table_file("../a.clf"));
    std::filesystem::current_path(before);
}

TEST_F(ImageTables, ATableNamesNoOtherFiles) {
    write("half.clf", list_of(range_to(0.5)));
    write("to_device.clf", list_of(reference("path=\"/dev/zero\"")));
    write("back.clf", list_of(reference("path=\"a.clf\"")));
    ASSERT_EQ(::mkfifo(file("pipe.clf").c_str(), 0600), 0);
    std::filesystem::create_symlink("/dev/zero", file("zero.clf"));
    // Each names the one before twice.
    write("twice0.clf", list_of(range_to(0.9)));
    for (int i = 1; i < 30; ++i) {
        const std::string before = reference(fmt::format("path=\"twice{}.clf\"", i - 1));
        write(fmt::format("twice{}.clf", i), list_of(before + before));
    }
    const std::string outside = "allowed is a file of the table's folder, or below";
    const std::vector<std::array<std::string, 2>> cases{
        {"path=\"/dev/zero\"", "a.clf: line 3: <Reference path = \"/dev/zero\">: " + outside},
        {"path=\"&#47;dev&#x2f;zero\"", "\"/dev/zero\">: " + outside},
        {"PATH=\"/dev/zero\"", "\"/dev/zero\">: " + outside},
        {"path=\"../a.clf\"", outside},
        {"path=\"more/../../a.clf\"", outside},
        {"path=\"$HOME/a.clf\"", "allowed is a name without $ and %"},
        {"path=\"\"", "is not a file's name"},
        {"path=\"none.clf\"", "there is no such file"},
        {"path=\"pipe.clf\"", "is a pipe, a regular file is needed"},
        {"path=\"zero.clf\"", "is a device, a regular file is needed"},
        {"path=\".\"", "is a folder, a file is needed"},
        {"path=\"to_device.clf\"", "a.clf: to_device.clf, line 3: <Reference path = \"/dev/zero\">: " + outside},
        {"path=\"a.clf\"", "refers to a table that refers back to this one"},
        {"path=\"back.clf\"", "refers to a table that refers back to this one"},
        {"path=\"twice29.clf\"", "at most 64 of"},
        {"basePath=\"/dev\" path=\"half.clf\"", "<Reference basepath = \"/dev\">: allowed is a path"},
        {"alias=\"x\"", "<Reference alias = \"x\">: allowed is a path"},
    };
    for (const auto& [attribute, part] : cases) {
        const Result<FoundTable> found = read_table_file(write("a.clf", list_of(reference(attribute))));
        ASSERT_FALSE(found) << attribute;
        EXPECT_NE(found.error().text.find(part), std::string::npos) << attribute << ": " << found.error().text;
        EXPECT_EQ(found.error().fault, Fault::User) << attribute;
    }
    // Entities are what the parser makes of them, and what is under another name's end is read as it is, too.
    const std::string entity =
        "<?xml version=\"1.0\"?>\n<!DOCTYPE a [<!ENTITY d \"/dev/zero\">]>\n<ProcessList id=\"a\" "
        "compCLFversion=\"3.0\">" +
        reference("path=\"&d;\"") + "</ProcessList>\n";
    for (const char* const name : {"b.clf", "b.csp", "b.spi1d", "b.3dl"}) {
        const Result<FoundTable> found = read_table_file(write(name, entity));
        ASSERT_FALSE(found) << name;
        EXPECT_NE(found.error().text.find(outside), std::string::npos) << name << ": " << found.error().text;
    }
}

}  // namespace
}  // namespace darkroom
