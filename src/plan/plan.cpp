// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <darkroom/plan.hpp>

namespace darkroom {

namespace {

double mebibytes(std::uint64_t bytes) { return static_cast<double>(bytes) / (1024.0 * 1024.0); }

std::string quoted(std::string_view text) {
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
    for (const std::string& text : texts) out += (out.empty() ? "" : ", ") + quoted(text);
    return "[" + out + "]";
}

}  // namespace

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
    std::string out = fmt::format("{} x {}, {} passes\n", extent.width, extent.height, passes.size());
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const PlanPass& pass = passes[i];
        out += fmt::format("{:3}  {}  ({}, {} x {}, reads {:.2f} MiB, writes {:.2f} MiB)\n", i + 1, pass.name,
                           pass.stage, pass.extent.width, pass.extent.height, mebibytes(pass.bytes_read),
                           mebibytes(pass.bytes_written));
        if (pass.entries.size() > 1) {
            out += "     fused:";
            for (const std::string& entry : pass.entries) out += " " + entry;
            out += "\n";
        }
        out += fmt::format("     new pass because {}\n", pass.boundary);
    }
    out += fmt::format("moved per frame: {:.2f} MiB read, {:.2f} MiB written\n", mebibytes(bytes_read()),
                       mebibytes(bytes_written()));
    out += fmt::format("transient memory: {:.2f} MiB ({:.2f} MiB before aliasing)\n", mebibytes(transient_bytes),
                       mebibytes(transient_bytes_unaliased));
    for (const std::string& text : left_out) out += fmt::format("left out: {}\n", text);
    for (const std::string& text : remarks) out += fmt::format("remark: {}\n", text);
    return out;
}

std::string Plan::json() const {
    std::string items;
    for (const PlanPass& pass : passes) {
        if (!items.empty()) items += ",";
        items += fmt::format(
            "\n    {{\"name\": {}, \"stage\": {}, \"entries\": {}, \"boundary\": {}, \"width\": {}, \"height\": {}, "
            "\"bytes_read\": {}, \"bytes_written\": {}}}",
            quoted(pass.name), quoted(pass.stage), list(pass.entries), quoted(pass.boundary), pass.extent.width,
            pass.extent.height, pass.bytes_read, pass.bytes_written);
    }
    return fmt::format(
        "{{\n  \"width\": {}, \"height\": {}, \"dispatches\": {},\n  \"passes\": [{}\n  ],\n  \"bytes_read\": {}, "
        "\"bytes_written\": "
        "{},\n  \"transient_bytes\": {}, \"transient_bytes_unaliased\": {},\n  \"left_out\": {},\n  \"remarks\": "
        "{},\n  \"frame_images\": {}\n}}\n",
        extent.width, extent.height, passes.size(), items, bytes_read(), bytes_written(), transient_bytes,
        transient_bytes_unaliased, list(left_out), list(remarks), list(frame_images));
}

}  // namespace darkroom
