// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "core/system/file.hpp"

namespace darkroom {
namespace {

std::error_code last_error() { return {errno, std::generic_category()}; }

FileKind kind_of(mode_t mode) {
    if (S_ISREG(mode)) return FileKind::Regular;
    if (S_ISDIR(mode)) return FileKind::Folder;
    if (S_ISFIFO(mode)) return FileKind::Pipe;
    if (S_ISSOCK(mode)) return FileKind::Socket;
    return FileKind::Device;
}

FileFacts facts_of(const struct stat& status) {
    return {.kind = kind_of(status.st_mode),
            .size = static_cast<std::uint64_t>(status.st_size),
            .seconds = status.st_mtim.tv_sec,
            .nanoseconds = status.st_mtim.tv_nsec,
            .number = status.st_ino};
}

int flags_of(OpenFile::How how) {
    switch (how) {
        case OpenFile::How::Read:
            return O_RDONLY | O_NONBLOCK | O_NOCTTY;
        case OpenFile::How::Write:
            return O_WRONLY | O_NONBLOCK;
        case OpenFile::How::Truncate:
            return O_WRONLY | O_TRUNC;
        case OpenFile::How::Create:
            return O_WRONLY | O_CREAT | O_EXCL;
    }
    return O_RDONLY;
}

}  // namespace

std::error_code facts_of(const std::filesystem::path& path, FileFacts& facts) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return last_error();
    facts = facts_of(status);
    return {};
}

std::error_code check_writable(const std::filesystem::path& path) {
    return ::access(path.c_str(), W_OK) == 0 ? std::error_code() : last_error();
}

std::uint64_t process_number() { return static_cast<std::uint64_t>(::getpid()); }

OpenFile::~OpenFile() {
    if (number_ >= 0) ::close(number_);
}

std::error_code OpenFile::open(const std::filesystem::path& path, How how) {
    number_ = ::open(path.c_str(), flags_of(how) | O_CLOEXEC, 0666);
    if (number_ < 0) return last_error();
    // Nobody waits for somebody who reads from a pipe; who is there may take his time.
    if (how == How::Write) ::fcntl(number_, F_SETFL, ::fcntl(number_, F_GETFL) & ~O_NONBLOCK);
    return {};
}

bool is_of_this_user(const std::filesystem::path& path) {
    struct stat status {};
    return ::lstat(path.c_str(), &status) == 0 && status.st_uid == ::geteuid();
}

std::error_code OpenFile::facts(FileFacts& facts) const {
    struct stat status {};
    if (::fstat(number_, &status) != 0) return last_error();
    facts = facts_of(status);
    return {};
}

std::error_code OpenFile::read(std::span<std::byte> room, std::size_t& count) {
    ssize_t done = 0;
    do done = ::read(number_, room.data(), room.size());
    while (done < 0 && errno == EINTR);
    if (done < 0) return last_error();
    count = static_cast<std::size_t>(done);
    return {};
}

std::error_code OpenFile::write(std::span<const std::byte> content) {
    while (!content.empty()) {
        const ssize_t done = ::write(number_, content.data(), content.size());
        if (done < 0 && errno == EINTR) continue;
        if (done < 0) return last_error();
        content = content.subspan(static_cast<std::size_t>(done));
    }
    return {};
}

bool OpenFile::lock() { return ::flock(number_, LOCK_EX | LOCK_NB) == 0; }
std::error_code OpenFile::reach_disk() { return ::fsync(number_) == 0 ? std::error_code() : last_error(); }

std::error_code OpenFile::close() {
    return ::close(std::exchange(number_, -1)) == 0 ? std::error_code() : last_error();
}

}  // namespace darkroom
