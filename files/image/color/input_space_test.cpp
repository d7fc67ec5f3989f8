// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "formats/file_color.hpp"
#include "formats/icc_profile.hpp"
#include "formats/tiff/tiff_check.hpp"
#include "image/color/convert_picture.hpp"
#include "image/color/interop_space.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "image/test_bytes.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

class ImageInputSpace : public WithFolder {
  protected:
    using Color = std::array<float, 3>;

    static std::string number(std::uint32_t value) {
        std::string out;
        for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xffU);
        return out;
    }
    /// ISO 3309, bit by bit: what PNG chunks end with.
    static std::uint32_t checksum(const std::string& data) {
        std::uint32_t crc = ~0U;
        for (const char c : data) {
            crc ^= static_cast<unsigned char>(c);
            for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xedb88320U : 0);
        }
        return ~crc;
    }
    static std::string chunk(const std::string& type, const std::string& data) {
        return number(static_cast<std::uint32_t>(data.size())) + type + data + number(checksum(type + data));
    }
    /// A picture of one colour whose sRGB chunk gives way to these.
    [[nodiscard]] std::filesystem::path png(const Color& color, const std::string& chunks) const {
        Picture picture(2, 2);
        for (std::size_t i = 0; i < 16; ++i) picture.pixels[i] = i % 4 < 3 ? color[i % 4] : 1;
        EXPECT_TRUE(write_picture(file("plain.png"), picture));
        std::string text = content(file("plain.png"));
        const std::size_t at = text.find("sRGB");
        EXPECT_NE(at, std::string::npos);
        text.replace(at - 4, 13, chunks);
        put(file("a.png"), text);
        return file("a.png");
    }
    static Color color_of(const Result<FrameFile>& frame) {
        EXPECT_TRUE(frame) << frame.error().text;
        if (!frame) return {};
        const float* const pixel = frame->color.at(1, 1);
        return {pixel[0], pixel[1], pixel[2]};
    }
    static void expect_near(const Color& color, const Color& expected) {
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(color[i], expected[i], 2e-4) << i;
    }
    static Result<FrameFile> read_as(const std::filesystem::path& path, std::string_view space) {
        return read_frame(path, {.input_space = *find_input_space(space)});
    }
    static std::string first_warning(const std::filesystem::path& path) {
        const auto frame = read_frame(path);
        return frame && !frame->warnings.empty() ? frame->warnings.front() : "";
    }
};

TEST(ImageColor, CurvesHaveTheirPublishedPlaces) {
    using Kind = TransferCurve::Kind;
    EXPECT_NEAR(TransferCurve{Kind::Srgb}.decode(0.5), 0.214041, 1e-6);
    EXPECT_NEAR((TransferCurve{Kind::Power, 2.4}.decode(0.5)), 0.189465, 1e-6);
    // ITU-R BT.2408-7: 58.1 % and 75 % are reference white; PQ ends at 10,000 cd/m2.
    EXPECT_NEAR(TransferCurve{Kind::Pq}.decode(0.5807), 1, 1e-3);
    EXPECT_NEAR(TransferCurve{Kind::Pq}.decode(1), 10000.0 / 203, 1e-9);
    EXPECT_NEAR(TransferCurve{Kind::Hlg}.decode(0.75), 1, 1e-12);
    EXPECT_NEAR(TransferCurve{Kind::Hlg}.decode(0.5), 1.0 / 12 / 0.265, 1e-3);
    for (const Kind kind : {Kind::Linear, Kind::Srgb, Kind::Pq, Kind::Hlg}) {
        const TransferCurve curve{kind};
        EXPECT_EQ(curve.decode(0), 0);
        EXPECT_EQ(curve.decode(-0.3), -curve.decode(0.3));
    }
}

