// SPDX-License-Identifier: MIT
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
