// SPDX-License-Identifier: MIT
// @effect feedback_trail: What is bright leaves a trail that fades.
// @accepts display_linear
// @param float amount = 0.8 in [0, 1] amount: Brightness of the trail.
// @param float half_life = 0.05 in [0.001, 0.1] s: Time in which the trail loses half its light.
// @history trail: 1/2 rgba16f
// After nine half-lives a trail is within half a code of 8 bits: 108 frames at 120 frames a second.
// @pre_roll 110

#include "shared/sanitize.glsl"

// What is no number would stay in the trail for ever.
vec3 feedback_trail_light(vec4 light) { return clamp(sanitize(light).rgb, 0.0, 1.0); }

// The trail fades by time, not by frames: it is as long at 30 as at 144 frames a second.
// @pass fade: picture trail_previous -> trail
vec4 feedback_trail_fade(Pixel pixel, FeedbackTrail parameters) {
    vec3 light = feedback_trail_light(sample_linear(picture, pixel.uv));
    vec3 before = feedback_trail_light(load(trail_previous, pixel.texel));
    return vec4(max(light, before * exp2(-frame_delta_time / parameters.half_life)), 1.0);
}

// @end trail
vec4 feedback_trail(vec4 color, Pixel pixel, FeedbackTrail parameters) {
    return vec4(max(color.rgb, parameters.amount * sample_linear(trail, pixel.uv).rgb), color.a);
}
