// SPDX-License-Identifier: MIT
#include "compose/worker.hpp"

#include "core/caught.hpp"
#include "core/thread/parallel.hpp"

namespace darkroom::compose {

/// Room for what a few recordings ask for; more waits for the next ones.
Worker::Work::Work() {
    wanted.reserve(256);
    garbage.reserve(64);
}

Worker::Worker(gpu::Context& context, bool may_start) : context_(context) {
    if (may_start) thread_ = start_thread([this] { work(); });
}

void Worker::stop() {
    {
        const std::scoped_lock lock(mutex_);
        is_ending_ = true;
    }
    is_due_.notify_one();
    thread_.reset();
}

Worker::~Worker() { stop(); }

void Worker::want(PassKernels& kernels, const plan::Shape& shape) {
    if (!thread_ || kernels.is_wanted(shape)) return;
    {
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (!lock || next_.wanted.size() == next_.wanted.capacity()) return;
        next_.wanted.emplace_back(&kernels, shape);
    }
    kernels.set_wanted(shape);
    is_due_.notify_one();
}

void Worker::discard(std::unique_ptr<Garbage>& garbage) {
    {
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (!lock || next_.garbage.size() == next_.garbage.capacity()) return;
        next_.garbage.push_back(std::move(garbage));
    }
    is_due_.notify_one();
}

void Worker::run(std::function<void()> task) {
    {
        const std::scoped_lock lock(mutex_);
        next_.task.swap(task);
    }
    is_due_.notify_one();
}

void Worker::cancel() {
    std::function<void()> task;
    const std::scoped_lock lock(mutex_);
    next_.task.swap(task);
}

void Worker::clean_up() {
    if (!thread_) next_.garbage.clear();
}

void Worker::build(PassKernels& kernels, const plan::Shape& shape) {
    try {
        if (const auto ok = kernels.build(context_, shape); !ok)
            context_.say(Severity::Warning, "a lean kernel could not be built: " + ok.error().text);
    } catch (...) {
        context_.say(Severity::Warning, caught("building a lean kernel").value().text);
    }
}

void Worker::work() {
    Work now;
    const auto is_ending = [this] {
        const std::scoped_lock lock(mutex_);
        return is_ending_;
    };
    while (true) {
        {
            std::unique_lock lock(mutex_);
            is_due_.wait(lock, [this] { return is_ending_ || next_.is_any(); });
            if (is_ending_) return;
            std::swap(now, next_);
        }
        // In this order: a recording wishes for kernels of its chain before it puts that chain away.
        for (const auto& [kernels, shape] : now.wanted)
            if (!is_ending()) build(*kernels, shape);
        now.wanted.clear();
        now.garbage.clear();
        if (now.task && !is_ending()) now.task();
        now.task = nullptr;
    }
}

}  // namespace darkroom::compose
