// SPDX-License-Identifier: MIT
#include "scene/read/scene_file.hpp"

#include "core/files.hpp"
#include "toml/toml_text.hpp"

namespace darkroom::scene::reading {

Result<std::string> read_scene_text(const std::filesystem::path& path) {
    DARKROOM_TRY_VALUE(const std::vector<std::byte> bytes, read_file(path, {.max_size = max_toml_bytes}));
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

}  // namespace darkroom::scene::reading
