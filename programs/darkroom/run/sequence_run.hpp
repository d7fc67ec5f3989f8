// SPDX-License-Identifier: MIT
#pragma once
// Many frames through decoding, the device and encoding, which overlap: who calls says what each stage does, this says
// how far the work has come, what failed, and where the time went.

#include <darkroom/composer.hpp>
#include <darkroom/result.hpp>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/thread/pipeline.hpp"
#include "report.hpp"

namespace app {

struct SequenceStages {
    std::function<darkroom::Result<>(std::size_t)> decode, begin, finish, encode;  ///< as in PipelineStages
    /// What has been encoded goes out, in order; may be left out. A failure ends the work.
    std::function<darkroom::Result<>(std::size_t)> deliver{};
    /// What a step has made; nothing: it makes no picture.
    std::function<std::optional<Made>(std::size_t)> made;
    std::function<void(std::size_t)> release;  ///< the step is over, its memory can go
};

struct SequenceDesc {
    std::size_t steps = 0, pictures = 0;
    std::size_t jobs = 0, in_flight = 1;
    bool keeps_going = false, has_timings = false;
};

/// The error is that of the first step that failed; where the others went on, all have been told, and it counts them.
[[nodiscard]] darkroom::Result<> run_sequence(const SequenceDesc& desc, const SequenceStages& stages);

/// GPU milliseconds of passes, frame by frame.
class PassTimes {
  public:
    void add(std::span<const darkroom::PassTime> passes);
    /// Of one frame each pass, of several the means.
    void print() const;

  private:
    std::vector<std::string> order_;
    std::map<std::string, double> sums_;
    std::size_t frames_ = 0;
};

}  // namespace app
