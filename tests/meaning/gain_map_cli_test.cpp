// SPDX-License-Identifier: MIT
// JPEG pictures with a gain map, by the formula of ISO 21496-1 in double precision, by a file of libultrahdr and its
// numbers, and by that library where PyPI's imagecodecs is there.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/icc_profile.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "image/test_bytes.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

struct Range {
    double min = 0, max = 1, gamma = 1, base_offset = 1.0 / 64, brighter_offset = 1.0 / 64;
};
using Ranges = std::array<Range, 3>;

std::string segment(char kind, const std::string& data) {
    return std::string("\xff") + kind + big_endian(static_cast<std::uint32_t>(data.size() + 2), 2) + data;
}

/// In 1/4096.
std::string iso_of(const Ranges& ranges, bool shares_denominator, std::uint32_t base_headroom = 0) {
    const auto number = [&](double value) {
        return big_endian(std::bit_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * 4096))), 4) +
               (shares_denominator ? "" : big_endian(4096, 4));
    };
    std::string out = std::string("urn:iso:std:iso:ts:21496:-1\0", 28) + std::string(4, '\0') +
                      (shares_denominator ? '\xc8' : '\xc0') + (shares_denominator ? big_endian(4096, 4) : "");
    out += number(base_headroom) + number(2);
    for (const Range& of : ranges)
        for (const double value : {of.min, of.max, of.gamma, of.base_offset, of.brighter_offset}) out += number(value);
    return segment('\xe2', out);
}

std::string xmp_of(const std::string& attributes, const std::string& elements = "") {
    return segment('\xe1', std::string("http://ns.adobe.com/xap/1.0/\0", 29) +
                               "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF><rdf:Description "
                               "hdrgm:Version=\"1.0\" " +
                               attributes + ">" + elements + "</rdf:Description></rdf:RDF></x:xmpmeta>");
}

/// A list of two pictures (CIPA DC-007) in the first, and the second behind it.
std::string of_two(const std::string& first, const std::string& second) {
    const auto entry = [](std::uint16_t tag, std::uint16_t type, std::uint32_t count, std::uint32_t value) {
        return little_endian(tag) + little_endian(type) + little_endian(count) + little_endian(value);
    };
    const auto list = [&](std::size_t place) {
        return segment('\xe2', std::string("MPF\0II*\0", 8) + little_endian(8U) + little_endian(std::uint16_t{2}) +
                                   entry(0xb001, 4, 1, 2) + entry(0xb002, 7, 32, 38) + little_endian(0U) +
                                   little_endian(0x030000U) + std::string(12, '\0') + little_endian(0U) +
                                   little_endian(static_cast<std::uint32_t>(second.size())) +
                                   little_endian(static_cast<std::uint32_t>(place)) + little_endian(0U));
    };
    return first.substr(0, 2) + list(first.size() + list(0).size() - 10) + first.substr(2) + second;
}

