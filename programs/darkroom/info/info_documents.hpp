// SPDX-License-Identifier: MIT
#pragma once
// What is in a file, as a JSON document; its text is made of the same document, so nothing is said twice. A kind of
// file is a row of the table in info.cpp and a function here. No device is opened.

#include <cstdint>
#include <darkroom/look.hpp>
#include <filesystem>
#include <string>

#include "core/try.hpp"
#include "programs/darkroom/run/json.hpp"
#include "scene/named_files.hpp"

namespace app::info {

/// Keys are snake_case and in the order in which they are shown; null: known to be missing. Errors begin with the path.
[[nodiscard]] darkroom::Result<Json> picture(const std::filesystem::path& path);
[[nodiscard]] darkroom::Result<Json> model(const std::filesystem::path& path, darkroom::scene::NamedFiles named_files);
/// A scene, a prefab or a look: told apart by their tables.
[[nodiscard]] darkroom::Result<Json> toml(const std::filesystem::path& path, bool allows_custom_effects,
                                          darkroom::scene::NamedFiles named_files);

/// A colour table.
[[nodiscard]] darkroom::Result<Json> table(const std::filesystem::path& path);

/// The entries in the order in which they are applied; of the flat table those that are on or have values of their own.
[[nodiscard]] Json entries_of(const darkroom::Look& look);
[[nodiscard]] darkroom::Result<Json> scene(const std::string& text, const std::filesystem::path& path,
                                           darkroom::scene::NamedFiles named_files);

/// Aligned lines; arrays of objects become tables.
[[nodiscard]] std::string text_of(const Json& document);

}  // namespace app::info