// IEC 61966-2-1 between codes and beyond the last one, as a division by alpha leaves them.
TEST(ImageColor, CodesThatAlphaDividedAreDecodedWhereTheyLie) {
    for (const SampleKind samples : {SampleKind::Integer8, SampleKind::Integer16}) {
        Picture picture(1, 1);
        picture.pixels = {2, 0.5005F, 50000, 0.01F};
        decode(picture, samples, {TransferCurve::Kind::Srgb});
        const auto light = [](double value) { return std::pow((value + 0.055) / 1.055, 2.4); };
        EXPECT_NEAR(picture.pixels[0], light(2), 1e-5);
        EXPECT_NEAR(picture.pixels[1], light(0.5005), 1e-5);
        EXPECT_NEAR(picture.pixels[2] / light(50000), 1, 1e-5);
    }
}

TEST_F(ImageInputSpace, FloatsAreOfTheSpaceThatIsAskedFor) {
    FrameFile frame;
    frame.color = Picture(2, 2);
    for (std::size_t i = 0; i < 16; i += 4) frame.color.pixels[i] = 0.5F;
    frame.samples = SampleKind::Float;
    ASSERT_TRUE(write_frame(file("a.exr"), frame));  // it says Rec. 709
    expect_near(color_of(read_as(file("a.exr"), "rec709")), {0.5F, 0, 0});
    // Half of the first column of the published matrices to Rec. 709.
    expect_near(color_of(read_as(file("a.exr"), "acescg")), {0.85253F, -0.06513F, -0.01200F});
    expect_near(color_of(read_as(file("a.exr"), "ACES2065-1")), {1.26084F, -0.13824F, -0.00769F});
    expect_near(color_of(read_as(file("a.exr"), "rec2020")), {0.83025F, -0.06228F, -0.00908F});
    expect_near(color_of(read_as(file("a.exr"), "p3")), {0.61247F, -0.02103F, -0.00982F});
    expect_near(color_of(read_as(file("a.exr"), "srgb")), {0.214041F, 0, 0});
}

TEST_F(ImageInputSpace, IntegersAreOfTheSpaceThatIsAskedFor) {
    const auto grey = png({128 / 255.0F, 128 / 255.0F, 128 / 255.0F}, chunk("gAMA", number(100000)));
    expect_near(color_of(read_as(grey, "srgb")), {0.215861F, 0.215861F, 0.215861F});
    expect_near(color_of(read_as(grey, "acescg")), {0.501961F, 0.501961F, 0.501961F});
    expect_near(color_of(read_as(grey, "rec709")), {0.191253F, 0.191253F, 0.191253F});
}

TEST_F(ImageInputSpace, PngSaysItself) {
    const Color half{128 / 255.0F, 128 / 255.0F, 128 / 255.0F}, green{0, 1, 0};
    const auto grey = [](float value) { return Color{value, value, value}; };
    const std::string rec2020 = chunk("cICP", {9, 13, 0, 1}), linear = chunk("gAMA", number(100000));
    expect_near(color_of(read_frame(png(half, ""))), grey(0.215861F));
    expect_near(color_of(read_frame(png(half, linear))), grey(0.501961F));
    expect_near(color_of(read_frame(png(half, chunk("gAMA", number(45455))))), grey(0.215861F));
    expect_near(color_of(read_frame(png(half, chunk("gAMA", number(55556))))), grey(0.289056F));  // 1 / 1.8
    expect_near(color_of(read_frame(png(green, rec2020))), {-0.58764F, 1.13290F, -0.10058F});
    expect_near(color_of(read_frame(png(half, chunk("cICP", {1, 8, 0, 1})))), grey(0.501961F));
    // What cameras have stands for the display: ITU-R BT.1886.
    for (const char curve : {'\1', '\6', '\16', '\17'})
        expect_near(color_of(read_frame(png(half, chunk("cICP", {1, curve, 0, 1})))), grey(0.191253F));
    // cICP goes before gAMA, and sRGB too.
    expect_near(color_of(read_frame(png(half, linear + chunk("cICP", {1, 13, 0, 1})))), grey(0.215861F));
    expect_near(color_of(read_frame(png(half, linear + chunk("sRGB", std::string(1, 0))))), grey(0.215861F));
    std::string primaries;
    for (const std::uint32_t value : {31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600})
        primaries += number(value);
    expect_near(color_of(read_frame(png(green, chunk("cHRM", primaries)))), {-0.58764F, 1.13290F, -0.10058F});
}

