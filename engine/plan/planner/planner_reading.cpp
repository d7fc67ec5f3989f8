// SPDX-License-Identifier: MIT
// Readings, and where the interface meets the picture.

#include <fmt/format.h>

#include <algorithm>

#include "plan/planner/planner_state.hpp"

namespace darkroom::plan {

Result<std::size_t> Planner::append_reading(std::uint32_t entry, std::size_t input, FusedStep step) {
    const std::string why = fmt::format("{} reads the picture at moved coordinates", stack_[entry].desc.name);
    if (!stack_[entry].is_plain()) {
        step.reads = picture_name;
        step.is_layer = true;
        return append(entry, input, std::move(step), {});
    }
    program_.is_mixable[entry] = false;
    const bool goes_on =
        values_[input].reading != no_reading && readings_[values_[input].reading].steps.size() < max_fused_entries;
    const bool is_image = values_[input].image.is_valid();
    Reading reading = goes_on ? readings_[values_[input].reading] : Reading{.size = values_[input].size};
    if (!goes_on) {
        DARKROOM_TRY_VALUE(reading.image, materialise(input, why));
    }
    reading.steps.push_back(std::move(step));
    kernels_.push_back(
        {.picture = reading.image, .size = reading.size, .boundary = is_image ? values_[input].why : why});
    const std::size_t kernel = kernels_.size() - 1;
    DARKROOM_TRY(add_steps(kernel, reading, picture_name));
    const graph::Size size = reading.size;
    readings_.push_back(std::move(reading));
    values_.push_back(
        {.kernel = kernel, .size = size, .reader = image_reader_[entry], .reading = readings_.size() - 1});
    return values_.size() - 1;
}

Result<> Planner::add_steps(std::size_t kernel, const Reading& reading, std::string_view image) {
    for (FusedStep step : reading.steps) {
        step.reads = image;
        DARKROOM_TRY(add_step(kernel, std::move(step)));
    }
    return {};
}

Result<> Planner::add_step(std::size_t kernel, FusedStep step) {
    std::vector<FusedStep>& steps = kernels_[kernel].steps;
    step.place = static_cast<std::uint32_t>(steps.size());
    step.first_vector = 0;
    for (const FusedStep& other : steps) step.first_vector += other.custom_vectors;
    if (!step.is_merge) {
        DARKROOM_TRY_VALUE(step.text,
                           text_of(*step.info, fmt::format("{}.glsl", step.info->name), step.place, step.images));
    }
    steps.push_back(std::move(step));
    return {};
}

Result<std::size_t> Planner::at_target_size(std::uint32_t entry, std::size_t input) {
    const EffectInfo& info = *stack_[entry].info;
    const graph::Size target = frame_output();
    if (target.extent == graph::Extent::Scene || program_.is_left_out[entry] || !info.joins_ui()) return input;
    const auto stays_in_kernel = [&](std::uint32_t i) {
        const Entry& other = stack_[i];
        return other.info->touch == Touch::Pointwise && !other.info->has_second() && !other.desc.mask.is_given() &&
               (other.info->build == nullptr || other.info->is_last_step) && !other.desc.input.is_given();
    };
    if (!desc_.fuse || values_[input].size == target) return input;
    for (std::uint32_t i = entry; i < stack_.size(); ++i) {
        if (stack_[i].desc.is_ui) continue;
        if (!image_reader_[i].empty() || (i != entry && !program_.is_left_out[i] && !stays_in_kernel(i))) return input;
    }
    const std::string why = "the interface is composed at the target's size";
    DARKROOM_TRY(materialise(input, why));
    kernels_.push_back({.picture = values_[input].image, .size = target, .boundary = why});
    values_.push_back({.kernel = kernels_.size() - 1, .size = target});
    return values_.size() - 1;
}

bool Planner::is_of_ui(std::uint32_t entry) const {
    std::uint32_t i = entry;
    std::size_t steps = 0;  // frames before may close a loop
    do i = program_.entry_states[i];
    while (i < stack_.size() && stack_[i].info->makes == nullptr && ++steps < stack_.size());
    return i == ui_entry;
}

bool Planner::may_be_encoded(std::uint32_t entry) const {
    std::uint32_t i = program_.entry_states[entry];
    for (std::size_t steps = 0; i < stack_.size() && steps < stack_.size(); i = program_.entry_states[i], ++steps) {
        const EffectInfo& info = *stack_[i].info;
        if (info.makes == nullptr || program_.is_left_out[i]) continue;
        for (const Domain before : {Domain::SceneLinear, Domain::DisplayLinear})
            if (info.makes({.domain = before}, info.parameters.defaults.data()).domain == Domain::Encoded) return true;
    }
    return i == ui_entry;
}

}  // namespace darkroom::plan
