// SPDX-License-Identifier: MIT
// What a driver's compiler makes of a plan's kernels.
#include "compose/composer_state.hpp"
#include "core/caught.hpp"

namespace darkroom {

namespace {

/// Of the kernel that a frame gets for this pass.
Result<KernelStatistics> statistics_of(gpu::Context& context, const plan::ProgramPass& pass, const plan::Shape& shape) {
    DARKROOM_TRY_VALUE(const auto spec, plan::lean_spec(pass, shape));
    DARKROOM_TRY_VALUE(const auto kernel, gpu::Kernel::create(context, spec, pass.stage));
    auto out = kernel->statistics();
    if (out) out->name = pass.name;
    return out;
}

}  // namespace

Result<std::vector<KernelStatistics>> Composer::statistics(const CompileDesc& desc) const try {
    gpu::Context& context = *state_->context;
    if (!context.compiles_only)
        return user_error(
            "statistics: the composer's device is for recording or planning; allowed is one created with "
            "compiles_only");
    DARKROOM_TRY_VALUE(auto snapshot, state_->snapshot(desc));
    DARKROOM_TRY_VALUE(const auto program,
                       plan::plan_program(snapshot.values, desc, compose::planner_traits(context, desc.kernels)));
    DARKROOM_TRY_VALUE(const auto compiled,
                       program.graph.compile(plan::largest_extents(desc), graph::measure_on(context)));
    std::vector<const plan::Entry*> entries;
    for (const plan::Entry& entry : snapshot.values) entries.push_back(&entry);
    const plan::FrameValues values = plan::example_values(program, desc, entries);
    graph::Schedule schedule(compiled);
    schedule.derive(values.gates(), std::vector<graph::ImportState>(program.imports.size()), 0);

    std::vector<KernelStatistics> out;
    for (const auto& [kept, i] : plan::passes_in_order(program, compiled)) {
        if (!schedule.runs(kept)) continue;
        const plan::ProgramPass& pass = program.passes[i];
        DARKROOM_TRY_VALUE(auto one, statistics_of(context, pass,
                                                   plan::expected_shape(program, compiled, schedule, values, entries,
                                                                        pass, plan::largest_extents(desc))));
        out.push_back(std::move(one));
    }
    return out;
} catch (...) {
    return caught("statistics");
}

}  // namespace darkroom
