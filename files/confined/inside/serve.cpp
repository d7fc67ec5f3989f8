// SPDX-License-Identifier: MIT
#include "confined/inside/serve.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <thread>

#include "confined/exchange.hpp"
#include "confined/messages.hpp"
#include "core/thread/parallel.hpp"

namespace darkroom {

namespace {

/// A program that is gone, by whatever end, leaves no process at work behind.
void end_with_program() {
    pollfd program{.fd = socket_of_program, .events = POLLRDHUP, .revents = 0};
    while (poll(&program, 1, -1) < 0 && errno == EINTR) {
    }
    _exit(0);
}

}  // namespace

bool greet(std::string_view error) {
    // Without it this process ends when it is asked no more.
    if (std::optional<std::jthread> watching = start_thread(end_with_program)) watching->detach();
    error = error.substr(0, max_error_bytes);
    const ConfinedGreeting greeting{.error_size = static_cast<std::uint32_t>(error.size())};
    return send_all(socket_of_program, &greeting, sizeof greeting) &&
           send_all(socket_of_program, error.data(), error.size());
}

}  // namespace darkroom
