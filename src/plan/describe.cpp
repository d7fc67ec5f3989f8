// SPDX-License-Identifier: MIT
#include "plan/program.hpp"
#include "gpu/formats.hpp"

namespace darkroom::plan {

namespace {

std::uint64_t bytes_of(const graph::Slot& slot, VkExtent2D frame, std::uint32_t mip_level) {
    const VkExtent2D extent =
        graph::mip_extent(slot.desc.size.of(frame), mip_level < slot.desc.mip_levels ? mip_level : 0);
    return std::uint64_t{extent.width} * extent.height * gpu::format_traits(slot.desc.format).bits / 8;
}

}  // namespace

Plan describe_program(const Program& program, const graph::Compiled& compiled, const CompileDesc& desc) {
    Plan plan{.extent = desc.max_extent,
              .left_out = program.left_out,
              .remarks = program.remarks,
              .transient_bytes = compiled.transient_bytes(),
              .transient_bytes_unaliased = compiled.transient_bytes_unaliased()};
    // Everything on: what the plan can cost, not what this frame's toggles leave of it.
    graph::Schedule schedule(compiled);
    const auto toggles = std::make_unique<bool[]>(program.toggles.size() + 1);
    std::fill_n(toggles.get(), program.toggles.size(), true);
    schedule.derive({toggles.get(), program.toggles.size()}, std::vector<graph::ImportState>(program.imports.size()),
                    0);

    for (std::uint32_t i = 0; i < program.passes.size(); ++i) {
        const std::uint32_t kept = compiled.kept_pass_of({i});
        if (kept == ~0u) continue;
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
