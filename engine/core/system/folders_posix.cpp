// SPDX-License-Identifier: MIT
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

#include "core/system/folders.hpp"

namespace darkroom {

std::filesystem::path user_cache_folder() {
    // The XDG Base Directory Specification says that a relative path is to be ignored.
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && cache[0] == '/') {
        return std::filesystem::path(cache) / "darkroom";
    }
    if (const char* home = std::getenv("HOME"); home != nullptr && home[0] == '/') {
        return std::filesystem::path(home) / ".cache" / "darkroom";
    }
    return {};
}

bool is_of_this_user_alone(const std::filesystem::path& path) {
    struct stat facts {};
    const bool is_there = ::stat(path.c_str(), &facts) == 0;
    return is_there && facts.st_uid == ::geteuid() && (facts.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

}  // namespace darkroom
