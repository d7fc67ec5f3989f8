// SPDX-License-Identifier: MIT
#pragma once
// Work on several threads that are started for it and are gone afterwards. A machine or a host that allows no further
// thread makes it slower and nothing else. What lives longer than one call needs a thread of its own: start_thread().

#include <cstddef>
#include <functional>
#include <optional>
#include <thread>

namespace darkroom {

/// Starts a thread, or throws std::system_error as std::jthread does.
using StartThread = std::function<std::jthread(const std::function<void()>& run)>;

/// A thread that runs `run`, or nothing where none can be started.
[[nodiscard]] std::optional<std::jthread> start_thread(const std::function<void()>& run, const StartThread& start = {});

/// Calls `work(i)` once for every i below `count`, in no certain order, on at most `max_threads` threads, and waits.
/// The calling thread is one of them. 0 stands for the number of processors. The first exception that leaves `work`, on
/// whichever thread, is thrown to the caller once all threads have ended; no further call is begun after it.
void parallel_for(std::size_t count, std::size_t max_threads, const std::function<void(std::size_t)>& work,
                  const StartThread& start = {});

}  // namespace darkroom
