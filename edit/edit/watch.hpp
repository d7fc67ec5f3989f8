// SPDX-License-Identifier: MIT
#pragma once
// Files that may change on disk.

#include <filesystem>
#include <map>
#include <vector>

#include "core/files.hpp"

namespace darkroom::edit {

/// Tells when files are others than when it was last asked.
class Watch {
  public:
    void add(const std::filesystem::path& file) {
        if (!files_.contains(file)) files_.emplace(file, stamp_of(file));
    }
    /// Takes a file as it is now.
    void take(const std::filesystem::path& file) { files_[file] = stamp_of(file); }
    /// Those that are others than they were, which are then taken as they are now. One that is gone counts as unchanged
    /// until it is there again: editors replace files.
    [[nodiscard]] std::vector<std::filesystem::path> take_changes();
    [[nodiscard]] bool take_change() { return !take_changes().empty(); }

  private:
    std::map<std::filesystem::path, FileStamp> files_;
};

}  // namespace darkroom::edit
