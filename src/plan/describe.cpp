// SPDX-License-Identifier: MIT
#include <array>
#include <bit>

#include "gpu/formats.hpp"
#include "plan/gates.hpp"

namespace darkroom::plan {

namespace {

std::uint64_t bytes_of(const graph::Slot& slot, VkExtent2D frame, std::uint32_t mip_level) {
    const VkExtent2D extent =
        graph::mip_extent(slot.desc.size.of(frame), mip_level < slot.desc.mip_levels ? mip_level : 0);
    return std::uint64_t{extent.width} * extent.height * gpu::format_traits(slot.desc.format).bits / 8;
}

/// Lights that no condition of a pass leaves out: before a camera that looks along -z, bright and casting shadows.
std::array<Light, max_shadow_lights> example_lights(const CompileDesc& desc) {
    std::array<Light, max_shadow_lights> lights;
    for (Light& light : lights) {
        light.direction = {0, 0, -1};
        light.volumetric_intensity = 1;
        if (!desc.has_shadows) continue;
        // Conditions ask whether there is a view, never what it is.
        light.cascades.view = std::bit_cast<VkImageView>(std::uintptr_t{1});
        light.cascade_count = 1;
    }
    return lights;
}

}  // namespace

Plan describe_program(const Program& program, const graph::Compiled& compiled, const CompileDesc& desc,
                      std::span<const Entry> stack) {
    Plan plan{.extent = desc.max_extent,
              .left_out = program.left_out,
              .remarks = program.remarks,
              .transient_bytes = compiled.transient_bytes(),
              .transient_bytes_unaliased = compiled.transient_bytes_unaliased()};
    const Camera camera;
    const auto lights = example_lights(desc);
    Gates gates(program, stack);
    gates.evaluate(
        program, stack,
        {.frame_extent = desc.max_extent, .output_extent = desc.max_extent, .camera = &camera, .lights = lights});
    graph::Schedule schedule(compiled);
    schedule.derive(gates.toggles(), std::vector<graph::ImportState>(program.imports.size()), 0);

    for (std::uint32_t i = 0; i < program.passes.size(); ++i) {
        const std::uint32_t kept = compiled.kept_pass_of({i});
        if (kept == ~0u || !schedule.runs(kept)) continue;
        const ProgramPass& pass = program.passes[i];
        const graph::Slot& output = compiled.slots()[schedule.slot_of(pass.output)];
        PlanPass out{.name = pass.name,
                     .stage = pass.stage == gpu::Stage::Compute ? "compute" : "raster",
                     .entries = {},
                     .boundary = pass.boundary,
                     .extent = graph::mip_extent(output.desc.size.of(desc.max_extent), pass.output_mip_level),
                     .bytes_written = bytes_of(output, desc.max_extent, pass.output_mip_level)};
        for (std::size_t k = 0; k < pass.inputs.size(); ++k) {
            const PassInput& input = pass.inputs[k];
            // An image that is both loaded and sampled stands there twice.
            if (input.table != no_table || !pass.spec.images[k].loads_by.empty()) continue;
            out.bytes_read +=
                bytes_of(compiled.slots()[schedule.slot_of(input.version)], desc.max_extent, input.mip_level);
        }
        if (pass.spec.is_additive) out.bytes_read += out.bytes_written;
        for (const FusedStep& step : pass.steps) out.entries.push_back(step.name);
        plan.passes.push_back(std::move(out));
    }
    return plan;
}

}  // namespace darkroom::plan
