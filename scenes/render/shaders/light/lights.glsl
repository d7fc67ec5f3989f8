// Light that arrives at a point of a surface. Needs frame.glsl, brdf.glsl and shadow.glsl before it where it says so.

// KHR_lights_punctual, "Range Property": the inverse square, brought to 0 at the light's range. Nearer than a centimetre
// it grows no more.
float distance_attenuation(float squared_distance, float range) {
    float ratio = squared_distance / max(range * range, 1e-8);
    return clamp(1.0 - ratio * ratio, 0.0, 1.0) / max(squared_distance, 1e-4);
}

// KHR_lights_punctual, "Inner and Outer Cone Angles": 1 inside the inner angle, 0 outside the outer one, the square of
// what goes straight between; all angles as cosines, from the cone's axis.
float cone_attenuation(float cosine, float outer_cosine, float inner_cosine) {
    float t = clamp((cosine - outer_cosine) / max(inner_cosine - outer_cosine, 0.001), 0.0, 1.0);
    return t * t;
}

// Light from above and from below, over pi, where there is no environment.
vec3 hemisphere(vec3 n, vec3 sky, vec3 ground) {
    return mix(ground, sky, n.y * 0.5 + 0.5);
}

// What a lamp's shadow lets through, where any of its light would be seen.
float lamp_shadow(float first_tile, float tiles, bool is_seen, vec3 position, vec3 surface_normal, vec3 l) {
    float visibility = 1.0;
    // A loop in place of a branch, as in shadow_visibility().
    for (uint i = 0u, end = is_seen && first_tile >= 0.0 ? 1u : 0u; i < end; ++i) {
        visibility = lamp_visibility(uint(first_tile), uint(tiles), position, surface_normal, l);
    }
    return visibility;
}

// Sum over all lights of what leaves toward v. `n` is shaded, `surface_normal` is the geometry's, which shadows are
// offset along; `view_distance` is along the camera's axis.
vec3 reflected_lights(Reflectance surface, vec3 position, vec3 n, vec3 surface_normal, vec3 v, float view_distance,
                      bool shadows_are_on) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < frame.light_counts.x; ++i) {
        vec4 direction = lights.directional_direction[i];
        float visibility = 1.0;
        if (shadows_are_on && direction.w >= 0.0 && is_toward(surface, n, direction.xyz)) {
            visibility = shadow_visibility(uint(direction.w), position, surface_normal, view_distance);
        }
        sum += reflected(surface, n, v, direction.xyz) * lights.directional_color[i].rgb * visibility;
    }
    for (uint i = 0u; i < frame.light_counts.y; ++i) {
        vec3 to_light = lights.point_position[i].xyz - position;
        float squared_distance = dot(to_light, to_light);
        float attenuation = distance_attenuation(squared_distance, lights.point_position[i].w);
        if (attenuation > 0.0) {
            vec3 l = to_light * inversesqrt(max(squared_distance, 1e-12));
            if (lamps_cast_shadows) {
                attenuation *= lamp_shadow(lights.point_color[i].w, 6.0, is_toward(surface, n, l), position, surface_normal, l);
            }
            sum += reflected(surface, n, v, l) * lights.point_color[i].rgb * attenuation;
        }
    }
    for (uint i = 0u; i < frame.light_counts.z; ++i) {
        vec3 to_light = lights.spot_position[i].xyz - position;
        float squared_distance = dot(to_light, to_light);
        vec3 l = to_light * inversesqrt(max(squared_distance, 1e-12));
        vec4 axis = lights.spot_direction[i];
        vec4 color = lights.spot_color[i];
        float attenuation = distance_attenuation(squared_distance, lights.spot_position[i].w) *
                            cone_attenuation(dot(axis.xyz, -l), axis.w, color.w);
        if (lamps_cast_shadows) {
            vec2 tiles = lights.spot_tiles[i].xy;
            bool is_seen = attenuation > 0.0 && is_toward(surface, n, l);
            attenuation *= lamp_shadow(tiles.x, tiles.y, is_seen, position, surface_normal, l);
        }
        if (attenuation > 0.0) sum += reflected(surface, n, v, l) * color.rgb * attenuation;
    }
    return sum;
}
