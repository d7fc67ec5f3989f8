// SPDX-License-Identifier: MIT
#pragma once
// Files that a program keeps under names of its own making, beside documents that others may have brought: journals,
// caches, reports, records. Whoever can write into that folder could have put a link or a pipe there first, so none is
// followed and none is waited for.

#include <cstddef>
#include <darkroom/result.hpp>
#include <filesystem>
#include <memory>
#include <span>

namespace darkroom {

/// Whose may what stands there be? Anyone's in folders that several people share.
enum class FileOwner { ThisUser, Anyone };

/// May a file of ours be kept under this name? There is none, or a regular one that is no link, of this owner.
[[nodiscard]] Result<> check_own_file(const std::filesystem::path& path, FileOwner owner = FileOwner::ThisUser);

/// write_file, after check_own_file. What stands there is replaced, and never written through.
[[nodiscard]] Result<> write_own_file(const std::filesystem::path& path, std::span<const std::byte> content,
                                      FileOwner owner = FileOwner::ThisUser);

/// Held as long as this lives, however the process ends.
using FileLock = std::shared_ptr<const void>;
/// Of a file of ours that is there and that nobody holds; else null.
[[nodiscard]] FileLock lock_own_file(const std::filesystem::path& path);
/// write_own_file, of a file that is held before it stands there.
[[nodiscard]] Result<FileLock> write_locked_file(const std::filesystem::path& path, std::span<const std::byte> content);

}  // namespace darkroom
