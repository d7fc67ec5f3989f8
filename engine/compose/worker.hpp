// SPDX-License-Identifier: MIT
#pragma once
// The one thread of a composer: it builds kernels that recordings missed, compiles what compile_later() asked for, and
// frees what recordings put away. If no thread may or can start, kernels stay complete.

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "compose/chain/pass_kernels.hpp"
#include "gpu/device/context.hpp"

namespace darkroom::compose {

/// What a recording took out of use: the worker, or the next compile, frees it.
struct Garbage {
    Garbage() = default;
    Garbage(const Garbage&) = delete;
    Garbage& operator=(const Garbage&) = delete;
    virtual ~Garbage() = default;
};

class Worker {
  public:
    Worker(gpu::Context& context, bool may_start);
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;
    /// Waits for what runs now; nothing runs after it.
    void stop();
    [[nodiscard]] bool is_running() const { return thread_.has_value(); }

    // While recording. These neither wait nor allocate: what cannot be done at once is left for the next recording.
    void want(PassKernels& kernels, const plan::Shape& shape);
    /// Null behind it if it was taken.
    void discard(std::unique_ptr<Garbage>& garbage);

    /// Runs `task` on the thread, after the one that runs now; one that has not begun is replaced.
    void run(std::function<void()> task);
    /// Drops a task that has not begun.
    void cancel();
    /// Frees what was put away, on the calling thread, where no thread does it.
    void clean_up();

  private:
    struct Work {
        std::vector<std::pair<PassKernels*, plan::Shape>> wanted;
        std::vector<std::unique_ptr<Garbage>> garbage;
        std::function<void()> task;
        Work();
        [[nodiscard]] bool is_any() const { return !wanted.empty() || !garbage.empty() || task != nullptr; }
    };
    void work();
    void build(PassKernels& kernels, const plan::Shape& shape);

    gpu::Context& context_;
    std::mutex mutex_;  ///< guards the next two
    Work next_;
    bool is_ending_ = false;
    std::condition_variable is_due_;
    std::optional<std::jthread> thread_;
};

}  // namespace darkroom::compose
