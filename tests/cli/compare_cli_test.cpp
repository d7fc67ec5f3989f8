// SPDX-License-Identifier: MIT
// `darkroom compare` as a build server meets it: exit codes, thresholds, what is not a number, many files at once.

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfOutputFile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/exr/test_exr.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;
using test::Outcome;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t width = 24, height = 16;

class CliCompare : public test::CliFixture {
  protected:
    void make_files() override {
        write_exr("a.exr", {"R", "G", "B", "Z"}, samples(4));
        ASSERT_TRUE(write_picture(path("a.png"), gray(0.5f)));
    }
    [[nodiscard]] static Picture gray(float value) {
        Picture out(width, height);
        std::fill(out.pixels.begin(), out.pixels.end(), value);
        return out;
    }
    /// No two neighbours alike, all between 0.1 and 1.
    [[nodiscard]] static std::vector<float> samples(std::size_t channels) {
        std::vector<float> out(width * height * channels);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = 0.1f + static_cast<float>(i * 37 % 91) / 101;
        return out;
    }
    /// Numbers into a file as they are, which the library's own writers would mend.
    void write_exr(const std::string& name, const std::vector<std::string>& channels, const std::vector<float>& values,
                   std::uint32_t columns = width) const {
        test::store_floats(path(name), channels, columns, values);
    }
    [[nodiscard]] Outcome compare(const std::string& a, const std::string& b,
                                  std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"compare", path(a), path(b)});
        return run(more);
    }
    [[nodiscard]] json report(const std::string& a, const std::string& b, std::vector<std::string> more = {}) const {
        more.emplace_back("--json");
        const Outcome outcome = compare(a, b, more);
        const json document = json::parse(outcome.out, nullptr, false);
        EXPECT_FALSE(document.is_discarded()) << outcome.out;
        EXPECT_EQ(outcome.code == 0, document.value("passes", false)) << outcome.out;
        return document;
    }
};

