// SPDX-License-Identifier: MIT
#pragma once
// How much of the picture a viewer draws: what a hand moves may be smaller, by the time that frames take on the device;
// what time alone moves has all pixels, or what a frame time leaves of them.

#include <array>
#include <chrono>
#include <darkroom/device.hpp>
#include <optional>

#include "gpu/resource/resources.hpp"
#include "scale_choice.hpp"
#include "window/presenter.hpp"

namespace app {

inline constexpr std::uint32_t frames_in_flight = 2;

class DrawScale {
  public:
    using Clock = std::chrono::steady_clock;
    /// `frame_time`: seconds that a frame may take whoever moves it; nothing: what a hand feels as no delay.
    explicit DrawScale(std::optional<double> frame_time = std::nullopt);

    struct Turn {
        Clock::time_point now;
        double passed = 0;        ///< seconds since the frame before
        bool has_rested = false;  ///< nothing was drawn in between
        bool is_moved = false;    ///< by a hand
        bool is_running = false;  ///< time moves it, too
        bool gathers = false;     ///< its picture is made of several frames
        bool may_reduce = true;
    };
    /// Of the frame that comes.
    void choose(const Turn& turn);
    /// Of the sides of what is drawn to those of the whole picture.
    [[nodiscard]] double scale() const { return scale_; }
    /// Has nothing been moved for so long that the picture is to be drawn whole?
    [[nodiscard]] bool has_come_to_rest() const;

    /// Takes how long the slot's last frame took, and how long this one does from now on, up to end_timing().
    /// `has_developed`: the frame before made a picture.
    [[nodiscard]] darkroom::Result<> begin_timing(const darkroom::Device& device,
                                                  const darkroom::window::PresentFrame& frame, const Turn& turn,
                                                  bool has_developed);
    void end_timing(const darkroom::window::PresentFrame& frame, bool has_developed);
    /// Timers are lost with their device.
    void forget_device();

  private:
    bool has_frame_time_;
    ScaleChoice choice_;
    double scale_ = 1;
    std::uint32_t moves_ = 0;                       ///< frames that were moved by hand, one behind the other
    Clock::time_point moved_at_{};                  ///< a hand made the picture another
    darkroom::gpu::Timers timers_;                  ///< of whole frames
    std::array<double, frames_in_flight> timed_{};  ///< scales of frames under way; 0: the frame says nothing
};

}  // namespace app
