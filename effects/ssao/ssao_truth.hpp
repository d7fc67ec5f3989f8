// SPDX-License-Identifier: MIT
#pragma once
// Ambient occlusion of boxes by ray tracing (Embree), to judge the effect by. For tests only.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <memory>
#include <numbers>

#include "ssao/ssao_scenes.hpp"

namespace darkroom::test {

class OcclusionTruth {
  public:
    explicit OcclusionTruth(const std::vector<Box>& boxes)
        : device_(rtcNewDevice("threads=1"), rtcReleaseDevice), scene_(rtcNewScene(device_.get()), rtcReleaseScene) {
        RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_QUAD);
        auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), boxes.size() * 8));
        auto* const indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), boxes.size() * 6));
        // Corner i of a box has its x, y and z high where bits 0, 1 and 2 of i are set.
        constexpr std::array<unsigned, 24> sides{0, 2, 6, 4, 1, 3, 7, 5, 0, 1, 5, 4,
                                                 2, 3, 7, 6, 0, 1, 3, 2, 4, 5, 7, 6};
        for (std::size_t b = 0; b < boxes.size(); ++b) {
            for (std::size_t i = 0; i < 8; ++i)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    vertices[(b * 8 + i) * 3 + axis] =
                        static_cast<float>((i >> axis & 1) != 0 ? boxes[b].high[axis] : boxes[b].low[axis]);
            for (std::size_t i = 0; i < 24; ++i) indices[b * 24 + i] = static_cast<unsigned>(b * 8) + sides[i];
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_.get());
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
    [[nodiscard]] bool is_blocked(const Double3& point, const Double3& normal, const Double3& ray,
                                  double radius) const {
        constexpr double lift = 1e-3;  // off the surface that the ray starts from
        RTCRay query{.org_x = static_cast<float>(point[0] + normal[0] * lift),
                     .org_y = static_cast<float>(point[1] + normal[1] * lift),
                     .org_z = static_cast<float>(point[2] + normal[2] * lift),
                     .tnear = 0,
                     .dir_x = static_cast<float>(ray[0]),
                     .dir_y = static_cast<float>(ray[1]),
                     .dir_z = static_cast<float>(ray[2]),
                     .time = 0,
                     .tfar = static_cast<float>(radius),
                     .mask = ~0u};
#if RTC_VERSION_MAJOR >= 4
        rtcOccluded1(scene_.get(), &query);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded1(scene_.get(), &context, &query);
#endif
        return query.tfar < 0;
    }

    std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
    std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
};

}  // namespace darkroom::test
