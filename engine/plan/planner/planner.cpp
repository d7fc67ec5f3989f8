// SPDX-License-Identifier: MIT
// The planner: walks the stack in the user's order, keeps a kernel open as long as the next entry may join it, and says
// why a new one starts. See architecture.md, Fusion.

#include <fmt/format.h>

#include <algorithm>

#include "gpu/resource/formats.hpp"
#include "plan/frame/color.hpp"
#include "plan/planner/builder.hpp"

namespace darkroom::plan {

namespace {

std::uint32_t vectors_of(std::span<const FusedStep> steps) {
    std::uint32_t vectors = 0;
    for (const FusedStep& step : steps) vectors += step.custom_vectors;
    return vectors;
}

}  // namespace

Planner::Planner(std::span<const Entry> stack, const CompileDesc& desc, const PlannerTraits& traits)
    : stack_(stack), desc_(desc), traits_(traits), target_domain_(target_domain(desc)) {}

Result<Program> Planner::run() {
    DARKROOM_TRY(check_target_color(desc_));
    DARKROOM_TRY(check_handles());
    program_.is_left_out.assign(stack_.size(), false);
    program_.is_mixable.assign(stack_.size(), true);
    program_.watch_gates.assign(desc_.watches.size(), -1);

    const graph::Version color = import_host({HostImage::Kind::Color}, "color", desc_.color, {});
    values_.push_back({.image = color, .why = "the scene colour starts here"});
    entry_values_.assign(stack_.size(), 0);
    leave_out();
    resolve_inputs();
    count_readers();
    DARKROOM_TRY(make_wires());

    for (std::uint32_t i = 0; i < stack_.size(); ++i) {
        DARKROOM_TRY_VALUE(const auto read, scaled_input(i));
        DARKROOM_TRY_VALUE(const std::size_t input, at_target_size(i, read));
        program_.entry_sizes.push_back(values_[input].size);
        if (program_.is_left_out[i]) {
            entry_values_[i] = input;
        } else {
            DARKROOM_TRY_VALUE(auto value, add_entry(i, input));
            entry_values_[i] = value;
        }
        DARKROOM_TRY(keep_output(i));
        DARKROOM_TRY(add_watches(i));
    }
    DARKROOM_TRY(finish());
    DARKROOM_TRY(add_watches(no_entry));
    remark_watches();
    keep_values();
    return std::move(program_);
}

void Planner::leave_out() {
    // Entries whose picture would be an interface that is not there. What reads one of those is left out.
    const bool has_ui = is_given(desc_, FrameImage::Ui);
    std::vector<bool> is_missing(stack_.size(), !has_ui);
    for (std::uint32_t i = 0; i < stack_.size(); ++i) {
        const EffectInfo& info = *stack_[i].info;
        const EntryDesc& desc = stack_[i].desc;
        const auto reads_missing = [&](Handle wire) {
            if (has_ui) return false;
            return wire == ui_layer || (is_of_entry(wire) && index_of(wire) < i && is_missing[index_of(wire)]);
        };
        const std::uint32_t before = entry_before(i, desc.is_ui);
        is_missing[i] = desc.input.is_given() ? reads_missing(desc.input)
                                              : reads_missing(before < i           ? Handle{stack_[before].id}
                                                              : before == ui_entry ? ui_layer
                                                                                   : Handle{});
        Needs needs = info.needs;
        if (is_missing[i] || std::ranges::any_of(std::array{desc.source, second_of(i), desc.mask}, reads_missing))
            needs.add(FrameImage::Ui);
        std::string why;
        const auto is_there = [&](FrameImage image) { return is_given(desc_, image); };
        if (const std::string missing = missing_needs(needs, is_there); !missing.empty())
            why = fmt::format("needs {}, which the frame does not have", missing);
        else if (info.is_last_step && target_domain_ == Domain::SceneLinear)
            why = "the target takes scene-linear floats";
        if (why.empty()) continue;
        program_.left_out.push_back(fmt::format("{}: {}", stack_[i].desc.name, why));
        program_.is_left_out[i] = true;
    }
}

Result<std::size_t> Planner::add_entry(std::uint32_t entry, std::size_t input) {
    const EffectInfo& info = *stack_[entry].info;

    Builder builder(*this, entry, input);
    if (info.build != nullptr) {
        info.build(builder);
        if (!builder.error.empty()) return user_error(builder.error);
    }
    if (info.touch == Touch::Neighbourhood || info.touch == Touch::History) return add_result(entry, input, builder);

    FusedStep step{.info = &info,
                   .entry = entry,
                   .name = stack_[entry].desc.name,
                   .constants = builder.end_function,
                   .custom_vectors = builder.end_vectors};
    step.is_wrapped = may_need_work(info, may_be_encoded(entry), is_of_ui(entry));
    step.divides_alpha = maps_without_alpha(info, step.is_wrapped, desc_.is_color_associated && !is_of_ui(entry));
    if (is_reading(info.touch)) {
        if (!builder.sides.empty() || entry_values_read_.contains(entry))
            return user_error(fmt::format("effect '{}': a map reads no images and no values", info.name));
        return append_reading(entry, input, std::move(step));
    }
    std::vector<PassInput> side_inputs;
    for (Builder::Side& side : builder.sides) {
        step.images.push_back(side.name);
        side_inputs.push_back(side.input);
    }
    if (info.has_second()) {
        const std::size_t value = value_of(second_of(entry), entry);
        step.images.emplace_back("second");
        if (info.second == Second::InPlace && desc_.fuse && values_[value].reading != no_reading) {
            const Reading reading = readings_[values_[value].reading];
            side_inputs.push_back({.version = reading.image});
            return append(entry, input, std::move(step), std::move(side_inputs), &reading);
        }
        DARKROOM_TRY_VALUE(
            auto second, materialise(value, fmt::format("{} reads it as its second picture", stack_[entry].desc.name)));
        side_inputs.push_back({.version = second});
    }
    return append(entry, input, std::move(step), std::move(side_inputs));
}

Result<std::size_t> Planner::add_result(std::uint32_t entry, std::size_t input, Builder& builder) {
    if (!builder.output.is_valid())
        return user_error(fmt::format("effect '{}': its build() names no result", stack_[entry].info->name));
    auto picture = materialise(input, fmt::format("{} reads around its pixels", stack_[entry].desc.name));
    if (!picture) return failure(std::move(picture));
    const std::string why = fmt::format("{} has passes of its own", stack_[entry].desc.name);
    const graph::Size size = result_size(*stack_[entry].info, values_[input].size);
    // Whoever reads the output counts on its size, on or off.
    picture = at_size(*picture, size, fmt::format("{}.resampled input", stack_[entry].desc.name));
    if (!picture) return failure(std::move(picture));
    fall_back(builder.output, *picture);
    if (stack_[entry].is_plain()) {
        program_.is_mixable[entry] = false;
        values_.push_back({.image = builder.output, .size = size, .why = why});
        return values_.size() - 1;
    }
    values_.push_back({.image = *picture, .size = size, .why = why});
    FusedStep step{.info = stack_[entry].info, .entry = entry, .name = stack_[entry].desc.name, .is_merge = true};
    return append(entry, values_.size() - 1, std::move(step), {{.version = builder.output}});
}

Result<std::size_t> Planner::append(std::uint32_t entry, std::size_t input, FusedStep step,
                                    std::vector<PassInput> sides, const Reading* second) {
    const std::string& name = stack_[entry].desc.name;
    const Value from = values_[input];
    std::size_t kernel = from.kernel;
    const std::size_t side_count = sides.size() + (stack_[entry].desc.mask.is_given() ? 1 : 0);
    if (kernel == no_kernel) {
        kernel = open_kernel(input, from.why);
    } else {
        std::string why;
        if (!desc_.fuse)
            why = "fusion is off";
        else if ((step.info->touch == Touch::Warp && !step.is_merge) || step.is_layer)
            why = fmt::format("{} reads the picture at moved coordinates", name);
        else if (!from.reader.empty())
            why = fmt::format("{} reads the picture before it, too", from.reader);
        else if (kernels_[kernel].images.size() + side_count >= gpu::max_images)
            why = fmt::format("a kernel reads at most {} images", gpu::max_images);
        else if (kernels_[kernel].values.size() + entry_values_read_[entry].size() > gpu::max_buffers)
            why = fmt::format("a kernel reads at most {} values", gpu::max_buffers);
        else if (vectors_of(kernels_[kernel].steps) + step.custom_vectors +
                     (second == nullptr ? 0 : vectors_of(second->steps)) >
                 max_fused_vectors)
            why = fmt::format("a kernel holds at most {} vectors of its effects", max_fused_vectors);
        else if (kernels_[kernel].steps.size() + (second == nullptr ? 0 : second->steps.size()) >= max_fused_entries)
            why = fmt::format("a kernel holds at most {} entries", max_fused_entries);
        else if (joined_entries_ >= max_joined_entries)
            why = fmt::format("a plan joins at most {} entries to the kernels of others", max_joined_entries);
        else
            ++joined_entries_;
        if (!why.empty()) {
            DARKROOM_TRY(materialise(input, why));
            kernel = open_kernel(input, std::move(why));
        }
    }
    // The steps of a reading come before the one that reads by it.
    const std::size_t place = kernels_[kernel].steps.size() + (second == nullptr ? 0 : second->steps.size());
    const std::string suffix = place_suffix(static_cast<std::uint32_t>(place));
    if (second != nullptr) DARKROOM_TRY(add_steps(kernel, *second, "second" + suffix));
    if (stack_[entry].desc.mask.is_given()) {
        auto mask = materialise(value_of(stack_[entry].desc.mask, entry), fmt::format("{} reads it as its mask", name));
        if (mask) mask = at_size(*mask, from.size, fmt::format("{}.mask", name));
        if (!mask) return failure(std::move(mask));
        step.has_mask = true;
        kernels_[kernel].images.push_back({"mask" + suffix, {.version = *mask}});
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const bool is_second = !step.is_merge && step.images[i] == "second";
        if (is_second && step.info->second == Second::InPlace) {
            step.is_second_resampled = !has_size(sides[i].version, from.size);
        } else if (step.is_merge || is_second) {
            DARKROOM_TRY_VALUE(auto version, at_size(sides[i].version, from.size, fmt::format("{}.resampled", name)));
            sides[i].version = version;
        }
        const std::string shown = step.is_merge ? "layer" : step.images[i];
        kernels_[kernel].images.push_back({shown + suffix, sides[i]});
    }
    for (const auto& [value, number] : entry_values_read_[entry]) {
        step.images.push_back(value);
        kernels_[kernel].values.emplace_back(value + suffix, number);
    }
    DARKROOM_TRY(add_step(kernel, std::move(step)));
    values_.push_back({.kernel = kernel, .size = from.size, .reader = image_reader_[entry]});
    return values_.size() - 1;
}

std::size_t Planner::open_kernel(std::size_t input, std::string why) {
    kernels_.push_back({.picture = values_[input].image, .size = values_[input].size, .boundary = std::move(why)});
    return kernels_.size() - 1;
}

Result<graph::Version> Planner::materialise(std::size_t index, const std::string& why) {
    if (values_[index].image.is_valid()) return values_[index].image;
    return materialise_into(
        index, create_picture(fmt::format("picture {}", kernels_.size()), values_[index].size, desc_.intermediate),
        kernels_.size() > max_gated_kernels, why);
}

Result<graph::Version> Planner::materialise_into(std::size_t index, graph::Version image, bool is_always_on,
                                                 const std::string& why) {
    DARKROOM_TRY_VALUE(auto version, close_kernel(values_[index].kernel, image, facts_.at(image.index).format,
                                                  Finish::None, is_always_on));
    // Nobody joined the kernel behind this value (its reader was known), so whoever comes next starts a new one.
    values_[index].image = version;
    values_[index].why = why;
    values_[index].kernel = no_kernel;
    return version;
}

bool Planner::has_size(graph::Version version, graph::Size size) const {
    const Facts& facts = facts_.at(version.index);
    return facts.size == size &&
           std::ranges::all_of(facts.fall_backs, [&](graph::Version instead) { return has_size(instead, size); });
}

Result<graph::Version> Planner::at_size(graph::Version version, graph::Size size, const std::string& name) {
    if (has_size(version, size)) return version;
    kernels_.push_back({.picture = version, .size = size, .boundary = "its pictures differ in size"});
    return close_kernel(kernels_.size() - 1, create_picture(name, size, desc_.intermediate), desc_.intermediate,
                        Finish::None, true);
}

Result<> Planner::finish() {
    const std::uint32_t last_entry = last_of_picture();
    const std::size_t last = last_entry == no_entry ? 0 : entry_values_[last_entry];
    // Values change after compile, and with them the domain.
    Finish finish = finish_of(scene_state(desc_), desc_).kind;
    const Finish by_frame = desc_.target_color ? Finish::OfFrameOrConvert : Finish::OfFrame;
    if (finish == Finish::Convert) finish = by_frame;
    const bool is_open = desc_.target_color || finish_of(srgb_color, desc_).kind != finish;
    std::size_t steps = 0;
    for (std::uint32_t i = program_.last_entry; is_open && i < stack_.size() && steps < stack_.size();
         i = program_.entry_states[i], ++steps)
        if (stack_[i].info->makes != nullptr) finish = by_frame;
    const VkExtent2D own = desc_.target_extent;
    std::size_t kernel = values_[last].kernel;
    const graph::Size target_size = frame_output();
    // Where the interface is composed, the picture has been sampled already.
    const bool is_scaled = own.width != 0 && !(kernel != no_kernel && values_[last].reader.empty() &&
                                               kernels_[kernel].size == target_size);
    if (is_scaled || kernel == no_kernel || !values_[last].reader.empty()) {
        const std::string why = is_scaled
                                    ? "the target has an extent of its own: the picture is sampled into it"
                                    : fmt::format("{} reads the picture before the target, too", values_[last].reader);
        DARKROOM_TRY(materialise(last, why));
        kernel = open_kernel(last, is_scaled ? why : values_[last].why);
    }
    if (is_scaled) kernels_[kernel].size = target_size;
    if (own.width != 0)
        // What the entries do is done at the picture's extent, fused or not: a dither that is scaled is the price.
        program_.remarks.push_back(
            fmt::format("the target has an extent of its own, up to {}x{}: the last kernel samples the picture into "
                        "it, bilinearly.",
                        own.width, own.height));
    program_.target_size = kernels_[kernel].size;
    const graph::Version target = import_host({HostImage::Kind::Target}, "target", desc_.target, program_.target_size);
    kernels_[kernel].alpha = finish_alpha(desc_, finish);
    DARKROOM_TRY_VALUE(auto version, close_kernel(kernel, target, desc_.target.format, finish, true));
    program_.graph.keep(version);
    return {};
}

Result<graph::Version> Planner::close_kernel(std::size_t index, graph::Version target, VkFormat format, Finish finish,
                                             bool is_always_on) {
    const OpenKernel kernel = kernels_[index];
    ProgramPass pass{.boundary = kernel.boundary};
    const bool is_moved_here = is_moved(kernel.steps);

    Gate toggle;
    append_finish_members(finish, pass.spec.members);
    for (const FusedStep& step : kernel.steps) {
        const std::string& name = stack_[step.entry].desc.name;
        pass.name += (pass.name.empty() ? "" : "+") + name;
        toggle.entries.push_back(step.entry);
        append_header_members(step, pass.spec.members);
        append_parameter_members(*step.info, step.place, pass.spec.members);
        pass.spec.custom_vectors += step.custom_vectors;
    }
    if (pass.name.empty()) pass.name = kernel.is_alpha ? "scene alpha" : "copy";
    pass.spec.name = pass.name;
    if (kernel.constants != nullptr) pass.spec.custom_vectors = 1;
    pass.spec.frame = frame_members();
    pass.spec.outputs = {format};
    // imageLoad needs GENERAL, sampling the other layout: one image can be in one of them.
    const bool is_shared = std::ranges::any_of(kernel.images, [&](const auto& image) {
        return image.second.table == no_table && may_share(kernel.picture, image.second.version);
    });
    const bool is_warp = is_moved_here && kernel.steps.front().info->touch == Touch::Warp;
    const bool is_resampled = !is_warp && !has_size(kernel.picture, kernel.size);
    const Resampling resampling = is_resampled ? kernel.resampling : Resampling::None;
    pass.kind = FusedPass{kernel.steps, finish, resampling, kernel.is_alpha, kernel.alpha};
    if (kernel.steps.empty() && finish == Finish::None && !kernel.is_alpha && kernel.alpha == FinishAlpha{})
        pass.kind = CopyPass{.resampling = resampling, .constants = kernel.constants};
    const bool is_sampled = is_moved_here || is_shared || is_resampled;
    pass.spec.images.push_back(
        {.name = "picture", .storage_format = is_sampled ? VK_FORMAT_UNDEFINED : storage_format(kernel.picture)});
    pass.inputs.push_back({.version = kernel.picture});
    for (const auto& [name, input] : kernel.images) {
        pass.spec.images.push_back(kernel_image(name, input));
        pass.inputs.push_back(input);
    }
    for (const auto& [name, number] : kernel.values) {
        pass.spec.buffers.push_back({.name = name, .type = "float"});
        pass.buffers.push_back({.version = buffers_[number].version, .number = number});
    }
    // Unfused, a kernel whose entry is off copies: else every picture would live as long as those it may stand in for.
    // So does one that gives the picture another size.
    const bool has_toggle = !is_always_on && desc_.fuse && !kernel.is_alpha && !is_resampled;
    if (has_toggle) pass.toggle = toggle_index(std::move(toggle));
    DARKROOM_TRY_VALUE(auto version, add_pass(std::move(pass), target, 0));
    if (has_toggle) {
        fall_back(version, kernel.picture);
    }
    return version;
}

bool Planner::is_special_gate(std::size_t index) const {
    return program_.gates[index].watch || std::ranges::any_of(shared_, [&](const auto& row) {
               return row.second.toggle == static_cast<std::int32_t>(index);
           });
}

std::int32_t Planner::toggle_index(Gate toggle) {
    for (std::size_t i = 0; i < program_.gates.size(); ++i) {
        const Gate& other = program_.gates[i];
        if (!is_special_gate(i) && other.entries == toggle.entries && other.condition == toggle.condition &&
            other.argument == toggle.argument)
            return static_cast<std::int32_t>(i);
    }
    const auto index = static_cast<std::int32_t>(program_.gates.size());
    for (std::int32_t i = 0; i < index; ++i) {
        const Gate& other = program_.gates[static_cast<std::size_t>(i)];
        if (is_special_gate(static_cast<std::size_t>(i)) || other.entries != toggle.entries ||
            other.condition != toggle.condition)
            continue;
        // A condition that holds for an argument holds for all smaller ones.
        if (other.argument < toggle.argument)
            program_.graph.imply(index, i);
        else
            program_.graph.imply(i, index);
    }
    program_.gates.push_back(std::move(toggle));
    return index;
}

Result<std::shared_ptr<const EffectText>> Planner::text_of(const EffectInfo& info, const std::string& file,
                                                           std::uint32_t place, std::span<const std::string> images) {
    const auto key = std::tuple(&info, file, place, std::vector<std::string>(images.begin(), images.end()));
    if (const auto found = texts_.find(key); found != texts_.end()) return found->second;
    DARKROOM_TRY_VALUE(auto text, effect_text(info, file, place, images));
    return texts_[key] = std::make_shared<const EffectText>(std::move(text));
}

Result<Program> plan_program(std::span<const Entry> stack, const CompileDesc& desc, const PlannerTraits& traits) {
    return Planner(stack, desc, traits).run();
}

}  // namespace darkroom::plan
