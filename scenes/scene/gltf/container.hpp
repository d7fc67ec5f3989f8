// SPDX-License-Identifier: MIT
#pragma once
// The outside of a glTF file: the chunks of a .glb, the JSON text, and the URIs that name other files or hold data. It
// knows nothing of what the JSON means. Every URI stays in the folder of the model.

#include <cstddef>
#include <darkroom/result.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/budget.hpp"
#include "scene/named_files.hpp"

namespace darkroom::scene::gltf {

struct Container {
    nlohmann::json json;                ///< an object
    std::span<const std::byte> binary;  ///< the BIN chunk, in the bytes that were split; empty: none
    bool has_binary = false;
    std::vector<std::string> warnings;
};

/// The content of a .glb or .gltf file, told apart by the content. The budget is for the JSON. Errors are without the
/// file's name.
[[nodiscard]] Result<Container> split_container(std::span<const std::byte> file, Budget& budget);

/// The file that a URI names. Refused are schemes, absolute paths and whatever leaves `folder`, also by percent-encoded
/// characters or by symbolic links. The error names the URI; a file that does not exist is one.
[[nodiscard]] Result<std::filesystem::path> resolve_uri(const std::filesystem::path& folder, std::string_view uri,
                                                        NamedFiles named_files = NamedFiles::Own);

[[nodiscard]] bool is_data_uri(std::string_view uri);
/// The bytes of a data URI (RFC 2397).
[[nodiscard]] Result<std::vector<std::byte>> decode_data_uri(std::string_view uri);

/// At most `most` bytes from the start of a regular file; larger files are an error if `must_fit`.
[[nodiscard]] Result<std::vector<std::byte>> read_bounded(const std::filesystem::path& path, std::size_t most,
                                                          bool must_fit);

}  // namespace darkroom::scene::gltf
