// SPDX-License-Identifier: MIT
#pragma once
// The files that parameters of kind Resource name. In a look the word of such a parameter is 0, or the number of one of
// the entry's resources, from 1; apply() puts the Composer's number in its place.

#include <darkroom/look.hpp>
#include <filesystem>
#include <map>

namespace darkroom {

/// Loads what is named, each file once.
class ResourceFiles {
  public:
    /// Names are relative to `folder`.
    ResourceFiles(std::filesystem::path folder, const LookOptions& options)
        : folder_(std::move(folder)), options_(options) {}

    /// Gives the entry's parameter the file of this name; an empty one takes it away. Errors begin with the path.
    Result<> put(LookEntry& entry, const ParamInfo& row, const std::string& name);

  private:
    Result<std::shared_ptr<const ResourceData>> load(const std::filesystem::path& path);

    std::filesystem::path folder_;
    const LookOptions& options_;
    std::map<std::filesystem::path, std::shared_ptr<const ResourceData>> loaded_;
    std::size_t numbers_ = 0;  ///< of all that was loaded
};

/// The resource that an entry's parameter names; null: none.
[[nodiscard]] const LookResource* resource_of(const LookEntry& entry, const ParamInfo& row);
/// A value as TOML: of a parameter of kind Resource the file's name.
[[nodiscard]] std::string value_text(const LookEntry& entry, const ParamInfo& row);

}  // namespace darkroom
