// SPDX-License-Identifier: MIT
// @effect histogram: Draws how many pixels have which of 256 levels over the picture.
// @accepts encoded
// @param float height = 0.5 in [0, 1] amount: Share of the picture's height that the level of most pixels gets.
// @param rgb tint = 1, 0.8, 0.3 in [0, 1]: Colour of the bars.
// @buffer counts: 256 uint
// @value levels: 256
// @value most: 1

uint histogram_level(vec3 color) {
    return uint(clamp(dot(color, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0) * 255.0 + 0.5);
}

// @compute clear 64x1 4x1: -> counts
void histogram_clear(Histogram parameters) { counts[gl_GlobalInvocationID.x] = 0u; }

// @compute count 16x8: picture -> counts
shared uint histogram_part[256];

void histogram_count(Histogram parameters) {
    uint own = gl_LocalInvocationIndex;
    histogram_part[own] = histogram_part[own + 128u] = 0u;
    barrier();
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, size(picture))))
        atomicAdd(histogram_part[histogram_level(load(picture, texel).rgb)], 1u);
    barrier();
    atomicAdd(counts[own], histogram_part[own]);
    atomicAdd(counts[own + 128u], histogram_part[own + 128u]);
}

// @compute tell 1x1 1x1: counts -> levels most
void histogram_tell(Histogram parameters) {
    uint highest = 1u;
    for (int i = 0; i < 256; ++i) {
        levels[i] = float(counts[i]);
        highest = max(highest, counts[i]);
    }
    most[0] = float(highest);
}

// @end levels most
vec4 histogram(vec4 color, Pixel pixel, Histogram parameters) {
    float bar = parameters.height * levels[clamp(int(pixel.uv.x * 256.0), 0, 255)] / most[0];
    return 1.0 - pixel.uv.y < bar ? vec4(parameters.tint, color.a) : color;
}
