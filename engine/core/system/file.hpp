// SPDX-License-Identifier: MIT
#pragma once
// A file as the operating system has it: opened, read, written, and what is known of it. What of this is whole or not
// at all, and what is said to the user, is core/files.hpp's.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <system_error>

namespace darkroom {

enum class FileKind { Regular, Folder, Pipe, Socket, Device };

struct FileFacts {
    FileKind kind = FileKind::Regular;
    std::uint64_t size = 0;                     ///< bytes
    std::int64_t seconds = 0, nanoseconds = 0;  ///< of the last change
    std::uint64_t number = 0;                   ///< of the file in its file system
};
/// Of what the path names, links followed.
[[nodiscard]] std::error_code facts_of(const std::filesystem::path& path, FileFacts& facts);

/// Whether this process may write to what is there under the path.
[[nodiscard]] std::error_code check_writable(const std::filesystem::path& path);
/// On Windows, where folders say who may write, always.
[[nodiscard]] bool is_of_this_user(const std::filesystem::path& path);

/// Of this process, for names that no other one chooses at the same time.
[[nodiscard]] std::uint64_t process_number();

/// Closed with this. No program that is started meanwhile gets it.
class OpenFile {
  public:
    enum class How {
        Read,      ///< never waits: not for somebody who writes into a pipe
        Write,     ///< what is there, from its start; never waits for somebody who reads from a pipe
        Truncate,  ///< what is there, emptied
        Create,    ///< to write; refused where there is one
    };

    OpenFile() = default;
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile();

    [[nodiscard]] std::error_code open(const std::filesystem::path& path, How how);
    [[nodiscard]] std::error_code facts(FileFacts& facts) const;
    /// `count`: how many bytes were read into `room`; 0 at the end.
    [[nodiscard]] std::error_code read(std::span<std::byte> room, std::size_t& count);
    [[nodiscard]] std::error_code write(std::span<const std::byte> content);
    /// Until it is closed, however this process ends; false: somebody else holds it.
    [[nodiscard]] bool lock();
    /// Waits until what was written is on the disk.
    [[nodiscard]] std::error_code reach_disk();
    /// Some file systems say only here that there was no room.
    [[nodiscard]] std::error_code close();

  private:
    int number_ = -1;
};

}  // namespace darkroom
