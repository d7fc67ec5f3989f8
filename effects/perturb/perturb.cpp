// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstring>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/perturb.hpp>
#include <numbers>

#include "perturb/perturb_reference.hpp"

namespace darkroom {

namespace {

constexpr auto perturb_rows = describe(
    field<&Perturb::amount>("Factor of all displacements.", {0, 8}).as_amount(),
    field<&Perturb::strength>(
        "Amplitude of the sines in x and y, in pixels, then their number of waves across the picture.", {-256, 256})
        .as_size_of<&Perturb::reach>(),
    field<&Perturb::time_distortion>("Phase of the sines in x and y, in turns: 0 and 1 are the same.", {0, 1}),
    field<&Perturb::speed>("Turns of the phases, and of the distortion image, in a second.", {-16, 16}),
    field<&Perturb::ring_strength>("Amplitude of the ring at its start; below 0 it pulls.", {-256, 256}, unit::pixels)
        .as_size_of<&Perturb::reach>(),
    field<&Perturb::ring_center>("Place where the ring starts, in uv.", {-1, 2}),
    field<&Perturb::ring_width>("Half-width of the ring, in heights of the picture.", {0.001, 2}),
    field<&Perturb::ring_speed>("Speed of the ring, in heights of the picture a second.", {0, 16}),
    field<&Perturb::ring_period>("Time in which the ring dies down and after which it starts again.", {0.01, 3600},
                                 unit::seconds),
    field<&Perturb::distortion>("Image whose red and green displace the picture; 0.5 displaces by nothing. It repeats.")
        .as_picture(),
    field<&Perturb::distortion_strength>("Displacement where the distortion image is 0 or 1.", {-256, 256},
                                         unit::pixels)
        .as_size_of<&Perturb::reach>(),
    field<&Perturb::evaluation>("Place where the displacement is computed: every pixel, with sin() or a table of it, "
                                "or a grid's vertices, on the GPU or CPU.")
        .at_compile(),
    warp_grid_field<&Perturb::grid>(),
    field<&Perturb::reach>("Pixels that amplitudes and displacements are measured in: those of the picture, or of a "
                           "picture of 1080 lines."));

constexpr std::uint32_t own_vectors = 2, max_cpu_vertices = 1000, sine_entries = 256;

const Perturb& perturb_of(const void* parameters) { return *static_cast<const Perturb*>(parameters); }

bool has_grid(const Perturb& p) {
    return p.evaluation == PerturbEvaluation::Vertex || p.evaluation == PerturbEvaluation::Cpu;
}
bool asks_for_grid(const void* parameters, const PassContext&, std::uint32_t) {
    return has_grid(perturb_of(parameters));
}

std::size_t vertices_of(const Perturb& p) {
    const auto [columns, rows] = warp_grid_cells(p.grid);
    return std::size_t{columns + 1} * (rows + 1);
}

void write_own(const Perturb& p, const PassContext& context, std::span<PassVector> out) {
    const PerturbFrame frame = perturb_frame(p, context.time);
    out[0] = {frame.phase_x, frame.phase_y, frame.ring_radius, frame.ring_amplitude};
    out[1] = {static_cast<float>(context.frame_extent.width), static_cast<float>(context.frame_extent.height),
              p.distortion.id != 0 ? 1.0f : 0.0f, 0};
}
void end_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    write_own(perturb_of(parameters), context, out);
}

/// The vertices, where the CPU moves them and the plan has room for them. It sees no image of displacements.
void grid_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Perturb& p = perturb_of(parameters);
    write_own(p, context, out);
    const auto columns = context.output_extent.width, rows = context.output_extent.height;
    if (p.evaluation != PerturbEvaluation::Cpu || out.size() < own_vectors + (columns * rows + 1) / 2) return;
    out[1][3] = 1;
    const PerturbFrame frame = perturb_frame(p, context.time);
    const auto [width, height] = context.frame_extent;
    for (std::uint32_t i = 0; i < columns * rows; ++i) {
        const double u = static_cast<double>(i % columns) / (columns - 1),
                     v = static_cast<double>(i / columns) / (rows - 1);
        const PerturbShift shift = perturb_shift(p, frame, u, v, width, height, nullptr);
        PassVector& pair = out[own_vectors + i / 2];
        pair[2 * (i % 2)] = static_cast<float>(shift.x);
        pair[2 * (i % 2) + 1] = static_cast<float>(shift.y);
    }
}

