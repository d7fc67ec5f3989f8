// SPDX-License-Identifier: MIT
#pragma once
// Files that a program keeps under names of its own making, beside documents that others may have brought: journals,
// caches, records; and what it writes beside the pictures that were asked for: reports, frames. Whoever can write into
// that folder could have put a link or a pipe there first, so none is followed and none is waited for.

#include <cstddef>
#include <darkroom/result.hpp>
#include <filesystem>
#include <memory>
#include <span>

namespace darkroom {

/// Whose may what stands there be? Anyone's in folders that several people share. Such a file may be a place of the
/// system, too.
enum class FileOwner { ThisUser, Anyone };

/// Is this /dev/stdout, a program behind >(...), or another name that the system alone gives? It is written in place,
/// whatever it leads to.
[[nodiscard]] bool is_place_of_system(const std::filesystem::path& path);

/// May a file of ours be kept under this name? There is none, or a regular one that is no link, of this owner.
[[nodiscard]] Result<> check_own_file(const std::filesystem::path& path, FileOwner owner = FileOwner::ThisUser);

/// write_file, after check_own_file. What stands there is replaced, and never written through.
[[nodiscard]] Result<> write_own_file(const std::filesystem::path& path, std::span<const std::byte> content,
                                      FileOwner owner = FileOwner::ThisUser);

/// A folder for files of ours is there behind this; a link to one is none.
[[nodiscard]] Result<> make_own_folder(const std::filesystem::path& path);

/// Held as long as this lives, however the process ends.
using FileLock = std::shared_ptr<const void>;
/// Of a file of ours that is there and that nobody holds; else null.
[[nodiscard]] FileLock lock_own_file(const std::filesystem::path& path);
/// write_own_file, of a file that is held before it stands there.
[[nodiscard]] Result<FileLock> write_locked_file(const std::filesystem::path& path, std::span<const std::byte> content);

}  // namespace darkroom
