// SPDX-License-Identifier: MIT
#include "core/thread/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <vector>

namespace darkroom {

std::optional<std::jthread> start_thread(const std::function<void()>& run, const StartThread& start) {
    try {
        return start ? start(run) : std::jthread(run);
    } catch (const std::system_error&) {
        return {};
    }
}

void parallel_for(std::size_t count, std::size_t max_threads, const std::function<void(std::size_t)>& work,
                  const StartThread& start) {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> is_stopped{false};
    std::exception_ptr first;
    const auto run = [&] {
        try {
            for (std::size_t i = next++; i < count && !is_stopped; i = next++) work(i);
        } catch (...) {
            if (!is_stopped.exchange(true)) first = std::current_exception();
        }
    };
    const std::size_t allowed = max_threads > 0 ? max_threads : std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> threads;
    while (threads.size() + 1 < std::min(allowed, count)) {
        std::optional<std::jthread> thread = start_thread(run, start);
        if (!thread) break;
        threads.push_back(std::move(*thread));
    }
    run();
    threads.clear();
    if (first) std::rethrow_exception(first);
}

}  // namespace darkroom
