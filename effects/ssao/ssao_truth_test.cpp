// SPDX-License-Identifier: MIT
#include "ssao/ssao_truth.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <darkroom/composer.hpp>
#include <darkroom/effects/ssao.hpp>

namespace darkroom {
namespace {

using test::BoxScene;
using test::BoxView;

/// Of every third pixel, which meets each pixel of the noise's tile alike.
constexpr std::uint32_t stride = 3;

/// Rays of the cosine-weighted half ball, each as long as the radius and with no fading toward its end.
std::vector<double> traced(const BoxScene& scene, const BoxView& view, double radius) {
    const test::OcclusionTruth truth(scene.boxes);
    std::vector<double> out;
    for (std::uint32_t y = 0; y < view.depth.height; y += stride)
        for (std::uint32_t x = 0; x < view.depth.width; x += stride) {
            const Rgba& normal = view.normals.at(x, y);
            const bool is_sky = view.depth.at(x, y).r >= 1e9;
            out.push_back(is_sky ? 1 : truth.visibility(view.point(x, y), {normal.r, normal.g, normal.b}, radius, 12));
        }
    return out;
}

struct Likeness {
    double mean_error = 0, correlation = 0;
};

Likeness likeness(const Ssao& ssao, const BoxView& view, const std::vector<double>& truth) {
    const std::uint32_t width = view.depth.width, height = view.depth.height;
    const ReferenceImage seen = test::develop([&](Composer& composer) { composer.add(ssao); },
                                              test::uniform(width, height, {1, 1, 1, 1}), view.options());
    double error = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    std::size_t i = 0;
    for (std::uint32_t y = 0; y < height; y += stride)
        for (std::uint32_t x = 0; x < width; x += stride) {
            const double made = seen.at(x, y).r, expected = truth[i++];
            error += std::abs(made - expected);
            a += made;
            b += expected;
            aa += made * made;
            bb += expected * expected;
            ab += made * expected;
        }
    const auto n = static_cast<double>(i);
    return {error / n, (ab - a * b / n) / std::sqrt((aa - a * a / n) * (bb - b * b / n))};
}

void expect_ground_truth_is_closer(const BoxScene& scene, float radius, double allowed) {
    const BoxView view = test::view_of(scene, 256, 144);
    const std::vector<double> truth = traced(scene, view, double{radius});
    Ssao ssao{.radius = radius, .samples = 64, .resolution = SsaoResolution::Full};
    const Likeness hemisphere = likeness(ssao, view, truth);
    ssao.method = SsaoMethod::GroundTruth;
    const Likeness ground_truth = likeness(ssao, view, truth);
    fmt::print("{}, radius {}: mean error {:.4f} ({:.4f} hemisphere), correlation {:.3f} ({:.3f} hemisphere)\n",
               scene.name, radius, ground_truth.mean_error, hemisphere.mean_error, ground_truth.correlation,
               hemisphere.correlation);
    EXPECT_LE(ground_truth.mean_error, allowed);
    EXPECT_LT(ground_truth.mean_error, hemisphere.mean_error);
    EXPECT_GT(ground_truth.correlation, hemisphere.correlation);
    EXPECT_GT(ground_truth.correlation, 0.85);
    EXPECT_GT(hemisphere.correlation, 0.6);
}

TEST(TruthGpuSsao, Corner) { expect_ground_truth_is_closer(test::corner_scene(), 0.5f, 0.03); }
TEST(TruthGpuSsao, Courtyard) { expect_ground_truth_is_closer(test::courtyard_scene(), 0.5f, 0.03); }
TEST(TruthGpuSsao, Stairs) { expect_ground_truth_is_closer(test::stairs_scene(), 0.5f, 0.04); }
// More of what occludes is hidden.
TEST(TruthGpuSsao, CourtyardWithTwiceTheRadius) { expect_ground_truth_is_closer(test::courtyard_scene(), 1.0f, 0.06); }

}  // namespace
}  // namespace darkroom
