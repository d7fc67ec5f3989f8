// SPDX-License-Identifier: MIT
// Sizes in parts of the picture's height: one picture, small and large, is one picture behind blurs, glows and waves.
#include <gtest/gtest.h>
#include <darkroom/look.hpp>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

/// A bright disc and a pane, drawn at any size: of each pixel the mean of what lies under it.
ReferenceImage picture_of(std::uint32_t height) {
    ReferenceImage out(height, height);
    constexpr std::uint32_t parts = 4;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < height; ++x) {
            double sum = 0;
            for (std::uint32_t i = 0; i < parts * parts; ++i) {
                const double u = (x + (i % parts + 0.5) / parts) / height, v = (y + (i / parts + 0.5) / parts) / height;
                const bool is_lit = std::hypot(u - 0.4, v - 0.45) < 0.06 || (u > 0.6 && u < 0.9 && v > 0.7 && v < 0.8);
                sum += is_lit ? 0.95 : 0.05;
            }
            const double mean = sum / (parts * parts);
            out.at(x, y) = {mean, mean, mean, 1};
        }
    return out;
}

/// Of squares of the large picture that the small one's pixels are.
ReferenceImage reduced(const ReferenceImage& large, std::uint32_t height) {
    const std::uint32_t side = large.height / height;
    ReferenceImage out(height, height, {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < large.height; ++y)
        for (std::uint32_t x = 0; x < large.width; ++x)
            out.at(x / side, y / side).r += large.at(x, y).r / (side * side);
    return out;
}

/// The mean difference of the entry's picture at 720 lines and at 240.
double difference(const std::string& entry) {
    const Look look = test::must(parse_look("format = 1\n[[stack]]\n" + entry, "a look"));
    const auto run = [&](std::uint32_t height) {
        return test::develop([&](Composer& composer) { test::must(apply(look, composer)); }, picture_of(height));
    };
    const ReferenceImage small = run(240), large = reduced(run(720), 240);
    double sum = 0;
    for (std::size_t i = 0; i < small.pixels.size(); ++i) sum += std::abs(small.pixels[i].r - large.pixels[i].r);
    return sum / static_cast<double>(small.pixels.size());
}

TEST(EffectsReach, OnePictureAt240And720Lines) {
    struct Case {
        const char *by_height, *by_pixels;
    };
    for (const auto& [by_height, by_pixels] :
         {Case{"effect = \"gaussian_blur\"\nradius = \"2%\"", "effect = \"gaussian_blur\"\nradius = 22"},
          Case{"effect = \"gaussian_blur\"\nradius = \"2%\"\nresolution = \"full\"",
               "effect = \"gaussian_blur\"\nradius = 22\nresolution = \"full\""},
          Case{"effect = \"box_blur\"\nradius = \"1.5%\"", "effect = \"box_blur\"\nradius = 16"},
          Case{"effect = \"classic_bloom\"\nthreshold = 0.5\nradius = \"4%\"",
               "effect = \"classic_bloom\"\nthreshold = 0.5\nradius = 43"},
          Case{"effect = \"perturb\"\nstrength = \"2%, 1%, 3, 2\"",
               "effect = \"perturb\"\nstrength = [21.6, 10.8, 3, 2]\nreach = \"pixels\""}}) {
        const double here = difference(by_height), there = difference(by_pixels);
        EXPECT_LT(here, 0.2 * there) << by_height;
        EXPECT_GT(there, 0.005) << by_pixels;
    }
}

}  // namespace
}  // namespace darkroom
