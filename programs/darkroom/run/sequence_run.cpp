// SPDX-License-Identifier: MIT
#include "sequence_run.hpp"

#include <fmt/format.h>

#include <atomic>

namespace app {

using darkroom::PipelineTimes;
using darkroom::Result;

namespace {

void print_stages(const PipelineTimes& times, std::size_t pictures) {
    const double count = static_cast<double>(std::max<std::size_t>(1, pictures));
    const auto share = [&](double milliseconds) { return 100 * milliseconds / times.wall; };
    answer(fmt::format("{:>10.3f} ms  decode a frame, on {} threads", times.decode / count, times.workers));
    answer(fmt::format(
        "{:>10.3f} ms  upload, GPU and read-back a frame, on one; it waited {:.0f} % of the time for decode",
        times.work / count, share(times.wait_for_decode)));
    answer(fmt::format("{:>10.3f} ms  encode a frame, on {} threads; the last ones took {:.0f} % of the time",
                       times.encode / count, times.workers, share(times.wait_for_encode)));
    answer(fmt::format("{:>10.3f} ms  a frame, overlapped: {:.2f} frames a second", times.wall / count,
                       1000 * count / times.wall));
}

}  // namespace

Result<> run_sequence(const SequenceDesc& desc, const SequenceStages& stages) {
    survive_closed_pipes();
    std::vector<darkroom::Error> failures;
    PipelineTimes times;
    std::atomic<bool> is_undeliverable = false;
    const auto encode = [&](std::size_t step) -> Result<> {
        // The failure that counts has been noted.
        return is_undeliverable
                   ? darkroom::machine_error("standard output: the program that read the pictures has ended")
                   : stages.encode(step);
    };
    {
        Progress progress(desc.pictures);
        const auto is_done = [&](std::size_t step, const Result<>& encoded) {
            const Result<> result = encoded && stages.deliver && !is_undeliverable ? stages.deliver(step) : encoded;
            is_undeliverable = is_undeliverable || (encoded && !result);
            if (!result) {
                failures.push_back(result.error());
                progress.fail(result.error());
            } else if (const std::optional<Made> made = stages.made(step)) {
                progress.step(*made);
            }
            stages.release(step);
        };
        times = darkroom::run_pipeline(
            {.count = desc.steps, .jobs = desc.jobs, .in_flight = desc.in_flight, .keeps_going = desc.keeps_going},
            {.decode = stages.decode,
             .begin = stages.begin,
             .finish = stages.finish,
             .encode = encode,
             .is_done = is_done});
    }
    if (desc.has_timings && desc.pictures > 1) print_stages(times, desc.pictures);
    if (failures.empty()) return {};
    if (!desc.keeps_going) return failure(failures.front());
    for (const darkroom::Error& error : failures) complain(error.text);
    return darkroom::user_error(fmt::format("{} of {} frames failed", failures.size(), desc.steps));
}

void PassTimes::add(std::span<const darkroom::PassTime> passes) {
    ++frames_;
    for (const darkroom::PassTime& pass : passes) {
        const auto [sum, is_new] = sums_.try_emplace(std::string(pass.name), 0);
        if (is_new) order_.emplace_back(pass.name);
        sum->second += pass.milliseconds;
    }
}

void PassTimes::print() const {
    if (order_.empty()) {
        warn("this device has no timestamps");
        return;
    }
    double together = 0;
    for (const std::string& name : order_) {
        const double mean = sums_.at(name) / static_cast<double>(frames_);
        answer(fmt::format("{:>10.3f} ms  {}", mean, name));
        together += mean;
    }
    answer(fmt::format("{:>10.3f} ms  together{}", together, frames_ > 1 ? ", means of all frames" : ""));
}

}  // namespace app
