// SPDX-License-Identifier: MIT
// Shadows against rays: boxes stand between a plane and the sun, and a grid finer than the shadow map's texels says
// where the light's edge is by both. Distances are texels across the light.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "render/shadow/shadow_test_support.hpp"
#include "tests/embree.hpp"

namespace darkroom::render {

namespace {

using namespace test;

/// The instances of a snapshot as triangles that rays hit.
class RayScene {
  public:
    explicit RayScene(const scene::Snapshot& snapshot) : device_(rtcNewDevice("threads=1")) {
        scene_ = rtcNewScene(device_);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        for (const scene::Instance& instance : snapshot.instances) add_box(instance.world);
        rtcCommitScene(scene_);
    }
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;
    ~RayScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    [[nodiscard]] bool is_lit(vec3 point, vec3 toward_light) const {
        RTCRay ray{.org_x = point.x,
                   .org_y = point.y,
                   .org_z = point.z,
                   .tnear = 0,
                   .dir_x = toward_light.x,
                   .dir_y = toward_light.y,
                   .dir_z = toward_light.z,
                   .tfar = std::numeric_limits<float>::infinity(),
                   .mask = ~0U};
        darkroom::test::occlude(scene_, ray);
        return ray.tfar > 0;
    }

  private:
    void add_box(const mat4& world) {
        constexpr std::array<std::array<unsigned, 3>, 12> triangles{{{0, 1, 3},
                                                                     {0, 3, 2},
                                                                     {4, 6, 7},
                                                                     {4, 7, 5},
                                                                     {0, 4, 5},
                                                                     {0, 5, 1},
                                                                     {2, 3, 7},
                                                                     {2, 7, 6},
                                                                     {0, 2, 6},
                                                                     {0, 6, 4},
                                                                     {1, 5, 7},
                                                                     {1, 7, 3}}};
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* const corners = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 8));
        for (unsigned i = 0; i < 8; ++i) {
            const vec4 corner = world * vec4(i & 1U, (i >> 1U) & 1U, i >> 2U, 1);
            for (int k = 0; k < 3; ++k) corners[i * 3 + static_cast<unsigned>(k)] = corner[k];
        }
        void* const indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                      3 * sizeof(unsigned), triangles.size());
        std::memcpy(indices, triangles.data(), sizeof triangles);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
    }

    RTCDevice device_;
    RTCScene scene_ = nullptr;
};

constexpr std::uint32_t samples_a_texel = 4;

/// A square of points around `center` on the ground, evenly spaced as the light sees them.
Grid grid_across_light(const Cascades& cascades, std::uint32_t cascade, vec3 center, std::uint32_t size,
                       std::uint32_t resolution) {
    const mat4& matrix = cascades.world_to_cascade[cascade];
    Grid grid{.width = size, .height = size};
    const mat4 rows = glm::transpose(matrix);
    const scene::mat3 across = glm::inverse(glm::transpose(scene::mat3(vec3(rows[0]), vec3(rows[1]), grid.normal)));
    const float step = 2.0F / static_cast<float>(resolution * samples_a_texel);
    grid.right = across * vec3(step, 0, 0);
    grid.down = across * vec3(0, step, 0);
    // Not at special places of texels.
    const float back = static_cast<float>(size) / 2 + 0.37F;
    grid.first = center - (grid.right + grid.down) * back;
    return grid;
}

std::uint32_t cascade_at(const scene::Snapshot& snapshot, const Cascades& cascades, vec3 point) {
    const float distance = -(snapshot.camera.view * vec4(point, 1)).z;
    std::uint32_t cascade = 0;
    while (cascade + 1 < cascades.count && distance > cascades.splits[cascade]) ++cascade;
    return cascade;
}

struct Comparison {
    float edge_error = 0;        ///< greatest distance of a point on the wrong side of 0.5 from the true edge
    float wrong_away = 0;        ///< greatest error further than 3 texels from any true edge
    double lit = 0, shaded = 0;  ///< parts of the grid
};

Comparison compare(const std::vector<std::uint8_t>& truth, const Visibility& seen, std::uint32_t size) {
    constexpr int reach = 3 * samples_a_texel + 1;
    Comparison out;
    for (std::uint32_t y = reach; y + reach < size; ++y) {
        for (std::uint32_t x = reach; x + reach < size; ++x) {
            const bool is_lit = truth[y * size + x] != 0;
            (is_lit ? out.lit : out.shaded) += 1;
            int nearest = reach * reach;
            for (int v = -reach; v <= reach; ++v)
                for (int u = -reach; u <= reach; ++u)
                    if ((truth[(y + v) * size + x + u] != 0) != is_lit) nearest = std::min(nearest, u * u + v * v);
            const float value = seen.at(x, y);
            const float distance = std::sqrt(static_cast<float>(nearest)) / samples_a_texel;
            if ((value >= 0.5F) != is_lit) out.edge_error = std::max(out.edge_error, distance);
            if (distance > 3) out.wrong_away = std::max(out.wrong_away, std::abs(value - (is_lit ? 1.0F : 0.0F)));
        }
    }
    const double all = out.lit + out.shaded;
    out.lit /= all;
    out.shaded /= all;
    return out;
}

