// SPDX-License-Identifier: MIT
#include "compose/worker.hpp"

#include <utility>

#include "core/caught.hpp"
#include "core/thread/parallel.hpp"

namespace darkroom::compose {

Worker::Worker(gpu::Context& context, bool may_start) : context_(context) {
    if (may_start) thread_ = start_thread([this] { work(); });
}

void Worker::stop() {
    is_ending_ = true;
    wake();
    thread_.reset();
}

Worker::~Worker() {
    stop();
    free_garbage(garbage_.take_all());
}

void Worker::want(PassKernels& kernels, const plan::Shape& shape) {
    if (thread_ && kernels.want(shape)) wanted_.push(kernels);
}

void Worker::wake() {
    calls_.fetch_add(1, std::memory_order_release);
    calls_.notify_one();
}

void Worker::run(std::function<void()> task) {
    {
        const std::scoped_lock lock(task_mutex_);
        task_ = std::move(task);
    }
    wake();
}

void Worker::cancel() {
    const std::scoped_lock lock(task_mutex_);
    task_ = nullptr;
}

void Worker::clean_up() {
    if (!thread_) free_garbage(garbage_.take_all());
}

void Worker::build_wanted(PassKernels* list) {
    while (list != nullptr && !is_ending_) {
        PassKernels* const after = list->next;  // once its wish is taken, it may be pushed again
        try {
            if (const std::optional<plan::Shape> shape = list->take_wanted())
                if (const auto ok = list->build(context_, *shape); !ok)
                    context_.say(Severity::Warning, "a lean kernel could not be built: " + ok.error().text);
        } catch (...) {
            context_.say(Severity::Warning, caught("building a lean kernel").value().text);
        }
        list = after;
    }
}

void Worker::work() {
    std::uint32_t seen = 0;
    while (!is_ending_) {
        calls_.wait(seen, std::memory_order_acquire);
        seen = calls_.load(std::memory_order_acquire);
        // In this order: a recording wishes for kernels of its chain before it puts that chain away.
        Garbage* const garbage = garbage_.take_all();
        build_wanted(wanted_.take_all());
        free_garbage(garbage);
        std::function<void()> task;
        {
            const std::scoped_lock lock(task_mutex_);
            std::swap(task, task_);
        }
        if (task && !is_ending_) task();
    }
}

}  // namespace darkroom::compose
