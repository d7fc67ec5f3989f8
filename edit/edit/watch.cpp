// SPDX-License-Identifier: MIT
#include "edit/watch.hpp"

namespace darkroom::edit {

std::vector<std::filesystem::path> Watch::take_changes() {
    std::vector<std::filesystem::path> changed;
    for (auto& [file, stamp] : files_) {
        const FileStamp now = stamp_of(file);
        if (now == stamp || now == FileStamp{}) continue;
        stamp = now;
        changed.push_back(file);
    }
    return changed;
}

}  // namespace darkroom::edit
