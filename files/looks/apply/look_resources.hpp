// SPDX-License-Identifier: MIT
#pragma once
// The files that parameters of kind Resource, and wires, name. In a look the word of such a parameter is 0, or the
// number of one of the entry's resources, from 1; apply() puts the Composer's number in its place.

#include <darkroom/look.hpp>
#include <filesystem>
#include <map>

#include "looks/look_parts.hpp"

namespace darkroom {

/// Loads what is named, each file once.
class ResourceFiles {
  public:
    /// Names are relative to `folder`.
    ResourceFiles(std::filesystem::path folder, const LookOptions& options)
        : folder_(std::move(folder)), options_(options) {}

    /// Gives the entry's parameter the file of this name; an empty one takes it away. Errors begin with the path.
    Result<> put(LookEntry& entry, const ParamInfo& row, const std::string& name);
    /// Wires the entry to an output, or to the picture in the file of this name.
    Result<> put(LookEntry& entry, const WireInfo& wire, const std::string& name);

  private:
    Result<> put(LookEntry& entry, std::string_view parameter, const std::string& file, FileUse use);
    Result<std::shared_ptr<const ResourceData>> load(const std::filesystem::path& path, FileUse use);

    std::filesystem::path folder_;
    const LookOptions& options_;
    std::map<std::pair<std::filesystem::path, FileUse>, std::shared_ptr<const ResourceData>> loaded_;
    std::size_t numbers_ = 0;  ///< of all that was loaded
};

/// The resource that an entry's parameter names; null: none.
[[nodiscard]] const LookResource* resource_of(const LookEntry& entry, const ParamInfo& row);
/// The file that a wire of the entry names; null: it names none.
[[nodiscard]] const LookResource* resource_of(const LookEntry& entry, const WireInfo& wire);
/// As a string of TOML.
[[nodiscard]] std::string toml_string(std::string_view text);
/// What a table [ui] says of the game, as TOML; an empty list or table has no text.
[[nodiscard]] std::string game_text(const GameValue& value);
[[nodiscard]] std::string game_text(const GameTable& game);
[[nodiscard]] std::string list_text(std::span<const std::string> names);
/// A value as TOML: of a parameter of kind Resource the file's name.
[[nodiscard]] std::string value_text(const LookEntry& entry, const ParamInfo& row);

}  // namespace darkroom
