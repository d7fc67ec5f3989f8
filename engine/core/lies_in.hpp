// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace darkroom {

/// Whether the file, with all links followed, lies in the folder or below.
[[nodiscard]] inline bool lies_in(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path root = std::filesystem::canonical(folder.empty() ? "." : folder, error);
    if (error) return false;
    const std::filesystem::path target = std::filesystem::canonical(file, error);
    if (error) return false;
    const auto [root_end, target_end] = std::mismatch(root.begin(), root.end(), target.begin(), target.end());
    return root_end == root.end() && target_end != target.end();
}

}  // namespace darkroom
