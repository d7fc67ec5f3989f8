// SPDX-License-Identifier: MIT
// For auto_exposure_count.glsl and auto_exposure_count_masked.glsl, which define auto_exposure_has_mask and
// auto_exposure_mask_at(). Counts scene-linear pixels by luminance: 256 bins, an eighth of a stop each, from 2^-16, where
// black counts too. Beside its count a bin has the sum of where in it the pixels lie, so means are finer than bins. All are
// integers, so they do not depend on the order in which groups add them. A pixel weighs at most 15, and lies in one of 16
// parts of its bin: the 1024 of a group fit into 14 and 18 bits, and 2^28 into what all groups add to.
shared uint auto_exposure_part[256];

const ivec2 auto_exposure_group = ivec2(16, 8);
const ivec2 auto_exposure_tile = ivec2(64, 16);

// 15 at the centre, and in the corners 15 (1 - center_weight); times the mask.
uint auto_exposure_weight(ivec2 texel, ivec2 extent, float center_weight) {
    vec2 place = (2.0 * vec2(texel) + 1.0) / vec2(extent) - 1.0;
    float near = 1.0 - 0.5 * dot(place, place);
    return uint(15.0 * (1.0 - center_weight * (1.0 - near * near)) * auto_exposure_mask_at(texel, extent) + 0.5);
}

void run() {
    uint own = gl_LocalInvocationIndex;
    auto_exposure_part[own] = auto_exposure_part[own + 128u] = 0u;
    barrier();
    ivec2 extent = size(auto_exposure_picture);
    ivec2 first = ivec2(gl_WorkGroupID.xy) * auto_exposure_tile + ivec2(gl_LocalInvocationID.xy);
    float center_weight = auto_exposure_parameters().center_weight;
    for (int y = first.y; y < min(first.y + auto_exposure_tile.y, extent.y); y += auto_exposure_group.y) {
        vec3 colors[4];
        for (int i = 0; i < 4; ++i) {
            int x = min(first.x + i * auto_exposure_group.x, extent.x - 1);
            colors[i] = load(auto_exposure_picture, ivec2(x, y)).rgb;
        }
        for (int i = 0; i < 4; ++i) {
            ivec2 texel = ivec2(first.x + i * auto_exposure_group.x, y);
            if (texel.x >= extent.x) break;
            // A NaN is black.
            float luminance = clamp(dot(colors[i], vec3(0.2126, 0.7152, 0.0722)), 1.0 / 65536.0, 65504.0);
            uint place = min(uint((log2(luminance) + 16.0) * 128.0), 4095u);
            bool is_weighed = auto_exposure_has_mask || center_weight > 0.0;
            uint weight = is_weighed ? auto_exposure_weight(texel, extent, center_weight) : 15u;
            atomicAdd(auto_exposure_part[place >> 4u], weight * ((1u << 18u) + (place & 15u)));
        }
    }
    barrier();
    for (uint bin = own; bin < 256u; bin += 128u) {
        uint part = auto_exposure_part[bin];
        if (part == 0u) continue;
        atomicAdd(auto_exposure_counts[bin], part >> 18u);
        // The sum of a bin of 2^28 pixels fits in sixteenths.
        atomicAdd(auto_exposure_counts[bin + 256u], ((part & 0x3ffffu) + 8u) >> 4u);
    }
}
