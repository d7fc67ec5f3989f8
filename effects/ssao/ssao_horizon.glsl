// SPDX-License-Identifier: MIT
// Ground-truth visibility: the highest horizons along slices through the view vector, and the cosine-weighted integral
// between them. Jorge Jimenez, Xian-Chun Wu, Angelo Pesce and Adrian Jarabo, "Practical Realtime Strategies for Accurate
// Indirect Occlusion", 2016; equation numbers are theirs.

// M. Abramowitz and I. Stegun, "Handbook of Mathematical Functions", 1964, 4.4.45: within 7e-5.
float ssao_acos(float x) {
    float a = min(abs(x), 1.0);
    float angle = (((-0.0187293 * a + 0.0742610) * a - 0.2121144) * a + 1.5707288) * sqrt(1.0 - a);
    return x >= 0.0 ? angle : 3.14159265 - angle;
}

// Cosine of the horizon in one direction: at least `lowest`, that of the surface's own plane.
float ssao_horizon(SsaoPoint point, vec3 view, vec2 direction, float reach, float share, float lowest, int steps) {
    float horizon = lowest;
    [[unroll]] for (int i = 0; i < steps; ++i) {
        // Squared, so that near surfaces get more of the steps; and never the pixel itself.
        float along = (float(i) + share) * (1.0 / float(steps));
        vec2 place = vec2(point.texel) + 0.5 + direction * (1.0 + along * along * reach);
        vec2 inside = clamp(place, vec2(0.0), custom[4].zw);
        ivec2 texel = ivec2(inside);
        float found = load(ssao_distance, texel).r;
        vec3 offset = vec3(ssao_place(vec2(texel), found) - point.position.xy, point.planar - found);
        float squared = dot(offset, offset);
        float inverse = inversesqrt(squared);
        float near = clamp((custom[5].x - squared * inverse) * custom[6].z, 0.0, 1.0);
        bool occludes = place == inside && dot(offset, point.normal) > custom[5].z;
        horizon = max(horizon, occludes ? mix(lowest, dot(offset, view) * inverse, near) : lowest);
    }
    return horizon;
}

// Equation 7, one side: cos n + 2 h sin n - cos(2 h - n), from cosine and sine of h and n, times four.
float ssao_arc(float cosine, float sine, vec2 normal) {
    float twice = (2.0 * cosine * cosine - 1.0) * normal.x + 2.0 * sine * cosine * normal.y;
    return normal.x + 2.0 * ssao_acos(cosine) * normal.y - twice;
}

// Over what the open surface would see by the same directions: few of them do not add up to one.
float ssao_horizons(SsaoPoint point, int samples) {
    // ssao_slices() in ssao.cpp.
    int slices = clamp(int(sqrt(float(samples) * 0.25) + 0.5), 1, 4), steps = max(samples / (2 * slices), 1);
    vec2 first = load(ssao_turns, (point.texel & 3) + ivec2(0, 4 * slices)).xy;
    float share = float((point.texel.y - point.texel.x) & 3) * 0.25 + 0.125;
    vec2 ray = vec2(point.texel) * custom[0].xy + custom[0].zw;
    vec3 view = normalize(vec3(-ray, 1.0));
    // Two directions across the view vector (Tom Duff et al., "Building an Orthonormal Basis, Revisited", 2017).
    float a = 1.0 / (1.0 + view.z), b = -view.x * view.y * a;
    vec3 right = vec3(1.0 - view.x * view.x * a, b, -view.x);
    vec3 up = vec3(b, 1.0 - view.y * view.y * a, -view.y);
    vec2 middle = vec2(point.texel) + 0.5 - custom[4].xy;
    float per_w = 1.0 / (custom[3].w - custom[3].z * point.planar);
    float facing = max(dot(point.normal, view), 0.0), visible = 0.0, open = 0.0;
    // From one direction to the next, by a whole turn over 2, 4, 6 or 8.
    vec2 turn = slices == 1 ? vec2(-1.0, 0.0) : slices == 2 ? vec2(0.0, 1.0) : slices == 3 ? vec2(0.5, 0.866025404)
                                                                                           : vec2(0.707106781);
    [[unroll]] for (int i = 0; i < 2 * slices; ++i) {
        vec2 angle = first;
        first = vec2(angle.x * turn.x - angle.y * turn.y, angle.x * turn.y + angle.y * turn.x);
        vec3 across = right * angle.x + up * angle.y;
        // How a step across the view moves the texel.
        vec2 motion = (custom[2].xy * across.xy + (custom[2].zw - middle * custom[3].z) * across.z) * per_w;
        float squared = dot(motion, motion);
        float inverse = inversesqrt(max(squared, 1e-20));
        float reach = max(custom[5].x * squared * inverse - 1.0, 0.0);
        // The normal in the slice: its length, and cosine and sine of its angle to the view vector.
        float sideways = dot(point.normal, across);
        float in_slice = max(facing * facing + sideways * sideways, 1e-12), per_length = inversesqrt(in_slice);
        float length_in_slice = in_slice * per_length;
        vec2 normal = vec2(facing, sideways) * per_length;
        float horizon = ssao_horizon(point, view, motion * inverse, reach, share, -normal.y, steps);
        visible += length_in_slice * ssao_arc(horizon, sqrt(max(1.0 - horizon * horizon, 0.0)), normal);
        // The arc of the lowest horizon, whose cosine is -normal.y and sine normal.x.
        open += length_in_slice * 2.0 * (normal.x + ssao_acos(-normal.y) * normal.y);
    }
    return visible / max(open, 1e-6);
}