TEST_F(ImageInputSpace, WhatIsNotReadIsSaid) {
    const Color white{1, 1, 1};
    EXPECT_EQ(first_warning(png(white, "")), "");
    EXPECT_EQ(first_warning(png(white, chunk("cICP", {22, 13, 0, 1}))), "cICP 22 13 0 1 is not read: taken as sRGB");
    EXPECT_EQ(first_warning(png(white, chunk("gAMA", number(1)))), "gAMA 1e-05 is not read, [0.1, 10] is");
    EXPECT_EQ(first_warning(png(white, chunk("cHRM", std::string(32, 0)))),
              "cHRM spans no color space and is not read");
}

/// A profile with one tag.
std::string profile_with(const std::string& desc) {
    const auto number = [](std::size_t value) {
        return std::string({static_cast<char>(value >> 24), static_cast<char>(value >> 16),
                            static_cast<char>(value >> 8), static_cast<char>(value)});
    };
    std::string out(36, 0);
    out += "acsp";
    out.resize(128);
    return out + number(1) + "desc" + number(144) + number(desc.size()) + desc;
}

std::string described(const std::string& profile) { return profile_description(std::as_bytes(std::span(profile))); }

TEST(ImageIccProfile, SaysItsNameInBothForms) {
    using namespace std::string_literals;
    EXPECT_EQ(described(profile_with("desc\0\0\0\0\0\0\0\x0A"
                                     "Adobe RGB\0"s)),
              "Adobe RGB");
    EXPECT_EQ(described(profile_with("mluc\0\0\0\0\0\0\0\1\0\0\0\x0C"
                                     "enUS\0\0\0\4\0\0\0\x1C\0P\0\x33"s)),
              "P3");
    EXPECT_EQ(described(""), "");
    const std::string whole = profile_with(
        "desc\0\0\0\0\xff\xff\xff\xff"
        "Adobe RGB\0"s);
    EXPECT_EQ(described(whole), "");
    for (std::size_t size = 0; size < whole.size(); ++size) described(whole.substr(0, size));
}

/// A profile of three colorants, as ICC prints them for D50, and one curve.
std::string matrix_profile(const std::array<double, 9>& colorants, const std::string& curve,
                           const std::string& blue_curve = {}) {
    const auto number = [](std::int64_t value) {
        std::string out;
        for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
        return out;
    };
    std::string out(128, 0), tags, data;
    out.replace(16, 8, "RGB XYZ ");
    out.replace(36, 4, "acsp");
    const auto add = [&](const std::string& name, std::string tag) {
        tag.resize((tag.size() + 3) / 4 * 4);
        tags += name + number(static_cast<std::int64_t>(132 + 12 * 6 + data.size())) +
                number(static_cast<std::int64_t>(tag.size()));
        data += tag;
    };
    for (std::size_t i = 0; i < 3; ++i) {
        std::string xyz = "XYZ " + number(0);
        for (std::size_t k = 0; k < 3; ++k) xyz += number(std::llround(colorants[i * 3 + k] * 65536));
        add(std::string(1, "rgb"[i]) + "XYZ", xyz);
    }
    for (std::size_t i = 0; i < 3; ++i)
        add(std::string(1, "rgb"[i]) + "TRC", i == 2 && !blue_curve.empty() ? blue_curve : curve);
    return out + number(6) + tags + data;
}

