// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "gpu/resource/formats.hpp"
#include "graph/schedule.hpp"
#include "plan/frame/frame_values.hpp"
#include "plan/frame_inputs.hpp"

namespace darkroom::plan {

namespace {

std::uint64_t bytes_of(const graph::Slot& slot, const graph::Extents& frame, std::uint32_t mip_level) {
    const VkExtent2D extent =
        graph::mip_extent(slot.desc.size.of(frame), mip_level < slot.desc.mip_levels ? mip_level : 0);
    return std::uint64_t{extent.width} * extent.height * gpu::format_traits(slot.desc.format).bits / 8;
}

const char* name_of(Domain domain) {
    switch (domain) {
        case Domain::SceneLinear:
            return "scene_linear";
        case Domain::DisplayLinear:
            return "display_linear";
        case Domain::Encoded:
            return "encoded";
    }
    return "";
}

std::string accepted_domains(Domains accepts) {
    std::string out;
    for (const Domain domain : {Domain::SceneLinear, Domain::DisplayLinear, Domain::Encoded})
        if (accepts.contains(domain)) out += fmt::format("{}{}", out.empty() ? "" : " or ", name_of(domain));
    return out;
}

/// About colour domains, with the present values.
void remark_domains(const Program& program, const FrameValues& values, const CompileDesc& desc,
                    std::span<const Entry* const> entries, Plan& plan) {
    for (std::uint32_t i = 0; i < entries.size(); ++i) {
        const Domain domain = values.state_before(program, i).domain;
        const EffectInfo& info = *entries[i]->info;
        const Domains accepts = info.accepts_now == nullptr ? info.accepts : info.accepts_now(values.words(i));
        if (program.is_left_out[i] || !entries[i]->desc.enabled || accepts.contains(domain)) continue;
        // The interface's own chain stands where it stands.
        std::vector<std::string>& list = info.flat.is_of_ui() ? plan.remarks : plan.misplaced;
        list.push_back(fmt::format("{} expects a picture that is {}; this one is {}.", entries[i]->desc.name,
                                   accepted_domains(accepts), name_of(domain)));
    }
    if (!desc.target_color && values.finish().kind == Finish::EncodeSrgb)
        plan.remarks.push_back(fmt::format(
            "the picture is {} at the end of the stack: the target gets it sRGB-encoded; add encode to choose.",
            name_of(values.last_state(program).domain)));
}

/// About a target that says what it takes, and a picture that does not fit it.
void remark_target(const Program& program, const FrameValues& values, const ColorState& target,
                   std::span<const Entry* const> entries, std::vector<std::string>& remarks) {
    if (target.domain != Domain::Encoded) return;
    const ColorState last = values.last_state(program);
    const auto by = [&](auto member) -> std::string_view {
        std::size_t steps = 0;
        for (std::uint32_t i = program.last_entry; i < entries.size() && steps < entries.size();
             i = program.entry_states[i], ++steps)
            if (values.state_after(i).*member != values.state_before(program, i).*member) return entries[i]->desc.name;
        return "the scene";
    };
    if (last.peak_nits > 0 && last.peak_nits < 0.99f * target.peak_nits)
        remarks.push_back(fmt::format("{} ends the picture at {:g} cd/m2; the target shows up to {:g} cd/m2.",
                                      by(&ColorState::peak_nits), last.peak_nits, target.peak_nits));
    if (last.peak_nits > 1.01f * target.peak_nits)
        remarks.push_back(fmt::format("{} ends the picture at {:g} cd/m2; the target clips it at {:g} cd/m2.",
                                      by(&ColorState::peak_nits), last.peak_nits, target.peak_nits));
    if (last.peak_nits == 0)
        remarks.push_back(fmt::format(
            "the picture is the scene's light, without an end; the target clips it at {:g} cd/m2.", target.peak_nits));
    if (last.domain == Domain::Encoded && (last.transfer != target.transfer || last.primaries != target.primaries))
        remarks.push_back(fmt::format("{} makes {}; the target takes {}: the last kernel turns one into the other.",
                                      by(&ColorState::domain), text_of(last), text_of(target)));
}

}  // namespace

namespace {

std::vector<std::string> frame_images(const Program& program) {
    using Kind = HostImage::Kind;
    std::vector<std::string> out;
    for (const std::optional<HostImage>& image : program.imports) {
        if (!image || image->kind == Kind::Target || image->kind == Kind::Watched) continue;
        const std::string_view name = image->kind == Kind::Color    ? "color"
                                      : image->kind == Kind::Shadow ? frame_input(FrameImage::Shadows).name
                                                                    : frame_inputs[image->number].name;
        if (std::ranges::find(out, name) == out.end()) out.emplace_back(name);
    }
    return out;
}

/// Which of Plan::images each slot is; PlanImage::never: a constant one.
std::vector<std::uint32_t> add_images(const Program& program, const graph::Compiled& compiled,
                                      const graph::Extents& frame, std::vector<PlanImage>& images) {
    using Kind = graph::Slot::Kind;
    std::vector<std::uint32_t> out;
    for (const graph::Slot& slot : compiled.slots()) {
        const bool is_watch =
            slot.kind == Kind::Import && program.imports[slot.import_index]->kind == HostImage::Kind::Watched;
        if (slot.kind == Kind::Constant || is_watch || slot.desc.is_buffer()) {
            out.push_back(PlanImage::never);
            continue;
        }
        // Of a history, the slot of odd frames follows that of even ones.
        if (slot.history_parity == 0) {
            PlanImage image{.name = slot.desc.name,
                            .kind = slot.kind == Kind::Import      ? PlanImage::Kind::Host
                                    : slot.kind == Kind::Transient ? PlanImage::Kind::Transient
                                                                   : PlanImage::Kind::History,
                            .format = slot.desc.format,
                            .extent = slot.desc.size.of(frame),
                            .mip_levels = slot.desc.mip_levels,
                            .bytes = slot.size,
                            .offset = slot.offset};
            // How large a light's cascades are, each frame says.
            if (slot.kind == Kind::Import && program.imports[slot.import_index]->kind == HostImage::Kind::Shadow)
                image.extent = {};
            if (slot.kind != Kind::Transient && image.extent.width != 0)
                for (std::uint32_t level = 0; level < slot.desc.mip_levels; ++level)
                    image.bytes += bytes_of(slot, frame, level);
            if (slot.kind == Kind::Import) {
                image.stages = slot.uses.stages;
                image.access = slot.uses.access;
                image.layout = slot.uses.first_layout;
                image.final_layout = slot.uses.last_layout;
            }
            images.push_back(std::move(image));
        }
        out.push_back(static_cast<std::uint32_t>(images.size() - 1));
    }
    return out;
}

/// Numbers without those rounds none of whose passes runs.
void close_up_rounds(Plan& plan) {
    std::vector<std::uint32_t> rounds;
    for (const PlanPass& pass : plan.passes) rounds.push_back(pass.round);
    std::ranges::sort(rounds);
    // Not std::ranges::unique, whose subrange clang 14 cannot read in the standard library of gcc 12.
    rounds.erase(std::unique(rounds.begin(), rounds.end()), rounds.end());
    for (PlanPass& pass : plan.passes)
        pass.round = static_cast<std::uint32_t>(std::ranges::lower_bound(rounds, pass.round) - rounds.begin());
}

/// Lifetimes, from what passes read and write.
void add_lifetimes(Plan& plan) {
    const auto note = [&](const PlanUse& use, std::uint32_t pass) {
        PlanImage& image = plan.images[use.image];
        if (image.first_pass == PlanImage::never) image.first_pass = pass;
        image.last_pass = pass;
    };
    for (std::uint32_t i = 0; i < plan.passes.size(); ++i) {
        for (const PlanUse& read : plan.passes[i].reads) note(read, i);
        if (plan.passes[i].writes.image != PlanImage::never) note(plan.passes[i].writes, i);
        for (const PlanUse& write : plan.passes[i].more_writes) note(write, i);
    }
}

}  // namespace

std::map<std::uint32_t, std::uint32_t> passes_in_order(const Program& program, const graph::Compiled& compiled) {
    std::map<std::uint32_t, std::uint32_t> out;
    for (std::uint32_t i = 0; i < program.passes.size(); ++i)
        if (const std::uint32_t kept = compiled.kept_pass_of({i}); kept != ~0u) out.emplace(kept, i);
    return out;
}

Plan describe_program(const Program& program, const graph::Compiled& compiled, const CompileDesc& desc,
                      std::span<const Entry* const> entries) {
    return describe_frame(program, compiled, desc, entries, example_values(program, desc, entries));
}

Plan describe_frame(const Program& program, const graph::Compiled& compiled, const CompileDesc& desc,
                    std::span<const Entry* const> entries, const FrameValues& values) {
    Plan plan{.extent = desc.max_extent,
              .passes = {},
              .images = {},
              .left_out = program.left_out,
              .remarks = program.remarks,
              .states = {},
              .frame_images = frame_images(program),
              .transient_bytes = compiled.transient_bytes(),
              .transient_bytes_unaliased = compiled.transient_bytes_unaliased()};
    for (std::uint32_t i = 0; i < entries.size(); ++i)
        if (!program.is_left_out[i] && values.lacks_perspective(*entries[i]->info))
            plan.left_out.push_back(fmt::format("{}: {}", entries[i]->desc.name, lacks_perspective_reason));
    const graph::Extents largest = largest_extents(desc);
    remark_domains(program, values, desc, entries, plan);
    if (desc.target_color) remark_target(program, values, *desc.target_color, entries, plan.remarks);
    for (std::uint32_t i = 0; i < entries.size(); ++i)
        if (!program.is_left_out[i]) plan.states.push_back({entries[i]->desc.name, text_of(values.state_after(i))});
    graph::Schedule schedule(compiled);
    schedule.derive(values.gates(), std::vector<graph::ImportState>(program.imports.size()), 0);

    const std::vector<std::uint32_t> image_of = add_images(program, compiled, largest, plan.images);
    const auto use_of = [&](std::uint32_t slot, std::uint32_t mip_level) {
        return PlanUse{.image = image_of[slot],
                       .mip_level = std::min(mip_level, compiled.slots()[slot].desc.mip_levels - 1),
                       .is_previous = compiled.slots()[slot].history_parity == 1};
    };
    for (const auto& [kept, i] : passes_in_order(program, compiled)) {
        if (!schedule.runs(kept)) continue;
        const ProgramPass& pass = program.passes[i];
        PlanPass out{.name = pass.name,
                     .stage = pass.stage == gpu::Stage::Compute ? "compute" : "raster",
                     .entries = {},
                     .boundary = pass.boundary,
                     .round = compiled.rounds()[kept],
                     .reads = {},
                     .writes = {.image = PlanImage::never}};
        const auto extent_of = [&](std::uint32_t slot, std::uint32_t mip_level) {
            return graph::mip_extent(compiled.slots()[slot].desc.size.of(largest), mip_level);
        };
        pass.for_each_output([&](graph::Version version, std::uint32_t mip_level) {
            const std::uint32_t slot = schedule.slot_of(version);
            out.bytes_written += bytes_of(compiled.slots()[slot], largest, mip_level);
            const bool is_first = out.writes.image == PlanImage::never;
            if (is_first) out.extent = extent_of(slot, mip_level);
            if (is_first)
                out.writes = use_of(slot, mip_level);
            else
                out.more_writes.push_back(use_of(slot, mip_level));
        });
        if (!pass.output.is_valid() && !pass.inputs.empty())
            out.extent =
                extent_of(schedule.slot_of(pass.inputs[0].version, pass.inputs[0].instead), pass.inputs[0].mip_level);
        out.invocations = std::uint64_t{out.extent.width} * out.extent.height;
        if (const auto* const compute = pass.as<ComputePass>()) {
            const auto [width, height] = compute->groups_of(out.extent);
            out.invocations = std::uint64_t{width} * height * pass.spec.workgroup[0] * pass.spec.workgroup[1];
        }
        for (const PassInput& input : pass.inputs) {
            if (input.table != no_table) continue;
            const std::uint32_t slot = schedule.slot_of(input.version, input.instead);
            out.bytes_read += bytes_of(compiled.slots()[slot], largest, input.mip_level);
            if (image_of[slot] != PlanImage::never) out.reads.push_back(use_of(slot, input.mip_level));
        }
        if (pass.spec.is_additive) out.bytes_read += out.bytes_written;
        if (pass.as<FusedPass>() != nullptr)
            for (const FusedStep& step : pass.steps()) out.entries.push_back(step.name);
        plan.passes.push_back(std::move(out));
    }
    close_up_rounds(plan);
    add_lifetimes(plan);
    return plan;
}

}  // namespace darkroom::plan