double light_of_code(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

class CliGainMap : public test::CliFixture {
  protected:
    void make_files() override {
        write("plain.toml", "format = 1\n[[stack]]\neffect = \"exposure\"\n");
        save("base.jpg", 32, [](std::uint32_t, std::uint32_t) { return std::array{0.5f, 0.5f, 0.5f}; });
        save("map.jpg", 8, [](std::uint32_t, std::uint32_t) { return std::array{0.2f, 0.5f, 0.8f}; });
    }
    template <class Color>
    void save(const std::string& name, std::uint32_t side, const Color& color) const {
        Picture out(side, side);
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x) std::ranges::copy(color(x, y), out.at(x, y));
        ASSERT_TRUE(write_picture(path(name), out, {.quality = 100, .chroma = "4:4:4"}));
    }
    void save_with(const std::string& name, const std::string& numbers, const std::string& map = "map.jpg") const {
        const std::string second = content(path(map));
        write(name, of_two(content(path("base.jpg")), second.substr(0, 2) + numbers + second.substr(2)));
    }
    [[nodiscard]] Picture light(const std::string& from, const std::string& warning = "") const {
        const Outcome outcome = run({"develop", from, "--look", path("plain.toml"), "-o", path("light.exr"), "--bits",
                                     "float", "-q"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, warning.empty() ? "" : fmt::format("darkroom: warning: {}: {}\n", from, warning));
        return outcome.code == 0 ? picture("light.exr") : Picture{};
    }
    /// What the formula says of the two pictures as they are read alone.
    void expect_by_formula(const std::string& name, const Ranges& ranges) const {
        const Picture found = light(path(name)), base = picture("base.jpg"), map = picture("map.jpg");
        ASSERT_EQ(found.pixels.size(), base.pixels.size());
        for (std::uint32_t x = 0; x < found.width; x += 5)
            for (std::size_t c = 0; c < 3; ++c) {
                const Range& of = ranges[c];
                const double share = std::pow(double{map.at(4, 4)[c]}, 1 / of.gamma);
                const double expected = (light_of_code(double{base.at(x, 9)[c]}) + of.base_offset) *
                                            std::exp2(of.min + (of.max - of.min) * share) -
                                        of.brighter_offset;
                EXPECT_NEAR(double{found.at(x, 9)[c]}, expected, 2e-5 * std::abs(expected) + 1e-6) << name << x << c;
            }
    }
};

constexpr Ranges three{Range{-0.5, 2, 1, 0.25, 0.125}, Range{0, 3, 2, 0, 0}, Range{0.25, 1, 0.5, 0.0625, 0.5}};

TEST_F(CliGainMap, IsoSaysItsNumbersByChannel) {
    save_with("own.jpg", iso_of(three, false));
    expect_by_formula("own.jpg", three);
    save_with("shared.jpg", iso_of(three, true));
    expect_by_formula("shared.jpg", three);
    const auto info = nlohmann::json::parse(run({"info", path("own.jpg"), "--json"}).out, nullptr, false);
    EXPECT_NE(info.dump().find("gain map (ISO 21496-1)"), std::string::npos) << info;
}

TEST_F(CliGainMap, XmpSaysThemInAttributesAndLists) {
    const Range all{0, 2.5};
    save_with("short.jpg", xmp_of("hdrgm:GainMapMax=\"2.5\" hdrgm:HDRCapacityMax=\"2.5\""));
    expect_by_formula("short.jpg", {all, all, all});
    const auto list = [](const std::string& name, auto of) {
        return fmt::format("<hdrgm:{0}>\n<rdf:Seq><rdf:li>{1}</rdf:li>\n<rdf:li>{2}</rdf:li><rdf:li> {3} </rdf:li>"
                           "</rdf:Seq></hdrgm:{0}>\n",
                           name, of(three[0]), of(three[1]), of(three[2]));
    };
    save_with("lists.jpg",
              xmp_of("", list("GainMapMin", [](const Range& of) { return of.min; }) +
                             list("GainMapMax", [](const Range& of) { return of.max; }) +
                             list("Gamma", [](const Range& of) { return of.gamma; }) +
                             list("OffsetSDR", [](const Range& of) { return of.base_offset; }) +
                             list("OffsetHDR", [](const Range& of) { return of.brighter_offset; })));
    expect_by_formula("lists.jpg", three);
    // Both are there: the standard goes first.
    save_with("both.jpg", xmp_of("hdrgm:GainMapMax=\"7\"") + iso_of(three, false));
    expect_by_formula("both.jpg", three);
}

// From the left half of a map to the right one it goes straight, about the middle of the picture.
TEST_F(CliGainMap, ASmallerMapIsDrawnOverTheWholePicture) {
    save("map.jpg", 16, [](std::uint32_t x, std::uint32_t) {
        const float value = x < 8 ? 0.0f : 1.0f;
        return std::array{value, value, value};
    });
    const Range of{0, 2, 1, 0, 0};
    save_with("half.jpg", iso_of({of, of, of}, false));
    const Picture found = light(path("half.jpg")), base = picture("base.jpg");
    ASSERT_EQ(found.width, 32u);
    for (std::uint32_t x = 0; x < 32; ++x) {
        const double share = std::clamp((x + 0.5) / 2 - 7.5, 0.0, 1.0);
        const double expected = light_of_code(double{base.at(x, 9)[1]}) * std::exp2(2 * share);
        EXPECT_NEAR(double{found.at(x, 9)[1]}, expected, 0.01 * expected) << x;
    }
}

TEST_F(CliGainMap, WhatIsNotAppliedIsTold) {
    const auto told = [](const std::string& why) {
        return "has a gain map for light beyond white, which is not applied, since " + why +
               ": the picture without it is read";
    };
    const auto expect_told = [&](const std::string& numbers, const std::string& why) {
        save_with("not.jpg", numbers);
        const Picture found = light(path("not.jpg"), told(why)), plain = light(path("base.jpg"));
        EXPECT_EQ(found.pixels, plain.pixels);
    };
    const auto with = [](auto&& change) {
        Ranges out = three;
        change(out[1]);
        return out;
    };
    expect_told(segment('\xe2', iso_of(three, false).substr(4, 56)), "its numbers by ISO 21496-1 are cut off");
    expect_told(iso_of(with([](Range& of) { of.gamma = 0; }), false), "its gamma is 0, 1/64 to 64 is allowed");
    expect_told(iso_of(with([](Range& of) { of.max = 40; }), true), "its gain is 40 stops, -16 to 16 are allowed");
    expect_told(iso_of(with([](Range& of) { of.min = 4; }), true), "its least gain is 4 stops, its greatest 3");
    expect_told(iso_of(with([](Range& of) { of.base_offset = 3; }), true), "its offset is 3, -1 to 1 is allowed");
    expect_told(iso_of(three, false, 3), "it makes the picture darker, for displays without room");
    std::string nothing = iso_of(three, true);
    nothing.replace(nothing.find('\xc8') + 1, 4, 4, '\0');
    expect_told(nothing, "its gain is -inf stops, -16 to 16 are allowed");
    expect_told(xmp_of("hdrgm:Gamma=\"1\""), "it does not say hdrgm:GainMapMax");
    expect_told(xmp_of("hdrgm:GainMapMax=\"two\""), "its hdrgm:GainMapMax is no number");
    expect_told(xmp_of("hdrgm:GainMapMax=\"nan\""), "its gain is nan stops, -16 to 16 are allowed");
    expect_told(xmp_of("", "<hdrgm:GainMapMax><rdf:li>1</rdf:li><rdf:li>2</rdf:li></hdrgm:GainMapMax>"),
                "hdrgm:GainMapMax has 2 values, 1 or 3 are allowed");
    expect_told(segment('\xe1', std::string("http://ns.adobe.com/xap/1.0/\0", 29) + "<x aux:hdrgainmap/>"),
                "it is of Apple's kind");
}

TEST_F(CliGainMap, ADamagedOneIsRefused) {
    save_with("whole.jpg", iso_of(three, false));
    const std::string whole = content(path("whole.jpg"));
    write("cut.jpg", whole.substr(0, whole.size() - 20));
    expect_refused({"info", path("cut.jpg")}, 1, "its gain map: truncated");
    save("large.jpg", 40, [](std::uint32_t, std::uint32_t) { return std::array{0.5f, 0.5f, 0.5f}; });
    save_with("larger.jpg", iso_of(three, false), "large.jpg");
    expect_refused({"info", path("larger.jpg")}, 1, "its gain map: is 40x40, its picture's 32x32 is allowed");
    std::string bad = whole;
    bad.replace(bad.size() - 60, 40, 40, '\x55');
    write("bad.jpg", bad);
    const Outcome outcome = run({"develop", path("bad.jpg"), "-o", path("out.png")});
    EXPECT_LE(outcome.code, 1) << outcome.err;
    EXPECT_LE(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
}

// The base is in Rec. 709, the gain is one of P3's red, green and blue. Grey is grey in both.
TEST_F(CliGainMap, TheGainMayBeOfOtherColorsThanThePicture) {
    const std::vector<std::byte> bytes = display_profile("P3", find_input_space("p3")->primaries);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string profile = segment('\xe2', std::string("ICC_PROFILE\0\1\1", 14).append(text));
    std::string numbers = iso_of(three, false);
    numbers.replace(numbers.find('\xc0'), 1, 1, '\x80');
    save_with("wide.jpg", profile + numbers);
    const Picture found = light(path("wide.jpg")), base = picture("base.jpg"), map = picture("map.jpg");
    ASSERT_EQ(found.width, 32u);
    std::array<double, 3> wide{};
    for (std::size_t c = 0; c < 3; ++c) {
        const Range& of = three[c];
        const double share = std::pow(double{map.at(4, 4)[c]}, 1 / of.gamma);
        wide[c] = (light_of_code(double{base.at(9, 9)[c]}) + of.base_offset) *
                      std::exp2(of.min + (of.max - of.min) * share) -
                  of.brighter_offset;
    }
    // Linear P3 of D65 to linear Rec. 709, as CSS Color Module Level 4 has it by way of XYZ.
    constexpr std::array<std::array<double, 3>, 3> to_rec709{{{1.2249401763, -0.2249401763, 0},
                                                              {-0.0420569547, 1.0420569547, 0},
                                                              {-0.0196375546, -0.0786360456, 1.0982736001}}};
    for (std::size_t c = 0; c < 3; ++c) {
        double expected = 0;
        for (std::size_t i = 0; i < 3; ++i) expected += to_rec709[c][i] * wide[i];
        EXPECT_NEAR(double{found.at(9, 9)[c]}, expected, 1e-3) << c;
    }
}

// libultrahdr 1.4.0 wrote it from light in Rec. 709: a base in Display P3, of whose colours the gain is. The numbers
// are what that library decodes.
TEST_F(CliGainMap, AFileOfLibultrahdrIsTheLightThatItDecodes) {
    const Picture found = light(std::string(test::source_folder) + "/tests/meaning/ultra_hdr.jpg");
    ASSERT_EQ(found.width, 32u);
    struct Decoded {
        std::uint32_t y, x;
        std::array<double, 3> light;
    };
    for (const auto& [y, x, expected] :
         {Decoded{0, 0, {0.0471, 0.049, 0.0372}}, Decoded{31, 0, {0.0496, 0.0477, 0.832}},
          Decoded{0, 31, {3.9844, 0.3474, 0.0445}}, Decoded{31, 31, {4.0469, 2.8398, 1.543}},
          Decoded{16, 16, {1.1406, 0.5542, 0.6504}}, Decoded{8, 24, {2.4082, 0.4155, 0.3818}},
          Decoded{24, 8, {0.3264, 0.5098, 0.8013}}})
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(double{found.at(x, y)[c]}, expected[c], 0.015 * expected[c] + 0.002) << y << ' ' << x;
}

TEST_F(CliGainMap, FilesOfLibultrahdrAreTheLightThatItDecodes) {
    if (run_lines("python3 -c 'import imagecodecs, numpy'").code != 0)
        GTEST_SKIP() << "python3 has no imagecodecs (PyPI), which holds libultrahdr";
    // A smooth picture with lights of seven whites; maps of the picture's size and of a quarter of its side.
    const Outcome made = run_lines(R"(python3 - <<'END'
import imagecodecs, numpy
y, x = numpy.mgrid[0:192, 0:256]
light = numpy.ones((192, 256, 4), numpy.float16)
lamp = 6 * numpy.exp(-((x - 180) / 40.0) ** 2 - ((y - 80) / 40.0) ** 2)
for c, (ramp, tint) in enumerate([(1.0, 1.0), (0.6, 0.8), (0.3, 0.5)]):
    light[..., c] = 0.02 + ramp * x / 256 + tint * lamp
wide = numpy.array([[0.8224621, 0.177538, 0], [0.0331941, 0.9668058, 0], [0.0170827, 0.0723974, 0.9105199]])
def save(name, rgb):
    with open(name, "wb") as file:
        file.write(b"PF\n256 192\n-1\n" + rgb[::-1].astype("<f4").tobytes())
for gamut, turn in (("BT_709", numpy.eye(3)), ("DISPLAY_P3", numpy.linalg.inv(wide))):
    save(f"{gamut}.pfm", light[..., :3].astype(float) @ turn.T)
    for scale in (1, 4):
        data = imagecodecs.ultrahdr_encode(light, gamut=imagecodecs.ULTRAHDR.CG[gamut], scale=scale, level=98)
        open(f"{gamut}_{scale}.jpg", "wb").write(data)
        save(f"{gamut}_{scale}.pfm", imagecodecs.ultrahdr_decode(data)[..., :3].astype(float) @ turn.T)
END
)");
    ASSERT_EQ(made.code, 0) << made.err;
    const auto flip = [&](const std::string& reference, const std::string& found) {
        const Outcome outcome = run({"compare", path(reference), path(found), "--json"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const auto told = nlohmann::json::parse(outcome.out, nullptr, false);
        return outcome.code == 0 ? told.at("layers").at(0).at("flip").at("mean").get<double>() : 1.0;
    };
    for (const std::string gamut : {"BT_709", "DISPLAY_P3"}) {
        // Its tables of 1024 codes and 1024 gains are steps of 0.2 % and more.
        EXPECT_LT(flip(gamut + "_1.pfm", gamut + "_1.jpg"), 0.012) << gamut;
        // The library draws a smaller map half of its pixel aside, so the light that was encoded is the referee.
        EXPECT_LT(flip(gamut + ".pfm", gamut + "_4.jpg"), 0.9 * flip(gamut + ".pfm", gamut + "_4.pfm")) << gamut;
    }
}

// A room with a lamp that is brighter than the display of 1000 cd/m2 shows.
class CliGainMapWriting : public CliGainMap {
  protected:
    void make_files() override {
        CliGainMap::make_files();
        FrameFile frame;
        frame.color = Picture(160, 120);
        for (std::uint32_t y = 0; y < 120; ++y)
            for (std::uint32_t x = 0; x < 160; ++x) {
                const double away = std::hypot(x - 110.0, y - 50.0) / 25, lamp = 12 * std::exp(-away * away);
                const auto color = [&](double ramp, double tint) {
                    return static_cast<float>(0.01 + ramp * x / 160 + tint * lamp);
                };
                const std::array pixel{color(0.8, 1), color(0.5, 0.8), color(0.2, 0.5), 1.0f};
                std::ranges::copy(pixel, frame.color.at(x, y));
            }
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
    }
    void develop(std::vector<std::string> flags, const std::string& out, double peak = 1000) const {
        flags.insert(flags.begin(), {"develop", path("frame.exr"), "-q", "-o", path(out)});
        flags.insert(flags.end(), {"--tonemap-curve", "bt2390", "--tonemap-white", "12", "--tonemap-peak-nits",
                                   fmt::format("{}", peak), "--no-bloom"});
        const Outcome outcome = run(flags);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    [[nodiscard]] double flip(const std::string& reference, const std::string& found) const {
        const Outcome outcome = run({"compare", path(reference), path(found), "--json"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        if (outcome.code != 0) return 1;
        return nlohmann::json::parse(outcome.out).at("layers").at(0).at("flip").at("mean").get<double>();
    }
};

TEST_F(CliGainMapWriting, BothPicturesAreDevelopedFromTheScenesLight) {
    develop({"--gain-map"}, "both.jpg");
    develop({"--bits", "float"}, "bright.exr");
    EXPECT_LT(flip("bright.exr", "both.jpg"), 0.015);
    // The base is the picture for displays of standard range, by the same look, to the last bit.
    develop({}, "standard.jpg", 203);
    const std::string both = content(path("both.jpg")), mark = "Item:Length=\"";
    const std::size_t length = std::stoul(both.substr(both.find(mark) + mark.size()));
    ASSERT_EQ(both.substr(both.size() - length, 3), "\xff\xd8\xff");
    write("base.jpg", both.substr(0, both.size() - length));
    EXPECT_EQ(picture("base.jpg"), picture("standard.jpg"));
}

TEST_F(CliGainMapWriting, LibultrahdrReadsTheSameLight) {
    if (run_lines("python3 -c 'import imagecodecs, numpy'").code != 0)
        GTEST_SKIP() << "python3 has no imagecodecs (PyPI), which holds libultrahdr";
    develop({"--gain-map"}, "both.jpg");
    develop({"--bits", "float"}, "bright.exr");
    const Outcome made = run_lines(R"(python3 - <<'END'
import imagecodecs
light = imagecodecs.ultrahdr_decode(open("both.jpg", "rb").read())[..., :3]
with open("theirs.pfm", "wb") as file:
    file.write(b"PF\n160 120\n-1\n" + light[::-1].astype("<f4").tobytes())
END
)");
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_LT(flip("both.jpg", "theirs.pfm"), 0.01);
    EXPECT_LT(flip("bright.exr", "theirs.pfm"), 0.02);
}

TEST_F(CliGainMapWriting, GainmapJsFindsItsNumbersInBothPlaces) {
    if (run_lines("node -e \"require('@monogrid/gainmap-js')\"").code != 0)
        GTEST_SKIP() << "node has no @monogrid/gainmap-js (npm, NODE_PATH)";
    develop({"--gain-map"}, "both.jpg");
    const Outcome told = run_lines(R"(node - <<'END'
const { extractGainmapFromJPEG, extractXMP } = require("@monogrid/gainmap-js");
const data = new Uint8Array(require("fs").readFileSync("both.jpg"));
extractGainmapFromJPEG(data).then((found) => {
    const xmp = extractXMP(data);
    for (const of of [found.metadata, xmp])
        console.log(of.gainMapMin[1], of.gamma[0], of.offsetSdr[2], of.offsetHdr[0], of.hdrCapacityMin);
    console.log(Math.abs(found.metadata.gainMapMax[0] - xmp.gainMapMax[0]) < 1e-4,
                Math.abs(xmp.hdrCapacityMax - Math.log2(1000 / 203)) < 0.01);
});
END
)");
    EXPECT_EQ(told.out, "-0.25 0.5 0.015625 0.015625 0\n-0.25 0.5 0.015625 0.015625 0\ntrue true\n") << told.err;
}

TEST_F(CliGainMapWriting, WhereThereIsNothingToShowItIsRefused) {
    const std::string frame = path("frame.exr");
    const std::vector<std::string> bright{"--tonemap-curve", "bt2390", "--tonemap-peak-nits", "1000"};
    const auto refused = [&](const std::string& out, std::vector<std::string> flags, const std::string& why) {
        flags.insert(flags.begin(), {"develop", frame, "-o", path(out), "--gain-map"});
        expect_refused(flags, 1, why);
    };
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), bright.begin(), bright.end());
        return more;
    };
    refused("out.jpg", {}, "--gain-map: the look ends at white on every display");
    refused("out.png", bright, "out.png has none; .jpg has");
    refused("out.jpg", with({"--reference"}), "works without --reference");
    refused("out.jpg", with({"--output-space", "srgb"}), "works without --output-space");
}

}  // namespace
}  // namespace darkroom
