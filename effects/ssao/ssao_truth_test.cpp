// SPDX-License-Identifier: MIT
#include "ssao/ssao_truth.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <darkroom/composer.hpp>
#include <darkroom/effects/ssao.hpp>
#include <filesystem>

#include "scene/model.hpp"

namespace darkroom {
namespace {

using test::BoxScene;
using test::BoxView;
using test::OcclusionTruth;

/// Of every third pixel, which meets each pixel of the noise's tile alike.
constexpr std::uint32_t stride = 3;

/// Every third pixel of every third row: what rays of the cosine-weighted half ball say that are as long as the radius
/// and do not fade toward its end, and whether it lies within 3 pixels of an edge of the depth.
struct Truth {
    std::vector<double> visibility;
    std::vector<bool> is_at_edge;
};

/// Where the depth jumps by more than a slope explains.
bool is_edge(const ReferenceImage& depth, int x, int y) {
    const auto nearness = [&](int column, int row) { return 1 / depth.clamped(column, row).r; };
    const double here = nearness(x, y);
    return std::abs(nearness(x - 1, y) + nearness(x + 1, y) - 2 * here) > 0.02 * here ||
           std::abs(nearness(x, y - 1) + nearness(x, y + 1) - 2 * here) > 0.02 * here;
}

Truth traced(const OcclusionTruth& rays, const BoxView& view, double radius, int side) {
    Truth out;
    for (std::uint32_t y = 0; y < view.depth.height; y += stride)
        for (std::uint32_t x = 0; x < view.depth.width; x += stride) {
            const Rgba& normal = view.normals.at(x, y);
            const bool is_sky = view.depth.at(x, y).r >= 1e9;
            out.visibility.push_back(
                is_sky ? 1 : rays.visibility(view.point(x, y), {normal.r, normal.g, normal.b}, radius, side));
            bool is_near = false;
            for (int j = -3; j <= 3 && !is_near; ++j)
                for (int i = -3; i <= 3 && !is_near; ++i)
                    is_near = is_edge(view.depth, static_cast<int>(x) + i, static_cast<int>(y) + j);
            out.is_at_edge.push_back(is_near);
        }
    return out;
}

struct Likeness {
    double error = 0, edge_error = 0, correlation = 0;  ///< absolute, mean
};

Likeness likeness(const Ssao& ssao, const BoxView& view, const Truth& truth) {
    const std::uint32_t width = view.depth.width, height = view.depth.height;
    const ReferenceImage seen = test::develop([&](Composer& composer) { composer.add(ssao); },
                                              test::uniform(width, height, {1, 1, 1, 1}), view.options());
    double error = 0, edge_error = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    std::size_t i = 0, edges = 0;
    for (std::uint32_t y = 0; y < height; y += stride)
        for (std::uint32_t x = 0; x < width; x += stride, ++i) {
            const double made = seen.at(x, y).r, expected = truth.visibility[i];
            error += std::abs(made - expected);
            edge_error += truth.is_at_edge[i] ? std::abs(made - expected) : 0;
            edges += truth.is_at_edge[i] ? 1 : 0;
            a += made;
            b += expected;
            aa += made * made;
            bb += expected * expected;
            ab += made * expected;
        }
    const auto n = static_cast<double>(i);
    return {error / n, edge_error / static_cast<double>(std::max<std::size_t>(edges, 1)),
            (ab - a * b / n) / std::sqrt((aa - a * a / n) * (bb - b * b / n))};
}

void expect_ground_truth_is_closer(const BoxScene& scene, float radius, double allowed) {
    const BoxView view = test::view_of(scene, 256, 144);
    const Truth truth = traced(OcclusionTruth(test::triangles_of(scene.boxes)), view, double{radius}, 12);
    Ssao ssao{.radius = radius, .samples = 64, .method = SsaoMethod::Hemisphere, .resolution = SsaoResolution::Full};
    const Likeness hemisphere = likeness(ssao, view, truth);
    ssao.method = SsaoMethod::GroundTruth;
    const Likeness ground_truth = likeness(ssao, view, truth);
    fmt::print("{}, radius {}: mean error {:.4f} ({:.4f} hemisphere), correlation {:.3f} ({:.3f} hemisphere)\n",
               scene.name, radius, ground_truth.error, hemisphere.error, ground_truth.correlation,
               hemisphere.correlation);
    EXPECT_LE(ground_truth.error, allowed);
    EXPECT_LT(ground_truth.error, hemisphere.error);
    EXPECT_GT(ground_truth.correlation, hemisphere.correlation);
    EXPECT_GT(ground_truth.correlation, 0.85);
    EXPECT_GT(hemisphere.correlation, 0.6);
}

TEST(TruthGpuSsao, Corner) { expect_ground_truth_is_closer(test::corner_scene(), 0.5f, 0.012); }
TEST(TruthGpuSsao, Courtyard) { expect_ground_truth_is_closer(test::courtyard_scene(), 0.5f, 0.016); }
TEST(TruthGpuSsao, Stairs) { expect_ground_truth_is_closer(test::stairs_scene(), 0.5f, 0.024); }
// More of what occludes is hidden.
TEST(TruthGpuSsao, CourtyardWithTwiceTheRadius) { expect_ground_truth_is_closer(test::courtyard_scene(), 1.0f, 0.035); }

/// The defaults against 256 rays a pixel at 960x540: errors times 1000 at most so large, at both radii.
void expect_default_is_near(std::string_view name, const OcclusionTruth& rays, const BoxView& view,
                            const std::array<double, 2>& allowed) {
    constexpr std::array<float, 2> radii{0.5f, 1.5f};
    for (std::size_t i = 0; i < 2; ++i) {
        const Truth truth = traced(rays, view, double{radii[i]}, 16);
        for (const float thickness : {0.4f, Ssao{}.thickness, 1.2f, 0.0f}) {
            const Ssao ssao{.radius = radii[i], .thickness = thickness, .method = SsaoMethod::GroundTruth};
            const Likeness made = likeness(ssao, view, truth);
            fmt::print("{}, radius {}, thickness {}: error {:.1f}, within 3 px of edges {:.0f}, correlation {:.2f}\n",
                       name, radii[i], thickness, made.error * 1000, made.edge_error * 1000, made.correlation);
            if (thickness == Ssao{}.thickness) {
                EXPECT_LE(made.error * 1000, allowed[i]) << name << ", radius " << radii[i];
            }
        }
    }
}

void expect_default_is_near(const BoxScene& scene, const std::array<double, 2>& allowed) {
    expect_default_is_near(scene.name, OcclusionTruth(test::triangles_of(scene.boxes)), test::view_of(scene, 960, 540),
                           allowed);
}

TEST(SoakGpuSsaoTruth, Corner) { expect_default_is_near(test::corner_scene(), {11, 40}); }
TEST(SoakGpuSsaoTruth, Courtyard) { expect_default_is_near(test::courtyard_scene(), {13, 48}); }
TEST(SoakGpuSsaoTruth, Stairs) { expect_default_is_near(test::stairs_scene(), {24, 54}); }

/// The triangles of a model, and what its first camera sees of them.
TEST(SoakGpuSsaoTruth, Interior) {
    const char* const folder = std::getenv("DARKROOM_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "DARKROOM_TEST_DATA is not set";
    const auto model = scene::read_model(std::filesystem::path(folder) / "models/ComposedInterior.glb");
    ASSERT_TRUE(model) << model.error().text;
    test::TriangleMesh mesh;
    std::vector<scene::mat4> world;
    Camera camera;
    for (const scene::Node& node : model->nodes) {
        const scene::mat4 own = node.matrix ? *node.matrix : node.transform.matrix();
        world.push_back(node.parent == scene::no_index ? own : world[node.parent] * own);
        const scene::mat4& at = world.back();
        if (node.camera != scene::no_index)
            camera = test::look_at({at[3].x, at[3].y, at[3].z},
                                   {at[3].x - at[2].x, at[3].y - at[2].y, at[3].z - at[2].z}, 0.74271, 960.0 / 540);
        if (node.mesh == scene::no_index) continue;
        for (const scene::Primitive& primitive : model->meshes[node.mesh].primitives) {
            for (const std::uint32_t index : primitive.indices)
                mesh.corners.push_back(static_cast<unsigned>(mesh.points.size()) + index);
            for (const scene::Vertex& vertex : primitive.vertices) {
                const scene::vec4 point = at * scene::vec4(vertex.position, 1);
                mesh.points.push_back({point.x, point.y, point.z});
            }
        }
    }
    const OcclusionTruth rays(mesh);
    const BoxView view = test::view_through(camera, 960, 540, [&](const Double3& from, const Double3& direction) {
        return rays.first_hit(from, direction);
    });
    // The search before had 50 and 127.
    expect_default_is_near("interior", rays, view, {42, 102});
}

}  // namespace
}  // namespace darkroom
