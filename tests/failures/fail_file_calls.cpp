// SPDX-License-Identifier: MIT
// Put before the C library by LD_PRELOAD: of the calls that the program makes for files below DARKROOM_FAIL_FOLDER, one
// fails, number DARKROOM_FAIL_NUMBER, with error DARKROOM_FAIL_ERROR of those that it may have. Each call is one letter
// more in the file DARKROOM_FAIL_LOG.
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdarg>
#include <span>
#include <string_view>

namespace {

/// Not a number of the system's: the call does a part of what was asked.
constexpr int a_part = -1;

struct Kind {
    char letter;
    std::array<int, 4> errors;  ///< up to the first 0
};
constexpr Kind opening{'o', {EACCES, EMFILE, EIO, ENOSPC}}, reading{'r', {EIO, EINTR, a_part}},
    writing{'w', {ENOSPC, EIO, EINTR, a_part}}, renaming{'n', {EACCES, ENOSPC, EIO}}, reaching{'s', {EIO, ENOSPC}},
    closing{'c', {EIO, ENOSPC}}, mapping{'m', {ENOMEM}}, resizing{'t', {ENOSPC, EIO}}, linking{'l', {EACCES, ENOSPC}};

constexpr int max_files = 4096;
std::array<std::atomic<bool>, max_files> is_ours{};
std::atomic<long> calls{0};

const char* variable(const char* name) {
    const char* const value = ::getenv(name);
    return value == nullptr ? "" : value;
}

bool lies_in_folder(const char* path) {
    static const std::string_view folder = variable("DARKROOM_FAIL_FOLDER");
    static const bool is_program = std::string_view(program_invocation_short_name) == "darkroom";
    return is_program && !folder.empty() && std::string_view(path).starts_with(folder);
}

bool is_known(int file) { return file >= 0 && file < max_files && is_ours[static_cast<std::size_t>(file)]; }

void log(char letter) {
    static const char* const path = variable("DARKROOM_FAIL_LOG");
    if (*path == 0) return;
    const long file = ::syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    ::syscall(SYS_write, file, &letter, 1);
    ::syscall(SYS_close, file);
}

/// What this call fails with: 0 for not at all.
int take_failure(const Kind& kind) {
    static const char* const number = variable("DARKROOM_FAIL_NUMBER");
    static const long failing = *number == 0 ? -1 : ::atol(number);
    static const auto error = static_cast<std::size_t>(::atol(variable("DARKROOM_FAIL_ERROR")));
    log(kind.letter);
    if (calls++ != failing) return 0;
    const auto known = static_cast<std::size_t>(std::ranges::find(kind.errors, 0) - kind.errors.begin());
    return kind.errors[error % known];
}

template <class Function>
Function real(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

template <class Back>
Back fail(int error) {
    errno = error;
    return Back(-1);
}

int open_counted(const char* name, const char* path, int flags, mode_t mode) {
    const bool is_counted = lies_in_folder(path);
    if (is_counted)
        if (const int error = take_failure(opening)) return fail<int>(error);
    const int file = real<int (*)(const char*, int, ...)>(name)(path, flags, mode);
    if (file >= 0 && file < max_files) is_ours[static_cast<std::size_t>(file)] = is_counted;
    return file;
}

/// Calls `go` for all bytes, or for the first half of them.
template <class Go>
ssize_t move_bytes(int file, const Kind& kind, std::size_t size, const Go& go) {
    const int error = is_known(file) ? take_failure(kind) : 0;
    if (error > 0) return fail<ssize_t>(error);
    return go(error == a_part ? (size + 1) / 2 : size);
}

int simple(bool is_counted, const Kind& kind) { return is_counted ? take_failure(kind) : 0; }

}  // namespace

// As the C library has it.
// NOLINTBEGIN
extern "C" {

int open(const char* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return open_counted("open", path, flags, mode);
}
int open64(const char* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return open_counted("open64", path, flags, mode);
}
ssize_t read(int file, void* to, std::size_t size) {
    const auto function = real<ssize_t (*)(int, void*, std::size_t)>("read");
    return move_bytes(file, reading, size, [&](std::size_t part) { return function(file, to, part); });
}
ssize_t write(int file, const void* from, std::size_t size) {
    const auto function = real<ssize_t (*)(int, const void*, std::size_t)>("write");
    return move_bytes(file, writing, size, [&](std::size_t part) { return function(file, from, part); });
}
ssize_t pread(int file, void* to, std::size_t size, off_t at) {
    const auto function = real<ssize_t (*)(int, void*, std::size_t, off_t)>("pread");
    return move_bytes(file, reading, size, [&](std::size_t part) { return function(file, to, part, at); });
}
ssize_t pwrite(int file, const void* from, std::size_t size, off_t at) {
    const auto function = real<ssize_t (*)(int, const void*, std::size_t, off_t)>("pwrite");
    return move_bytes(file, writing, size, [&](std::size_t part) { return function(file, from, part, at); });
}
int rename(const char* from, const char* to) {
    if (const int error = simple(lies_in_folder(to), renaming)) return fail<int>(error);
    return real<int (*)(const char*, const char*)>("rename")(from, to);
}
int link(const char* from, const char* to) {
    if (const int error = simple(lies_in_folder(to), linking)) return fail<int>(error);
    return real<int (*)(const char*, const char*)>("link")(from, to);
}
int fsync(int file) {
    if (const int error = simple(is_known(file), reaching)) return fail<int>(error);
    return real<int (*)(int)>("fsync")(file);
}
int fdatasync(int file) {
    if (const int error = simple(is_known(file), reaching)) return fail<int>(error);
    return real<int (*)(int)>("fdatasync")(file);
}
int ftruncate(int file, off_t size) {
    if (const int error = simple(is_known(file), resizing)) return fail<int>(error);
    return real<int (*)(int, off_t)>("ftruncate")(file, size);
}
/// Closed all the same, as on Linux.
int close(int file) {
    const int error = simple(is_known(file), closing);
    if (file >= 0 && file < max_files) is_ours[static_cast<std::size_t>(file)] = false;
    const int done = real<int (*)(int)>("close")(file);
    return error != 0 ? fail<int>(error) : done;
}
void* mmap(void* wanted, std::size_t size, int protection, int flags, int file, off_t at) {
    if (const int error = simple(is_known(file), mapping)) {
        errno = error;
        return MAP_FAILED;
    }
    return real<void* (*)(void*, std::size_t, int, int, int, off_t)>("mmap")(wanted, size, protection, flags, file, at);
}
}
// NOLINTEND
