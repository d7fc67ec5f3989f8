// SPDX-License-Identifier: MIT
#pragma once
// What the layers of shaders/light/brdf.glsl reflect, in double precision, from the formulas of the Khronos Group's
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

/// KHR_materials_clearcoat, "Layering": mix(base, layer, weight * fr), the layer specular_brdf() of the coat's normal.
inline dvec3 reflected(const LayeredSurface& surface, const dvec3& n, const dvec3& coat_normal, const dvec3& v,
                       const dvec3& l) {
    const double n_dot_l = glm::dot(coat_normal, l);
    const double alpha = std::pow(std::clamp(surface.coat_roughness, 0.04, 1.0), 2);
    const double layer = ggx_distribution(glm::dot(coat_normal, glm::normalize(v + l)), alpha) *
                         smith_visibility(glm::dot(coat_normal, v), n_dot_l, alpha) * std::max(n_dot_l, 0.0);
    return glm::mix(reflected_base(surface, n, v, l), dvec3(layer), coat_part(surface, coat_normal, v));
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

/// The same toward v under the coat, which gives back all that it takes.
inline dvec3 reflected_white(const LayeredSurface& surface, const dvec3& n, const dvec3& v,
                             const dvec2& scale_and_bias) {
    return glm::mix(reflected_white_base(surface, scale_and_bias), dvec3(1), coat_part(surface, n, v));
}

}  // namespace darkroom::render::reference
