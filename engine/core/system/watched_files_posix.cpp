// SPDX-License-Identifier: MIT
#include "core/system/watched_files.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <string>
#include <tuple>

#include "core/system/spawn.hpp"

namespace darkroom {
namespace {

// For a signal handler: a table of fixed size, since a handler may neither allocate nor lock. A file that finds no
// room, or whose name is too long, is written all the same and left by a signal.
struct Watched {
    enum State : int { Free, Changing, Used };
    std::atomic<int> state{Free};
    std::array<char, 1024> path{};
};
std::array<Watched, 256> watched_files;
static_assert(std::atomic<int>::is_always_lock_free);

std::atomic<int> creating{0};
std::atomic<bool> is_ending{false};

/// While one lives, a file may come to be. The handler waits for it on another thread, so no file appears behind it.
class Creation {
  public:
    Creation() {
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_BLOCK, &all, &before_);
        ++creating;
        if (!is_ending) return;
        --creating;
        for (;;) ::pause();
    }
    Creation(const Creation&) = delete;
    Creation& operator=(const Creation&) = delete;
    ~Creation() {
        --creating;
        ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }

  private:
    sigset_t before_{};
};

// Only what a handler may call (signal-safety(7)). A file system that hangs is waited for a second at most. The signal
// that is raised is blocked until the handler returns.
void remove_watched(int signal) {
    is_ending = true;
    for (int wait = 0; wait < 1000 && creating > 0; ++wait) ::poll(nullptr, 0, 1);
    for (const Watched& file : watched_files)
        if (file.state == Watched::Used) ::unlink(file.path.data());
    if (const int process = process_that_ends_with_us; process > 0) ::kill(process, signal);
    ::signal(signal, SIG_DFL);
    ::raise(signal);
}

}  // namespace

int watch_file(const std::filesystem::path& path) noexcept {
    const std::string& name = path.native();
    if (name.size() >= watched_files[0].path.size()) return -1;
    for (std::size_t i = 0; i < watched_files.size(); ++i) {
        int free = Watched::Free;
        if (!watched_files[i].state.compare_exchange_strong(free, Watched::Changing)) continue;
        std::copy_n(name.c_str(), name.size() + 1, watched_files[i].path.data());
        watched_files[i].state = Watched::Used;
        return static_cast<int>(i);
    }
    return -1;
}

void unwatch_file(int place) noexcept {
    if (place >= 0) watched_files[static_cast<std::size_t>(place)].state = Watched::Free;
}

void create_watched(const std::function<void()>& create) {
    const Creation creation;
    create();
}

void remove_watched_files_on_signals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
        action = {};
        action.sa_handler = remove_watched;
        ::sigfillset(&action.sa_mask);
        std::ignore = ::sigaction(signal, &action, nullptr);
    }
}

}  // namespace darkroom
