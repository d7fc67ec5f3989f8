// SPDX-License-Identifier: MIT
#include "edit/watch.hpp"

#include <sys/stat.h>

namespace darkroom::edit {

Watch::Stamp Watch::stamp_of(const std::filesystem::path& file) {
    struct stat is {};
    if (::stat(file.c_str(), &is) != 0) return {};
    return {static_cast<std::uint64_t>(is.st_size), is.st_mtim.tv_sec, is.st_mtim.tv_nsec, is.st_ino};
}

bool Watch::take_change() {
    bool is_any = false;
    for (auto& [file, stamp] : files_) {
        const Stamp now = stamp_of(file);
        if (now == stamp || now == Stamp{}) continue;
        stamp = now;
        is_any = true;
    }
    return is_any;
}

}  // namespace darkroom::edit
