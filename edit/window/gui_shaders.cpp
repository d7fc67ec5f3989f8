// SPDX-License-Identifier: MIT
#include "window/gui_shaders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/assert.hpp"
#include "panels/show/false_color.hpp"

namespace darkroom::window {

namespace {

struct File {
    std::string_view name;
    std::string_view text;
};

constexpr File files[] = {
#include "gui_shader_texts.inc"
};

std::string numbered(std::string_view name) {
    const auto file = std::ranges::find(files, name, &File::name);
    DARKROOM_ASSERT(file != std::end(files));
    return fmt::format("#line 1 \"{}\"\n{}", file->name, file->text);
}

std::string whole(std::string_view generated, std::string_view name) {
    return fmt::format("#version 460\n#extension GL_GOOGLE_cpp_style_line_directive : require\n{}{}{}",
                       numbered("gui_common.glsl"), generated, numbered(name));
}

/// vec3 NAME(float value, float grey)
std::string band_function(std::string_view name, std::span<const panels::FalseColorBand> bands) {
    std::string out = fmt::format("vec3 {}(float value, float grey) {{\n", name);
    for (std::size_t i = bands.size(); i-- > 0;) {
        const panels::FalseColorBand& band = bands[i];
        const auto& [r, g, b] = band.color;
        if (i > 0) out += fmt::format("if (value >= {:.9f}) ", band.from);
        out += band.is_grey ? "return vec3(clamp(grey, 0.0, 1.0));\n"
                            : fmt::format("return vec3({:.9f}, {:.9f}, {:.9f});\n", r, g, b);
    }
    return out + "}\n";
}

}  // namespace

std::string gui_vertex_shader() { return whole({}, "gui_vertex.glsl"); }

std::string gui_fragment_shader() { return whole({}, "gui_fragment.glsl"); }

std::string pane_fragment_shader() {
    return whole(band_function("stop_color", panels::stop_bands) + band_function("code_color", panels::code_bands),
                 "pane_fragment.glsl");
}

}  // namespace darkroom::window
