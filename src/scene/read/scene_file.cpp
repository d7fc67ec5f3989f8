// SPDX-License-Identifier: MIT
#include "scene/read/scene_file.hpp"

#include <fmt/format.h>

#include <system_error>

#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "toml/toml_text.hpp"

namespace darkroom::scene::reading {

Result<std::string> read_scene_text(const std::filesystem::path& path) {
    const std::string shown = printable(path.string());
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    const bool is_regular = std::filesystem::is_regular_file(status);
    // It is read twice, for the scene and for its look, which a pipe would not survive.
    if (std::filesystem::exists(status) && !is_regular && !std::filesystem::is_directory(status))
        return user_error(fmt::format("{}: is no regular file, expected a scene", shown));
    const std::uintmax_t size = is_regular ? std::filesystem::file_size(path, error) : 0;
    if (!error && size > most_toml_bytes)
        return user_error(fmt::format("{}: {} bytes, a scene file has at most {}", shown, size, most_toml_bytes));
    const Result<std::vector<std::byte>> bytes = read_file(path);
    if (!bytes) return failure(bytes.error());
    return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

}  // namespace darkroom::scene::reading
