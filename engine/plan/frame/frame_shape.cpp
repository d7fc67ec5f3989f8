// SPDX-License-Identifier: MIT
#include "plan/frame/frame_shape.hpp"

#include <algorithm>

namespace darkroom::plan {

namespace {

bool is_whole(const gpu::Region& region) {
    return region.offset.x == 0 && region.offset.y == 0 && region.extent.width == region.image.width &&
           region.extent.height == region.image.height;
}

}  // namespace

Shape shape_of(const ProgramPass& pass, std::span<const Entry* const> entries, const FrameValues& values,
               const gpu::Region& output, std::span<const gpu::Binding> inputs) {
    Shape shape;
    if (is_whole(output) && std::ranges::all_of(inputs, [](const gpu::Binding& b) { return is_whole(b.region); }))
        shape.flags |= Shape::is_whole;
    if (pass.asks_rays_meet && values.rays_meet()) shape.flags |= Shape::rays_meet;
    const bool is_fused = pass.as<FusedPass>() != nullptr;
    const std::span<const FusedStep> steps = pass.steps();
    if (is_fused) {
        if (pass.finishes_by_frame()) shape.flags |= std::uint64_t{values.finish().word()} << Shape::finish_bit;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            const std::uint32_t entry = steps[i].entry;
            if (!values.is_on(entry)) continue;
            shape.set_step(i, entries[entry]->is_plain(values.opacity(entry), steps[i].has_mask));
        }
    }
    for (const Literal& literal : pass.literals) {
        const std::uint32_t entry = steps[literal.step].entry;
        // An entry that is off is not in the kernel; a pass of an effect that is off does not run, or for another one.
        if (is_fused && !values.is_on(entry)) continue;
        const std::uint32_t value =
            literal.row == nullptr ? values.work(entry).word : values.words(entry)[literal.row->word];
        shape.choices |= (value & literal.mask()) << literal.bit;
    }
    return shape;
}

Shape expected_shape(const Program& program, const graph::Compiled& compiled, const graph::Schedule& schedule,
                     const FrameValues& values, std::span<const Entry* const> entries, const ProgramPass& pass,
                     const graph::Extents& largest) {
    const auto region = [&](std::uint32_t slot, std::uint32_t mip_level) {
        // A pass that is off has no slot: any region does.
        if (slot >= compiled.slots().size()) return gpu::Region{{}, largest.scene, largest.scene};
        const graph::ImageDesc& desc = compiled.slots()[slot].desc;
        const VkExtent2D extent = graph::mip_extent(desc.size.of(largest), std::min(mip_level, desc.mip_levels - 1));
        return gpu::Region{{}, extent, extent};
    };
    std::array<gpu::Binding, gpu::max_images> inputs;
    for (std::size_t i = 0; i < pass.inputs.size(); ++i) {
        const PassInput& input = pass.inputs[i];
        if (input.table == no_table) {
            inputs[i].region = region(schedule.slot_of(input.version, input.instead), input.mip_level);
        } else {
            const VkExtent3D& extent = program.fixed_images[input.table].desc.extent;
            inputs[i].region.extent = inputs[i].region.image = {extent.width, extent.height};
        }
    }
    return shape_of(pass, entries, values, region(schedule.slot_of(pass.output), pass.output_mip_level),
                    {inputs.data(), pass.inputs.size()});
}

}  // namespace darkroom::plan
