// SPDX-License-Identifier: MIT
// The mean of a row of pixels over [begin, end), which need not be whole: bilinear taps of two pixels each, which count by
// what of them lies there, so that every pixel counts alike whatever the ratio of two sizes is.
#ifndef shared_area
#define shared_area
struct AreaTap {
    float place, weight;  // in pixels of the row
};

int area_taps(float begin, float end) {
    return int(ceil(0.5 * (end - floor(begin))));
}

AreaTap area_tap(float begin, float end, int i) {
    float own = floor(begin) + float(2 * i);
    vec2 covered = clamp(min(vec2(end), vec2(own + 1.0, own + 2.0)) - max(vec2(begin), vec2(own, own + 1.0)), 0.0, 1.0);
    float weight = covered.x + covered.y;
    return AreaTap(own + 0.5 + covered.y / max(weight, 1e-6), weight);
}
#endif
