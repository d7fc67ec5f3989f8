// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "core/assert.hpp"
#include "plan/planner/builder.hpp"

namespace darkroom::plan {

PassImage Builder::remember(Image image) {
    images_.push_back(image);
    return {static_cast<std::uint32_t>(images_.size() - 1)};
}

PassImage Builder::image_of(std::size_t value) {
    const auto version =
        planner_.materialise(value, fmt::format("{} reads around its pixels", planner_.stack_[entry_].desc.name));
    if (!version) {
        error = version.error().text;
        return {};
    }
    return remember({.version = *version});
}

PassImage Builder::picture() { return image_of(input_); }

PassImage Builder::source() {
    const Handle handle = planner_.stack_[entry_].desc.source;
    if (!handle.is_given()) return image_of(input_);
    const PassImage image = image_of(planner_.value_of(handle, entry_));
    if (!error.empty()) return {};
    return at_own_size(planner_.at_size(images_[image.index].version, planner_.values_[input_].size,
                                        fmt::format("{}.source", planner_.stack_[entry_].desc.name)));
}

PassImage Builder::at_own_size(Result<graph::Version> version) {
    if (version) return remember({.version = *version, .format = planner_.facts_.at(version->index).format});
    error = version.error().text;
    return {};
}

graph::ImageDesc Builder::image_desc(const PassImageDesc& desc) const {
    const graph::Size size = desc.is_of_output ? planner_.frame_output() : planner_.values_[input_].size;
    const bool is_absolute = desc.extent.width != 0;
    return {.name = planner_.own_name(fmt::format("{}.{}", planner_.stack_[entry_].desc.name, desc.name)),
            .format = desc.format == VK_FORMAT_UNDEFINED ? planner_.desc_.intermediate : desc.format,
            .size = is_absolute ? graph::Size{.width = desc.extent.width, .height = desc.extent.height}
                                : size.scaled(desc.numerator, desc.denominator),
            .mip_levels = desc.mip_levels};
}

PassImage Builder::remember_new(graph::Version version, const graph::ImageDesc& desc) {
    planner_.facts_[version.index] = {.root = version.index,
                                      .size = desc.size,
                                      .format = desc.format,
                                      .usage = own_usage,
                                      .fall_backs = {},
                                      .name = desc.name};
    return remember({.version = version, .first_written = {}, .format = desc.format});
}

std::uint32_t Builder::from_max_extent(std::uint32_t (*question)(VkExtent2D)) {
    const graph::Size size = planner_.values_[input_].size;
    const std::uint32_t answer = question(size.of(largest_extents(planner_.desc_)));
    planner_.program_.extent_answers.push_back({question, size, answer});
    return answer;
}

PassImage Builder::create(const PassImageDesc& desc) {
    const graph::ImageDesc image = image_desc(desc);
    return remember_new(planner_.program_.graph.create(image), image);
}

bool Builder::is_stored(VkFormat format) const {
    if (!planner_.traits_.packing_pays) return false;
    const auto stage = planner_.traits_.stage_of({.name = "", .outputs = {format}, .is_additive = true});
    return stage && *stage == gpu::Stage::Compute;
}

bool Builder::is_written(VkFormat format) const {
    return planner_.traits_.stage_of({.name = "", .outputs = {format}}).has_value();
}

PassBuilder::History Builder::history(const PassImageDesc& desc) {
    const graph::ImageDesc image = image_desc(desc);
    auto& entries = planner_.program_.history_entries;
    const auto number = static_cast<std::uint32_t>(std::ranges::count(entries, entry_));
    const graph::Graph::History made =
        planner_.program_.graph.history(image, {planner_.stack_[entry_].history_owner, number});
    entries.push_back(entry_);
    return {remember_new(made.current, image), remember_new(made.previous, image)};
}

bool Builder::has_frame_image(FrameImage which) const { return is_given(planner_.desc_, which); }

PassImage Builder::frame_image(FrameImage which) {
    const FrameInput& input = frame_input(which);
    DARKROOM_ASSERT(input.use != nullptr);
    if (has_frame_image(which)) return at_own_size(planner_.input_at_size(input, planner_.values_[input_].size));
    if (input.is_optional)
        return remember({.version = planner_.import_neutral(VK_FORMAT_R32G32B32A32_SFLOAT, input.neutral),
                         .format = VK_FORMAT_R32G32B32A32_SFLOAT});
    error = fmt::format("effect '{}' reads the frame's {} without naming it in its needs",
                        planner_.stack_[entry_].info->name, input.name);
    return {};
}

PassImage Builder::shadow_map(std::uint32_t number) {
    constexpr std::array<const char*, max_shadow_lights> names{"shadow 0", "shadow 1", "shadow 2", "shadow 3"};
    DARKROOM_ASSERT(number < max_shadow_lights);
    if (!has_frame_image(FrameImage::Shadows)) {
        error = fmt::format("effect '{}' reads shadows without naming them in its needs",
                            planner_.stack_[entry_].info->name);
        return {};
    }
    return remember({.version = planner_.import_host({HostImage::Kind::Shadow, number}, names[number],
                                                     {VK_FORMAT_D32_SFLOAT}, {.width = 1, .height = 1}),
                     .format = VK_FORMAT_D32_SFLOAT,
                     .is_shadow_map = true});
}

PassImage Builder::shared(std::string_view name, PassImage (*make)(PassBuilder&), ConditionFunction condition) {
    const std::string key = fmt::format("{} {}", name, size_text(planner_.values_[input_].size));
    auto found = planner_.shared_.find(key);
    if (found == planner_.shared_.end()) {
        // A toggle of its own, which further effects join; what is shared may itself need something shared.
        planner_.program_.gates.push_back({});
        const auto own = static_cast<std::int32_t>(planner_.program_.gates.size() - 1);
        const std::int32_t outer = std::exchange(shared_toggle_, own);
        const std::vector<std::int32_t> outer_needs = std::exchange(shared_needs_, {});
        const PassImage made = make(*this);
        shared_toggle_ = outer;
        const std::vector<std::int32_t> needs = std::exchange(shared_needs_, outer_needs);
        if (made.index >= images_.size()) {
            planner_.program_.gates.resize(static_cast<std::size_t>(own));
            return {};
        }
        const Image& written = images_[made.index];
        found = planner_.shared_
                    .emplace(key, Planner::Shared{.version = written.version,
                                                  .first_written = written.first_written,
                                                  .format = written.format,
                                                  .toggle = own,
                                                  .needs = needs})
                    .first;
    }
    const Planner::Shared& image = found->second;
    const auto join = [&](std::int32_t index) {
        Gate& toggle = planner_.program_.gates[static_cast<std::size_t>(index)];
        toggle.entries.push_back(entry_);
        toggle.conditions.push_back(condition);
        shared_needs_.push_back(index);
    };
    join(image.toggle);
    for (const std::int32_t need : image.needs) join(need);
    return remember({.version = image.version,
                     .first_written = image.first_written,
                     .format = image.format,
                     .shared_toggle = image.toggle});
}

PassImage Builder::table(const TableDesc& desc) {
    planner_.program_.fixed_images.push_back({.desc = desc});
    return remember(
        {.format = desc.format, .table = static_cast<std::uint32_t>(planner_.program_.fixed_images.size() - 1)});
}

PassInput Builder::input_of(const Image& image, std::uint32_t mip_level) const {
    return {
        .version = image.version, .mip_level = mip_level, .table = image.table, .is_shadow_map = image.is_shadow_map};
}

PassImage Builder::remember_written(PassImage image, graph::Version version) {
    Image written = images_[image.index];
    written.version = version;
    if (!written.first_written.is_valid()) written.first_written = version;
    return remember(written);
}

bool Builder::check_outputs(const KernelPassDesc& desc) {
    if (!error.empty() || desc.output.index >= images_.size()) return false;
    const std::string_view effect = planner_.stack_[entry_].info->name;
    if (desc.more_outputs.size() >= gpu::max_outputs)
        error = fmt::format("effect '{}': pass '{}' writes {} images; at most {} are allowed", effect, desc.name,
                            desc.more_outputs.size() + 1, gpu::max_outputs);
    for (const PassImage more : desc.more_outputs) {
        if (!error.empty() || more.index >= images_.size()) return false;
        const Planner::Facts &first = planner_.facts_.at(images_[desc.output.index].version.index),
                             &other = planner_.facts_.at(images_[more.index].version.index);
        if (first.size != other.size)
            error = fmt::format("effect '{}': pass '{}' writes '{}' and '{}', which differ in extent", effect,
                                desc.name, first.name, other.name);
    }
    return error.empty();
}

void Builder::add_input(ProgramPass& pass, FusedStep& step, const KernelPassDesc::Input& input) {
    if (input.image.index >= images_.size()) return;
    step.images.push_back(input.name);
    const PassInput from = input_of(images_[input.image.index], input.mip_level);
    pass.inputs.push_back(from);
    pass.spec.images.push_back(planner_.kernel_image(input.name + place_suffix(0), from));
}

bool Builder::finish_pass(ProgramPass& pass, FusedStep& step, std::string_view shader, const Gate& gate,
                          std::span<const KernelPassDesc::Input> inputs) {
    for (const KernelPassDesc::Input& input : inputs)
        if (input.image.index >= images_.size()) return false;
    auto text = planner_.text_of(*step.info, std::string(shader), 0, step.images);
    if (!text) {
        error = text.error().text;
        return false;
    }
    step.text = std::move(*text);
    if (step.text->asks_parameters) append_parameter_members(*step.info, 0, pass.spec.members);
    pass.boundary = fmt::format("{} has passes of its own", step.name);
    pass.spec.name = pass.name;
    pass.spec.frame = frame_members();
    pass.toggle = shared_toggle_ < 0 ? planner_.toggle_index(gate) : shared_toggle_;
    for (const KernelPassDesc::Input& input : inputs)
        if (const std::int32_t shared = images_[input.image.index].shared_toggle; shared >= 0)
            planner_.program_.graph.imply(pass.toggle, shared);
    return true;
}

std::vector<PassImage> Builder::add_all(const KernelPassDesc& desc) {
    const Entry& entry = planner_.stack_[entry_];
    if (!check_outputs(desc)) return {};
    ProgramPass pass{.name = fmt::format("{}.{}", entry.desc.name, desc.name)};
    FusedStep step{.info = entry.info, .entry = entry_, .name = entry.desc.name};
    for (const KernelPassDesc::Input& input : desc.inputs) add_input(pass, step, input);
    if (!add_values(pass, step, desc)) return {};
    const Gate gate{.entries = {entry_}, .condition = desc.condition, .argument = desc.argument};
    if (!finish_pass(pass, step, desc.shader, gate, desc.inputs)) return {};
    pass.kind = KernelPass{.step = std::move(step), .constants = desc.constants};
    pass.spec.outputs = {images_[desc.output.index].format};
    std::vector<graph::Version> more_targets;
    for (const PassImage more : desc.more_outputs) {
        pass.spec.outputs.push_back(images_[more.index].format);
        more_targets.push_back(images_[more.index].version);
    }
    pass.spec.is_additive = desc.is_additive;
    pass.spec.custom_vectors = desc.custom_vectors;
    const auto version =
        planner_.add_pass(std::move(pass), images_[desc.output.index].version, desc.output_mip_level, more_targets);
    if (!version) {
        error = version.error().text;
        return {};
    }
    std::vector<PassImage> made{remember_written(desc.output, *version)};
    for (std::size_t i = 0; i < more_targets.size(); ++i)
        made.push_back(remember_written(desc.more_outputs[i], planner_.program_.passes.back().more_outputs[i]));
    return made;
}

void Builder::side(std::string name, PassImage image, PassVector neutral) {
    const bool is_known = image.index < images_.size();
    PassInput input = is_known ? input_of(images_[image.index], 0) : PassInput{};
    const bool is_always_there = is_known && !images_[image.index].first_written.is_valid();  // a table, or a picture
    if (!is_always_there) {
        const VkFormat format = is_known ? images_[image.index].format : VK_FORMAT_R32G32B32A32_SFLOAT;
        const graph::Version constant = planner_.import_neutral(format, neutral);
        if (is_known)
            input.instead = constant;
        else
            input.version = constant;
    }
    sides.push_back({std::move(name), input});
}

void Builder::result(PassImage image) {
    DARKROOM_ASSERT(image.index < images_.size() || !error.empty());
    if (image.index < images_.size()) output = images_[image.index].version;
}

}  // namespace darkroom::plan