// Rays know a sun without width.
constexpr CascadeDesc desc{.resolution = 512, .filter = ShadowFilter::Plain, .far_distance = 30};
constexpr std::uint32_t grid_size = 192;

Comparison against_rays(const scene::Snapshot& snapshot, vec3 center) {
    ShadowRig rig(desc);
    rig.prepare(snapshot);
    const Cascades& cascades = rig.pass.cascades(0);
    const std::uint32_t cascade = cascade_at(snapshot, cascades, center);
    const Grid grid = grid_across_light(cascades, cascade, center, grid_size, desc.resolution);
    const Visibility seen = rig.evaluate(grid);
    const RayScene rays(snapshot);
    std::vector<std::uint8_t> truth;
    for (std::uint32_t y = 0; y < grid.height; ++y)
        for (std::uint32_t x = 0; x < grid.width; ++x)
            truth.push_back(rays.is_lit(grid.point(x, y) + grid.normal * 1e-4F, snapshot.lights[0].direction) ? 1 : 0);
    return compare(truth, seen, grid_size);
}

void expect_truth(const scene::Snapshot& snapshot, vec3 center) {
    const Comparison result = against_rays(snapshot, center);
    EXPECT_LE(result.edge_error, 1.0F + 1.0F / samples_a_texel) << "a texel, and what the grid does not tell";
    EXPECT_EQ(result.wrong_away, 0);
    EXPECT_GT(result.lit, 0.1);
    EXPECT_GT(result.shaded, 0.1);
}

scene::Snapshot ground(const scene::CameraState& camera, vec3 light) {
    scene::Snapshot snapshot = empty_scene(camera);
    add_box(snapshot, vec3(-60, -1, -60), vec3(60, 0, 60));
    add_light(snapshot, light);
    return snapshot;
}

/// A wall at x 0.5 with a window and bars in it, `scale` times as large.
void add_window(scene::Snapshot& snapshot, float scale) {
    const auto add = [&](vec3 low, vec3 high) { add_box(snapshot, low * scale, high * scale); };
    add(vec3(0.5F, 0, -3), vec3(0.6F, 0.5F, 3));
    add(vec3(0.5F, 1.5F, -3), vec3(0.6F, 3, 3));
    add(vec3(0.5F, 0.5F, -3), vec3(0.6F, 1.5F, -0.5F));
    add(vec3(0.5F, 0.5F, 0.5F), vec3(0.6F, 1.5F, 3));
    for (const float z : {-0.25F, 0.0F, 0.25F}) add(vec3(0.53F, 0.5F, z - 0.03F), vec3(0.59F, 1.5F, z + 0.03F));
    add(vec3(0.53F, 1, -0.5F), vec3(0.59F, 1.06F, 0.5F));
}

/// Evenly spaced points of a rectangle that lies in one face.
Grid face_grid(vec3 corner, vec3 along, vec3 across, vec3 normal) {
    constexpr std::uint32_t count = 160;
    return {.width = count,
            .height = count,
            .first = corner + (along + across) * (0.5F / count),
            .right = along / static_cast<float>(count),
            .down = across / static_cast<float>(count),
            .normal = normal};
}

struct Wrong {
    double share = 0;  ///< of the points that are too dark or too light, by more than rounding
    float most = 0;
    float max_inside = 0;  ///< more than a texel from the rectangle's edges
};

/// No edge of light crosses the rectangle.
Wrong wrong_on_face(const scene::Snapshot& snapshot, const Grid& grid, bool is_lit) {
    ShadowRig rig(desc);
    rig.prepare(snapshot);
    const Visibility seen = rig.evaluate(grid);
    const RayScene rays(snapshot);
    Wrong out;
    for (std::uint32_t y = 0; y < grid.height; ++y)
        for (std::uint32_t x = 0; x < grid.width; ++x) {
            const vec3 point = grid.point(x, y) + grid.normal * 1e-4F;
            EXPECT_EQ(rays.is_lit(point, snapshot.lights[0].direction), is_lit) << "the test itself is wrong";
            const float error = std::abs(seen.at(x, y) - (is_lit ? 1.0F : 0.0F));
            if (error > 0.01F) out.share += 1;
            out.most = std::max(out.most, error);
            const std::uint32_t cascade = cascade_at(snapshot, rig.pass.cascades(0), point);
            const float texel = rig.pass.cascades(0).texel[cascade];
            const float away = std::min({static_cast<float>(x) + 0.5F, static_cast<float>(grid.width - x) - 0.5F}) *
                               glm::length(grid.right);
            const float above = std::min({static_cast<float>(y) + 0.5F, static_cast<float>(grid.height - y) - 0.5F}) *
                                glm::length(grid.down);
            if (std::min(away, above) > texel) out.max_inside = std::max(out.max_inside, error);
        }
    out.share /= static_cast<double>(grid.width) * grid.height;
    return out;
}

}  // namespace

