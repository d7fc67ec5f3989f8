// SPDX-License-Identifier: MIT
#include "render/shader_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "core/assert.hpp"

namespace darkroom::render {

namespace {

struct File {
    std::string_view name;
    std::string_view text;
};

constexpr File files[] = {
#include "shader_texts.inc"
};

void append(std::string& out, std::string_view name, std::vector<std::string_view>& seen) {
    if (std::ranges::find(seen, name) != seen.end()) return;
    const auto file = std::ranges::find(files, name, &File::name);
    DARKROOM_ASSERT(file != std::end(files));
    seen.push_back(file->name);
    out += fmt::format("#line 1 \"{}\"\n", name);
    constexpr std::string_view include = "#include \"";
    std::size_t number = 1;
    for (std::size_t start = 0; start < file->text.size(); ++number) {
        const std::size_t end = std::min(file->text.find('\n', start), file->text.size());
        const std::string_view line = file->text.substr(start, end - start);
        start = end + 1;
        if (!line.starts_with(include)) {
            out.append(line).push_back('\n');
            continue;
        }
        append(out, line.substr(include.size(), line.rfind('"') - include.size()), seen);
        out += fmt::format("#line {} \"{}\"\n", number + 1, name);
    }
}

}  // namespace

std::string shader_text(std::string_view name) {
    std::string out = "#version 460\n#extension GL_GOOGLE_cpp_style_line_directive : require\n";
    std::vector<std::string_view> seen;
    append(out, name, seen);
    return out;
}

}  // namespace darkroom::render
