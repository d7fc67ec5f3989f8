// How a surface reflects light: Lambert under a microfacet layer (Cook and Torrance, "A Reflectance Model for Computer
// Graphics", 1982) with the choices of Karis, "Real Shading in Unreal Engine 4", 2013. Needs nothing else; in double
// precision it is render/light/brdf_reference.hpp.
const float pi = 3.14159265358979;
const float dielectric_f0 = 0.04;    // of glass and most plastics: index of refraction 1.5
const float least_roughness = 0.04;  // a smoother highlight of a light without size would fall between the pixels

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

// Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, equation 33. 1 - (n.h)^2 is taken as
// |n x h|^2, which keeps the peak of smooth surfaces exact in single precision.
float ggx_distribution(vec3 n, vec3 h, float alpha) {
    float n_dot_h = max(dot(n, h), 0.0);
    vec3 sine = cross(n, h);
    float square = alpha * alpha;
    float denominator = max(n_dot_h * n_dot_h * square + dot(sine, sine), 1e-9);
    return square / (pi * denominator * denominator);
}

// Masking and shadowing over 4 n.v n.l, height-correlated (Heitz, "Understanding the Masking-Shadowing Function in
// Microfacet-Based BRDFs", 2014, eq. 99): the light of the surroundings has the same (render/light/environment.cpp).
float smith_visibility(float n_dot_v, float n_dot_l, float alpha) {
    float square = alpha * alpha;
    float masked = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - square) + square);
    float shadowed = n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - square) + square);
    return n_dot_v > 0.0 ? 0.5 / max(masked + shadowed, 1e-6) : 0.0;
}

// Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994, equation 15.
vec3 fresnel_schlick(vec3 f0, float v_dot_h) {
    float c = clamp(1.0 - v_dot_h, 0.0, 1.0);
    float square = c * c;
    return f0 + (1.0 - f0) * (square * square * c);
}

// The same for layers that are not white at grazing angles.
vec3 layer_fresnel(vec3 f0, float f90, float v_dot_h) {
    float c = clamp(1.0 - v_dot_h, 0.0, 1.0);
    float square = c * c;
    return f0 + (f90 - f0) * (square * square * c);
}

// Khronos Group, KHR_materials_clearcoat, 2021: Fresnel of the coat's own normal and the direction to the eye, of index
// 1.5, divides the light between the coat and what is under it.
Clearcoat clearcoat(float weight, float roughness, vec3 normal, vec3 v) {
    float part = weight * fresnel_schlick(vec3(dielectric_f0), max(dot(normal, v), 0.0)).r;
    return Clearcoat(part, clamp(roughness, least_roughness, 1.0), normal);
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

// A coat's highlight, before its part.
float coat_highlight(Clearcoat coat, vec3 v, vec3 l, vec3 h) {
    float n_dot_l = max(dot(coat.normal, l), 0.0);
    float alpha = coat.roughness * coat.roughness;
    return ggx_distribution(coat.normal, h, alpha) *
           smith_visibility(max(dot(coat.normal, v), 0.0), n_dot_l, alpha) * n_dot_l;
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