PassImage sine_table(PassBuilder& builder) {
    std::array<float, sine_entries> sines{};
    for (std::size_t i = 0; i < sines.size(); ++i)
        sines[i] = static_cast<float>(std::sin(2 * std::numbers::pi * static_cast<double>(i) / sine_entries));
    TableDesc table{.name = "sines",
                    .format = VK_FORMAT_R32_SFLOAT,
                    .extent = {sine_entries, 1, 1},
                    .is_load_only = true,
                    .data = std::vector<std::byte>(sizeof sines)};
    std::memcpy(table.data.data(), sines.data(), sizeof sines);
    return builder.table(table);
}

PassImage distortion(PassBuilder& builder, Resource resource) {
    const ResourceData* const data = builder.resource(resource);
    const auto* const image = data == nullptr ? nullptr : std::get_if<ResourceImage>(data);
    const ResourceImage still{.width = 1, .height = 1, .rgba = {0.5f, 0.5f, 0, 1}};
    const ResourceImage& used = image == nullptr ? still : *image;
    TableDesc table{.name = "distortion",
                    .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                    .extent = {used.width, used.height, 1},
                    .is_load_only = true,
                    .data = std::vector<std::byte>(used.rgba.size() * sizeof used.rgba[0])};
    std::memcpy(table.data.data(), used.rgba.data(), table.data.size());
    return builder.table(table);
}

void build(PassBuilder& builder) {
    const Perturb& p = perturb_of(builder.parameters());
    const PassImage image = distortion(builder, p.distortion);
    const std::size_t cpu_vertices = p.evaluation == PerturbEvaluation::Cpu ? vertices_of(p) : 0;
    PassImage grid;
    if (has_grid(p))
        grid = warp_grid(builder, p.grid,
                         {.name = "grid",
                          .shader = "perturb.glsl#grid",
                          .inputs = {{.name = "perturb_distortion", .image = image}},
                          .custom_vectors = own_vectors + static_cast<std::uint32_t>(cpu_vertices + 1) / 2,
                          .constants = grid_constants,
                          .condition = asks_for_grid});
    builder.side("perturb_vertices", grid, {});
    builder.side("perturb_distortion", image, {});
    builder.side("perturb_sines", sine_table(builder), {});
    builder.end_constants(own_vectors, end_constants);
}

std::string conflict(const void* parameters) {
    const Perturb& p = perturb_of(parameters);
    if (p.evaluation != PerturbEvaluation::Cpu) return {};
    if (p.distortion.id != 0) return "evaluation = cpu: the CPU does not read the distortion image; allowed is vertex";
    const std::size_t vertices = vertices_of(p);
    if (vertices <= max_cpu_vertices) return {};
    return "grid of " + std::to_string(vertices) + " vertices: with evaluation = cpu at most " +
           std::to_string(max_cpu_vertices) + " are allowed";
}

bool is_identity(const void* parameters) {
    const Perturb& p = perturb_of(parameters);
    const bool is_still = p.strength.x == 0 && p.strength.y == 0 && p.ring_strength == 0 &&
                          (p.distortion.id == 0 || p.distortion_strength == 0);
    return p.amount == 0 || is_still;
}

}  // namespace

PerturbFrame perturb_frame(const Perturb& p, double time) {
    const auto turn = [&](float start, float speed) {
        const double turns = double{start} + double{speed} * time;
        const auto phase = static_cast<float>(turns - std::floor(turns));
        return phase < 1 ? phase : 0.0f;
    };
    const double age = std::fmod(std::max(time, 0.0), double{p.ring_period});
    return {turn(p.time_distortion.x, p.speed.x), turn(p.time_distortion.y, p.speed.y),
            static_cast<float>(double{p.ring_speed} * age),
            static_cast<float>(double{p.ring_strength} * (1 - age / double{p.ring_period}))};
}

const EffectInfo& effect_info(const Perturb&) {
    static const EffectInfo info{
        .name = "perturb",
        .doc = "Displaces the picture by sines, a ring that runs outward, or an image.",
        .parameters = perturb_rows.table(),
        .files = embedded_files("perturb"),
        .touch = Touch::Warp,
        .accepts = Domains::all(),
        .flat = {.documented = 15, .scene_linear = 52},
        .build = build,
        .reference = perturb_reference,
        .conflict = conflict,
        .is_identity = is_identity,
    };
    return info;
}

}  // namespace darkroom
