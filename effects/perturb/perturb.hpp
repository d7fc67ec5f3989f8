// SPDX-License-Identifier: MIT
#pragma once
// Perturbation: the picture swims, as by heat, drink or a blast. Two crossed sines, a ring that runs outward from a
// point, and an image of displacements are added up; one set of parameters, four ways to evaluate it, which agree.

#include <darkroom/warp_grid.hpp>

namespace darkroom {

struct EffectInfo;

/// Where the displacement is worked out: in every pixel; there with a table in place of sin(); in the vertices of a
/// grid, between which it is interpolated; or in those by the CPU.
enum class PerturbEvaluation : std::uint32_t { Pixel, SineTable, Vertex, Cpu };

struct Perturb {
    float amount = 1.0f;
    Vec4 strength{6.0f, 6.0f, 2.0f, 2.0f};
    Vec2 time_distortion;
    Vec2 speed;
    float ring_strength = 0.0f;
    Vec2 ring_center{0.5f, 0.5f};
    float ring_width = 0.15f;
    float ring_speed = 0.6f;
    float ring_period = 2.0f;
    Resource distortion;
    float distortion_strength = 16.0f;
    PerturbEvaluation evaluation = PerturbEvaluation::Pixel;
    Vec2 grid = default_warp_grid;
};

/// What the CPU adds to the parameters in a frame.
struct PerturbFrame {
    float phase_x = 0, phase_y = 0;  ///< of the sines, in turns, [0, 1)
    float ring_radius = 0;           ///< in heights of the picture
    float ring_amplitude = 0;        ///< in pixels
};
[[nodiscard]] PerturbFrame perturb_frame(const Perturb& parameters, double time);

[[nodiscard]] const EffectInfo& effect_info(const Perturb&);

}  // namespace darkroom
