// SPDX-License-Identifier: MIT
// Copies of pictures inside the plan, for hosts that look into it: see darkroom/watch.hpp.

#include <fmt/format.h>

#include <algorithm>

#include "plan/planner/planner_state.hpp"

namespace darkroom::plan {

Result<> Planner::add_watches(std::uint32_t entry) {
    for (std::uint32_t i = 0; i < desc_.watches.size(); ++i) {
        if (program_.watch_gates[i] >= 0) continue;
        DARKROOM_TRY_VALUE(auto image, watched_output(i, entry));
        if (!image) continue;
        DARKROOM_TRY(add_watch(i, *image));
    }
    return {};
}

Result<std::optional<Planner::WatchedImage>> Planner::watched_output(std::uint32_t watch, std::uint32_t entry) {
    const Watch& wanted = desc_.watches[watch];
    std::optional<WatchedImage> out;
    if (!wanted.entry.is_given()) return watched_image(wanted);
    if (wanted.entry == scene_color) return out = {.input = {.version = values_[0].image}};
    if (!is_of_entry(wanted.entry) || index_of(wanted.entry) > entry) return out;
    DARKROOM_TRY_VALUE(auto version,
                       materialise(entry_values_[index_of(wanted.entry)], "a watch looks at the picture before it"));
    return out = {.input = {.version = version}};
}

std::optional<Planner::WatchedImage> Planner::watched_image(const Watch& watch) {
    const auto has_name = [&](graph::Version version) {
        return version.is_valid() && facts_.at(version.index).name == watch.image;
    };
    const auto can_read = [&](graph::Version version) {
        return (facts_.at(version.index).usage & VK_IMAGE_USAGE_SAMPLED_BIT) != 0;
    };
    const ProgramPass* first = nullptr;
    graph::Version last;
    for (const ProgramPass& pass : program_.passes)
        pass.for_each_output([&](graph::Version version, std::uint32_t mip_level) {
            if (!has_name(version)) return;
            last = version;
            if (first == nullptr && mip_level == watch.mip_level) first = &pass;
        });
    if (first == nullptr) {
        for (const auto& [which, version] : host_images_)
            if (has_name(version) && can_read(version) && which.kind != HostImage::Kind::Shadow && watch.mip_level == 0)
                return WatchedImage{.input = {.version = version}};
        return std::nullopt;
    }
    if (!can_read(last)) return std::nullopt;
    WatchedImage out{.input = {.version = last, .mip_level = watch.mip_level}, .writer = first->toggle};
    // Passes that write over it may have gates of their own.
    if (out.writer >= 0) out.input.instead = import_neutral(facts_.at(last.index).format, {});
    return out;
}

Result<> Planner::add_watch(std::uint32_t number, const WatchedImage& image) {
    const Watch& watch = desc_.watches[number];
    const bool is_entry = is_of_entry(watch.entry);
    const std::string shown = is_entry                 ? stack_[index_of(watch.entry)].desc.name
                              : watch.entry.is_given() ? "color"
                                                       : watch.image;
    const auto gate = static_cast<std::int32_t>(program_.gates.size());
    program_.gates.push_back({.entries = {}, .conditions = {}, .watch = number, .writer = image.writer});
    program_.watch_gates[number] = gate;
    if (image.writer >= 0) program_.graph.imply(gate, image.writer);
    const graph::Version target = import_host({HostImage::Kind::Watched, number}, fmt::format("watch {}", watch.id),
                                              watch.target, {.width = 1, .height = 1});
    ProgramPass pass{.name = fmt::format("watch {}", shown),
                     .kind = CopyPass{.resampling = Resampling::Nearest, .watch = number},
                     .toggle = gate,
                     .boundary = "the host looks at it"};
    pass.spec.name = pass.name;
    pass.spec.frame = frame_members();
    pass.spec.outputs = {watch.target.format};
    pass.spec.images.push_back({.name = std::string(picture_name)});
    pass.inputs.push_back(image.input);
    auto made = add_pass(std::move(pass), target, 0);
    return made ? Result<>{} : failure(std::move(made));
}

void Planner::remark_watches() {
    for (std::size_t i = 0; i < desc_.watches.size(); ++i) {
        const Watch& watch = desc_.watches[i];
        if (program_.watch_gates[i] >= 0) continue;
        const std::string what = watch.entry.is_given()
                                     ? fmt::format("entry {}", watch.entry.id)
                                     : fmt::format("mip level {} of an image '{}'", watch.mip_level, watch.image);
        program_.remarks.push_back(fmt::format("watch {}: the plan has no {}.", watch.id, what));
    }
}

}  // namespace darkroom::plan
