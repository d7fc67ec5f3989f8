// SPDX-License-Identifier: MIT
#pragma once
// Ambient occlusion by ray tracing (Embree), to judge the effect by. For tests only.

#include <cstring>
#include <memory>
#include <numbers>

#include "ssao/ssao_scenes.hpp"
#include "tests/embree.hpp"

namespace darkroom::test {

struct TriangleMesh {
    std::vector<std::array<float, 3>> points;
    std::vector<unsigned> corners;  ///< three a triangle
};

inline TriangleMesh triangles_of(const std::vector<Box>& boxes) {
    // Corner i of a box has its x, y and z high where bits 0, 1 and 2 of i are set.
    constexpr std::array<unsigned, 36> sides{0, 2, 6, 0, 6, 4, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                             2, 3, 7, 2, 7, 6, 0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6};
    TriangleMesh mesh;
    for (const Box& box : boxes) {
        for (const unsigned side : sides) mesh.corners.push_back(static_cast<unsigned>(mesh.points.size()) + side);
        for (unsigned i = 0; i < 8; ++i) {
            std::array<float, 3>& point = mesh.points.emplace_back();
            for (std::size_t axis = 0; axis < 3; ++axis)
                point[axis] = static_cast<float>((i >> axis & 1u) != 0 ? box.high[axis] : box.low[axis]);
        }
    }
    return mesh;
}

class OcclusionTruth {
  public:
    explicit OcclusionTruth(const TriangleMesh& mesh)
        : device_(rtcNewDevice("threads=1"), rtcReleaseDevice), scene_(rtcNewScene(device_.get()), rtcReleaseScene) {
        RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        void* const points = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                     3 * sizeof(float), mesh.points.size());
        void* const corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                      3 * sizeof(unsigned), mesh.corners.size() / 3);
        std::memcpy(points, mesh.points.data(), mesh.points.size() * 3 * sizeof(float));
        std::memcpy(corners, mesh.corners.data(), mesh.corners.size() * sizeof(unsigned));
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_.get());
    }

    /// The first triangle that a ray meets, its normal turned against the ray.
    [[nodiscard]] BoxHit first_hit(const Double3& from, const Double3& direction) const {
        RTCRayHit query{.ray = ray_of(from, direction, std::numeric_limits<float>::infinity()),
                        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
        intersect(scene_.get(), query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
        Double3 normal = normalized({query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
        const double along = normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2];
        for (double& axis : normal) axis *= along > 0 ? -1 : 1;
        return {query.ray.tfar, normal};
    }

    /// Whether a ray of unit length meets anything before it is so long.
    [[nodiscard]] bool is_met(const Double3& from, const Double3& direction, double distance) const {
        RTCRay query = ray_of(from, direction, static_cast<float>(distance));
        occlude(scene_.get(), query);
        return query.tfar < 0;
    }

    /// The share of side * side rays, spread by the cosine over the half ball, that meet nothing within `radius`.
    [[nodiscard]] double visibility(const Double3& point, const Double3& normal, double radius, int side) const {
        const Double3 helper = std::abs(normal[1]) > 0.9 ? Double3{1, 0, 0} : Double3{0, 1, 0};
        const Double3 tangent = normalized(cross(helper, normal)), bitangent = cross(normal, tangent);
        int clear = 0;
        for (int i = 0; i < side * side; ++i) {
            const double share = (i / side + 0.5) / side, angle = 2 * std::numbers::pi * (i % side + 0.5) / side;
            const double sine = std::sqrt(share), cosine = std::sqrt(1 - share);
            Double3 ray{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                ray[axis] = tangent[axis] * sine * std::cos(angle) + bitangent[axis] * sine * std::sin(angle) +
                            normal[axis] * cosine;
            if (!is_blocked(point, normal, ray, radius)) ++clear;
        }
        return double(clear) / (side * side);
    }

  private:
    static Double3 cross(const Double3& a, const Double3& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    static Double3 normalized(const Double3& v) {
        const double length = std::hypot(v[0], v[1], v[2]);
        return {v[0] / length, v[1] / length, v[2] / length};
    }
    static RTCRay ray_of(const Double3& from, const Double3& direction, float far) {
        return {.org_x = static_cast<float>(from[0]),
                .org_y = static_cast<float>(from[1]),
                .org_z = static_cast<float>(from[2]),
                .tnear = 0,
                .dir_x = static_cast<float>(direction[0]),
                .dir_y = static_cast<float>(direction[1]),
                .dir_z = static_cast<float>(direction[2]),
                .time = 0,
                .tfar = far,
                .mask = ~0u};
    }
    [[nodiscard]] bool is_blocked(const Double3& point, const Double3& normal, const Double3& ray,
                                  double radius) const {
        constexpr double lift = 1e-3;  // off the surface that the ray starts from
        const Double3 from{point[0] + normal[0] * lift, point[1] + normal[1] * lift, point[2] + normal[2] * lift};
        return is_met(from, ray, radius);
    }

    std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
    std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
};

}  // namespace darkroom::test
