// SPDX-License-Identifier: MIT
// One group: the mean of the histogram between two percentiles, a bin's pixels being where they are on average; the
// exposure that brings it to middle grey; and how far the exposure has come by now. auto_exposure_adapted holds the
// multiplier, its stops, the stops that it moves toward and the metered ones from middle grey; zeros before the first
// frame and after a cut.
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
    vec3 edges = clamp(vec3(through - counts.x - counts.y, through - counts.y, through), window.x, window.y);
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
    float metered = all > 0.0 ? sum.y / sum.x / 8.0 - 16.0 - auto_exposure_grey : 0.0;
    float target = parameters.compensation + auto_exposure_curve(metered) -
                   clamp(metered, parameters.darkest, max(parameters.brightest, parameters.darkest));
    // From the frame before on it moved toward what that frame showed.
    bool is_first = auto_exposure_adapted[0] <= 0.0;
    float stops = is_first ? target : auto_exposure_moved(auto_exposure_adapted[1], auto_exposure_adapted[2]);
    auto_exposure_adapted[0] = exp2(stops);
    auto_exposure_adapted[1] = stops;
    auto_exposure_adapted[2] = target;
    auto_exposure_adapted[3] = metered;
}
