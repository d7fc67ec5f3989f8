// SPDX-License-Identifier: MIT
// The wires of a stack: who reads whose output, and the pictures that no entry makes: the scene's alpha, those that the
// host defined, and all of the frame before.

#include <fmt/format.h>

#include <algorithm>

#include "gpu/resource/formats.hpp"
#include "plan/planner/planner_state.hpp"

namespace darkroom::plan {

namespace {

/// Of the histories of an entry, that of its output; its effect's are counted from 0.
constexpr std::uint32_t output_history = ~0u;

}  // namespace

graph::Size Planner::frame_output() const {
    return {.extent = desc_.target_extent.width != 0 ? graph::Extent::Output : graph::Extent::Scene};
}

graph::Size Planner::result_size(const EffectInfo& info, graph::Size input) const {
    const ResultScale& scale = info.output_scale;
    return (scale.is_of_output ? frame_output() : input).scaled(scale.numerator, scale.denominator);
}

Result<> Planner::check_size(std::uint32_t entry, graph::Size size) const {
    const VkExtent2D extent = size.of(largest_extents(desc_));
    const std::uint32_t most = traits_.max_image_side;
    if (extent.width <= most && extent.height <= most) return {};
    const EntryDesc& desc = stack_[entry].desc;
    const double gibibytes =
        1.0 * extent.width * extent.height * gpu::format_traits(desc_.intermediate).bits / 8 / (1U << 30U);
    return user_error(fmt::format(
        "stack entry '{}': scale = {}/{} makes pictures of {}x{}, {:.1f} GiB each: allowed are at most {}x{}",
        desc.name, desc.scale.numerator, desc.scale.denominator, extent.width, extent.height, gibibytes, most, most));
}

bool Planner::is_of_entry(Handle handle) const {
    return handle.is_given() && !handle.is_previous && index_of(handle) != no_entry;
}

const ResourceImage* Planner::picture_of(std::uint32_t entry, Handle handle) const {
    if (handle.is_previous) return nullptr;
    const ResourceData* const data = find_resource(stack_[entry].resources.get(), {handle.id});
    return data == nullptr ? nullptr : std::get_if<ResourceImage>(data);
}

Result<> Planner::check_handles() const {
    const auto check = [&](std::uint32_t entry, Handle handle, std::string_view which) -> Result<> {
        if (!handle.is_given() || handle.id == scene_color.id || handle.id == scene_alpha.id) return {};
        if (handle.id == ui_layer.id) return {};
        if (picture_of(entry, handle) != nullptr) return {};
        const std::uint32_t from = index_of(handle);
        if (handle.is_previous ? from != no_entry : from < entry) return {};
        return user_error(fmt::format("stack entry '{}': its {} is {}", stack_[entry].desc.name, which,
                                      from == no_entry ? "no entry of this stack; it may have been removed"
                                                       : "not the output of an earlier entry"));
    };
    for (std::uint32_t i = 0; i < stack_.size(); ++i) {
        const EntryDesc& desc = stack_[i].desc;
        DARKROOM_TRY(check(i, desc.input, "input"));
        DARKROOM_TRY(check(i, desc.source, "source"));
        DARKROOM_TRY(check(i, desc.second, "second"));
        DARKROOM_TRY(check(i, desc.mask, "mask"));
        if (stack_[i].info->has_second() && !second_of(i).is_given())
            return user_error(fmt::format("stack entry '{}': {} reads two pictures: name the other one as `second`",
                                          desc.name, stack_[i].info->name));
    }
    return {};
}

std::uint32_t Planner::index_of(Handle handle) const {
    const auto found = std::ranges::find(stack_, handle.id, &Entry::id);
    return found == stack_.end() ? no_entry : static_cast<std::uint32_t>(found - stack_.begin());
}

std::uint32_t Planner::entry_before(std::uint32_t entry, bool is_ui) const {
    while (entry-- > 0)
        if (stack_[entry].desc.is_ui == is_ui) return entry;
    return is_ui ? ui_entry : no_entry;
}

std::uint32_t Planner::last_of_picture() const {
    return entry_before(static_cast<std::uint32_t>(stack_.size()), false);
}

Handle Planner::second_of(std::uint32_t entry) const {
    const Entry& own = stack_[entry];
    if (own.desc.second.is_given() || !own.info->joins_ui()) return own.desc.second;
    const std::uint32_t last = entry_before(entry, true);
    return last == ui_entry ? ui_layer : Handle{stack_[last].id};
}

std::uint32_t Planner::past_what_is_left_out(std::uint32_t from) const {
    return from < stack_.size() && program_.is_left_out[from] ? program_.entry_inputs[from] : from;
}

std::uint32_t Planner::resolved(Handle handle, std::uint32_t entry) const {
    if (!handle.is_given()) return past_what_is_left_out(entry_before(entry, stack_[entry].desc.is_ui));
    if (!is_of_entry(handle)) return handle == ui_layer ? ui_entry : no_entry;
    return past_what_is_left_out(index_of(handle));
}

void Planner::resolve_inputs() {
    for (std::uint32_t i = 0; i < stack_.size(); ++i)
        program_.entry_inputs.push_back(resolved(stack_[i].desc.input, i));
    for (std::uint32_t i = 0; i < stack_.size(); ++i) {
        const Handle input = stack_[i].desc.input;
        const bool is_earlier = input.is_previous && index_of(input) != no_entry;
        program_.entry_states.push_back(is_earlier ? past_what_is_left_out(index_of(input)) : program_.entry_inputs[i]);
    }
    program_.last_entry = past_what_is_left_out(last_of_picture());
}

std::size_t Planner::value_of(Handle handle, std::uint32_t entry) const {
    if (handle == scene_color) return 0;
    if (!handle.is_given()) {
        const std::uint32_t from = entry_before(entry, stack_[entry].desc.is_ui);
        if (from < stack_.size()) return entry_values_[from];
        if (from == no_entry) return 0;
        handle = ui_layer;
    }
    if (const auto found = wires_.find({handle.id, handle.is_previous}); found != wires_.end()) return found->second;
    // Of an interface that the frames do not have: all that reads it is left out.
    return handle == ui_layer ? 0 : entry_values_[index_of(handle)];
}

/// Who reads the output of each entry as a picture of its own: such an output must become an image.
void Planner::count_readers() {
    image_reader_.assign(stack_.size(), {});
    std::vector<std::uint32_t> inputs(stack_.size(), 0);
    const auto read_picture = [&](std::uint32_t from, const std::string& reader) {
        if (from < stack_.size() && inputs[from]++ > 0) image_reader_[from] = reader;
    };
    for (std::uint32_t i = 0; i < stack_.size(); ++i) {
        if (program_.is_left_out[i]) continue;
        const EntryDesc& wiring = stack_[i].desc;
        for (const Handle handle : {wiring.source, second_of(i), wiring.mask}) {
            const std::uint32_t from = is_of_entry(handle) ? resolved(handle, i) : no_entry;
            if (from < stack_.size()) image_reader_[from] = wiring.name;
        }
        read_picture(program_.entry_inputs[i], wiring.name);
    }
    for (const Watch& watch : desc_.watches)
        if (is_of_entry(watch.entry)) image_reader_[index_of(watch.entry)] = "a watch";
    read_picture(program_.last_entry, "the target");
}

/// The pictures that no entry makes, for the wires that name them.
Result<> Planner::make_wires() {
    for (std::uint32_t i = 0; i < stack_.size(); ++i) {
        const EntryDesc& desc = stack_[i].desc;
        const Handle input = program_.entry_inputs[i] == ui_entry ? ui_layer : desc.input;
        for (const Handle handle : {input, desc.source, second_of(i), desc.mask}) {
            const std::pair key{handle.id, handle.is_previous};
            // What is left out hands on its input, and reads nothing else.
            const bool is_read = handle.is_given() && (!program_.is_left_out[i] || handle == input);
            if (!is_read || wires_.contains(key)) continue;
            if (const ResourceImage* const picture = picture_of(i, handle)) {
                const graph::Size size{.width = picture->width, .height = picture->height};
                const graph::Version image = import_constant({.name = "picture",
                                                              .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                              .extent = {picture->width, picture->height, 1}},
                                                             size);
                program_.fixed_images.back().picture = stack_[i].resources->at(handle.id);
                values_.push_back({.image = image, .size = size, .why = "a picture that was given starts here"});
            } else if (handle.is_previous) {
                DARKROOM_TRY(previous_of(handle));
            } else if (handle == ui_layer) {
                if (!is_given(desc_, FrameImage::Ui)) continue;
                const graph::Version image = import_input(frame_input(FrameImage::Ui));
                values_.push_back(
                    {.image = image, .size = facts_.at(image.index).size, .why = "the interface starts here"});
            } else if (handle == scene_alpha) {
                kernels_.push_back(
                    {.picture = values_[0].image, .boundary = "the scene's alpha becomes a picture", .is_alpha = true});
                values_.push_back({.kernel = kernels_.size() - 1});
                DARKROOM_TRY(materialise(values_.size() - 1, "the scene's alpha starts here"));
            } else {
                continue;
            }
            wires_[key] = values_.size() - 1;
        }
    }
    return {};
}

/// Appends the value of what an entry, or the scene, was in the frame before. Who makes it writes it later.
Result<> Planner::previous_of(Handle handle) {
    const std::uint32_t entry =
        handle.id == scene_color.id || handle.id == scene_alpha.id ? no_entry : index_of(handle);
    const std::string name = entry == no_entry ? std::string("scene") : stack_[entry].desc.name;
    if (handle.id == scene_alpha.id || handle.id == ui_layer.id)
        return user_error(
            fmt::format("{} has no previous frame: copy it by an entry, and read the previous frame of that entry",
                        handle.id == ui_layer.id ? "the interface" : "the scene's alpha"));
    const graph::Size size = entry == no_entry ? graph::Size{} : output_size(entry);
    const VkFormat wanted = entry == no_entry ? VK_FORMAT_UNDEFINED : stack_[entry].desc.format;
    const VkFormat format = wanted == VK_FORMAT_UNDEFINED ? desc_.intermediate : wanted;
    const graph::ImageDesc image{.name = own_name(fmt::format("{}.output", name)), .format = format, .size = size};
    const graph::Graph::History made = program_.graph.history(
        image, {entry == no_entry ? std::uint64_t{scene_color.id} : stack_[entry].history_owner, output_history});
    program_.history_entries.push_back(no_entry);
    for (const graph::Version version : {made.current, made.previous})
        facts_[version.index] = {.root = version.index,
                                 .size = size,
                                 .format = format,
                                 .usage = own_usage,
                                 .fall_backs = {},
                                 .name = image.name};
    kept_outputs_[entry] = made.current;
    values_.push_back({.image = made.previous, .size = size, .why = fmt::format("{} of the frame before", name)});
    if (entry != no_entry) return {};
    DARKROOM_TRY(copy_into(0, made.current));
    return {};
}

Result<graph::Version> Planner::copy_into(std::size_t value, graph::Version image) {
    kernels_.push_back({.picture = values_[value].image,
                        .size = values_[value].size,
                        .boundary = "its output has a format of its own, or is read in the next frame"});
    return close_kernel(kernels_.size() - 1, image, facts_.at(image.index).format, Finish::None, true);
}

graph::Size Planner::output_size(std::uint32_t entry) const {
    const EntryDesc& desc = stack_[entry].desc;
    const EffectInfo& info = *stack_[entry].info;
    graph::Size size;  // of the scene, and of what is read of the frame before
    if (const ResourceImage* const picture = desc.input.is_given() ? picture_of(entry, desc.input) : nullptr)
        size = {.width = picture->width, .height = picture->height};
    else if (!desc.input.is_previous && program_.entry_inputs[entry] == ui_entry)
        size = frame_output();
    else if (!desc.input.is_previous && program_.entry_inputs[entry] != no_entry)
        size = output_size(program_.entry_inputs[entry]);
    if (program_.is_left_out[entry]) return size;
    size = size.scaled(desc.scale.numerator, desc.scale.denominator);
    const bool has_result = info.touch == Touch::Neighbourhood || info.touch == Touch::History;
    return has_result ? result_size(info, size) : size;
}

/// The picture that an entry gets, at the size it works at.
Result<std::size_t> Planner::scaled_input(std::uint32_t entry) {
    const EntryDesc& desc = stack_[entry].desc;
    const std::size_t input = value_of(desc.input, entry);
    const graph::Size own = desc.input.is_previous ? graph::Size{} : values_[input].size;
    const graph::Size size =
        program_.is_left_out[entry] ? values_[input].size : own.scaled(desc.scale.numerator, desc.scale.denominator);
    if (size == values_[input].size) return input;
    DARKROOM_TRY(check_size(entry, size));
    DARKROOM_TRY_VALUE(auto image, materialise(input, fmt::format("{} works at another size", desc.name)));
    kernels_.push_back(
        {.picture = image, .size = size, .boundary = fmt::format("{} works at another size", desc.name)});
    values_.push_back({.kernel = kernels_.size() - 1, .size = size});
    if (stack_[entry].info->touch == Touch::Warp)
        DARKROOM_TRY(materialise(values_.size() - 1, fmt::format("{} reads it at moved coordinates", desc.name)));
    return values_.size() - 1;
}

/// Writes the entry's output where it shall lie: in a format of its own, or for the next frame.
Result<> Planner::keep_output(std::uint32_t entry) {
    const EntryDesc& desc = stack_[entry].desc;
    const auto kept = kept_outputs_.find(entry);
    const bool has_format = desc.format != VK_FORMAT_UNDEFINED && !program_.is_left_out[entry];
    if (kept == kept_outputs_.end() && !has_format) return {};
    const std::size_t value = entry_values_[entry];
    const std::string why = kept != kept_outputs_.end() ? fmt::format("{} is read in the next frame, too", desc.name)
                                                        : fmt::format("{} has a format of its own", desc.name);
    const graph::Version image = kept != kept_outputs_.end() ? kept->second
                                                             : create_picture(fmt::format("{}.output", desc.name),
                                                                              values_[value].size, desc.format);
    if (!values_[value].image.is_valid()) {
        auto made = materialise_into(value, image, true, why);
        return made ? Result<>{} : failure(std::move(made));
    }
    DARKROOM_TRY_VALUE(auto copied, copy_into(value, image));
    values_.push_back({.image = copied, .size = values_[value].size, .why = why});
    entry_values_[entry] = values_.size() - 1;
    return {};
}

}  // namespace darkroom::plan
