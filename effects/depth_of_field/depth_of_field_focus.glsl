// SPDX-License-Identifier: MIT
// One group: the middle one of 5 by 5 distances about a place, and how far the lens has come toward it by now.
// depth_of_field_focus holds the distance that is sharp, in metres, the same in dioptres, and the dioptres that the lens
// moves toward; zeros before the first frame and after a cut. custom[0] = (x, y, z, w) with 1 / distance =
// (d z + w) / (d x + y), custom[1] = (depth of the sky, dioptres of way since the frame before, the farthest and the
// nearest that there may be in dioptres).
shared float depth_of_field_seen[25];

float depth_of_field_dioptres(float depth) {
    float inverse = (depth * custom[0].z + custom[0].w) / (depth * custom[0].x + custom[0].y);
    // What is no number compares as not nearer than the sky.
    inverse = depth != custom[1].x && inverse > 0.0 ? inverse : 0.0;
    return clamp(inverse, custom[1].z, custom[1].w);
}

// At constant speed while more than a tenth of a dioptre is left, then in proportion to what is left. Two steps leave
// what one does that is as long as both.
float depth_of_field_moved(float dioptres, float target) {
    const float slow = 0.1;
    float left = abs(target - dioptres), way = custom[1].y, steady = clamp(left - slow, 0.0, way);
    left = (left - steady) * exp((steady - way) / slow);
    return target < dioptres ? target + left : target - left;
}

void run() {
    int own = int(gl_LocalInvocationIndex);
    ivec2 extent = size(depth_of_field_depth);
    float seen = 0.0;
    if (own < 25) {
        // A hundredth of the height to each side.
        int apart = max((extent.y + 100) / 200, 1);
        ivec2 place = ivec2(depth_of_field_parameters().autofocus_place * vec2(extent));
        ivec2 texel = clamp(place + (ivec2(own % 5, own / 5) - 2) * apart, ivec2(0), extent - 1);
        seen = depth_of_field_dioptres(load(depth_of_field_depth, texel).r);
        depth_of_field_seen[own] = seen;
    }
    barrier();
    if (own >= 25) return;
    int before = 0;
    for (int i = 0; i < 25; ++i) {
        float other = depth_of_field_seen[i];
        before += other < seen || (other == seen && i < own) ? 1 : 0;
    }
    if (before != 12) return;
    // From the frame before on it moved toward what that frame showed.
    bool is_first = depth_of_field_focus[0] <= 0.0;
    float dioptres = is_first ? seen : depth_of_field_moved(depth_of_field_focus[1], depth_of_field_focus[2]);
    depth_of_field_focus[0] = 1.0 / dioptres;
    depth_of_field_focus[1] = dioptres;
    depth_of_field_focus[2] = seen;
}
