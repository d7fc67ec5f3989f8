// SPDX-License-Identifier: MIT
#include "graph/graph.hpp"

#include <fmt/format.h>

#include "graph/solution.hpp"

namespace darkroom::graph {
namespace {

Version add_version(Declaration& declaration, VersionRecord record) {
    const auto index = static_cast<std::uint32_t>(declaration.versions.size());
    declaration.images[record.image].versions.push_back(index);
    declaration.versions.push_back(record);
    return {index};
}

Version add_image(Declaration& declaration, Image image) {
    const auto index = static_cast<std::uint32_t>(declaration.images.size());
    declaration.images.push_back(std::move(image));
    return add_version(declaration, {.image = index});
}

std::string origin(const Declaration& declaration, std::uint32_t version) {
    const VersionRecord& record = declaration.versions[version];
    if (record.producer != none) {
        return fmt::format("version written by '{}'", declaration.passes[record.producer].desc.name);
    }
    const Image& image = declaration.images[record.image];
    if (image.is_previous) return "version written by the last frame";
    return image.starts_defined() ? "version written by the host" : "declared, never written";
}

/// Is `version` there and not overwritten before pass `pass_name`?
bool is_usable(Declaration& declaration, const std::string& pass_name, Version version, const char* verb) {
    if (version.index >= declaration.versions.size()) {
        declaration.complain(fmt::format("pass '{}' {} a version that does not exist", pass_name, verb));
        return false;
    }
    const VersionRecord& record = declaration.versions[version.index];
    if (record.killer == none) return true;
    const std::string& image = declaration.images[record.image].desc.name;
    if (record.killer == declaration.passes.size()) {
        declaration.complain(
            fmt::format("pass '{}' writes '{}' twice: one write with one mip range is allowed", pass_name, image));
        return false;
    }
    declaration.complain(fmt::format("pass '{}' {} '{}' ({}) after pass '{}' overwrote it", pass_name, verb, image,
                                     origin(declaration, version.index), declaration.passes[record.killer].desc.name));
    return false;
}

/// Says so, and returns false, if the range does not lie inside the image.
bool is_inside(Declaration& declaration, const std::string& pass_name, Version version, MipRange mips,
               const char* verb) {
    const ImageDesc& desc = declaration.image_of(version.index).desc;
    const bool is_open = mips.count == none;
    if (mips.first < desc.mip_levels && mips.count != 0 && (is_open || mips.count <= desc.mip_levels - mips.first)) {
        return true;
    }
    declaration.complain(fmt::format("pass '{}' {} {} mip levels of '{}' from level {} on, which has {}", pass_name,
                                     verb, is_open ? std::string("all") : fmt::to_string(mips.count), desc.name,
                                     mips.first, desc.mip_levels));
    return false;
}

/// Says so, and returns false, if a buffer is used as an image, or an image as a buffer.
bool is_of_kind(Declaration& declaration, const std::string& pass_name, Version version, Use use) {
    const ImageDesc& desc = declaration.image_of(version.index).desc;
    if (desc.is_buffer() == is_of_buffers(use)) return true;
    declaration.complain(fmt::format("pass '{}' uses '{}' as {}", pass_name, desc.name,
                                     desc.is_buffer() ? "an image, which is a buffer" : "a buffer, which is an image"));
    return false;
}

/// A buffer stands in for buffers, an image for images.
void check_stand_in(Declaration& declaration, Version version, Version instead) {
    const ImageDesc &desc = declaration.image_of(version.index).desc, &other = declaration.image_of(instead.index).desc;
    if (desc.is_buffer() == other.is_buffer()) return;
    declaration.complain(
        fmt::format("'{}' cannot stand in for '{}': one is a buffer, one an image", other.name, desc.name));
}

Version add_write(Declaration& declaration, const PassDesc& desc, const Write& write) {
    const std::string& pass_name = desc.name;
    if (!is_usable(declaration, pass_name, write.version, "writes")) return {};
    Image& image = declaration.images[declaration.versions[write.version.index].image];
    if (image.desc.mip_levels == 0 || image.desc.mip_levels > max_mip_levels) return {};
    if (!is_inside(declaration, pass_name, write.version, write.mips, "writes")) return {};
    if (!is_write(write.use)) {
        declaration.complain(
            fmt::format("pass '{}' writes '{}' with a use that only reads", pass_name, image.desc.name));
        return {};
    }
    if (image.kind == Slot::Kind::Constant || image.is_previous) {
        declaration.complain(fmt::format("pass '{}' writes '{}', which is {}: reading is allowed", pass_name,
                                         image.desc.name, image.is_previous ? "the last frame's history" : "constant"));
        return {};
    }
    if (!is_of_kind(declaration, pass_name, write.version, write.use)) return {};
    const MipMask mips = mip_mask(write.mips, image.desc.mip_levels);
    const auto pass = static_cast<std::uint32_t>(declaration.passes.size());
    VersionRecord& replaced = declaration.versions[write.version.index];
    const bool is_first = replaced.producer == none && !image.starts_defined();
    replaced.killer = pass;
    return add_version(declaration, {.image = replaced.image,
                                     .producer = pass,
                                     .gate = desc.gate,
                                     .replaced = write.version.index,
                                     .mips = mips,
                                     .keeps_content = keeps_content(write.use),
                                     .is_partial = mips != all_mips(image.desc.mip_levels),
                                     .is_first = is_first});
}

}  // namespace

Graph::Graph() : declaration_(std::make_unique<Declaration>()) {}
Graph::~Graph() = default;
Graph::Graph(Graph&&) noexcept = default;
Graph& Graph::operator=(Graph&&) noexcept = default;

Version Graph::import(ImportDesc desc) {
    return add_image(*declaration_, {.desc = std::move(desc.image),
                                     .kind = desc.is_constant ? Slot::Kind::Constant : Slot::Kind::Import,
                                     .allowed_usage = desc.usage,
                                     .import_index = declaration_->import_count++});
}

Version Graph::create(ImageDesc desc) {
    return add_image(*declaration_, {.desc = std::move(desc), .kind = Slot::Kind::Transient});
}

Graph::History Graph::history(ImageDesc desc, HistoryKey key) {
    for (const Image& other : declaration_->images) {
        if (key.owner == 0 || other.kind != Slot::Kind::History || other.history_key != key) continue;
        declaration_->complain(
            fmt::format("the histories '{}' and '{}' have the same key {}.{}: one a history is allowed",
                        other.desc.name, desc.name, key.owner, key.number));
    }
    Image image{.desc = std::move(desc),
                .kind = Slot::Kind::History,
                .history_index = declaration_->history_count++,
                .history_key = key};
    const Version current = add_image(*declaration_, image);
    image.is_previous = true;
    return {current, add_image(*declaration_, std::move(image))};
}

Version Graph::create_buffer(std::string name, VkDeviceSize bytes) {
    return add_image(*declaration_, {.desc = {.name = std::move(name), .buffer_bytes = bytes}});
}

Version Graph::lasting_buffer(std::string name, VkDeviceSize bytes, HistoryKey key) {
    return add_image(*declaration_, {.desc = {.name = std::move(name), .buffer_bytes = bytes},
                                     .kind = Slot::Kind::Lasting,
                                     .history_index = declaration_->history_count++,
                                     .history_key = key});
}

std::vector<Version> Graph::add(PassDesc desc) {
    Declaration& declaration = *declaration_;
    for (const Read& read : desc.reads) {
        if (!is_usable(declaration, desc.name, read.version, "reads")) continue;
        is_inside(declaration, desc.name, read.version, read.mips, "reads");
        is_of_kind(declaration, desc.name, read.version, read.use);
        if (read.instead.is_valid() && read.instead.index >= declaration.versions.size()) {
            declaration.complain(fmt::format("pass '{}' reads '{}', or a version that does not exist", desc.name,
                                             declaration.image_of(read.version.index).desc.name));
        } else if (read.instead.is_valid()) {
            check_stand_in(declaration, read.version, read.instead);
        }
        if (is_write(read.use)) {
            declaration.complain(fmt::format("pass '{}' reads '{}' with a use that writes", desc.name,
                                             declaration.image_of(read.version.index).desc.name));
        }
    }
    std::vector<Version> made;
    made.reserve(desc.writes.size());
    for (const Write& write : desc.writes) made.push_back(add_write(declaration, desc, write));
    declaration.passes.push_back({.desc = std::move(desc), .made = made});
    return made;
}

void Graph::fall_back(Version version, Version instead) {
    Declaration& declaration = *declaration_;
    const auto count = declaration.versions.size();
    if (version.index >= count || instead.index >= count) {
        declaration.complain("a fall-back names a version that does not exist");
        return;
    }
    VersionRecord& record = declaration.versions[version.index];
    if (record.producer == none) {
        declaration.complain(
            fmt::format("'{}' has a fall-back, but no pass writes it", declaration.images[record.image].desc.name));
        return;
    }
    record.instead = instead.index;
    check_stand_in(declaration, version, instead);
}

void Graph::imply(std::int32_t gate, std::int32_t implied) { declaration_->implications.push_back({gate, implied}); }

void Graph::keep(Version version) {
    Declaration& declaration = *declaration_;
    if (version.index >= declaration.versions.size()) {
        declaration.complain("a version that does not exist is to be kept");
        return;
    }
    declaration.versions[version.index].is_kept = true;
}

}  // namespace darkroom::graph
