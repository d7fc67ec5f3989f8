// SPDX-License-Identifier: MIT
#pragma once
// Files that a program keeps under names of its own making, beside documents that others may have brought: journals,
// caches, reports, records. Whoever can write into that folder could have put a link or a pipe there first, so none is
// followed and none is waited for.

#include <cstddef>
#include <darkroom/result.hpp>
#include <filesystem>
#include <span>

namespace darkroom {

/// May a file of ours be kept under this name? There is none, or a regular one of this user that is no link.
[[nodiscard]] Result<> check_own_file(const std::filesystem::path& path);

/// write_file, after check_own_file. What stands there is replaced, and never written through.
[[nodiscard]] Result<> write_own_file(const std::filesystem::path& path, std::span<const std::byte> content,
                                      bool waits_for_disk = false);

}  // namespace darkroom
