// SPDX-License-Identifier: MIT
#pragma once
// The one thread of a composer: it builds kernels that recordings missed, compiles what compile_later() asked for, and
// frees what recordings put away. If no thread may or can start, kernels stay complete.

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "compose/atomic_stack.hpp"
#include "compose/chain/pass_kernels.hpp"
#include "gpu/device/context.hpp"

namespace darkroom::compose {

class Worker {
  public:
    Worker(gpu::Context& context, bool may_start);
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;
    /// Waits for what runs now; nothing runs after it.
    void stop();
    [[nodiscard]] bool is_running() const { return thread_.has_value(); }

    // While recording: never waits.
    void want(PassKernels& kernels, const plan::Shape& shape);
    void discard(Garbage& garbage) { garbage_.push(garbage); }
    [[nodiscard]] AtomicStack<Garbage>& garbage() { return garbage_; }
    /// There is something to do.
    void wake();

    /// Runs `task` on the thread, after the one that runs now; one that has not begun is replaced.
    void run(std::function<void()> task);
    /// Drops a task that has not begun.
    void cancel();
    /// Frees what was put away, on the calling thread, where no thread does it.
    void clean_up();

  private:
    void work();
    void build_wanted(PassKernels* list);

    gpu::Context& context_;
    AtomicStack<Garbage> garbage_;
    AtomicStack<PassKernels> wanted_;
    std::mutex task_mutex_;
    std::function<void()> task_;
    std::atomic<std::uint32_t> calls_{0};
    std::atomic<bool> is_ending_{false};
    std::optional<std::jthread> thread_;
};

}  // namespace darkroom::compose
