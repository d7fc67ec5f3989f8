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
    /// Factor of all displacements. [0, 8]
    float amount = 1.0f;
    /// Amplitude of the sines in x and y, in pixels, then their number of waves across the picture. [-256, 256]
    Vec4 strength{6.0f, 6.0f, 2.0f, 2.0f};
    /// Phase of the sines in x and y, in turns: 0 and 1 are the same. [0, 1]
    Vec2 time_distortion;
    /// Turns of the phases, and of the distortion image, in a second. [-16, 16]
    Vec2 speed;
    /// Amplitude of the ring at its start; below 0 it pulls. [-256, 256] px
    float ring_strength = 0.0f;
    /// Place where the ring starts, in uv. [-1, 2]
    Vec2 ring_center{0.5f, 0.5f};
    /// Half-width of the ring, in heights of the picture. [0.001, 2]
    float ring_width = 0.15f;
    /// Speed of the ring, in heights of the picture a second. [0, 16]
    float ring_speed = 0.6f;
    /// Time in which the ring dies down and after which it starts again. [0.01, 3600] s
    float ring_period = 2.0f;
    /// Image whose red and green displace the picture; 0.5 displaces by nothing. It repeats.
    Resource distortion;
    /// Displacement where the distortion image is 0 or 1. [-256, 256] px
    float distortion_strength = 16.0f;
    /// Place where the displacement is computed: every pixel, with sin() or a table of it, or a grid's vertices, on the
    /// GPU or CPU.
    PerturbEvaluation evaluation = PerturbEvaluation::Pixel;
    /// Columns and rows of the grid whose vertices are evaluated. [1, 256]
    Vec2 grid = default_warp_grid;
    /// Pixels that amplitudes and displacements are measured in: those of the picture, or of a picture of 1080 lines.
    Reach reach = Reach::Height;
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
