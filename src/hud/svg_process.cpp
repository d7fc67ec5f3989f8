// SPDX-License-Identifier: MIT
#include "hud/svg_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "core/program_module.hpp"
#include "core/spawn.hpp"
#include "core/text/param_text.hpp"
#include "hud/svg_messages.hpp"

namespace darkroom {

namespace {

/// Longer ones are no error texts.
constexpr std::uint32_t most_error_bytes = 65536;

Failure failed(const char* what) {
    return machine_error(fmt::format("drawing SVG: {}: {}", what, std::strerror(errno)));
}

bool send_all(int socket, const void* data, std::size_t size) {
    for (const auto* at = static_cast<const char*>(data); size > 0;) {
        const ssize_t sent = send(socket, at, size, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        at += sent;
        size -= static_cast<std::size_t>(sent);
    }
    return true;
}

bool receive(int socket, void* data, std::size_t size) {
    for (auto* at = static_cast<char*>(data); size > 0;) {
        const ssize_t got = recv(socket, at, size, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        at += got;
        size -= static_cast<std::size_t>(got);
    }
    return true;
}

/// Out of the way of the numbers that the process will give to its own.
int lifted(int descriptor) {
    if (descriptor < 0) return descriptor;
    const int high = fcntl(descriptor, F_DUPFD_CLOEXEC, 10);
    close(descriptor);
    return high;
}

}  // namespace

Result<> SvgProcess::start() {
    if (process_ >= 0) return {};
    const std::string path = program_module("darkroom_svg").string();
    int ends[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return failed("making a socket");
    const int other = lifted(ends[1]);
    {
        const std::lock_guard lock(mutex_);
        socket_ = lifted(ends[0]);
        if (is_cancelled_) shutdown(socket_, SHUT_RDWR);
    }
    // Of one size, which neither side can change: no page of it is ever missing. It takes what is drawn alone.
    memory_ = lifted(memfd_create("darkroom_svg", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (ftruncate(memory_, static_cast<off_t>(limits_.pixels) * 4) != 0 ||
        fcntl(memory_, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) {
        const int reason = errno;
        close(other);
        stop();
        errno = reason;
        return failed("memory for a picture");
    }
    // A drawing ends itself in time; a second more, and it hangs.
    const timeval most{.tv_sec = static_cast<time_t>(limits_.seconds) + 1, .tv_usec = 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &most, sizeof most);
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &most, sizeof most);

    const std::array arguments{std::string("darkroom_svg")};
    const int reason = Spawn()
                           .give(other, STDIN_FILENO)
                           .open(STDOUT_FILENO, "/dev/null", O_WRONLY)
                           .open(STDERR_FILENO, "/dev/null", O_WRONLY)
                           .give(memory_, svg_memory_descriptor)
                           .close_from(svg_memory_descriptor + 1)
                           .start(process_, path, arguments);
    close(other);
    if (reason == 0) return {};
    process_ = -1;
    stop();
    errno = reason;
    return failed(path.c_str());
}

void SvgProcess::cancel() {
    const std::lock_guard lock(mutex_);
    is_cancelled_ = true;
    if (socket_ >= 0) shutdown(socket_, SHUT_RDWR);
}

void SvgProcess::stop() {
    {
        const std::lock_guard lock(mutex_);
        if (socket_ >= 0) close(socket_);
        socket_ = -1;
    }
    if (memory_ >= 0) close(memory_);
    if (process_ >= 0) {
        kill(process_, SIGKILL);
        while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }
    process_ = memory_ = -1;
}

Result<HudPicture> SvgProcess::draw(std::string_view document, std::uint32_t width, std::uint32_t height) {
    const std::uint64_t pixels = std::uint64_t{width} * height;
    if (width == 0 || height == 0 || width > limits_.side || height > limits_.side || pixels > limits_.pixels)
        return user_error(fmt::format("a picture of {}x{}: allowed is [1, {}] a side, at most {} pixels", width, height,
                                      limits_.side, limits_.pixels));
    if (document.size() > limits_.document_bytes)
        return user_error(fmt::format("{} bytes: allowed are {}", document.size(), limits_.document_bytes));
    if (auto started = start(); !started) return failure(std::move(started));

    // What larger pictures left is given back.
    const std::size_t size = pixels * 4, all = std::size_t{limits_.pixels} * 4;
    if (all > size)
        static_cast<void>(fallocate(memory_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(size),
                                    static_cast<off_t>(all - size)));
    const SvgRequest request{static_cast<std::uint32_t>(document.size()), width, height, limits_.seconds};
    SvgReply reply;
    std::string error;
    bool is_answered = send_all(socket_, &request, sizeof request) &&
                       send_all(socket_, document.data(), document.size()) && receive(socket_, &reply, sizeof reply) &&
                       reply.error_size <= most_error_bytes;
    if (is_answered) {
        error.resize(reply.error_size);
        is_answered = receive(socket_, error.data(), error.size());
    }
    if (!is_answered) {
        stop();
        return user_error(fmt::format("it takes more than {} s or too much memory to draw", limits_.seconds));
    }
    if (!error.empty()) return user_error(std::move(error));

    HudPicture picture{width, height, std::vector<std::uint8_t>(size)};
    for (std::size_t at = 0; at < size;) {
        const ssize_t got = pread(memory_, picture.rgba.data() + at, size - at, static_cast<off_t>(at));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return failed("memory of a picture");
        at += static_cast<std::size_t>(got);
    }
    return picture;
}

}  // namespace darkroom
