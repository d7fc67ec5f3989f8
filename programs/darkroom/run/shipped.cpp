// SPDX-License-Identifier: MIT
#include "shipped.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/system/module.hpp"
#include "core/text/param_text.hpp"

namespace app {

namespace fs = std::filesystem;

fs::path shipped_file(const fs::path& name) {
    std::error_code error;
    fs::path folder = darkroom::running_program().parent_path();
    for (; !folder.empty() && folder != folder.root_path(); folder = folder.parent_path())
        for (const fs::path& file : {folder / name, folder / "share/darkroom" / name})
            if (fs::is_regular_file(file, error)) return file;
    return {};
}

std::vector<fs::path> shipped_looks() {
    std::error_code error;
    std::vector<fs::path> out;
    for (fs::directory_iterator file(shipped_file("looks/default.toml").parent_path(), error), end;
         !error && file != end; file.increment(error))
        if (file->path().extension() == ".toml") out.push_back(file->path());
    std::ranges::sort(out);
    return out;
}

std::string find_shipped_look(std::string& name) {
    std::error_code error;
    // A flag: that the value is missing is told where all flags are known.
    if (name.empty() || name.starts_with('-') || name.find_first_of("/.\\") != std::string::npos ||
        fs::exists(name, error))
        return {};
    if (const fs::path found = shipped_file("looks/" + name + ".toml"); !found.empty()) {
        name = found.string();
        return {};
    }
    std::vector<std::string> names;
    for (const fs::path& file : shipped_looks()) names.push_back(file.stem().string());
    return fmt::format("{}: no such file, and no look that ships has this name{}", darkroom::printable(name),
                       darkroom::suggestion(name, names));
}

}  // namespace app