TEST_F(CliCompare, WhatIsEqualPassesEveryThreshold) {
    for (const std::string name : {"a.exr", "a.png"}) {
        const Outcome outcome =
            compare(name, name, {"--fail-max", "0", "--fail-psnr", "1000", "--fail-flip", "0", "--layers", "all"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        EXPECT_EQ(outcome.out.find("worst pixel"), std::string::npos) << "there is none: " << outcome.out;
    }
}

TEST_F(CliCompare, APictureOfNanIsNotABlackOne) {
    write_exr("black.exr", {"R", "G", "B"}, std::vector<float>(width * height * 3, 0.0f));
    write_exr("nan.exr", {"R", "G", "B"}, std::vector<float>(width * height * 3, not_a_number));
    const Outcome outcome = compare("black.exr", "nan.exr", {"--fail-max", "1e30", "--fail-flip", "1"});
    EXPECT_EQ(outcome.code, 3) << outcome.out;
    EXPECT_NE(outcome.err.find("NaN or infinity differs in 1152 samples"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.out.find("NaN              0 and 1152"), std::string::npos) << outcome.out;
    EXPECT_EQ(compare("nan.exr", "nan.exr", {"--fail-max", "0"}).code, 0) << "the same ones in the same places";
}

TEST_F(CliCompare, NanAndInfinitiesAreToldByPlaceAndKind) {
    const std::vector<float> plain = samples(3);
    const auto with = [&](const std::string& name, std::size_t at, float value) {
        std::vector<float> values = plain;
        values[at] = value;
        write_exr(name, {"R", "G", "B"}, values);
    };
    constexpr std::size_t green = (5 * width + 7) * 3 + 1;
    with("nan.exr", green, not_a_number);
    with("elsewhere.exr", green + 3, not_a_number);
    with("up.exr", green, infinity);
    with("down.exr", green, -infinity);
    with("large.exr", green, 65504.0f);
    for (const auto& [a, b] : std::vector<std::pair<std::string, std::string>>{
             {"nan.exr", "elsewhere.exr"}, {"nan.exr", "up.exr"}, {"up.exr", "down.exr"}, {"up.exr", "large.exr"}})
        EXPECT_EQ(compare(a, b).code, 3) << a << ' ' << b;
    EXPECT_EQ(compare("up.exr", "up.exr").code, 0);
    const json found = report("large.exr", "up.exr").at("layers").at(0);
    EXPECT_EQ(found.at("reference").at("infinite"), 0);
    EXPECT_EQ(found.at("test").at("infinite"), 1);
    EXPECT_EQ(found.at("non_finite_differences"), 1);
    EXPECT_EQ(found.at("max_error"), "inf");
    EXPECT_EQ(found.at("worst").at("x"), 7);
    EXPECT_EQ(found.at("worst").at("y"), 5);
    EXPECT_EQ(found.at("worst").at("channel"), "green");
    EXPECT_EQ(found.at("worst").at("reference"), 65504.0);
    EXPECT_EQ(found.at("worst").at("test"), "inf");
}

TEST_F(CliCompare, NanInAlphaAndOtherLayersCounts) {
    std::vector<float> values = samples(4);
    values[3 + 4 * 11] = not_a_number;
    write_exr("alpha.exr", {"R", "G", "B", "A"}, values);
    write_exr("opaque.exr", {"R", "G", "B", "A"}, samples(4));
    EXPECT_EQ(compare("opaque.exr", "alpha.exr").code, 3);
    write_exr("depth.exr", {"R", "G", "B", "Z"}, values);
    EXPECT_EQ(compare("a.exr", "depth.exr").code, 0) << "nobody asked for depth";
    const Outcome depth = compare("a.exr", "depth.exr", {"--layers", "depth"});
    EXPECT_EQ(depth.code, 3);
    EXPECT_NE(depth.out.find("worst pixel      11,0  Z: "), std::string::npos) << depth.out;
    EXPECT_EQ(compare("a.exr", "depth.exr", {"--layers", "all"}).code, 3);
}

TEST_F(CliCompare, EachThresholdFailsWithThree) {
    Picture brighter = gray(0.5f);
    brighter.at(3, 4)[1] = 0.75f;
    ASSERT_TRUE(write_picture(path("b.png"), brighter));
    EXPECT_EQ(compare("a.png", "b.png").code, 0) << "who asks for nothing is told numbers alone";
    const json numbers = report("a.png", "b.png").at("layers").at(0);
    const double most = numbers.at("max_error"), psnr = numbers.at("psnr"), mean = numbers.at("flip").at("mean");
    EXPECT_NEAR(most, 63.0 / 255, 1e-6) << "codes 128 and 191";
    EXPECT_NEAR(psnr, 10 * std::log10(width * height * 3 / (most * most)), 1e-6);
    const auto text = [](double value) { return std::to_string(value); };
    for (const auto& [flag, passes, fails, told] :
         {std::tuple("--fail-max", text(most + 1e-3), text(most - 1e-3), "max error"),
          std::tuple("--fail-psnr", text(psnr - 0.1), text(psnr + 0.1), "PSNR"),
          std::tuple("--fail-flip", text(mean * 1.1), text(mean * 0.9), "mean FLIP"),
          std::tuple("--fail-above", text(mean * 1.1), text(mean * 0.9), "mean FLIP")}) {
        EXPECT_EQ(compare("a.png", "b.png", {flag, passes}).code, 0) << flag;
        const Outcome outcome = compare("a.png", "b.png", {flag, fails});
        EXPECT_EQ(outcome.code, 3) << flag;
        EXPECT_NE(outcome.err.find(told), std::string::npos) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
    brighter = gray(0.5f);
    brighter.at(3, 4)[3] = 0;
    ASSERT_TRUE(write_picture(path("b.png"), brighter, {.alpha = true}));
    EXPECT_EQ(compare("a.png", "b.png", {"--fail-max", "0.4"}).code, 3) << "alpha is a channel";
}

TEST_F(CliCompare, LayersAreThoseThatTheFilesName) {
    std::vector<float> values = samples(4);
    write_exr("n.exr", {"R", "G", "B", "mask.weight"}, values);
    values[3] += 0.5f;
    write_exr("m.exr", {"R", "G", "B", "mask.weight"}, values);
    EXPECT_EQ(compare("n.exr", "m.exr", {"--fail-max", "0"}).code, 0);
    for (const std::string layer : {"mask", "mask.weight", "color,mask", "all"})
        EXPECT_EQ(compare("n.exr", "m.exr", {"--fail-max", "0.4", "--layers", layer}).code, 3) << layer;
    const json layers = report("n.exr", "m.exr", {"--layers", "color,mask"}).at("layers");
    ASSERT_EQ(layers.size(), 2u);
    EXPECT_EQ(layers.at(0).at("max_error"), 0.0);
    EXPECT_NEAR(layers.at(1).at("max_error").get<double>(), 0.5, 1e-6);
    EXPECT_FALSE(layers.at(1).contains("flip"));
    expect_refused({"compare", path("n.exr"), path("m.exr"), "--layers", "maks"}, 1, "did you mean 'mask'");
    const Outcome missing = compare("a.exr", "m.exr", {"--layers", "all"});
    EXPECT_EQ(missing.code, 3);
    EXPECT_NE(missing.err.find("depth: only the reference has it"), std::string::npos) << missing.err;
}

/// Colours, numbers of objects, and a layer of a number and a weight, by OpenEXR's own writer.
void store_ids(const std::string& path, const std::vector<std::uint32_t>& ids, Imf::Compression compression) {
    std::vector<float> ones(ids.size(), 1);
    Imf::Header header(width, height);
    header.compression() = compression;
    Imf::FrameBuffer buffer;
    const auto add = [&](const char* name, Imf::PixelType type, const void* first) {
        header.channels().insert(name, Imf::Channel(type));
        buffer.insert(name, Imf::Slice::Make(type, first, header.dataWindow()));
    };
    for (const char* const name : {"R", "G", "B", "object.weight"}) add(name, Imf::FLOAT, ones.data());
    for (const char* const name : {"ids", "object.number"}) add(name, Imf::UINT, ids.data());
    Imf::OutputFile output(path.c_str(), header);
    output.setFrameBuffer(buffer);
    output.writePixels(height);
}

// A float would hold neither of these numbers.
TEST_F(CliCompare, NumbersOfObjectsAreComparedInAllTheirBits) {
    constexpr std::uint32_t most = 0xffffffffU;
    for (const Imf::Compression compression : {Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        std::vector<std::uint32_t> ids(width * height, most - 1);
        store_ids(path("m.exr"), ids, compression);
        ids[5] = most;
        ids[width * 3 + 7] = (1U << 24) + 1;
        store_ids(path("n.exr"), ids, compression);
        EXPECT_EQ(compare("n.exr", "n.exr", {"--layers", "all", "--fail-max", "0"}).code, 0);
        EXPECT_EQ(compare("m.exr", "n.exr", {"--layers", "all", "--fail-max", "0"}).code, 3);
        const Outcome told = compare("m.exr", "n.exr", {"--layers", "ids"});
        EXPECT_EQ(told.out, "differing pixels 2 of 384\nworst pixel      7,3  ids: 4294967294 and 16777217\n");
        const json layers = report("m.exr", "n.exr", {"--layers", "all"}).at("layers");
        ASSERT_EQ(layers.size(), 4u) << "of the object its weight and its number";
        for (const json& layer : json::parse(run({"info", path("n.exr"), "--json"}).out).at("layers")) {
            if (layer.at("layer") != "ids") continue;
            EXPECT_EQ((json{layer.at("min"), layer.at("max")}), (json{16777217U, most}));
        }
        EXPECT_NE(run({"info", path("n.exr")}).out.find("  16777217  4294967295  "), std::string::npos);
        for (const json& layer : layers) {
            const bool is_number = layer.at("channels") == json{"ids"} || layer.at("channels") == json{"object.number"};
            EXPECT_EQ(layer.at("differing_pixels"), is_number ? 2 : 0) << layer;
            EXPECT_EQ(layer.at("max_error"), is_number ? most - 1.0 - ((1U << 24) + 1) : 0.0) << layer;
        }
    }
}

TEST_F(CliCompare, WhatCannotBeComparedIsNoDifference) {
    write_exr("wide.exr", {"R", "G", "B"}, samples(3), width / 2);
    expect_refused({"compare", path("a.exr"), path("wide.exr")}, 1, "24x16 and 12x32");
    expect_refused({"compare", path("a.png"), path("a.exr")}, 1, "cannot be compared");
    expect_refused({"compare", path("a.exr"), write("bad.exr", "bad")}, 1, "bad.exr");
    expect_refused({"compare", path("a.exr"), path("")}, 1, "two files, two folders or two sequences");
    expect_refused({"compare", path("a.exr"), path("a.exr"), "--layers", "depth", "--fail-flip", "0"}, 1,
                   "--fail-flip");
    expect_refused({"compare", path("a.exr"), path("a.exr"), "--layers", "color,"}, 1, "a name is empty");
    expect_refused({"compare", path("a.exr"), path("a.exr"), "--diff", path("a.exr")}, 1, "would be overwritten");
    expect_refused({"compare", path("a.exr"), path("a.exr"), "--diff", path("d.png"), "--sheet", path("./d.png")}, 1,
                   "d.png: --diff and --sheet name the same file");
}

class CliCompareMany : public CliCompare {
  protected:
    void make_files() override {
        for (const std::string folder : {"a", "b"}) {
            fs::create_directory(path(folder));
            for (int i = 1; i <= 10; ++i) {
                // Ever further apart, and the ninth has a NaN.
                std::vector<float> values(width * height * 3, 0.5f);
                if (folder == "b")
                    for (float& value : values) value += 0.01f * static_cast<float>(i - 1);
                if (folder == "b" && i == 9) values[7] = not_a_number;
                write_exr(folder + "/s." + std::to_string(i) + ".exr", {"R", "G", "B"}, values);
            }
            write(folder + "/notes.txt", "no picture");
        }
    }
};

TEST_F(CliCompareMany, FoldersAndSequencesAreATableAndASummary) {
    for (const auto& [a, b] : {std::pair("a", "b"), std::pair("a/s.%d.exr", "b/s.%d.exr")}) {
        const Outcome outcome = compare(a, b, {"--fail-max", "0.055"});
        EXPECT_EQ(outcome.code, 3);
        EXPECT_NE(outcome.out.find("\ns.10.exr"), std::string::npos) << outcome.out;
        EXPECT_NE(outcome.out.find("10 compared, 4 differ, 0 missing"), std::string::npos) << outcome.out;
        EXPECT_NE(outcome.out.find("PSNR dB    worst -inf (s.9.exr)"), std::string::npos) << outcome.out;
    }
    EXPECT_EQ(compare("a", "a", {"--fail-max", "0"}).code, 0);
    EXPECT_EQ(compare("a/s.%d.exr[1-8]", "b/s.%d.exr[1-8]").code, 0);
    EXPECT_EQ(compare("a/s.%d.exr", "b/s.%d.exr").code, 3) << "the NaN, without any threshold";
    const json all = report("a", "b", {"--fail-max", "0.055"});
    EXPECT_EQ(all.at("pairs").size(), 10u);
    EXPECT_EQ(all.at("failed"), 4);
    EXPECT_EQ(all.at("max_error").at("worst"), "inf");
    EXPECT_EQ(all.at("max_error").at("pair"), "s.9.exr");
}

TEST_F(CliCompareMany, WhatIsMissingIsADifference) {
    fs::remove(path("b/s.3.exr"));
    fs::remove(path("b/s.9.exr"));
    fs::remove(path("a/s.5.exr"));
    const Outcome outcome = compare("a", "b");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_NE(outcome.out.find("only in the reference: " + path("a/s.3.exr")), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("only in the test: " + path("b/s.5.exr")), std::string::npos) << outcome.out;
    EXPECT_EQ(compare("a/s.%d.exr", "b/s.%d.exr").code, 3);
    EXPECT_EQ(report("a", "b").at("only_in_reference").size(), 2u);
}

TEST_F(CliCompareMany, OneBadFileHidesNoOther) {
    write("b/s.2.exr", "bad");
    const Outcome outcome = compare("a", "b");
    EXPECT_EQ(outcome.code, 1) << "a request that cannot be answered goes before a difference";
    EXPECT_NE(outcome.out.find("9 compared, 1 differ, 0 missing, 1 cannot be compared"), std::string::npos)
        << outcome.out;
    EXPECT_NE(outcome.err.find("s.2.exr"), std::string::npos) << outcome.err;
    fs::create_directory(path("empty"));
    fs::create_directory(path("none"));
    expect_refused({"compare", path("empty"), path("none")}, 1, "no pictures in either");
    expect_refused({"compare", path("a"), path("a/s.1.exr")}, 1, "is a folder and");
    expect_refused({"compare", path("a"), path("b"), "--diff", path("x.png")}, 1, "--sheet");
}

TEST_F(CliCompareMany, TheSheetShowsTheWorstInTheirOrder) {
    const Outcome outcome = compare("a", "b", {"--sheet", path("sheet.png")});
    EXPECT_NE(outcome.out.find("sheet row 1: s.9.exr\nsheet row 2: s.10.exr\nsheet row 3: s.8.exr\n"),
              std::string::npos)
        << outcome.out;
    const Picture sheet = picture("sheet.png");
    EXPECT_EQ(sheet.width, 3 * width + 4 * 8);
    EXPECT_EQ(sheet.height, 8 * height + 9 * 8) << "eight rows";
    // The cell of the test in the first row: magenta where the NaN is, pixel 2 of the first line.
    const float* const pixel = sheet.at(8 + width + 8 + 2, 8);
    EXPECT_EQ(std::vector<float>(pixel, pixel + 3), (std::vector<float>{1, 0, 1}));
    EXPECT_LT(sheet.at(8 + width + 8 + 3, 8)[0], 1.0f);
    // FLIP errors of the second row: all alike, and brighter than those of the eighth.
    EXPECT_GT(sheet.at(8 + 2 * (width + 8) + 4, 8 + height + 8)[0],
              sheet.at(8 + 2 * (width + 8) + 4, 8 + 7 * (height + 8))[0]);
}

TEST_F(CliCompare, WhatIsNotThereIsNamed) {
    fs::create_directory(path("folder"));
    for (const auto& [a, b, missing] : std::vector<std::array<std::string, 3>>{{"folder", "none", "none"},
                                                                               {"none", "folder", "none"},
                                                                               {"none/", "other/", "none/"},
                                                                               {"a.png", "none.png", "none.png"}}) {
        const Outcome outcome = compare(a, b);
        EXPECT_EQ(outcome.code, 1);
        EXPECT_EQ(outcome.err, "darkroom: " + path(missing) + ": there is no such file or folder\n");
    }
}

}  // namespace
}  // namespace darkroom
