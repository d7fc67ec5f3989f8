// SPDX-License-Identifier: MIT
#pragma once
// Files that may change on disk.

#include <cstdint>
#include <filesystem>
#include <map>
#include <tuple>

namespace darkroom::edit {

/// Tells when files are others than when it was last asked.
class Watch {
  public:
    void add(const std::filesystem::path& file) {
        if (!files_.contains(file)) files_.emplace(file, stamp_of(file));
    }
    /// Takes a file as it is now.
    void take(const std::filesystem::path& file) { files_[file] = stamp_of(file); }
    /// Is any of them another than it was? They are then taken as they are now. One that is gone counts as unchanged
    /// until it is there again: editors replace files.
    [[nodiscard]] bool take_change();

  private:
    /// Size, time of the last change, number of the file.
    using Stamp = std::tuple<std::uint64_t, std::int64_t, std::int64_t, std::uint64_t>;
    [[nodiscard]] static Stamp stamp_of(const std::filesystem::path& file);

    std::map<std::filesystem::path, Stamp> files_;
};

}  // namespace darkroom::edit
