// SPDX-License-Identifier: MIT
#pragma once
// Rays that tests compare with, by Embree 3 or 4, which differ in the name of their header and in what a ray is traced
// with. No other file asks for the version.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace darkroom::test {

#if RTC_VERSION_MAJOR >= 4

inline void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray); }
/// Sets the end of a ray that meets anything to minus infinity.
inline void occlude(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }

#else

inline void intersect(RTCScene scene, RTCRayHit& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &ray);
}
inline void occlude(RTCScene scene, RTCRay& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
}

#endif

}  // namespace darkroom::test
