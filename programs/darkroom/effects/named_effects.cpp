// SPDX-License-Identifier: MIT
#include "named_effects.hpp"

#include <algorithm>
#include <string_view>
#include <system_error>

#include "core/files.hpp"
#include "toml/toml_text.hpp"

namespace app {

namespace {

namespace fs = std::filesystem;

bool is_regular(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

/// Most looks and scenes name no file, and are then not parsed twice.
bool names_file(const fs::path& path) {
    const auto bytes = darkroom::read_file(path, {.max_size = darkroom::max_toml_bytes});
    return bytes && std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()).find(".glsl") !=
                        std::string_view::npos;
}

}  // namespace

std::vector<darkroom::LookEntry> effects_named_by(std::span<char* const> arguments) {
    std::vector<darkroom::LookEntry> out;
    if (std::ranges::find(arguments, std::string_view(no_custom_effects)) != arguments.end()) return out;
    for (const std::string_view argument : arguments) {
        const bool is_flag = argument.starts_with("--");
        const fs::path path = is_flag ? argument.substr(std::min(argument.find('=') + 1, argument.size())) : argument;
        if (path.extension() == ".glsl" && is_regular(path)) {
            if (auto entry = darkroom::custom_entry(path)) out.push_back(std::move(*entry));
        } else if (path.extension() == ".toml" && is_regular(path) && names_file(path)) {
            const auto look = darkroom::read_look(path, {.is_scene = true, .allows_custom_effects = true});
            if (!look) continue;
            std::ranges::copy_if(look->entries, std::back_inserter(out),
                                 [](const darkroom::LookEntry& entry) { return entry.effect_owner != nullptr; });
        }
    }
    return out;
}

}  // namespace app
