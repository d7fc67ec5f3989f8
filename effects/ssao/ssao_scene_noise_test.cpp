// SPDX-License-Identifier: MIT
// What noise the occlusion leaves in the shipped scenes, as their looks finish them: of every pixel, how far it is from
// the mean of the pixels around on its surface, beyond how far it is with what rays say in place of the effect.
// Where DARKROOM_PICTURES names a folder, it gets a map of each scene: white is 16 codes of 255.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "image/picture/write.hpp"
#include "ssao/ssao_scene_view.hpp"

namespace darkroom {
namespace {

// Two codes are hardly seen, eight are where there is one pixel of them.
TEST(SoakGpuSsaoNoise, OfTheShippedScenes) {
    for (const char* const name : test::shipped_scenes) {
        test::SceneView scene(name);
        Picture map;
        const test::Noise noise = test::noise_of(scene, &map);
        fmt::print("{}: 99th percentile {:.2f}, 99.9th {:.2f}, worst {:.2f}\n", name, noise.usual, noise.most,
                   noise.worst);
        if (const char* const folder = std::getenv("DARKROOM_PICTURES"))
            gpu::test::must(write_picture(std::filesystem::path(folder) / fmt::format("{}_noise.png", name), map));
        // Leaves, cords and other parts that are a few pixels wide fill the last two.
        const bool is_fine = std::string_view(name) == "street" || std::string_view(name) == "interior";
        EXPECT_LE(noise.usual, is_fine ? 1.3 : 0.5) << name;
        EXPECT_LE(noise.most, is_fine ? 6 : 2) << name;
        if (is_fine) continue;
        EXPECT_LE(noise.worst, 8) << name;
    }
}

// What lies flat under the light is where occlusion shows as dirt. Of the showcase's floor hardly anything is hidden.
TEST(SoakGpuSsaoNoise, FloorsAreNearerToRaysThanByTheHemisphere) {
    for (const char* const name : {"forge", "courtyard", "dungeon"}) {
        test::SceneView scene(name);
        Ssao hemisphere = scene.occlusion;
        hemisphere.method = SsaoMethod::Hemisphere;
        const ReferenceImage made = test::visibility_of(scene.occlusion, scene.view.options());
        const ReferenceImage points = test::visibility_of(hemisphere, scene.view.options());
        double count = 0, truth = 0, seen = 0, seen_by_points = 0, error = 0, error_of_points = 0;
        for (std::uint32_t y = 0; y < test::picture_extent.height; y += 5)
            for (std::uint32_t x = 0; x < test::picture_extent.width; x += 5) {
                if (scene.view.normals.at(x, y).g < 0.95) continue;
                const double expected = scene.truth(x, y);
                count += 1;
                truth += expected;
                seen += made.at(x, y).r;
                seen_by_points += points.at(x, y).r;
                error += std::abs(made.at(x, y).r - expected);
                error_of_points += std::abs(points.at(x, y).r - expected);
            }
        fmt::print("{}: floors {:.4f} by rays, {:.4f}, {:.4f} by the hemisphere; error {:.4f}, {:.4f}\n", name,
                   truth / count, seen / count, seen_by_points / count, error / count, error_of_points / count);
        EXPECT_LT(error, error_of_points) << name;
    }
}

}  // namespace
}  // namespace darkroom
