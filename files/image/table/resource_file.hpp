// SPDX-License-Identifier: MIT
#pragma once
// The files that looks name, whatever they name them for.

#include <darkroom/resource.hpp>
#include <darkroom/result.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace darkroom {

/// For LookOptions::load_resource. Errors begin with the path, and so do warnings.
[[nodiscard]] Result<ResourceData> load_resource_file(const std::filesystem::path& path, FileUse use,
                                                      std::vector<std::string>& warnings);

}  // namespace darkroom
