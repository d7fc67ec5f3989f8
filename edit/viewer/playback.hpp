// SPDX-License-Identifier: MIT
#pragma once
// Where a sequence is while it plays: a frame's number that moves with the time, between two ends, round and round or
// once. It knows no files.

#include <cstddef>

namespace app {

class Playback {
  public:
    Playback() = default;
    /// `rate`: frames a second, above 0.
    Playback(std::size_t frames, double rate) : frames_(frames), last_(frames > 0 ? frames - 1 : 0), rate_(rate) {}

    /// False: it stands at its end.
    bool advance(double seconds);
    /// By so many frames, past the ends back in at the others.
    void step(long frames);
    void seek(std::size_t number);
    /// From here on, or up to here; an end that would be before the beginning takes it along.
    void begin_here();
    void end_here();
    void play_all();
    /// Frames a second, brought into [1/1000, 1000].
    void set_rate(double rate);
    void set_looping(bool is_looping) { is_looping_ = is_looping; }

    [[nodiscard]] std::size_t frames() const { return frames_; }
    [[nodiscard]] std::size_t number() const;
    [[nodiscard]] std::size_t first() const { return first_; }
    [[nodiscard]] std::size_t last() const { return last_; }
    [[nodiscard]] double rate() const { return rate_; }
    [[nodiscard]] bool is_looping() const { return is_looping_; }
    [[nodiscard]] bool is_at_end() const { return !is_looping_ && number() >= last_; }

  private:
    std::size_t frames_ = 0, first_ = 0, last_ = 0;
    double rate_ = 60, at_ = 0;  ///< frames a second; in frames
    bool is_looping_ = true;
};

}  // namespace app
