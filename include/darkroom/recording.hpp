// SPDX-License-Identifier: MIT
#pragma once
// What a Composer tells of recordings that have finished, and of a compile that has not.

#include <cstdint>
#include <darkroom/result.hpp>
#include <optional>
#include <span>
#include <string_view>

namespace darkroom {

struct PassTime {
    std::string_view name;
    double milliseconds = 0;
};
/// Times of one finished recording: those of its own passes. Valid until the Composer records or compiles again.
struct RecordingTimes {
    std::uint64_t frame_index = 0;  ///< Frame::frame_index of that recording
    std::span<const PassTime> passes;
};

/// What a value was when an earlier recording had run; no numbers: none has finished yet, or the plan has no such
/// value. Valid until the Composer records or compiles again.
struct ValueReading {
    std::uint64_t frame_index = 0;  ///< Frame::frame_index of that recording
    std::span<const float> numbers;
};

/// What became of compile_later().
struct PendingCompile {
    bool is_pending = false;     ///< under way, or ready
    bool is_ready = false;       ///< the next record takes it, if its frame has the formats and extents that it is for
    std::optional<Error> error;  ///< why the last one failed; the plan before it goes on
};

}  // namespace darkroom
