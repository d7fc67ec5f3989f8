// SPDX-License-Identifier: MIT
#include "plan/frame/frame_values.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace darkroom::plan {

namespace {

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

Presence Entry::evaluate(std::span<std::uint32_t> out, const Moment& moment) const {
    std::copy(base.begin(), base.end(), out.begin());
    Presence presence{desc.enabled, desc.opacity};
    for (const Layer& layer : layers) layer.apply(out, presence, moment);
    apply(pulses, out, moment);
    for (const Override& o : overrides) std::copy_n(o.value.begin(), o.words, out.begin() + o.word);
    return presence;
}

std::vector<std::uint32_t> Entry::values_at_compile() const {
    std::vector<std::uint32_t> out(info->parameters.defaults.begin(), info->parameters.defaults.end());
    for (const ParamInfo& row : info->parameters.rows)
        if (row.is_at_compile) std::copy_n(base.begin() + row.word, row.words, out.begin() + row.word);
    return out;
}

FrameValues::FrameValues(const Program& program, std::span<const Entry* const> entries)
    : is_on_(entries.size()),
      opacities_(entries.size()),
      states_(entries.size()),
      works_(entries.size()),
      gates_(std::make_unique<bool[]>(program.gates.size() + 1)),
      gate_count_(program.gates.size()) {
    std::uint32_t words = 0;
    for (const Entry* const entry : entries) {
        first_word_.push_back(words);
        words += static_cast<std::uint32_t>(entry->info->parameters.words());
    }
    words_.resize(words + 1);
}

void FrameValues::evaluate(const Program& program, const CompileDesc& desc, std::span<const Entry* const> entries,
                           const PassContext& context, VkExtent2D target, std::span<const Watched* const> watched) {
    extents_ = extents_of(desc, context.scene_extent, target);
    scene_ = scene_state(desc);
    const Camera camera = context.camera == nullptr ? Camera{} : *context.camera;
    const Moment moment = moment_of(context.time, camera);
    rays_meet_ = plan::rays_meet(camera);
    has_perspective_ = plan::has_perspective(camera);
    for (std::uint32_t i = 0; i < entries.size(); ++i) {
        const Entry& entry = *entries[i];
        std::uint32_t* const words = words_.data() + first_word_[i];
        const Presence presence = entry.evaluate({words, entry.info->parameters.words()}, moment);
        opacities_[i] = presence.opacity;
        const bool is_left_out = program.is_left_out[i] || lacks_perspective(*entry.info);
        is_on_[i] = !is_left_out && entry.is_on(presence, words) ? 1 : 0;
        const ColorState before = state_before(program, i);
        works_[i] = work_of(*entry.info, before, words);
        states_[i] = entry.state_after(before, words, is_on(i));
    }
    finish_ = finish_of(last_state(program), desc);
    for (std::size_t i = 0; i < gate_count_; ++i) gates_[i] = is_open(program, program.gates[i], context, watched);
}

bool FrameValues::is_open(const Program& program, const Gate& gate, const PassContext& context,
                          std::span<const Watched* const> watched) const {
    if (gate.watch)
        return *gate.watch < watched.size() && watched[*gate.watch] != nullptr &&
               (gate.writer < 0 || gates_[static_cast<std::size_t>(gate.writer)]);
    const auto holds = [&](std::uint32_t entry, ConditionFunction condition) {
        if (condition == nullptr) return true;
        PassContext own = context;
        own.frame_extent = program.entry_sizes[entry].of(extents_);
        return condition(words(entry), own, gate.argument);
    };
    bool is_wanted = false;
    for (std::size_t i = 0; i < gate.entries.size() && !is_wanted; ++i)
        is_wanted = is_on(gate.entries[i]) && (gate.conditions.empty() || holds(gate.entries[i], gate.conditions[i]));
    return is_wanted && holds(gate.entries.front(), gate.condition);
}

Camera example_camera() {
    Camera out;
    out.projection[11] = -1;
    out.projection[15] = 0;
    return out;
}

FrameValues example_values(const Program& program, const CompileDesc& desc, std::span<const Entry* const> entries) {
    FrameValues values(program, entries);
    const Camera camera = example_camera();
    const auto lights = example_lights(desc);
    // Twice, for entries that read what a later one made in the frame before.
    for (int frame = 0; frame < 2; ++frame)
        values.evaluate(program, desc, entries,
                        {.scene_extent = desc.max_extent,
                         .frame_extent = desc.max_extent,
                         .output_extent = desc.max_extent,
                         .camera = &camera,
                         .lights = lights},
                        desc.target_extent);
    return values;
}

}  // namespace darkroom::plan
