// SPDX-License-Identifier: MIT
#include "compose/stack/stack_program.hpp"

#include <algorithm>
#include <tuple>

#include "gpu/device/context.hpp"
#include "gpu/resource/format_use.hpp"
#include "plan/frame_inputs.hpp"

namespace darkroom::compose {

namespace {

/// Of an entry what the planner looks at; the rest are values of a frame.
auto wiring_of(const plan::Entry& entry) {
    const EntryDesc& desc = entry.desc;
    const auto wire = [](Handle handle) { return std::pair(handle.id, handle.is_previous); };
    return std::tuple(entry.id, entry.info, wire(desc.input), wire(desc.source), wire(desc.second), wire(desc.mask),
                      desc.name, entry.is_plain(), desc.scale.numerator, desc.scale.denominator, desc.format);
}

/// The stage the user asked for where it can run the kernel, else the other one.
Result<gpu::Stage> stage_of(const gpu::Context& context, const gpu::KernelSpec& spec, KernelStage wanted) {
    if (wanted == KernelStage::Auto) {
        const gpu::Stage preferred = gpu::preferred_stage(context, spec);
        DARKROOM_TRY(gpu::usable(context, spec, preferred));
        return preferred;
    }
    const gpu::Stage first = wanted == KernelStage::Compute ? gpu::Stage::Compute : gpu::Stage::Raster;
    const gpu::Stage second = wanted == KernelStage::Compute ? gpu::Stage::Raster : gpu::Stage::Compute;
    auto ok = gpu::usable(context, spec, first);
    if (ok) return first;
    if (gpu::usable(context, spec, second)) return second;
    return failure(std::move(ok));
}

}  // namespace

Result<> StackProgram::make_tables(gpu::Context& context, const StackProgram* older) {
    if (tables) return {};
    const auto is_shadow_map = [](const auto& import) {
        return import && import->kind == plan::HostImage::Kind::Shadow;
    };
    if (std::ranges::any_of(program.imports, is_shadow_map)) {
        DARKROOM_TRY_VALUE(lit, LitShadowMap::create(context));
    }
    const bool has_older = older != nullptr && older->tables.has_value();
    DARKROOM_TRY_VALUE(auto made, has_older ? Tables::create(context, program.fixed_images, &*older->tables,
                                                             older->program.fixed_images)
                                            : Tables::create(context, program.fixed_images));
    tables.emplace(std::move(made));
    return {};
}

bool StackProgram::serves(std::span<const plan::Entry> other_stack, const CompileDesc& other_desc) const {
    const auto is_same = [&](const plan::Entry& a, const plan::Entry& b) {
        return wiring_of(a) == wiring_of(b) && a.values_at_compile() == b.values_at_compile();
    };
    return plan::bring_the_same(desc, other_desc) && facts_of(desc) == facts_of(other_desc) &&
           std::ranges::equal(stack, other_stack, is_same) &&
           std::ranges::all_of(program.extent_answers, [&](const plan::Program::ExtentAnswer& asked) {
               return asked.question(asked.size.of(plan::largest_extents(other_desc))) == asked.answer;
           });
}

plan::PlannerTraits planner_traits(const gpu::Context& context, KernelStage kernels) {
    return {.stage_of = [&context, kernels](const gpu::KernelSpec& spec) { return stage_of(context, spec, kernels); },
            .can_load = [&context](VkFormat format) { return gpu::can_load(context, format); },
            .can_filter = [&context](VkFormat format) { return gpu::can_filter(context, format); },
            .has_robust_images = context.traits.has_robust_images,
            .sub_texel_bits = context.traits.sub_texel_bits,
            .packing_pays = !context.traits.is_software,
            .max_image_side = context.traits.max_image_dimension,
            .max_storage_images = context.traits.max_storage_images,
            .workgroup = gpu::usual_workgroup(context),
            .compute = {.workgroup_invocations = context.traits.max_workgroup_invocations,
                        .shared_bytes = context.traits.max_shared_bytes}};
}

Result<std::shared_ptr<StackProgram>> plan_stack(const gpu::Context& context, std::span<const plan::Entry> stack,
                                                 const CompileDesc& desc) {
    DARKROOM_TRY_VALUE(auto program, plan::plan_program(stack, desc, planner_traits(context, desc.kernels)));
    auto out = std::make_shared<StackProgram>();
    out->program = std::move(program);
    for (const plan::Entry& entry : stack) out->stack.push_back(entry);
    out->desc = desc;
    for (const plan::ProgramPass& pass : out->program.passes)
        out->kernels.push_back(std::make_unique<PassKernels>(pass));
    return out;
}

}  // namespace darkroom::compose
