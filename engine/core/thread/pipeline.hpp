// SPDX-License-Identifier: MIT
#pragma once
// A list of items through three stages that overlap: decoded ahead by workers, worked on in order by the calling thread
// (which may have several under way on a device), encoded behind by the workers. At most `window` items are between the
// beginning of their decoding and the end of is_done, which bounds the memory.

#include <cstddef>
#include <darkroom/result.hpp>
#include <functional>

#include "core/thread/parallel.hpp"

namespace darkroom {

/// Called with the number of an item. An item that failed in one stage enters no other. Exceptions count as failures of
/// the machine.
struct PipelineStages {
    std::function<Result<>(std::size_t)> decode;         ///< any thread, several at a time
    std::function<Result<>(std::size_t)> begin, finish;  ///< the calling thread, both in the order of the items
    std::function<Result<>(std::size_t)> encode;         ///< any thread, several at a time
    /// In order, one at a time; any thread. While it runs, other items go on.
    std::function<void(std::size_t, const Result<>&)> is_done;
};

struct PipelineDesc {
    std::size_t count = 0;
    std::size_t jobs = 0;       ///< workers beside the calling thread, 0: as many as there are processors
    std::size_t in_flight = 1;  ///< items between begin and finish, at most
    /// False: the first failure ends the work; items before it are still done, and none after it is begun.
    bool keeps_going = false;
    StartThread start{};

    [[nodiscard]] std::size_t worker_count() const;
    [[nodiscard]] std::size_t window() const { return worker_count() + in_flight + 2; }
};

/// Milliseconds, over all items and threads.
struct PipelineTimes {
    double decode = 0, work = 0, encode = 0;  ///< of these stages, waiting not counted
    double wait_for_decode = 0;               ///< the calling thread had nothing to begin or to finish
    double wait_for_encode = 0;               ///< and then waited for the last items to be encoded
    double wall = 0;
    std::size_t workers = 0;
};

PipelineTimes run_pipeline(const PipelineDesc& desc, const PipelineStages& stages);

}  // namespace darkroom
