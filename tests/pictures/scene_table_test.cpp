// SPDX-License-Identifier: MIT
// How good the shipped scenes are at their defaults: shadows against rays, the noise of the occlusion, the picture
// against that of 256 samples, and the longest run of one code. DARKROOM_PICTURES_SIZE (as 960x540) makes it shorter;
// the bounds are those of 1920x1080. Where DARKROOM_PICTURES names a folder, it gets the pictures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <darkroom/effects/ssao.hpp>
#include <filesystem>

#include "image/picture/write.hpp"
#include "tests/cli/cli_support.hpp"
#include "tests/pictures/scene_shadows.hpp"

namespace darkroom {
namespace {

/// Of the same three codes in a row or a column of an 8-bit picture. Black and white, which are cut off, are no bands.
std::uint32_t longest_band(const Picture& picture) {
    const auto code = [&](std::uint32_t x, std::uint32_t y, std::size_t channel) {
        return std::lround(picture.at(x, y)[channel] * 255);
    };
    const auto is_cut_off = [&](std::uint32_t x, std::uint32_t y) {
        const auto sum = code(x, y, 0) + code(x, y, 1) + code(x, y, 2);
        return sum == 0 || sum == 3 * 255;
    };
    std::uint32_t longest = 0;
    const auto walk = [&](std::uint32_t lines, std::uint32_t length, const auto& place) {
        for (std::uint32_t line = 0; line < lines; ++line) {
            std::uint32_t run = 0;
            for (std::uint32_t i = 0; i < length; ++i) {
                const auto [x, y] = place(line, i);
                const auto [u, v] = place(line, i == 0 ? 0 : i - 1);
                bool is_same = i > 0 && !is_cut_off(x, y);
                for (std::size_t channel = 0; channel < 3; ++channel)
                    is_same = is_same && code(x, y, channel) == code(u, v, channel);
                run = is_same ? run + 1 : 1;
                longest = std::max(longest, run);
            }
        }
    };
    walk(picture.height, picture.width, [](std::uint32_t y, std::uint32_t x) { return std::pair(x, y); });
    walk(picture.width, picture.height, [](std::uint32_t x, std::uint32_t y) { return std::pair(x, y); });
    return longest;
}

Picture part_of(const Picture& picture, std::uint32_t left, std::uint32_t top, std::uint32_t width,
                std::uint32_t height) {
    Picture out(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) std::copy_n(picture.at(left + x, top + y), 4, out.at(x, y));
    return out;
}

class SoakGpuPictures : public test::CliFixture, public testing::WithParamInterface<const char*> {
  protected:
    /// By the program.
    [[nodiscard]] Picture rendered(const std::string& scene, std::vector<std::string> flags) const {
        const char* const folder = std::getenv("DARKROOM_PICTURES");
        std::string name = scene;
        for (const std::string& flag : flags) name += flag;
        const std::string out = folder != nullptr ? fmt::format("{}/{}.png", folder, name) : path(name + ".png");
        flags.insert(flags.begin(),
                     {"render", fmt::format("{}/scenes/{}.scene.toml", test::source_folder, scene), "-o", out, "--size",
                      fmt::format("{}x{}", test::picture_extent.width, test::picture_extent.height)});
        const test::Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        const Result<ComparablePicture> read = read_comparable(out);
        EXPECT_TRUE(read) << read.error().text;
        return read ? read->picture : Picture{};
    }
    [[nodiscard]] static double flip(const Picture& reference, const Picture& picture) {
        const Result<Comparison> compared = compare(reference, picture);
        EXPECT_TRUE(compared) << compared.error().text;
        return compared ? compared->flip_mean : 1;
    }
};

INSTANTIATE_TEST_SUITE_P(Shipped, SoakGpuPictures, testing::ValuesIn(test::shipped_scenes),
                         [](const auto& scene) { return std::string(scene.param); });

TEST_P(SoakGpuPictures, HasTheShadowsOfRaysAndNoNoise) {
    test::SceneView scene(GetParam());
    Picture shadows, speckles;
    const test::ShadowFaults faults = test::shadow_faults(scene, &shadows);
    const test::Noise noise = test::noise_of(scene, &speckles);
    fmt::print("| {} | {} leak, {} acne of {} | noise {:.2f}, worst {:.1f} |\n", GetParam(), faults.leaking,
               faults.acne, faults.looked_at, noise.most, noise.worst);
    if (const char* const folder = std::getenv("DARKROOM_PICTURES")) {
        gpu::test::must(write_picture(fmt::format("{}/{}_shadows.png", folder, GetParam()), shadows));
        gpu::test::must(write_picture(fmt::format("{}/{}_noise.png", folder, GetParam()), speckles));
    }
    EXPECT_GT(faults.looked_at, 10000U);
    EXPECT_LE(double(faults.leaking), 0.001 * double(faults.looked_at));
    EXPECT_LE(double(faults.acne), 0.001 * double(faults.looked_at));
}

TEST_P(SoakGpuPictures, IsThePictureOf256SamplesWithoutBands) {
    const Picture picture = rendered(GetParam(), {});
    const Picture truth = rendered(GetParam(), {"--samples", "256", "--no-fxaa"});
    const double difference = flip(truth, picture);
    const std::uint32_t band = longest_band(picture);
    fmt::print("| {} | FLIP {:.4f} | band {} |\n", GetParam(), difference, band);
    EXPECT_LE(difference, 0.02);
    EXPECT_LE(band, 100U);
    if (std::string_view(GetParam()) != "dungeon") return;
    // Its window and a hand's width of wall, as shares of the picture.
    const auto [width, height] = test::picture_extent;
    const std::uint32_t left = width * 4 / 10, top = height * 4 / 10, wide = width * 13 / 100, high = height / 4;
    const auto window = [&](const Picture& of) {
        return flip(part_of(truth, left, top, wide, high), part_of(of, left, top, wide, high));
    };
    const double smooth = window(picture), jagged = window(rendered(GetParam(), {"--samples", "1"}));
    fmt::print("| window | FLIP {:.4f}, of one place {:.4f} |\n", smooth, jagged);
    EXPECT_LE(smooth, 0.02);
    EXPECT_GT(jagged, 0.02) << "which the mean of the whole picture does not tell";
}

}  // namespace
}  // namespace darkroom
