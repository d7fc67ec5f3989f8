// SPDX-License-Identifier: MIT
#include "core/thread/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace darkroom {
namespace {

using Clock = std::chrono::steady_clock;
using Stage = std::function<Result<>(std::size_t)>;

double since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

Result<> run_stage(const Stage& stage, std::size_t item) {
    try {
        return stage(item);
    } catch (const std::bad_alloc&) {
        return machine_error("out of memory");
    } catch (const std::exception& error) {
        return machine_error(error.what());
    }
}

class Run {
  public:
    Run(const PipelineDesc& desc, const PipelineStages& stages)
        : desc_(desc), stages_(stages), results_(desc.count), states_(desc.count, State::Waiting) {}

    PipelineTimes run() {
        const Clock::time_point start = Clock::now();
        std::vector<std::jthread> workers;
        while (workers.size() < std::min(desc_.worker_count(), desc_.count)) {
            std::optional<std::jthread> worker = start_thread([this] { work(); }, desc_.start);
            if (!worker) break;
            workers.push_back(std::move(*worker));
        }
        has_workers_ = !workers.empty();
        conduct();
        workers.clear();
        times_.workers = std::max<std::size_t>(1, desc_.worker_count());
        times_.wall = since(start);
        return times_;
    }

  private:
    enum class State { Waiting, Decoding, Decoded, Begun, Encoding, Done };
    using Lock = std::unique_lock<std::mutex>;

    /// No item from here on is begun any more.
    [[nodiscard]] std::size_t end() const { return std::min(desc_.count, stop_); }

    /// One piece of work for any thread: what is nearest to its end goes first. False: there is none now.
    bool work_once(Lock& lock) {
        if (!to_encode_.empty()) {
            const std::size_t item = to_encode_.front();
            to_encode_.pop_front();
            Result<> done = timed(lock, stages_.encode, item, times_.encode);
            end_item(lock, item, std::move(done));
            return true;
        }
        if (next_ >= end() || next_ - reported_ >= desc_.window()) return false;
        const std::size_t item = next_++;
        ++alive_;
        states_[item] = State::Decoding;
        Result<> done = timed(lock, stages_.decode, item, times_.decode);
        if (done)
            states_[item] = State::Decoded;
        else
            end_item(lock, item, std::move(done));
        changed_.notify_all();
        return true;
    }

    Result<> timed(Lock& lock, const Stage& stage, std::size_t item, double& sum) {
        lock.unlock();
        const Clock::time_point start = Clock::now();
        Result<> done = run_stage(stage, item);
        const double milliseconds = since(start);
        lock.lock();
        sum += milliseconds;
        return done;
    }

    void end_item(Lock& lock, std::size_t item, Result<> result) {
        if (!result && !desc_.keeps_going) stop_ = std::min(stop_, item);
        results_[item] = std::move(result);
        states_[item] = State::Done;
        --alive_;
        changed_.notify_all();
        report(lock);
    }

    /// Outside of the lock, since whoever is told may take long: a slow pipe holds up no other item within the window.
    void report(Lock& lock) {
        if (std::exchange(is_reporting_, true)) return;  // who is at it comes to this item, too
        while (reported_ < desc_.count && states_[reported_] == State::Done) {
            if (reported_ <= stop_) {
                lock.unlock();
                stages_.is_done(reported_, results_[reported_]);
                lock.lock();
            }
            ++reported_;
            changed_.notify_all();
        }
        is_reporting_ = false;
    }

    void work() {
        Lock lock(mutex_);
        while (!is_over_)
            if (!work_once(lock)) changed_.wait(lock);
    }

    /// The calling thread waits for others, or does their work where there are none.
    void wait(Lock& lock, double& sum) {
        const Clock::time_point start = Clock::now();
        if (has_workers_) {
            changed_.wait(lock);
            sum += since(start);
        } else {
            work_once(lock);
        }
    }

    void finish_oldest(Lock& lock) {
        const std::size_t item = begun_.front();
        begun_.pop_front();
        Result<> done = timed(lock, stages_.finish, item, times_.work);
        if (!done) return end_item(lock, item, std::move(done));
        states_[item] = State::Encoding;
        to_encode_.push_back(item);
        changed_.notify_all();
    }

    void conduct() {
        Lock lock(mutex_);
        for (std::size_t item = 0; item < end() || !begun_.empty();) {
            const bool is_left = item < end();
            if (is_left && states_[item] == State::Done) {
                ++item;
            } else if (is_left && states_[item] == State::Decoded && begun_.size() < desc_.in_flight) {
                states_[item] = State::Begun;
                Result<> done = timed(lock, stages_.begin, item, times_.work);
                if (done)
                    begun_.push_back(item);
                else
                    end_item(lock, item, std::move(done));
                ++item;
            } else if (!begun_.empty()) {
                finish_oldest(lock);
            } else {
                wait(lock, times_.wait_for_decode);
            }
        }
        while (alive_ > undone_decoded() || is_reporting_) wait(lock, times_.wait_for_encode);
        is_over_ = true;
        changed_.notify_all();
    }

    /// Items that were decoded before the work was ended, and that nobody wants any more.
    [[nodiscard]] std::size_t undone_decoded() const {
        return static_cast<std::size_t>(std::ranges::count(states_, State::Decoded));
    }

    const PipelineDesc& desc_;
    const PipelineStages& stages_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Result<>> results_;
    std::vector<State> states_;
    std::deque<std::size_t> begun_, to_encode_;
    std::size_t next_ = 0, alive_ = 0, reported_ = 0;
    std::size_t stop_ = static_cast<std::size_t>(-1);
    bool is_over_ = false, has_workers_ = false, is_reporting_ = false;
    PipelineTimes times_;
};

}  // namespace

std::size_t PipelineDesc::worker_count() const {
    return jobs > 0 ? jobs : std::max(1U, std::thread::hardware_concurrency());
}

PipelineTimes run_pipeline(const PipelineDesc& desc, const PipelineStages& stages) { return Run(desc, stages).run(); }

}  // namespace darkroom
