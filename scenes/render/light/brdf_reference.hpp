// SPDX-License-Identifier: MIT
#pragma once
// The formulas of shaders/light/brdf.glsl and shaders/light/lights.glsl in double precision, as they were published:
// what the shaders are compared with, and what is integrated to see that no energy is made. Not for drawing.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/math.hpp"

namespace darkroom::render::reference {

using glm::dvec2;
using glm::dvec3;

struct Reflectance {
    dvec3 diffuse{0};
    dvec3 f0{0};
    double roughness = 1;
};

/// Metallic-roughness as in the Khronos Group's glTF 2.0 specification, appendix B.2, with F0 = 0.04 for dielectrics.
inline Reflectance reflectance(const dvec3& base_color, double metallic, double roughness) {
    return {.diffuse = base_color * (1.0 - metallic),
            .f0 = dvec3(0.04) * (1.0 - metallic) + base_color * metallic,
            .roughness = std::clamp(roughness, 0.04, 1.0)};
}

/// Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, equation 33, with the tangent
/// eliminated.
inline double ggx_distribution(double n_dot_h, double alpha) {
    if (n_dot_h <= 0) return 0;
    const double square = alpha * alpha;
    const double denominator = n_dot_h * n_dot_h * (square - 1) + 1;
    return square / (std::numbers::pi * denominator * denominator);
}

/// Height-correlated masking and shadowing over 4 n.v n.l: Heitz, "Understanding the Masking-Shadowing Function in
/// Microfacet-Based BRDFs", 2014, equations 72 and 99.
inline double smith_visibility(double n_dot_v, double n_dot_l, double alpha) {
    const auto lambda = [&](double cosine) {
        return (std::sqrt(1 + alpha * alpha * (1 - cosine * cosine) / (cosine * cosine)) - 1) / 2;
    };
    if (n_dot_v <= 0 || n_dot_l <= 0) return 0;
    return 1 / (1 + lambda(n_dot_v) + lambda(n_dot_l)) / (4 * n_dot_v * n_dot_l);
}

/// Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994, equation 15.
inline dvec3 fresnel_schlick(const dvec3& f0, double v_dot_h) {
    return f0 + (dvec3(1) - f0) * std::pow(std::clamp(1 - v_dot_h, 0.0, 1.0), 5);
}

/// The two parts of the BRDF, Cook and Torrance, "A Reflectance Model for Computer Graphics", 1982; without n.l.
struct Brdf {
    dvec3 diffuse{0};
    dvec3 specular{0};
};
inline Brdf brdf(const Reflectance& surface, const dvec3& n, const dvec3& v, const dvec3& l) {
    const double n_dot_v = std::max(glm::dot(n, v), 0.0);
    const double n_dot_l = std::max(glm::dot(n, l), 0.0);
    const dvec3 h = glm::normalize(v + l);
    const dvec3 fresnel = fresnel_schlick(surface.f0, glm::dot(v, h));
    const double alpha = surface.roughness * surface.roughness;
    // Shirley, Smits, Hu and Lafortune, "A Practitioners' Assessment of Light Reflection Models", 1997.
    const double enters = (1 - std::pow(1 - n_dot_v, 5)) * (1 - std::pow(1 - n_dot_l, 5));
    return {.diffuse = surface.diffuse * (dvec3(1) - surface.f0) * (1.05 * enters / std::numbers::pi),
            .specular = fresnel * ggx_distribution(glm::dot(n, h), alpha) * smith_visibility(n_dot_v, n_dot_l, alpha)};
}

/// What leaves toward `v` of light of unit radiance from `l`.
inline dvec3 reflected(const Reflectance& surface, const dvec3& n, const dvec3& v, const dvec3& l) {
    const Brdf value = brdf(surface, n, v, l);
    return (value.diffuse + value.specular) * std::max(glm::dot(n, l), 0.0);
}

/// Fdez-Aguero, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting", 2019, section 3.2 and
/// listing 1, with the Fresnel term left to the split-sum table.
inline dvec3 reflected_surroundings(const Reflectance& surface, const dvec3& irradiance, const dvec3& reflection,
                                    const dvec2& scale_and_bias) {
    const dvec3 single = surface.f0 * scale_and_bias.x + dvec3(scale_and_bias.y);
    const double lost = 1 - (scale_and_bias.x + scale_and_bias.y);
    const dvec3 average = surface.f0 + (dvec3(1) - surface.f0) / 21.0;
    const dvec3 multiple = single * average / (dvec3(1) - average * lost) * lost;
    return single * reflection + (multiple + surface.diffuse * (dvec3(1) - single - multiple)) * irradiance;
}

/// KHR_lights_punctual: inverse square, brought to 0 at the range.
inline double distance_attenuation(double distance, double range) {
    return std::clamp(1 - std::pow(distance / range, 4), 0.0, 1.0) / std::max(distance * distance, 1e-4);
}

/// KHR_lights_punctual: the square of what goes straight between the cosines.
inline double cone_attenuation(double cosine, double outer_cosine, double inner_cosine) {
    const double t = std::clamp((cosine - outer_cosine) / std::max(inner_cosine - outer_cosine, 0.001), 0.0, 1.0);
    return t * t;
}

/// Light from above and below.
inline dvec3 hemisphere(const dvec3& n, const dvec3& sky, const dvec3& ground) {
    return ground + (sky - ground) * (n.y * 0.5 + 0.5);
}

}  // namespace darkroom::render::reference
