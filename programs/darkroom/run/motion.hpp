// SPDX-License-Identifier: MIT
#pragma once
// What moves a stack from frame to frame: the timeline of events, and the interface with its controllers. Controllers
// remember, so a run that begins in the middle takes them through the frames before, without pictures.

#include <functional>
#include <optional>
#include <utility>

#include "timeline.hpp"
#include "ui_source.hpp"

namespace app {

class Motion {
  public:
    /// At most so many frames are gone through before one that makes a picture: some ten seconds.
    static constexpr std::size_t max_frames_before = 1'000'000;
    /// The time of a frame in seconds; nothing: it cannot be read, and is left out. Asked for the sake of controllers
    /// alone.
    using TimeOf = std::function<std::optional<double>(std::size_t frame)>;

    Motion() = default;
    /// Of a look as LookFlags gives it. `frame`: 0 is the first of the whole run.
    Motion(const darkroom::Look& look, Timeline timeline, TimeOf time_of)
        : ui_(look, timeline), timeline_(std::move(timeline)), time_of_(std::move(time_of)) {}

    /// Brings the stack to a frame at its time: the same whether the frames before were made or not. Frames come in
    /// order, always to the same Composer.
    [[nodiscard]] darkroom::Result<> advance(darkroom::Composer& composer, std::size_t frame, double time) {
        return advance(composer, frame, time, [] {});
    }
    /// See UiSource.
    [[nodiscard]] darkroom::Result<std::shared_ptr<const std::vector<std::uint8_t>>> picture(VkExtent2D extent) {
        return ui_.picture(extent);
    }
    /// How many frames before one the histories of this look need, where frames are `delta_time` seconds apart, at the
    /// worst of all frames up to `last` as controllers leave them; 0 without controllers. Nothing that scripts say is
    /// told: the run itself tells it. Errors: of scripts.
    [[nodiscard]] darkroom::Result<std::uint32_t> pre_roll(const darkroom::Look& look, double delta_time,
                                                           std::size_t last) const;

  private:
    /// The same; `each` is called at every frame that is gone through, and at this one.
    [[nodiscard]] darkroom::Result<> advance(darkroom::Composer& composer, std::size_t frame, double time,
                                             const std::function<void()>& each);
    [[nodiscard]] darkroom::Result<std::size_t> first_for(darkroom::Composer& composer, std::size_t frame, double time);
    [[nodiscard]] darkroom::Result<> move(darkroom::Composer& composer, double time);

    UiSource ui_;
    Timeline timeline_;
    TimeOf time_of_;
    std::optional<std::size_t> next_;  ///< behind the last frame
};

}  // namespace app