TEST(ImageIccProfile, OfAMatrixAndACurveIsRead) {
    using Kind = TransferCurve::Kind;
    const auto bytes = [](std::int64_t value, int count) {
        std::string out;
        for (int shift = 8 * (count - 1); shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
        return out;
    };
    const auto coding = [](const std::string& profile) { return profile_coding(std::as_bytes(std::span(profile))); };
    std::string parametric = "para" + bytes(0, 4) + bytes(3, 2) + bytes(0, 2);
    for (const double value : {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045})
        parametric += bytes(std::llround(value * 65536), 4);
    std::string sampled = "curv" + bytes(0, 4) + bytes(1024, 4);
    for (int i = 0; i < 1024; ++i)
        sampled += bytes(std::llround(TransferCurve{Kind::Srgb}.decode(i / 1023.0) * 65535), 2);
    std::string odd = "curv" + bytes(0, 4) + bytes(3, 4) + bytes(0, 2) + bytes(60000, 2) + bytes(65535, 2);
    // Of colour.org's and Adobe's own profiles.
    const std::array<double, 9> p3{0.51512, 0.2412, -0.00105, 0.29198, 0.69225, 0.04189, 0.1571, 0.06657, 0.78407};
    const std::array<double, 9> srgb{0.43607, 0.22249, 0.01392, 0.38515, 0.71687, 0.09708, 0.14307, 0.06061, 0.7141};
    const std::array<double, 9> adobe{0.60974, 0.31111, 0.01947, 0.20528, 0.62567, 0.06087, 0.14919, 0.06322, 0.74457};
    EXPECT_EQ(coding(matrix_profile(p3, parametric)), (ColorCoding{find_input_space("p3")->primaries, {Kind::Srgb}}));
    EXPECT_EQ(coding(matrix_profile(srgb, sampled)), ColorCoding{}) << "to the bit, however its numbers are rounded";
    const std::string gamma = "curv" + bytes(0, 4) + bytes(1, 4) + bytes(563, 2);
    const auto found = coding(matrix_profile(adobe, gamma));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->curve.exponent, 2.19922, 1e-4);
    const std::array<double, 9> published{1.39836, -0.39836, 0, 0, 1, 0, 0, -0.04293, 1.04293};
    const ColorMatrix matrix = *to_rec709(found->primaries);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(matrix[i], published[i], 1e-3) << i;
    EXPECT_FALSE(coding(matrix_profile(p3, odd))) << "no curve that is known";
    const std::string unknown = matrix_profile(p3, odd);
    EXPECT_TRUE(has_curves(std::as_bytes(std::span(unknown)))) << "whatever it is called";
    EXPECT_FALSE(coding(matrix_profile(p3, parametric, gamma))) << "a curve for each channel";
    const std::vector<std::byte> ours = display_profile("Display P3", find_input_space("p3")->primaries);
    EXPECT_EQ(profile_coding(ours), (ColorCoding{find_input_space("p3")->primaries, {Kind::Srgb}}));
    EXPECT_EQ(profile_description(ours), "Display P3");
    const std::string whole = matrix_profile(srgb, sampled);
    for (std::size_t size = 0; size < whole.size(); size += 7) coding(whole.substr(0, size));
}

TEST(ImageInteropSpace, NamesOfTheForumAreKnown) {
    using Kind = TransferCurve::Kind;
    for (const char* const id : {"lin_ap1_scene",
                                 "lin_ap0_scene",
                                 "lin_rec709_scene",
                                 "lin_p3d65_scene",
                                 "lin_rec2020_scene",
                                 "lin_adobergb_scene",
                                 "lin_ciexyzd65_scene",
                                 "srgb_rec709_scene",
                                 "g22_rec709_scene",
                                 "g18_rec709_scene",
                                 "srgb_ap1_scene",
                                 "g22_ap1_scene",
                                 "srgb_p3d65_scene",
                                 "g22_adobergb_scene",
                                 "data",
                                 "unknown",
                                 "srgb_rec709_display",
                                 "g24_rec709_display",
                                 "srgb_p3d65_display",
                                 "srgbx_p3d65_display",
                                 "pq_p3d65_display",
                                 "pq_rec2020_display",
                                 "hlg_rec2020_display",
                                 "g22_rec709_display",
                                 "g22_adobergb_display",
                                 "g26_p3d65_display",
                                 "g26_xyzd65_display",
                                 "pq_xyzd65_display"})
        EXPECT_TRUE(find_interop_space(id)) << id;
    for (const char* const id : {"", "_", "__", "lin", "lin_ap1", "lin_ap1_scenes", "lin__scene", "ap1_lin_scene"})
        EXPECT_FALSE(find_interop_space(id)) << id;
    EXPECT_EQ(find_interop_space("studio:srgb_ap1_scene")->coding,
              (ColorCoding{find_input_space("acescg")->primaries, {Kind::Srgb}}));
    EXPECT_EQ(interop_id_of({}), "lin_rec709_scene");
    EXPECT_EQ(interop_id_of(find_input_space("aces2065-1")->primaries), "lin_ap0_scene");
    EXPECT_EQ(interop_id_of({.red = {0.7, 0.3}}), "");
}

