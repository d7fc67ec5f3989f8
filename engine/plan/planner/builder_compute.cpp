// SPDX-License-Identifier: MIT
// Compute passes of effects, their buffers, and values: buffers with a name that outlast the frame.

#include <fmt/format.h>

#include <algorithm>

#include "plan/planner/builder.hpp"

namespace darkroom::plan {

namespace {

/// Histories of an entry that are images count from 0, values from here.
constexpr std::uint32_t first_value_number = 1u << 16u;

}  // namespace

bool Builder::tiles_pay(VkFormat format, const ComputeLimits& asked) {
    const PlannerTraits& traits = planner_.traits_;
    std::string why;
    if (!traits.packing_pays)
        why = "shared memory does not pay on a software driver";
    else if (!is_stored(format))
        why = "compute kernels do not write its images here";
    else if (asked.shared_bytes > traits.compute.shared_bytes)
        why = fmt::format("it needs {} bytes of shared memory, and there are {}", asked.shared_bytes,
                          traits.compute.shared_bytes);
    else if (asked.workgroup_invocations > traits.compute.workgroup_invocations)
        why = fmt::format("it needs workgroups of {} invocations, and {} are allowed", asked.workgroup_invocations,
                          traits.compute.workgroup_invocations);
    else
        return true;
    planner_.program_.remarks.push_back(
        fmt::format("{} has a pass for each step: {}.", planner_.stack_[entry_].desc.name, why));
    return false;
}

PassBuffer Builder::create_buffer(std::string_view name, std::uint32_t bytes) {
    const std::string shown = planner_.own_name(fmt::format("{}.{}", planner_.stack_[entry_].desc.name, name));
    planner_.buffers_.push_back({.version = planner_.program_.graph.create_buffer(shown, std::max(bytes, 4u))});
    return {static_cast<std::uint32_t>(planner_.buffers_.size() - 1)};
}

PassBuffer Builder::value(std::string_view name, std::uint32_t numbers) {
    const auto number = static_cast<std::uint32_t>(planner_.buffers_.size());
    numbers = std::max(numbers, 1u);
    const graph::HistoryKey key{planner_.stack_[entry_].history_owner, first_value_number + value_count_++};
    planner_.buffers_.push_back({.version = planner_.program_.graph.lasting_buffer(
                                     planner_.own_name(fmt::format("value {}", name)), 4 * numbers, key),
                                 .numbers = numbers});
    // No switch resets it: cuts alone do.
    planner_.program_.history_entries.push_back(no_entry);
    planner_.named_values_.insert_or_assign(std::string(name), number);
    return {number};
}

PassBuffer Builder::find_value(std::string_view name) const {
    const auto found = planner_.named_values_.find(name);
    return found == planner_.named_values_.end() ? PassBuffer{} : PassBuffer{found->second};
}

bool Builder::check_value(std::string_view reader, const std::string& name, PassBuffer value) {
    if (value.index < planner_.buffers_.size() && planner_.buffers_[value.index].numbers > 0) return true;
    error = fmt::format("effect '{}': {} reads '{}', which is not a value", planner_.stack_[entry_].info->name, reader,
                        name);
    return false;
}

void Builder::value_side(std::string name, PassBuffer value) {
    if (check_value("its end", name, value))
        planner_.entry_values_read_[entry_].emplace_back(std::move(name), value.index);
}

bool Builder::add_values(ProgramPass& pass, FusedStep& step, const KernelPassDesc& desc) {
    if (desc.values.size() > gpu::max_buffers)
        error = fmt::format("effect '{}': pass '{}' reads {} values; at most {} are allowed",
                            planner_.stack_[entry_].info->name, desc.name, desc.values.size(), gpu::max_buffers);
    for (const auto& [name, value] : desc.values) {
        if (!error.empty() || !check_value(fmt::format("pass '{}'", desc.name), name, value)) return false;
        step.images.push_back(name);
        pass.spec.buffers.push_back({.name = name + place_suffix(0), .type = "float"});
        pass.buffers.push_back({.version = planner_.buffers_[value.index].version, .number = value.index});
    }
    return error.empty();
}

bool Builder::check_compute(const ComputePassDesc& desc) {
    if (!error.empty()) return false;
    const auto refuse = [&](const std::string& why) {
        error = fmt::format("effect '{}': pass '{}': {}", planner_.stack_[entry_].info->name, desc.name, why);
        return false;
    };
    const ComputeLimits& limits = planner_.traits_.compute;
    const std::uint32_t invocations = desc.workgroup[0] * desc.workgroup[1];
    if (invocations == 0 || invocations > limits.workgroup_invocations)
        return refuse(fmt::format("a workgroup of {} x {}; 1 to {} invocations are allowed here", desc.workgroup[0],
                                  desc.workgroup[1], limits.workgroup_invocations));
    if (desc.shared_bytes > limits.shared_bytes)
        return refuse(fmt::format("{} bytes of shared memory; at most {} are allowed here", desc.shared_bytes,
                                  limits.shared_bytes));
    if (desc.outputs.size() > gpu::max_outputs || desc.buffers.size() > gpu::max_buffers)
        return refuse(fmt::format("{} outputs and {} buffers; at most {} and {} are allowed", desc.outputs.size(),
                                  desc.buffers.size(), gpu::max_outputs, gpu::max_buffers));
    if (desc.groups[0] == 0 && desc.outputs.empty() && desc.inputs.empty())
        return refuse("no image whose extent says how many groups there are");
    const auto is_known = [&](const ComputePassDesc::Output& out) { return out.image.index < images_.size(); };
    const auto is_there = [&](const ComputePassDesc::Buffer& buffer) {
        return buffer.buffer.index < planner_.buffers_.size();
    };
    return std::ranges::all_of(desc.outputs, is_known) && std::ranges::all_of(desc.buffers, is_there);
}

void Planner::keep_values() {
    graph::PassDesc copy{.name = "values", .has_side_effect = true};
    for (const auto& [name, number] : named_values_) {
        const BufferRecord& value = buffers_[number];
        program_.values.push_back({name, value.version, value.numbers});
        copy.reads.push_back({value.version, graph::Use::BufferCopy});
    }
    if (!copy.reads.empty()) program_.graph.add(std::move(copy));
}

std::vector<PassImage> Builder::add_compute(const ComputePassDesc& desc) {
    if (!check_compute(desc)) return {};
    const Entry& entry = planner_.stack_[entry_];
    ProgramPass pass{.name = fmt::format("{}.{}", entry.desc.name, desc.name)};
    FusedStep step{.info = entry.info, .entry = entry_, .name = entry.desc.name};
    for (const KernelPassDesc::Input& input : desc.inputs) add_input(pass, step, input);
    ComputePass compute{.groups = desc.groups, .tile = desc.tile[0] != 0 ? desc.tile : desc.workgroup};
    pass.spec.is_additive = desc.is_additive;
    pass.spec.compute = gpu::ComputeBody{.outputs = {}, .shared_bytes = desc.shared_bytes};
    for (const ComputePassDesc::Output& out : desc.outputs) {
        const Image& image = images_[out.image.index];
        step.images.push_back(out.name);
        pass.spec.compute->outputs.push_back(out.name + place_suffix(0));
        pass.spec.outputs.push_back(image.format);
        compute.outputs.push_back({image.version, out.mip_level});
    }
    for (const ComputePassDesc::Buffer& buffer : desc.buffers) {
        const std::uint32_t number = buffer.buffer.index;
        step.images.push_back(buffer.name);
        pass.spec.buffers.push_back({.name = buffer.name + place_suffix(0),
                                     .type = buffer.type,
                                     .is_written = buffer.access != ComputePassDesc::Access::Read});
        pass.buffers.push_back({planner_.buffers_[number].version, buffer.access, number});
    }
    pass.spec.workgroup = desc.workgroup;
    pass.spec.custom_vectors = desc.custom_vectors;
    const Gate gate{.entries = {entry_}, .condition = desc.condition, .argument = desc.argument};
    if (!finish_pass(pass, step, desc.shader, gate, desc.inputs)) return {};
    compute.own = {.step = std::move(step), .constants = desc.constants};
    pass.kind = std::move(compute);
    if (const auto ok = planner_.add_compute(std::move(pass)); !ok) {
        error = ok.error().text;
        return {};
    }
    std::vector<PassImage> made;
    const auto& added = std::get<ComputePass>(planner_.program_.passes.back().kind);
    for (std::size_t i = 0; i < desc.outputs.size(); ++i)
        made.push_back(remember_written(desc.outputs[i].image, added.outputs[i].version));
    return made;
}

}  // namespace darkroom::plan
