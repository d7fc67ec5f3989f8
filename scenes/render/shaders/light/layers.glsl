// What may lie over a surface: a coat, and fibres. Needs microfacets.glsl; in double precision it is
// render/light/layers_reference.hpp.

// What a pipeline's materials reflect beyond metallic-roughness, in bits. Those that have nothing of it have pipelines
// that know nothing of it.
layout(constant_id = 13) const uint layers = 0u;
const uint Layer_specular = 1u;
const uint Layer_clearcoat = 2u;
const uint Layer_sheen = 4u;
const bool has_specular_layer = (layers & Layer_specular) != 0u;
const bool has_clearcoat = (layers & Layer_clearcoat) != 0u;
const bool has_sheen = (layers & Layer_sheen) != 0u;
const float least_sheen_roughness = 0.1;

// What Layer_clearcoat lays over all else.
struct Clearcoat {
    float part;  // of the light toward the eye, that the coat reflects
    float roughness;
    vec3 normal;
};

// What Layer_sheen lays over the surface, under the coat: fibres that stand off it.
struct Sheen {
    vec3 color;
    float roughness;
    float albedo;  // of white fibres toward the eye
};

// Khronos Group, KHR_materials_clearcoat, 2021: Fresnel of the coat's own normal and the direction to the eye, of index
// 1.5, divides the light between the coat and what is under it.
Clearcoat clearcoat(float weight, float roughness, vec3 normal, vec3 v) {
    float part = weight * fresnel_schlick(vec3(dielectric_f0), max(dot(normal, v), 0.0)).r;
    return Clearcoat(part, clamp(roughness, least_roughness, 1.0), normal);
}

// A coat's highlight, before its part.
float coat_highlight(Clearcoat coat, vec3 v, vec3 l, vec3 h) {
    float n_dot_l = max(dot(coat.normal, l), 0.0);
    float alpha = coat.roughness * coat.roughness;
    return ggx_distribution(coat.normal, h, alpha) *
           smith_visibility(max(dot(coat.normal, v), 0.0), n_dot_l, alpha) * n_dot_l;
}

// Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", 2017, section 3, as the Khronos Group's
// KHR_materials_sheen, 2020, has it.
float sheen_shape(float x, float alpha) {
    float t = (1.0 - alpha) * (1.0 - alpha);
    return mix(21.5473, 25.3245, t) / (1.0 + mix(3.82987, 3.32435, t) * pow(x, mix(0.19823, 0.16801, t))) +
           mix(-1.97760, -1.27393, t) * x + mix(-4.32054, -4.85967, t);
}

float sheen_lambda(float cosine, float alpha) {
    return exp(cosine < 0.5 ? sheen_shape(cosine, alpha)
                            : 2.0 * sheen_shape(0.5, alpha) - sheen_shape(1.0 - cosine, alpha));
}

// What white fibres send to the eye of light of unit radiance: their BRDF times n.l.
float sheen_highlight(float roughness, float n_dot_h, float n_dot_v, float n_dot_l) {
    float alpha = roughness * roughness;
    float sine = sqrt(max(1.0 - n_dot_h * n_dot_h, 0.0));
    float distribution = (2.0 + 1.0 / alpha) * pow(sine, 1.0 / alpha) / (2.0 * pi);
    float hidden = (1.0 + sheen_lambda(n_dot_v, alpha) + sheen_lambda(n_dot_l, alpha)) * 4.0 * n_dot_v * n_dot_l;
    return distribution * n_dot_l / max(hidden, 1.0);
}

// How much of the light from everywhere white fibres send in a direction of this cosine. Fitted to the integral of
// sheen_highlight(), of which it is off by 0.04 at most and by 0.01 in the mean square.
float sheen_albedo(float cosine, float roughness) {
    vec4 powers = vec4(1.0 / (roughness * roughness), 1.0 / roughness, 1.0, roughness);
    float head_on = dot(vec4(-0.0085, 0.2377, -1.0925, 0.6619), powers);
    float slope = dot(vec4(0.0237, -1.4463, 0.7810, -0.9339), powers);
    float bend = dot(vec4(0.0458, -0.9256, 1.5842, -0.7346), powers);
    return min(exp(head_on + (slope + bend * cosine) * cosine), 1.0);
}

Sheen sheen(vec3 color, float roughness, float n_dot_v) {
    roughness = clamp(roughness, least_sheen_roughness, 1.0);
    return Sheen(color, roughness, sheen_albedo(n_dot_v, roughness));
}

// Of the light of what is under the fibres.
float kept_by_sheen(Sheen sheen, float albedo) {
    return 1.0 - max(max(sheen.color.r, sheen.color.g), sheen.color.b) * albedo;
}