TEST_F(ImageInputSpace, ProfilesOfJpegAreNamed) {
    using namespace std::string_literals;
    Picture picture(8, 8);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = i % 4 == 0 || i % 4 == 3 ? 1.0F : 0.0F;
    ASSERT_TRUE(write_picture(file("plain.jpg"), picture));
    const auto jpeg = [&](const std::string& name) {
        std::string desc = "desc\0\0\0\0\0\0\0"s;
        desc += static_cast<char>(name.size() + 1);
        desc += name + '\0';
        const std::string data = "ICC_PROFILE\0\1\1"s + profile_with(desc);
        const std::size_t length = data.size() + 2;
        std::string text = content(file("plain.jpg"));
        text.insert(2, "\xff\xe2"s + static_cast<char>(length >> 8) + static_cast<char>(length & 0xff) + data);
        put(file("a.jpg"), text);
        return file("a.jpg");
    };
    EXPECT_EQ(first_warning(jpeg("sRGB IEC61966-2.1")), "");
    EXPECT_EQ(first_warning(jpeg("Adobe RGB (1998)")),
              "its ICC profile 'Adobe RGB (1998)' is not read: taken as sRGB, --input-space says otherwise");
    const Color red = color_of(read_frame(jpeg("Display P3")));
    EXPECT_NEAR(red[0], 1.2249F, 0.03F);
    EXPECT_NEAR(red[1], -0.0421F, 0.005F);
    EXPECT_EQ(first_warning(jpeg("Display P3")), "");
}

TEST_F(ImageInputSpace, ProfilesOfTiffAreNamed) {
    using namespace std::string_literals;
    const auto tiff = [&](const std::string& name) {
        std::string profile = profile_with("desc\0\0\0\0\0\0\0"s + static_cast<char>(name.size() + 1) + name + '\0');
        profile.resize((profile.size() + 3) / 4 * 4);
        TestTiff test = TestTiff::gray(16, 16);
        std::vector<std::uint32_t>& numbers = test.tags[34675];
        numbers.resize(profile.size() / 4);
        std::memcpy(numbers.data(), profile.data(), profile.size());
        put(file("a.tif"), test.text());
        return test.text();
    };
    tiff("sRGB IEC61966-2.1");
    EXPECT_EQ(first_warning(file("a.tif")), "");
    const std::string whole = tiff("Adobe RGB (1998)");
    EXPECT_EQ(first_warning(file("a.tif")),
              "its ICC profile 'Adobe RGB (1998)' is not read: taken as sRGB, --input-space says otherwise");
    // Wherever a damaged directory says that it lies.
    for (const char byte : {'\x00', '\x7f', '\xff'})
        for (std::size_t i = 8; i < 8 + 2 + 12 * 10; ++i) {
            std::string damaged = whole;
            damaged[i] = byte;
            static_cast<void>(profile_of_tiff(std::as_bytes(std::span(damaged))));
        }
}

TEST(ImageColor, UnknownSpacesAreTold) {
    const auto space = find_input_space("acescc");
    ASSERT_FALSE(space);
    EXPECT_EQ(
        space.error().text,
        "'acescc' is not a known color space, did you mean 'acescg'? allowed is srgb, rec709, rec2020, p3, acescg "
        "or aces2065-1");
}

}  // namespace
}  // namespace darkroom
