// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <share.h>
#include <sys/stat.h>
#include <windows.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <utility>

#include "core/system/file.hpp"

namespace darkroom {
namespace {

// The C runtime's functions set errno, the system's own have a number of another kind.
std::error_code last_error() { return {errno, std::generic_category()}; }
std::error_code last_system_error() { return {static_cast<int>(::GetLastError()), std::system_category()}; }

std::error_code facts_of_handle(HANDLE file, FileFacts& facts) {
    const DWORD type = ::GetFileType(file);
    if (type != FILE_TYPE_DISK) {
        facts = {.kind = type == FILE_TYPE_PIPE ? FileKind::Pipe : FileKind::Device};
        return {};
    }
    BY_HANDLE_FILE_INFORMATION is{};
    if (::GetFileInformationByHandle(file, &is) == 0) return last_system_error();
    const auto joined = [](DWORD high, DWORD low) { return std::uint64_t{high} << 32 | low; };
    // In steps of 100 ns since 1601.
    const std::uint64_t ticks = joined(is.ftLastWriteTime.dwHighDateTime, is.ftLastWriteTime.dwLowDateTime);
    constexpr std::uint64_t ticks_per_second = 10'000'000;
    facts = {.kind = (is.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0 ? FileKind::Folder : FileKind::Regular,
             .size = joined(is.nFileSizeHigh, is.nFileSizeLow),
             .seconds = static_cast<std::int64_t>(ticks / ticks_per_second),
             .nanoseconds = static_cast<std::int64_t>(ticks % ticks_per_second * 100),
             .number = joined(is.nFileIndexHigh, is.nFileIndexLow)};
    return {};
}

int flags_of(OpenFile::How how) {
    switch (how) {
        case OpenFile::How::Read:
            return _O_RDONLY;
        case OpenFile::How::Write:
            return _O_WRONLY;
        case OpenFile::How::Truncate:
            return _O_WRONLY | _O_TRUNC;
        case OpenFile::How::Create:
            return _O_WRONLY | _O_CREAT | _O_EXCL;
    }
    return _O_RDONLY;
}

// What one call takes.
unsigned int part_of(std::size_t size) { return static_cast<unsigned int>(std::min<std::size_t>(size, INT_MAX)); }

}  // namespace

std::error_code facts_of(const std::filesystem::path& path, FileFacts& facts) {
    // Folders are opened, too, and nobody is kept from anything meanwhile.
    const HANDLE file =
        ::CreateFileW(path.c_str(), FILE_READ_ATTRIBUTES, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                      nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
    if (file == INVALID_HANDLE_VALUE) return last_system_error();
    const std::error_code failed = facts_of_handle(file, facts);
    ::CloseHandle(file);
    return failed;
}

bool is_of_this_user(const std::filesystem::path& /*path*/) { return true; }

std::error_code check_writable(const std::filesystem::path& path) {
    constexpr int writable = 2;
    return ::_waccess(path.c_str(), writable) == 0 ? std::error_code() : last_error();
}

std::uint64_t process_number() { return ::GetCurrentProcessId(); }

OpenFile::~OpenFile() {
    if (number_ >= 0) ::_close(number_);
}

std::error_code OpenFile::open(const std::filesystem::path& path, How how) {
    number_ = ::_wsopen(path.c_str(), flags_of(how) | _O_BINARY | _O_NOINHERIT, _SH_DENYNO, _S_IREAD | _S_IWRITE);
    return number_ >= 0 ? std::error_code() : last_error();
}

std::error_code OpenFile::facts(FileFacts& facts) const {
    return facts_of_handle(reinterpret_cast<HANDLE>(::_get_osfhandle(number_)), facts);
}

std::error_code OpenFile::read(std::span<std::byte> room, std::size_t& count) {
    const int done = ::_read(number_, room.data(), part_of(room.size()));
    if (done < 0) return last_error();
    count = static_cast<std::size_t>(done);
    return {};
}

std::error_code OpenFile::write(std::span<const std::byte> content) {
    while (!content.empty()) {
        const int done = ::_write(number_, content.data(), part_of(content.size()));
        if (done < 0) return last_error();
        content = content.subspan(static_cast<std::size_t>(done));
    }
    return {};
}

bool OpenFile::lock() {
    OVERLAPPED from_start{};
    return ::LockFileEx(reinterpret_cast<HANDLE>(::_get_osfhandle(number_)),
                        LOCKFILE_EXCLUSIVE_LOCK | LOCKFILE_FAIL_IMMEDIATELY, 0, 1, 0, &from_start) != 0;
}
std::error_code OpenFile::reach_disk() { return ::_commit(number_) == 0 ? std::error_code() : last_error(); }

std::error_code OpenFile::close() {
    return ::_close(std::exchange(number_, -1)) == 0 ? std::error_code() : last_error();
}

}  // namespace darkroom