TEST(TruthGpuShadow, WindowWithBars) {
    scene::Snapshot snapshot = ground(look(vec3(-2, 2, 0.5F), vec3(-0.2F, 0, 0)), vec3(0.4F, 0.6F, 0.05F));
    add_window(snapshot, 1);
    expect_truth(snapshot, vec3(-0.17F, 0, 0.1F));
}

TEST(TruthGpuShadow, WindowInTheSecondCascade) {
    scene::Snapshot snapshot = ground(look(vec3(-5, 6, 1), vec3(-0.4F, 0, 0)), vec3(0.4F, 0.6F, 0.05F));
    add_window(snapshot, 2);
    expect_truth(snapshot, vec3(-0.34F, 0, 0.2F));
}

TEST(TruthGpuShadow, LightOverhead) {
    scene::Snapshot snapshot = ground(look(vec3(0, 2, 2), vec3(0)), vec3(0, 1, 0));
    add_box(snapshot, vec3(-0.3F, 0.5F, -0.3F), vec3(0.1F, 0.6F, 0.2F));
    add_box(snapshot, vec3(0.15F, 0, -0.3F), vec3(0.2F, 1, 0.2F));
    expect_truth(snapshot, vec3(0));
}

TEST(TruthGpuShadow, CeilingBehindTheCamera) {
    scene::Snapshot snapshot = ground(look(vec3(0, 1, 3), vec3(0)), vec3(0.2F, 1, 0.8F));
    add_box(snapshot, vec3(-40, 20, -40), vec3(4, 21, 60));
    add_box(snapshot, vec3(3.9F, 10, 8), vec3(40, 11, 60));
    expect_truth(snapshot, vec3(0.03F, 0, 0.03F));
}

TEST(TruthGpuShadow, CasterBeyondTheDepthRange) {
    if (!gpu::test::context().traits.has_depth_clamp) GTEST_SKIP() << "the device cannot clamp depth";
    scene::Snapshot snapshot = ground(look(vec3(0, 1, 3), vec3(0)), vec3(0.2F, 1, 0.8F));
    add_box(snapshot, vec3(-100, 300, -100), vec3(60, 301, 500));
    expect_truth(snapshot, vec3(0.03F, 0, 0.03F));
}

TEST(TruthGpuShadow, LowSun) {
    scene::Snapshot snapshot = ground(look(vec3(-1, 2, 2), vec3(0)), vec3(1, std::tan(glm::radians(10.0F)), 0.3F));
    add_box(snapshot, vec3(0.6F, 0, -0.2F), vec3(0.7F, 0.3F, -0.1F));
    add_box(snapshot, vec3(0.6F, 0, 0.1F), vec3(0.8F, 0.4F, 0.3F));
    add_box(snapshot, vec3(1.5F, 0.2F, -0.5F), vec3(1.6F, 0.3F, 0.5F));
    expect_truth(snapshot, vec3(-0.2F, 0, 0));
}

// Beyond the edge of a face the filter meets its neighbour. Points that see the whole sun may be dark there, up to a
// texel from the edge, and nowhere else.
TEST(TruthGpuShadow, FacesThatTheSunGrazesStayLitToTheirEdges) {
    const vec3 up(0, 1, 0);
    for (const float degrees : {12.0F, 30.0F}) {
        scene::Snapshot snapshot =
            ground(look(vec3(3, 2, 3), vec3(0, 0.5F, 0)), vec3(1, std::tan(glm::radians(degrees)), 0.3F));
        add_box(snapshot, vec3(-1, 0, -1), vec3(1, 1, 1));
        const struct {
            const char* name;
            Grid grid;
            double max_share;
        } faces[]{
            {"top", face_grid(vec3(0.4F, 1, -1), vec3(0.6F, 0, 0), vec3(0, 0, 2), up), 0},
            {"side", face_grid(vec3(0.4F, 0, 1), vec3(0.6F, 0, 0), up, vec3(0, 0, 1)), 0.01},
            {"front", face_grid(vec3(1, 0, -1), up, vec3(0, 0, 2), vec3(1, 0, 0)), 0.01},
            {"ground", face_grid(vec3(1, 0, -0.9F), vec3(0.6F, 0, 0), vec3(0, 0, 1.8F), up), 0.01},
        };
        for (const auto& [name, grid, max_share] : faces) {
            const Wrong wrong = wrong_on_face(snapshot, grid, true);
            EXPECT_LE(wrong.share, max_share) << name << " at " << degrees;
            EXPECT_LE(wrong.max_inside, 0) << name << " at " << degrees;
        }
        const Grid behind = face_grid(vec3(-1.6F, 0, -0.9F), vec3(0.6F, 0, 0), vec3(0, 0, 0.9F), up);
        EXPECT_EQ(wrong_on_face(snapshot, behind, false).most, 0) << "what bias loses shows where a caster stands";
    }
}

}  // namespace darkroom::render
