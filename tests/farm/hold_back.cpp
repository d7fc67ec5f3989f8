// SPDX-License-Identifier: MIT
// Put before the C library by LD_PRELOAD: a file beside which lies another of its name with ".held" is opened when that
// one has gone. A test says so when a frame comes.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <cstdarg>
#include <string>

namespace {

using Open = int (*)(const char*, int, ...);

int open_later(const char* name, const char* path, int flags, mode_t mode) {
    const std::string held = std::string(path) + ".held";
    while (::access(held.c_str(), F_OK) == 0) ::usleep(10'000);
    return reinterpret_cast<Open>(::dlsym(RTLD_NEXT, name))(path, flags, mode);
}

}  // namespace

extern "C" int open(const char* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return open_later("open", path, flags, mode);
}

extern "C" int open64(const char* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return open_later("open64", path, flags, mode);
}
