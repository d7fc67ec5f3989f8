// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <darkroom/plan.hpp>

#include "gpu/resource/formats.hpp"

namespace darkroom {

namespace {

double mebibytes(std::uint64_t bytes) { return static_cast<double>(bytes) / (1024.0 * 1024.0); }

std::string json_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (static_cast<unsigned char>(c) < 0x20)
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            out += c;
    }
    return out + '"';
}

std::string list(const std::vector<std::string>& texts) {
    std::string out;
    for (const std::string& text : texts) out += (out.empty() ? "" : ", ") + json_string(text);
    return "[" + out + "]";
}

std::string_view name_of(PlanImage::Kind kind) {
    switch (kind) {
        case PlanImage::Kind::Host:
            return "host";
        case PlanImage::Kind::Transient:
            return "transient";
        case PlanImage::Kind::History:
            return "history";
    }
    return "";
}

/// "bloom.pyramid  (transient, R16G16B16A16_SFLOAT, 960 x 540, 5 mip levels, 5.27 MiB at 0.00 MiB, passes 1 to 9)"
std::string text_of(const PlanImage& image) {
    std::string out = fmt::format("{}  ({}, {}", image.name, name_of(image.kind), gpu::format_name(image.format));
    if (image.extent.width != 0) out += fmt::format(", {} x {}", image.extent.width, image.extent.height);
    if (image.mip_levels > 1) out += fmt::format(", {} mip levels", image.mip_levels);
    if (image.bytes != 0) out += fmt::format(", {:.2f} MiB", mebibytes(image.bytes));
    if (image.kind == PlanImage::Kind::Transient) out += fmt::format(" at {:.2f} MiB", mebibytes(image.offset));
    if (image.first_pass == PlanImage::never) return out + ", no pass)";
    return out + fmt::format(", passes {} to {})", image.first_pass + 1, image.last_pass + 1);
}

std::string json_of(const PlanUse& use) {
    return fmt::format("{{\"image\": {}, \"mip_level\": {}, \"is_previous\": {}}}", use.image, use.mip_level,
                       use.is_previous);
}

std::string json_of(const PlanState& state) {
    return fmt::format("{{\"entry\": {}, \"state\": {}}}", json_string(state.entry), json_string(state.state));
}

std::string json_of(const PlanPass& pass) {
    std::string reads;
    for (const PlanUse& read : pass.reads) reads += (reads.empty() ? "" : ", ") + json_of(read);
    return fmt::format(
        "{{\"name\": {}, \"stage\": {}, \"round\": {}, \"entries\": {}, \"boundary\": {}, \"width\": {}, \"height\": "
        "{}, "
        "\"bytes_read\": {}, \"bytes_written\": {}, \"reads\": [{}], \"writes\": {}}}",
        json_string(pass.name), json_string(pass.stage), pass.round, list(pass.entries), json_string(pass.boundary),
        pass.extent.width, pass.extent.height, pass.bytes_read, pass.bytes_written, reads, json_of(pass.writes));
}

std::string json_of(const PlanImage& image) {
    const auto pass = [](std::uint32_t number) {
        return number == PlanImage::never ? std::string("null") : fmt::to_string(number);
    };
    // As Vulkan numbers them: a host hands them on.
    const std::string uses =
        image.kind != PlanImage::Kind::Host
            ? std::string{}
            : fmt::format(", \"stages\": {}, \"access\": {}, \"layout\": {}, \"final_layout\": {}", image.stages,
                          image.access, static_cast<int>(image.layout), static_cast<int>(image.final_layout));
    return fmt::format(
        "{{\"name\": {}, \"kind\": \"{}\", \"format\": \"{}\", \"width\": {}, \"height\": {}, \"mip_levels\": {}, "
        "\"bytes\": {}, \"offset\": {}, \"first_pass\": {}, \"last_pass\": {}{}}}",
        json_string(image.name), name_of(image.kind), gpu::format_name(image.format), image.extent.width,
        image.extent.height, image.mip_levels, image.bytes, image.offset, pass(image.first_pass), pass(image.last_pass),
        uses);
}

/// The items of a list, a line each.
template <class Item>
std::string lines_of(const std::vector<Item>& items) {
    std::string out;
    for (const Item& item : items) out += (out.empty() ? "\n    " : ",\n    ") + json_of(item);
    return out;
}

}  // namespace

std::uint32_t Plan::rounds() const {
    std::uint32_t count = 0;
    for (const PlanPass& pass : passes) count = std::max(count, pass.round + 1);
    return count;
}

std::uint64_t Plan::bytes_read() const {
    std::uint64_t sum = 0;
    for (const PlanPass& pass : passes) sum += pass.bytes_read;
    return sum;
}

std::uint64_t Plan::bytes_written() const {
    std::uint64_t sum = 0;
    for (const PlanPass& pass : passes) sum += pass.bytes_written;
    return sum;
}

std::string Plan::text() const {
    const bool has_rounds = rounds() < passes.size();
    std::string out = fmt::format("{} x {}, {} passes", extent.width, extent.height, passes.size());
    out += has_rounds ? fmt::format(" in {} rounds\n", rounds()) : "\n";
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const PlanPass& pass = passes[i];
        out += fmt::format("{:3}  {}  ({}, {}{} x {}, reads {:.2f} MiB, writes {:.2f} MiB)\n", i + 1, pass.name,
                           pass.stage, has_rounds ? fmt::format("round {}, ", pass.round + 1) : "", pass.extent.width,
                           pass.extent.height, mebibytes(pass.bytes_read), mebibytes(pass.bytes_written));
        if (pass.entries.size() > 1) {
            out += "     fused:";
            for (const std::string& entry : pass.entries) out += " " + entry;
            out += "\n";
        }
        out += fmt::format("     new pass because {}\n", pass.boundary);
    }
    out += "images:\n";
    for (const PlanImage& image : images) out += fmt::format("     {}\n", text_of(image));
    out += fmt::format("moved per frame: {:.2f} MiB read, {:.2f} MiB written\n", mebibytes(bytes_read()),
                       mebibytes(bytes_written()));
    out += fmt::format("transient memory: {:.2f} MiB ({:.2f} MiB before aliasing)\n", mebibytes(transient_bytes),
                       mebibytes(transient_bytes_unaliased));
    if (!states.empty()) out += "colour:\n";
    for (const PlanState& state : states) out += fmt::format("     {}: {}\n", state.entry, state.state);
    for (const std::string& text : left_out) out += fmt::format("left out: {}\n", text);
    for (const std::string& text : misplaced) out += fmt::format("misplaced: {}\n", text);
    for (const std::string& text : remarks) out += fmt::format("remark: {}\n", text);
    return out;
}

std::string Plan::json() const {
    return fmt::format(
        "{{\n  \"width\": {}, \"height\": {}, \"dispatches\": {},\n  \"passes\": [{}\n  ],\n  \"images\": [{}\n  ],\n  "
        "\"bytes_read\": {}, \"bytes_written\": {},\n  \"transient_bytes\": {}, \"transient_bytes_unaliased\": {},\n  "
        "\"states\": [{}\n  ],\n  \"left_out\": {},\n  \"misplaced\": {},\n  \"remarks\": {},\n  \"frame_images\": "
        "{}\n}}\n",
        extent.width, extent.height, passes.size(), lines_of(passes), lines_of(images), bytes_read(), bytes_written(),
        transient_bytes, transient_bytes_unaliased, lines_of(states), list(left_out), list(misplaced), list(remarks),
        list(frame_images));
}

}  // namespace darkroom
