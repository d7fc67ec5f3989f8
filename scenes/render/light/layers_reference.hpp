// SPDX-License-Identifier: MIT
#pragma once
// What the layers of shaders/light/layers.glsl reflect, in double precision, from the formulas of the Khronos Group's
// extensions of glTF 2.0. The matte base is coupled to its layer as in brdf_reference.hpp. Not for drawing.

#include "render/light/brdf_reference.hpp"

namespace darkroom::render::reference {

inline double largest(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

struct LayeredSurface {
    dvec3 base_color{1};
    double metallic = 0, roughness = 1;
    double index_of_refraction = 1.5, specular_weight = 1;
    dvec3 specular_color{1};
    double coat_weight = 0, coat_roughness = 0;
    dvec3 sheen_color{0};
    double sheen_roughness = 0;
};

/// KHR_materials_ior, "Implementation", and KHR_materials_specular, fresnel_mix(): what a whole layer reflects head-on.
inline dvec3 dielectric_f0(const LayeredSurface& surface) {
    const double root = (1 - surface.index_of_refraction) / (1 + surface.index_of_refraction);
    return glm::min(surface.specular_color * root * root, dvec3(1));
}

/// KHR_materials_specular: mix(dielectric_brdf, metal_brdf, metallic), and in the dielectric's
/// (1 - weight * max(fr)) * base + weight * fr * layer.
inline dvec3 reflected_base(const LayeredSurface& surface, const dvec3& n, const dvec3& v, const dvec3& l) {
    const double weight = surface.specular_weight;
    const dvec3 f0 = dielectric_f0(surface);
    const auto roughly = [&](const dvec3& diffuse, const dvec3& head_on) {
        return brdf({.diffuse = diffuse, .f0 = head_on, .roughness = std::clamp(surface.roughness, 0.04, 1.0)}, n, v,
                    l);
    };
    const double part = 1 - surface.metallic;
    // Where the metal is a part, a base under it would lose what it reflects, as in reflectance().
    const dvec3 kept = dvec3(largest(f0)) * part + surface.base_color * surface.metallic;
    const dvec3 dielectric = surface.base_color * (1 - weight) / std::numbers::pi +
                             weight * (roughly(surface.base_color, kept).diffuse + roughly(dvec3(0), f0).specular);
    const dvec3 metal = roughly(dvec3(0), surface.base_color).specular;
    return (dielectric * part + metal * surface.metallic) * std::max(glm::dot(n, l), 0.0);
}

/// KHR_materials_clearcoat, fresnel_coat(): what the coat takes of the light toward the eye.
inline double coat_part(const LayeredSurface& surface, const dvec3& coat_normal, const dvec3& v) {
    return surface.coat_weight * fresnel_schlick(dvec3(0.04), std::abs(glm::dot(coat_normal, v))).x;
}

/// KHR_materials_sheen, "Sheen visibility": l() and lambda_sheen().
inline double sheen_lambda(double cosine, double alpha) {
    const auto l = [&](double x) {
        const double t = (1 - alpha) * (1 - alpha);
        const double a = std::lerp(21.5473, 25.3245, t), b = std::lerp(3.82987, 3.32435, t);
        const double c = std::lerp(0.19823, 0.16801, t), d = std::lerp(-1.97760, -1.27393, t);
        const double e = std::lerp(-4.32054, -4.85967, t);
        return a / (1 + b * std::pow(x, c)) + d * x + e;
    };
    return std::abs(cosine) < 0.5 ? std::exp(l(cosine)) : std::exp(2 * l(0.5) - l(1 - cosine));
}

/// KHR_materials_sheen: the distribution of Charlie, times visibility, times n.l.
inline double sheen_highlight(double roughness, const dvec3& n, const dvec3& v, const dvec3& l) {
    const double alpha = roughness * roughness, n_dot_h = glm::dot(n, glm::normalize(v + l));
    const double n_dot_v = glm::dot(n, v), n_dot_l = glm::dot(n, l);
    if (n_dot_v <= 0 || n_dot_l <= 0) return 0;
    const double distribution = (2 + 1 / alpha) * std::pow(1 - n_dot_h * n_dot_h, 0.5 / alpha) / (2 * std::numbers::pi);
    const double visibility =
        1 / ((1 + sheen_lambda(n_dot_v, alpha) + sheen_lambda(n_dot_l, alpha)) * 4 * n_dot_v * n_dot_l);
    return distribution * std::clamp(visibility, 0.0, 1.0) * n_dot_l;
}

/// E() of KHR_materials_sheen as layers.glsl approximates it.
inline double sheen_albedo(double cosine, double roughness) {
    const auto row = [&](double a, double b, double c, double d) {
        return a / (roughness * roughness) + b / roughness + c + d * roughness;
    };
    const double exponent = row(-0.0085, 0.2377, -1.0925, 0.6619) + cosine * row(0.0237, -1.4463, 0.781, -0.9339) +
                            cosine * cosine * row(0.0458, -0.9256, 1.5842, -0.7346);
    return std::min(std::exp(exponent), 1.0);
}

inline double roughness_of_sheen(const LayeredSurface& surface) { return std::max(surface.sheen_roughness, 0.1); }

/// KHR_materials_sheen, "Albedo scaling", toward v and, where light comes from l alone, the same for it.
inline dvec3 under_sheen(const LayeredSurface& surface, const dvec3& base, double albedo) {
    return base * (1 - largest(surface.sheen_color) * albedo);
}

/// KHR_materials_clearcoat, "Layering": mix(base, layer, weight * fr), the layer specular_brdf() of the coat's normal.
inline dvec3 reflected(const LayeredSurface& surface, const dvec3& n, const dvec3& coat_normal, const dvec3& v,
                       const dvec3& l) {
    const double n_dot_l = glm::dot(coat_normal, l);
    const double alpha = std::pow(std::clamp(surface.coat_roughness, 0.04, 1.0), 2);
    const double layer = ggx_distribution(glm::dot(coat_normal, glm::normalize(v + l)), alpha) *
                         smith_visibility(glm::dot(coat_normal, v), n_dot_l, alpha) * std::max(n_dot_l, 0.0);
    const double roughness = roughness_of_sheen(surface), n_dot_v = std::max(glm::dot(n, v), 0.0);
    const double albedo =
        std::max(sheen_albedo(n_dot_v, roughness), sheen_albedo(std::max(glm::dot(n, l), 0.0), roughness));
    const dvec3 base = under_sheen(surface, reflected_base(surface, n, v, l), albedo) +
                       surface.sheen_color * sheen_highlight(roughness, n, v, l);
    return glm::mix(base, dvec3(layer), coat_part(surface, coat_normal, v));
}

/// Of a dielectric or a metal in surroundings of one radiance: the same mixture.
inline dvec3 reflected_white_base(const LayeredSurface& surface, const dvec2& scale_and_bias) {
    const auto layer = [&](const dvec3& head_on) {
        return reflected_surroundings({.f0 = head_on}, dvec3(1), dvec3(1), scale_and_bias);
    };
    if (surface.metallic == 1) return layer(surface.base_color);
    const dvec3 f0 = dielectric_f0(surface);
    const dvec3 whole = layer(f0) + surface.base_color * (dvec3(1) - layer(dvec3(largest(f0))));
    return surface.base_color * (1 - surface.specular_weight) + whole * surface.specular_weight;
}

/// What leaves toward v of light of unit radiance from everywhere under the fibres, with what they send.
inline dvec3 with_white_sheen(const LayeredSurface& surface, const dvec3& base, double n_dot_v) {
    const double albedo = sheen_albedo(n_dot_v, roughness_of_sheen(surface));
    return under_sheen(surface, base, albedo) + surface.sheen_color * albedo;
}

/// The same toward v under the fibres and the coat, which gives back all that it takes.
inline dvec3 reflected_white(const LayeredSurface& surface, const dvec3& n, const dvec3& v,
                             const dvec2& scale_and_bias) {
    const dvec3 base =
        with_white_sheen(surface, reflected_white_base(surface, scale_and_bias), std::max(glm::dot(n, v), 0.0));
    return glm::mix(base, dvec3(1), coat_part(surface, n, v));
}

}  // namespace darkroom::render::reference
