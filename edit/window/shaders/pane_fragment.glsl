layout(location = 0) in vec2 texel;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 result;

// One view of codes as they are: the compiler drops all else, and most drivers in software run both sides of a branch.
layout(constant_id = 2) const bool is_plain = false;
const uint transfer_encoded = 0, transfer_scene_linear = 1, transfer_raw = 2, transfer_motion = 3;
const uint channels_rgb = 0, channels_alpha = 4, channels_luminance = 5;
const uint flag_second = 1, flag_false_color = 2, flag_clipping = 4;
const vec3 rec709_weights = vec3(0.2126, 0.7152, 0.0722);
const float middle_grey = 0.18;

vec4 fetch(sampler2D image, View view, vec2 at) {
    vec2 half_texel = 0.5 / vec2(textureSize(image, 0));
    vec2 place = view.region.xy + at * view.region.zw;
    // Never a texel beside the region.
    return textureLod(image, clamp(place, view.region.xy + half_texel, view.region.xy + view.region.zw - half_texel), 0.0);
}

// The numbers that are shown: exposed light or code, or data mapped to 0..1, of the channels that were chosen.
vec3 shown_numbers(vec4 value, View view) {
    vec3 rgb = value.rgb;
    if (view.transfer == transfer_raw) {
        vec4 mapped = (value - view.low) / (view.high - view.low);
        if (block.channels == channels_alpha) return mapped.aaa;
        rgb = mapped.rgb;
    } else {
        if (block.channels == channels_alpha) return value.aaa;
        if (view.transfer == transfer_scene_linear)
            rgb *= block.exposure;
        else if (block.exposure != 1.0)
            rgb = srgb_encode(srgb_decode(rgb) * block.exposure);
    }
    if (block.channels == channels_rgb) return rgb;
    if (block.channels != channels_luminance) return vec3(rgb[block.channels - 1]);
    if (view.transfer == transfer_encoded) return vec3(srgb_encode(dot(rec709_weights, srgb_decode(rgb))));
    return vec3(dot(rec709_weights, rgb));
}

vec3 false_color(vec3 numbers, bool is_linear) {
    float grey = dot(rec709_weights, numbers);
    if (is_linear) return stop_color(log2(max(grey, 1e-30) / middle_grey), srgb_encode(grey));
    return code_color(grey, grey);
}

float from_segment(vec2 place, vec2 from, vec2 to) {
    vec2 along = to - from;
    return length(place - from - along * clamp(dot(place - from, along) / max(dot(along, along), 1e-6), 0.0, 1.0));
}

// Where things go: to the right is red, up chartreuse, to the left cyan, down violet, and the brighter the farther. In
// every cell of the window's pixels an arrow has the direction of its middle.
vec3 motion_color(sampler2D image, View view) {
    const float cell = 24.0, longest = 10.0, head = 5.0;
    vec2 away = -fetch(image, view, texel).xy / view.high;
    if (any(isnan(away))) return vec3(1.0, 0.0, 1.0);
    float hue = atan(-away.y, away.x) / 6.28318530718;
    vec3 wheel = clamp(abs(fract(hue + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
    vec3 picture = srgb_encode(wheel * min(length(away), 1.0));

    vec2 pixel = max(fwidth(texel), vec2(1e-9)), place = texel / pixel, middle = (floor(place / cell) + 0.5) * cell;
    vec2 of_cell = -fetch(image, view, middle * pixel).xy / view.high;
    float far = min(length(of_cell), 1.0);
    if (!(far > 0.05)) return picture;
    vec2 along = normalize(of_cell), beside = vec2(-along.y, along.x), tip = middle + along * far * longest;
    float off = from_segment(place, middle - along * far * longest, tip);
    off = min(off, from_segment(place, tip, tip + (beside - along) * head * far));
    off = min(off, from_segment(place, tip, tip - (beside + along) * head * far));
    picture *= 1.0 - clamp(2.5 - off, 0.0, 0.7);  // a rim: yellow is nearly as bright as the arrow
    return mix(picture, vec3(1.0), clamp(1.5 - off, 0.0, 1.0));
}

vec3 shown_color(sampler2D image, View view) {
    if (view.transfer == transfer_motion) return motion_color(image, view);
    vec4 value = fetch(image, view, texel);
    bool is_alpha = block.channels == channels_alpha;
    vec3 numbers = shown_numbers(value, view);
    bool is_marked = (block.flags & flag_clipping) != 0;
    bvec3 is_broken = is_alpha ? bvec3(isnan(value.a) || isinf(value.a))
                               : bvec3(any(isnan(value.rgb)), any(isinf(value.rgb)), false);
    if (is_marked && any(is_broken)) return vec3(1.0, 0.0, 1.0);
    if (any(isnan(numbers))) numbers = vec3(0.0);
    bool is_linear = view.transfer == transfer_scene_linear && !is_alpha;
    vec3 picture = is_linear ? clamp(srgb_encode(max(numbers, vec3(0.0))), 0.0, largest_code()) : clamp(numbers, 0.0, 1.0);
    if ((block.flags & flag_false_color) != 0 && view.transfer != transfer_raw && !is_alpha)
        picture = false_color(numbers, is_linear);
    // Stripes of four pixels, so that what is under them stays visible.
    bool is_stripe = (uint(gl_FragCoord.x + gl_FragCoord.y) & 7u) < 4u;
    if (is_marked && is_stripe) {
        if (any(greaterThanEqual(numbers, vec3(1.0)))) return vec3(1.0, 0.1, 0.1);
        if (any(lessThan(numbers, vec3(0.0)))) return vec3(0.1, 0.3, 1.0);
    }
    return picture;
}

vec3 plain_color(vec3 codes) { return any(isnan(codes)) ? vec3(0.0) : clamp(codes, 0.0, 1.0); }

void main() {
    if (is_plain) {
        result = to_target(color * vec4(plain_color(fetch(first_image, block.first, texel).rgb), 1.0));
        return;
    }
    bool has_second = (block.flags & flag_second) != 0;
    float from_divider = texel.x - block.divider;
    float pixel = fwidth(texel.x);
    vec3 picture = has_second && from_divider >= 0.0 ? shown_color(second_image, block.second)
                                                     : shown_color(first_image, block.first);
    // Two pixels wide: one on either side.
    if (has_second && abs(from_divider) < pixel) picture = vec3(0.9);
    result = to_target(color * vec4(picture, 1.0));
}
