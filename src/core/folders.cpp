// SPDX-License-Identifier: MIT
#include "core/folders.hpp"

#include <cstdlib>

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

}  // namespace darkroom
