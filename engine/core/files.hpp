// SPDX-License-Identifier: MIT
#pragma once
// Whole files in and out. What is written appears under its name complete or not at all: it goes to a temporary file in
// the same folder, which is then renamed. Nothing here knows a format. Unless it is asked to, nothing waits for the
// disk (fsync): the promise covers errors and kills of this process, not a power cut.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <set>
#include <span>
#include <vector>

#include "core/try.hpp"

namespace darkroom {

struct ReadFileOptions {
    std::uintmax_t max_size = std::numeric_limits<std::uintmax_t>::max();  ///< bytes; longer ones are refused
    bool takes_start = false;       ///< of a longer one its first max_size bytes, instead of an error
    bool is_path_in_errors = true;  ///< put before them; false where the caller names the file by other words
    /// Is asked about the first bytes, at most 16, before the others are read.
    std::function<Result<>(std::span<const std::byte> start)> check_start;
};

/// The content of a regular file. All that this project opens by a name to read it is opened here. Folders, pipes,
/// sockets and devices are refused at once, since one may never answer and another never ends.
[[nodiscard]] Result<std::vector<std::byte>> read_file(const std::filesystem::path& path,
                                                       const ReadFileOptions& options = {});

/// Keeps the names of the files that its thread reads while it lives: what a piece of work depends on. They do not nest.
class ReadRecord {
  public:
    ReadRecord();
    ReadRecord(const ReadRecord&) = delete;
    ReadRecord& operator=(const ReadRecord&) = delete;
    ~ReadRecord();
    [[nodiscard]] const std::set<std::filesystem::path>& files() const { return files_; }

  private:
    std::set<std::filesystem::path> files_;
};

/// What tells one state of a file from the next: editors replace files, so its number counts, too.
struct FileStamp {
    std::uint64_t size = 0;
    std::int64_t seconds = 0, nanoseconds = 0;  ///< of the last change
    std::uint64_t number = 0;                   ///< of the file in its file system
    friend bool operator==(const FileStamp&, const FileStamp&) = default;
};
/// A default one: there is no such file.
[[nodiscard]] FileStamp stamp_of(const std::filesystem::path& path);

/// Writes the file whole or not at all; on failure an existing file stays as it was. A link is followed. A target that
/// is no regular file (a pipe, /dev/stdout) is written in place, since there is nothing to replace. `waits_for_disk`:
/// for what cannot be made again.
[[nodiscard]] Result<> write_file(const std::filesystem::path& path, std::span<const std::byte> content,
                                  bool waits_for_disk = false);

/// A temporary path beside a target, for writers that want a path rather than bytes. It carries the target's extension,
/// because such writers choose the format by it. `commit` moves it over the target; without a commit the destructor
/// removes it and the target is untouched.
class AtomicPath {
  public:
    /// Makes SIGINT, SIGTERM and SIGHUP remove the temporary files that are left, then end the process by the signal's
    /// default action. For programs: a library must not take signals from its host. A signal that is ignored stays so.
    static void remove_on_signals();

    /// Reserves the temporary file (empty). Fails if the folder is missing or not writable, or if the target exists and
    /// is no regular file.
    [[nodiscard]] static Result<AtomicPath> beside(const std::filesystem::path& target);

    AtomicPath(AtomicPath&& other) noexcept;
    AtomicPath& operator=(AtomicPath&& other) noexcept;
    ~AtomicPath();

    [[nodiscard]] const std::filesystem::path& path() const { return temporary_; }
    [[nodiscard]] Result<> commit();

  private:
    AtomicPath(std::filesystem::path target, std::filesystem::path temporary);
    void discard() noexcept;
    void forget() noexcept;

    std::filesystem::path target_;
    std::filesystem::path temporary_;  // empty once committed or moved from
    int watched_ = -1;                 // its place in what a signal handler knows
};

}  // namespace darkroom
