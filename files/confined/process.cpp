// SPDX-License-Identifier: MIT
#include "confined/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <vector>

#include "confined/exchange.hpp"
#include "confined/messages.hpp"
#include "core/program_module.hpp"
#include "core/system/spawn.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

/// What brings many libraries starts in this time even from a slow disk.
constexpr std::uint32_t seconds_to_start = 60;

/// Out of the way of the numbers that the process will give to its own.
Descriptor lifted(int descriptor) {
    const Descriptor low(descriptor);
    return Descriptor(fcntl(descriptor, F_DUPFD_CLOEXEC, 10));
}

std::atomic<bool> may_be_unconfined{false};

std::string end_of(int status) {
    if (WIFSIGNALED(status))
        return fmt::format("was ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    return fmt::format("ended with code {}", WEXITSTATUS(status));
}

}  // namespace

Failure ConfinedProcess::failed(const std::string& why) const {
    return machine_error(fmt::format("{}: {}", program_module(program_.c_str()).string(), why));
}

void ConfinedProcess::allow_unconfined(bool is_allowed) { may_be_unconfined = is_allowed; }

bool ConfinedProcess::allows_unconfined() { return may_be_unconfined; }

bool ConfinedProcess::is_running() const {
    siginfo_t ended{};
    return process_ >= 0 && waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           ended.si_pid == 0;
}

Result<> ConfinedProcess::start(std::span<const std::string> arguments) {
    if (is_running()) return {};
    static_cast<void>(stop());
    int ends[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return failed(std::strerror(errno));
    Descriptor other = lifted(ends[1]);
    {
        const std::lock_guard lock(mutex_);
        socket_ = lifted(ends[0]);
        if (is_cancelled_) shutdown(socket_.number(), SHUT_RDWR);
    }
    if (!socket_.is_open() || !other.is_open()) return failed(std::strerror(EMFILE));
    std::vector<std::string> all{program_};
    all.insert(all.end(), arguments.begin(), arguments.end());
    if (may_be_unconfined) all.emplace_back(allow_unconfined_flag);
    const int reason = Spawn()
                           .give(other.number(), STDIN_FILENO)
                           .open(STDOUT_FILENO, "/dev/null", O_WRONLY)
                           .open(STDERR_FILENO, "/dev/null", O_WRONLY)
                           .close_from(STDERR_FILENO + 1)
                           .start(process_, program_module(program_.c_str()).string(), all);
    other.close();
    if (reason != 0) {
        process_ = -1;
        static_cast<void>(stop());
        return failed(std::strerror(reason));
    }
    limit_wait(seconds_to_start);
    ConfinedGreeting greeting;
    std::string error;
    bool is_there = receive(&greeting, sizeof greeting) && greeting.error_size <= max_error_bytes;
    if (is_there) {
        error.resize(greeting.error_size);
        is_there = receive(error.data(), error.size());
    }
    if (is_there && error.empty()) return {};
    const std::string end = stop();
    return failed(is_there ? printable(error) : end);
}

void ConfinedProcess::limit_memory(std::uint64_t bytes) const {
    if (is_sanitized) return;
    rlimit own{};
    getrlimit(RLIMIT_AS, &own);
    // What may be asked for later cannot be more than what is allowed now: the upper limit stays, and the process can
    // change neither.
    own.rlim_cur = std::min<rlim_t>(own.rlim_max, bytes);
    prlimit(process_, RLIMIT_AS, &own, nullptr);
}

void ConfinedProcess::limit_wait(std::uint32_t seconds) const {
    if (max_seconds_ == seconds) return;
    max_seconds_ = seconds;
    const timeval most{.tv_sec = static_cast<time_t>(seconds), .tv_usec = 0};
    setsockopt(socket_.number(), SOL_SOCKET, SO_RCVTIMEO, &most, sizeof most);
    setsockopt(socket_.number(), SOL_SOCKET, SO_SNDTIMEO, &most, sizeof most);
}

bool ConfinedProcess::send(const void* data, std::size_t size, std::span<const int> descriptors) const {
    errno = 0;
    const bool is_sent = send_all(socket_.number(), data, size, descriptors);
    if (!is_sent && errno == EAGAIN) is_late_ = true;
    return is_sent;
}

bool ConfinedProcess::receive(void* data, std::size_t size) const {
    errno = 0;
    const bool is_there = receive_all(socket_.number(), data, size);
    if (!is_there && errno == EAGAIN) is_late_ = true;
    return is_there;
}

void ConfinedProcess::cancel() {
    const std::lock_guard lock(mutex_);
    is_cancelled_ = true;
    if (socket_.is_open()) shutdown(socket_.number(), SHUT_RDWR);
}

std::string ConfinedProcess::stop() {
    {
        const std::lock_guard lock(mutex_);
        socket_.close();
    }
    int status = 0;
    if (process_ >= 0) {
        // One that is ending already keeps its own reason.
        kill(process_, SIGKILL);
        while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
    }
    process_ = -1;
    std::string out = is_late_ ? fmt::format("took more than {} s", max_seconds_) : end_of(status);
    is_late_ = false;
    max_seconds_ = 0;
    return out;
}

}  // namespace darkroom
