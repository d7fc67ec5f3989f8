// SPDX-License-Identifier: MIT
// From a pass that the planner or an effect made to one of the graph: how it reads each image, which stage runs it, and
// what it writes.

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gpu/resource/formats.hpp"
#include "plan/planner/planner_state.hpp"

namespace darkroom::plan {

void Planner::limit_storage_images(ProgramPass& pass) const {
    std::vector<gpu::KernelImage>& images = pass.spec.images;
    const auto is_storage = [](const gpu::KernelImage& image) { return image.storage_format != VK_FORMAT_UNDEFINED; };
    const auto is_beyond = [&] {
        const auto count = static_cast<std::size_t>(std::ranges::count_if(images, is_storage));
        return count + pass.spec.outputs.size() > traits_.max_storage_images;
    };
    if (!is_beyond()) return;
    for (std::size_t i = 0; i < images.size(); ++i)
        if (pass.inputs[i].table == no_table) images[i].storage_format = VK_FORMAT_UNDEFINED;
    // Then tables, the last first.
    for (std::size_t i = images.size(); i-- > 0 && is_beyond();) images[i].storage_format = VK_FORMAT_UNDEFINED;
}

bool Planner::can_filter(const PassInput& input) const {
    if (!traits_.can_filter) return true;
    if (input.table != no_table) return traits_.can_filter(program_.fixed_images[input.table].desc.format);
    const auto known = facts_.find(input.version.index);
    if (known == facts_.end()) return true;
    const Facts& facts = known->second;
    // Depth is never filtered.
    return gpu::is_depth(facts.format) ||
           (traits_.can_filter(facts.format) && std::ranges::all_of(facts.fall_backs, [&](graph::Version instead) {
                return can_filter({.version = instead});
            }));
}

Result<> Planner::settle_inputs(ProgramPass& pass) {
    limit_storage_images(pass);
    if (pass.spec.images.size() > gpu::max_images || pass.spec.custom_vectors > max_custom_vectors)
        return user_error(fmt::format("pass '{}': {} images and {} custom vectors; at most {} and {} are allowed",
                                      pass.name, pass.spec.images.size(), pass.spec.custom_vectors, gpu::max_images,
                                      max_custom_vectors));
    for (std::size_t i = 0; i < pass.inputs.size(); ++i) {
        gpu::KernelImage& image = pass.spec.images[i];
        image.is_filtered_by_loads = image.storage_format == VK_FORMAT_UNDEFINED && image.sampler_type == "sampler2D" &&
                                     !can_filter(pass.inputs[i]);
    }
    pass.spec.has_robust_images = traits_.has_robust_images;
    pass.spec.sub_texel_bits = traits_.sub_texel_bits;
    lay_out_literals(pass);
    for (const FusedStep& step : pass.steps()) pass.asks_rays_meet |= step.text && step.text->asks_rays_meet;
    return {};
}

void Planner::add_reads(const ProgramPass& pass, graph::PassDesc& desc) const {
    using graph::Use;
    const bool is_raster = pass.stage == gpu::Stage::Raster;
    for (std::size_t i = 0; i < pass.inputs.size(); ++i) {
        if (pass.inputs[i].table != no_table) continue;
        const bool is_storage = pass.spec.images[i].storage_format != VK_FORMAT_UNDEFINED;
        const Use use = is_storage ? (is_raster ? Use::StorageReadFragment : Use::StorageRead)
                                   : (is_raster ? Use::SampledFragment : Use::SampledCompute);
        desc.reads.push_back({pass.inputs[i].version, use, {pass.inputs[i].mip_level, 1}, pass.inputs[i].instead});
    }
    for (const PassBufferUse& buffer : pass.buffers)
        if (buffer.access == ComputePassDesc::Access::Read)
            desc.reads.push_back({buffer.version, is_raster ? Use::BufferReadFragment : Use::BufferRead});
}

void Planner::take_facts(graph::Version made, graph::Version from) {
    facts_[made.index] = facts_[from.index];
    facts_[made.index].fall_backs.clear();
}

Result<graph::Version> Planner::add_pass(ProgramPass pass, graph::Version target, std::uint32_t mip_level,
                                         std::span<const graph::Version> more_targets) {
    pass.spec.workgroup = traits_.workgroup;
    DARKROOM_TRY(settle_inputs(pass));
    DARKROOM_TRY_VALUE(pass.stage, traits_.stage_of(pass.spec));
    // What the host's target was made for decides over what would be faster.
    const VkImageUsageFlags usage = facts_.at(target.index).usage;
    if ((usage & VK_IMAGE_USAGE_STORAGE_BIT) == 0) pass.stage = gpu::Stage::Raster;
    if ((usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) == 0) pass.stage = gpu::Stage::Compute;
    const bool is_raster = pass.stage == gpu::Stage::Raster;
    graph::PassDesc desc{.name = pass.name, .has_side_effect = pass.watch().has_value(), .gate = pass.toggle};
    add_reads(pass, desc);
    const graph::Use use = pass.spec.is_additive ? (is_raster ? graph::Use::ColorBlend : graph::Use::StorageReadWrite)
                                                 : (is_raster ? graph::Use::ColorWrite : graph::Use::StorageWrite);
    desc.writes.push_back({target, use, {mip_level, 1}});
    for (const graph::Version more : more_targets) desc.writes.push_back({more, use, {mip_level, 1}});
    pass.output_mip_level = mip_level;
    pass.more_outputs = program_.graph.add(std::move(desc));
    pass.output = pass.more_outputs.front();
    pass.more_outputs.erase(pass.more_outputs.begin());
    take_facts(pass.output, target);
    for (std::size_t i = 0; i < more_targets.size(); ++i) take_facts(pass.more_outputs[i], more_targets[i]);
    program_.passes.push_back(std::move(pass));
    return program_.passes.back().output;
}

Result<> Planner::add_compute(ProgramPass pass) {
    DARKROOM_TRY(settle_inputs(pass));
    pass.stage = gpu::Stage::Compute;
    graph::PassDesc desc{.name = pass.name, .gate = pass.toggle};
    add_reads(pass, desc);
    auto& compute = std::get<ComputePass>(pass.kind);
    std::vector<std::size_t> write_of;  // of each output: levels of one image are one write
    for (const ComputePass::Output& output : compute.outputs) {
        if (!desc.writes.empty() && desc.writes.back().version == output.version)
            ++desc.writes.back().mips.count;
        else
            desc.writes.push_back({output.version,
                                   pass.spec.is_additive ? graph::Use::StorageReadWrite : graph::Use::StorageWrite,
                                   {output.mip_level, 1}});
        write_of.push_back(desc.writes.size() - 1);
    }
    for (const PassBufferUse& buffer : pass.buffers) {
        if (buffer.access == ComputePassDesc::Access::Read) continue;
        // A value that its pass does not write stays as it was.
        const bool keeps = buffer.access == ComputePassDesc::Access::ReadWrite || buffers_[buffer.number].numbers > 0;
        desc.writes.push_back({buffer.version, keeps ? graph::Use::BufferReadWrite : graph::Use::BufferWrite});
    }
    const std::vector<graph::Version> made = program_.graph.add(std::move(desc));
    for (std::size_t i = 0; i < compute.outputs.size(); ++i) {
        take_facts(made[write_of[i]], compute.outputs[i].version);
        compute.outputs[i].version = made[write_of[i]];
    }
    std::size_t write = write_of.empty() ? 0 : write_of.back() + 1;
    for (PassBufferUse& buffer : pass.buffers)
        if (buffer.access != ComputePassDesc::Access::Read)
            buffers_[buffer.number].version = buffer.version = made[write++];
    if (!compute.outputs.empty()) {
        pass.output = compute.outputs.front().version;
        pass.output_mip_level = compute.outputs.front().mip_level;
    }
    program_.passes.push_back(std::move(pass));
    return {};
}

}  // namespace darkroom::plan
