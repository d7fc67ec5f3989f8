// Light from the skybox, made by render/light/environment.cpp; frame.glsl is included before. All of it is multiplied by the
// environment's intensity.

/// Where a normalised direction is in an equirectangular picture: -z in its middle, +x to the right of it.
vec2 direction_to_uv(vec3 direction) {
    const float pi = 3.14159265;
    return vec2(atan(direction.x, -direction.z) / (2.0 * pi) + 0.5, 0.5 - asin(clamp(direction.y, -1.0, 1.0)) / pi);
}

/// What a white diffuse surface shows. Nine harmonics ring below zero opposite a strong light.
vec3 environment_irradiance(vec3 n) {
    vec3 sum = frame.irradiance[0].rgb * 0.28209479;
    sum += (frame.irradiance[1].rgb * n.y + frame.irradiance[2].rgb * n.z + frame.irradiance[3].rgb * n.x) * 0.48860251;
    sum += (frame.irradiance[4].rgb * (n.x * n.y) + frame.irradiance[5].rgb * (n.y * n.z) +
            frame.irradiance[7].rgb * (n.x * n.z)) * 1.09254843;
    sum += frame.irradiance[6].rgb * (0.31539157 * (3.0 * n.z * n.z - 1.0));
    sum += frame.irradiance[8].rgb * (0.54627421 * (n.x * n.x - n.y * n.y));
    return max(sum, vec3(0)) * frame.environment_settings.x;
}

/// What a white glossy surface shows in the direction r. The sampler repeats across the seam behind the viewer, and an
/// explicit level needs no derivatives, which would jump there.
vec3 environment_reflection(vec3 r, float roughness) {
    float level = clamp(roughness, 0.0, 1.0) * frame.environment_settings.y;
    return textureLod(prefiltered_environment, direction_to_uv(r), level).rgb * frame.environment_settings.x;
}

/// Scale and bias of F0. The table's edges are kept apart, since its sampler repeats.
vec2 environment_brdf(float n_dot_v, float roughness) {
    vec2 edge = 0.5 / vec2(textureSize(split_sum, 0));
    return textureLod(split_sum, clamp(vec2(n_dot_v, roughness), edge, 1.0 - edge), 0.0).rg;
}
