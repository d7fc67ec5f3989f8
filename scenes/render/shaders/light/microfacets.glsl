// The microfacets of Karis, "Real Shading in Unreal Engine 4", 2013: GGX, and Fresnel's reflection after Schlick. Needs
// nothing else.
const float pi = 3.14159265358979;
const float dielectric_f0 = 0.04;    // of glass and most plastics: index of refraction 1.5
const float least_roughness = 0.04;  // a smoother highlight of a light without size would fall between the pixels

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

// The same for what is not white at grazing angles.
vec3 layer_fresnel(vec3 f0, float f90, float v_dot_h) {
    float c = clamp(1.0 - v_dot_h, 0.0, 1.0);
    float square = c * c;
    return f0 + (f90 - f0) * (square * square * c);
}
