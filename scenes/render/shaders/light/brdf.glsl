// How a surface reflects light: Lambert under a microfacet layer (Cook and Torrance, "A Reflectance Model for Computer
// Graphics", 1982), and the layers over it. Needs microfacets.glsl and layers.glsl; in double precision it is
// render/light/brdf_reference.hpp.
struct Reflectance {
    vec3 diffuse;  // albedo of what light enters the surface
    vec3 f0;       // reflectance head-on
    float roughness;
    // Of Layer_specular:
    float f90;         // reflectance at grazing angles
    vec3 whole_f0;     // f0 where the layer is whole
    vec3 kept_f0;      // what a whole layer keeps from the matte base, head-on
    float layer_part;  // of the matte base, that is under the layer
    Sheen sheen;
    Clearcoat coat;
};

Reflectance reflectance(vec3 base_color, float metallic, float roughness) {
    vec3 f0 = mix(vec3(dielectric_f0), base_color, metallic);
    return Reflectance(base_color * (1.0 - metallic), f0, clamp(roughness, least_roughness, 1.0), 1.0, f0, f0, 1.0,
                       Sheen(vec3(0.0), 1.0, 0.0), Clearcoat(0.0, 1.0, vec3(0.0)));
}

// Khronos Group, KHR_materials_specular, 2021, with the F0 of KHR_materials_ior: `layer_f0` is that of the dielectric, times
// the colour, and may be above 1. Its weight is the part of the base under the layer; the rest is bare. The base loses
// the layer's largest channel, lest the complement of its colour shows. Metals are as they were.
Reflectance reflectance_with_specular(vec3 base_color, float metallic, float roughness, vec3 layer_f0, float weight) {
    Reflectance surface = reflectance(base_color, metallic, roughness);
    vec3 f0 = min(layer_f0, vec3(1.0));
    surface.f0 = mix(f0 * weight, base_color, metallic);
    surface.f90 = mix(weight, 1.0, metallic);
    surface.whole_f0 = mix(f0, base_color, metallic);
    surface.kept_f0 = mix(vec3(max(f0.r, max(f0.g, f0.b))), base_color, metallic);
    surface.layer_part = weight;
    return surface;
}

// Whether light from there meets the surface or its coat.
bool is_toward(Reflectance surface, vec3 n, vec3 l) {
    if (has_clearcoat) return max(dot(n, l), dot(surface.coat.normal, l)) > 0.0;
    return dot(n, l) > 0.0;
}

// What a matte base gives back under a layer that reflects more the more grazing the light goes in or out, so that no more
// light leaves than comes: Shirley, Smits, Hu and Lafortune, "A Practitioners' Assessment of Light Reflection Models",
// 1997.
vec3 coupled_diffuse(Reflectance surface, float n_dot_v, float n_dot_l) {
    vec2 rest = 1.0 - clamp(vec2(n_dot_v, n_dot_l), 0.0, 1.0), square = rest * rest;
    vec2 enters = 1.0 - square * square * rest;
    if (has_specular_layer) {
        vec3 under_layer = (1.0 - surface.kept_f0) * (1.05 / pi * enters.x * enters.y);
        return surface.diffuse * mix(vec3(1.0 / pi), under_layer, surface.layer_part);
    }
    return surface.diffuse * (1.0 - surface.f0) * (1.05 / pi * enters.x * enters.y);
}

// What leaves toward v of light of unit radiance from l: the BRDF times n.l. All directions are normalised and point
// away from the surface.
vec3 reflected(Reflectance surface, vec3 n, vec3 v, vec3 l) {
    float n_dot_l = max(dot(n, l), 0.0);
    float n_dot_v = max(dot(n, v), 0.0);
    vec3 half_vector = v + l;
    vec3 h = half_vector * inversesqrt(max(dot(half_vector, half_vector), 1e-12));
    vec3 fresnel = has_specular_layer ? layer_fresnel(surface.f0, surface.f90, dot(v, h))
                                      : fresnel_schlick(surface.f0, dot(v, h));
    float alpha = surface.roughness * surface.roughness;
    float specular = ggx_distribution(n, h, alpha) * smith_visibility(n_dot_v, n_dot_l, alpha);
    vec3 leaves = (coupled_diffuse(surface, n_dot_v, n_dot_l) + fresnel * specular) * n_dot_l;
    if (has_sheen) {
        float taken = max(surface.sheen.albedo, sheen_albedo(n_dot_l, surface.sheen.roughness));
        leaves = leaves * kept_by_sheen(surface.sheen, taken) +
                 surface.sheen.color * sheen_highlight(surface.sheen.roughness, dot(n, h), n_dot_v, n_dot_l);
    }
    if (has_clearcoat) leaves = mix(leaves, vec3(coat_highlight(surface.coat, v, l, h)), surface.coat.part);
    return leaves;
}

// What comes back of light that is lost between the microfacets of a whole layer, for each part that is not lost.
vec3 multiple_scattering(vec3 f0, float lost) {
    vec3 average_fresnel = f0 + (1.0 - f0) / 21.0;
    return lost * average_fresnel / (1.0 - average_fresnel * lost);
}

// reflected_surroundings() of Layer_specular.
vec3 layer_surroundings(Reflectance surface, vec3 irradiance, vec3 reflection, vec2 scale_and_bias) {
    float lost = 1.0 - (scale_and_bias.x + scale_and_bias.y);
    vec3 single = surface.f0 * scale_and_bias.x + surface.f90 * scale_and_bias.y;
    vec3 multiple = single * multiple_scattering(surface.whole_f0, lost);
    vec3 kept = surface.kept_f0 * scale_and_bias.x + scale_and_bias.y;
    kept += kept * multiple_scattering(surface.kept_f0, lost);
    return single * reflection + (multiple + surface.diffuse * (1.0 - surface.layer_part * kept)) * irradiance;
}

// What leaves of light from everywhere: `irradiance` over pi, `reflection` from the mirrored direction, as blurred as
// the surface is rough, `scale_and_bias` the split sum of Karis. The light that bounces between microfacets comes back
// as in Fdez-Aguero, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting", 2019, so that a white
// surface in white light is white.
vec3 reflected_surroundings(Reflectance surface, vec3 irradiance, vec3 reflection, vec2 scale_and_bias) {
    if (has_specular_layer) return layer_surroundings(surface, irradiance, reflection, scale_and_bias);
    vec3 single = surface.f0 * scale_and_bias.x + scale_and_bias.y;
    float lost = 1.0 - (scale_and_bias.x + scale_and_bias.y);
    vec3 average_fresnel = surface.f0 + (1.0 - surface.f0) / 21.0;
    vec3 multiple = lost * single * average_fresnel / (1.0 - average_fresnel * lost);
    return single * reflection + (multiple + surface.diffuse * (1.0 - single - multiple)) * irradiance;
}
