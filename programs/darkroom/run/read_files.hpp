// SPDX-License-Identifier: MIT
#pragma once
// Files that were read, so that nothing is written over them.

#include <filesystem>
#include <mutex>
#include <set>
#include <vector>

namespace app {

/// From any thread: a window reads looks while it draws.
class ReadFiles {
  public:
    void add(const std::filesystem::path& file) {
        const std::lock_guard lock(adding_);
        files_.insert(file);
    }
    [[nodiscard]] std::vector<std::filesystem::path> all() const {
        const std::lock_guard lock(adding_);
        return {files_.begin(), files_.end()};
    }

  private:
    mutable std::mutex adding_;
    std::set<std::filesystem::path> files_;
};

}  // namespace app
