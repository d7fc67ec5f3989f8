// SPDX-License-Identifier: MIT
#part clear
void run() { auto_exposure_counts[gl_GlobalInvocationID.x] = 0u; }

#part count
// Every pixel counts.
const bool auto_exposure_has_mask = false;

float auto_exposure_mask_at(ivec2 texel, ivec2 extent) { return 1.0; }

#part count_masked
// Pixels count as much as a picture says that is stretched over theirs.
const bool auto_exposure_has_mask = true;

float auto_exposure_mask_at(ivec2 texel, ivec2 extent) {
    return sample_linear(auto_exposure_mask, (vec2(texel) + 0.5) / vec2(extent)).r;
}

#part count count_masked
// Counts scene-linear pixels by luminance: 256 bins, an eighth of a stop each, from 2^-16, where
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

#part adapt
// One group: the mean of the histogram between two percentiles, a bin's pixels being where they are on average; the
// exposure that brings it to middle grey; and how far the exposure has come by now. auto_exposure_adapted holds the
// multiplier, its stops, the stops that it moves toward and the metered ones from middle grey; zeros before the first
// frame and after a cut. auto_exposure_histogram holds what hosts show: the stops from middle grey at which the bins begin,
// the stops of a bin, those between which is metered, the metered ones and those of the exposure; and the share of all that
// each bin has.
shared uint auto_exposure_through[128];
shared vec2 auto_exposure_sums[128];

const float auto_exposure_grey = log2(0.18);

// What custom[1] and up hold, linear between the points.
float auto_exposure_curve(float stops) {
    int count = int(custom[0].z);
    vec2 last = custom[1].xy;
    float result = count > 0 ? last.y : 0.0;
    for (int i = 1; i < count; ++i) {
        vec2 next = (i & 1) == 0 ? custom[1 + i / 2].xy : custom[1 + i / 2].zw;
        float way = (stops - last.x) / max(next.x - last.x, 1e-6);
        if (way > 0.0) result = mix(last.y, next.y, min(way, 1.0));
        last = next;
    }
    return result;
}

// At constant speed while more than a stop is left, then in proportion to what is left: of `left` stops a way of w
// leaves left - w down to 1, and from there e^-w of it. Two steps leave what one does that is as long as both.
float auto_exposure_moved(float stops, float target) {
    float left = abs(target - stops);
    float way = target < stops ? custom[0].x : custom[0].y;
    float steady = clamp(left - 1.0, 0.0, way);
    left = (left - steady) * exp(steady - way);
    return target < stops ? target + left : target - left;
}

float auto_exposure_stops(float bin) { return bin / 8.0 - 16.0 - auto_exposure_grey; }

// Notes a bin, of which so many pixels are darker and so many darker or in it. Where an edge of the window lies in it, its
// pixels are all over it.
void auto_exposure_note(uint bin, float darker, float through, vec2 window, float all) {
    auto_exposure_histogram[6u + bin] = (through - darker) / max(all, 1.0);
    vec2 at = float(bin) + (window - darker) / max(through - darker, 1.0);
    if (darker <= window.x && window.x < through) auto_exposure_histogram[2] = auto_exposure_stops(at.x);
    if (darker < window.y && window.y <= through) auto_exposure_histogram[3] = auto_exposure_stops(at.y);
}

void run() {
    AutoExposure parameters = auto_exposure_parameters();
    uint own = gl_LocalInvocationIndex;
    uvec2 bins = uvec2(2u * own, 2u * own + 1u);
    uvec2 counts = uvec2(auto_exposure_counts[bins.x], auto_exposure_counts[bins.y]);
    // In bins; parts of bins are sixteenths, counted at their middle.
    vec2 within = vec2(auto_exposure_counts[bins.x + 256u], auto_exposure_counts[bins.y + 256u]);
    vec2 places = vec2(bins) + within / max(vec2(counts), 1.0) + 1.0 / 32.0;
    uint through = counts.x + counts.y;
    for (uint way = 1u; way < 128u; way *= 2u) {
        auto_exposure_through[own] = through;
        barrier();
        if (own >= way) through += auto_exposure_through[own - way];
        barrier();
    }
    auto_exposure_through[own] = through;
    barrier();
    float all = float(auto_exposure_through[127]);
    vec2 window = all * vec2(parameters.low, max(parameters.high, parameters.low + 0.001));
    vec3 ends = vec3(through - counts.x - counts.y, through - counts.y, through);
    auto_exposure_note(bins.x, ends.x, ends.y, window, all);
    auto_exposure_note(bins.y, ends.y, ends.z, window, all);
    vec3 edges = clamp(ends, window.x, window.y);
    vec2 parts = edges.yz - edges.xy;
    vec2 sum = vec2(parts.x + parts.y, dot(parts, places));
    for (uint others = 64u; others > 0u; others /= 2u) {
        auto_exposure_sums[own] = sum;
        barrier();
        if (own < others) sum += auto_exposure_sums[own + others];
        barrier();
    }
    if (own != 0u) return;
    // Where the mask leaves nothing, nothing is changed.
    float metered = all > 0.0 ? auto_exposure_stops(sum.y / sum.x) : 0.0;
    float target = parameters.compensation + auto_exposure_curve(metered) -
                   clamp(metered, parameters.darkest, max(parameters.brightest, parameters.darkest));
    // From the frame before on it moved toward what that frame showed.
    bool is_first = auto_exposure_adapted[0] <= 0.0;
    float stops = is_first ? target : auto_exposure_moved(auto_exposure_adapted[1], auto_exposure_adapted[2]);
    auto_exposure_adapted[0] = exp2(stops);
    auto_exposure_adapted[1] = stops;
    auto_exposure_adapted[2] = target;
    auto_exposure_adapted[3] = metered;
    auto_exposure_histogram[0] = auto_exposure_stops(0.0);
    auto_exposure_histogram[1] = 1.0 / 8.0;
    if (all == 0.0) auto_exposure_histogram[2] = auto_exposure_histogram[3] = 0.0;
    auto_exposure_histogram[4] = metered;
    auto_exposure_histogram[5] = stops;
}

#part end
// scene_linear -> scene_linear

vec4 auto_exposure(vec4 color, Pixel pixel, AutoExposure parameters) {
    return vec4(color.rgb * auto_exposure_adapted[0], color.a);
}
