// Body of the resolve kernel (render/pass/resolve.cpp), which writes `const int samples = N;` and a shade() above main.
// custom[0]: near, far (which may be infinite), 1 for a perspective, near over far.

/// Distance along the view axis of a reversed depth, 1e10 where nothing is.
float planar_distance(float depth) {
    float near_distance = custom[0].x, far_distance = custom[0].y;
    if (depth <= 0.0) return 1e10;
    if (custom[0].z == 0.0) return near_distance + (1.0 - depth) * (far_distance - near_distance);
    return near_distance / mix(depth, 1.0, custom[0].w);
}
