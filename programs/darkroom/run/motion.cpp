// SPDX-License-Identifier: MIT
#include "motion.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/try.hpp"

namespace app {

using darkroom::Composer;
using darkroom::Result;

Result<> Motion::move(Composer& composer, double time) {
    DARKROOM_TRY(timeline_.advance(composer, time));
    return ui_.advance(composer, time);
}

// The first frame of all, or, where all scripts state a pre-roll, the first within it.
Result<std::size_t> Motion::first_for(Composer& composer, std::size_t frame, double time) {
    if (next_) return *next_;
    DARKROOM_TRY(ui_.start(composer));
    const std::optional<double> pre_roll = ui_.pre_roll();
    if (!pre_roll) return 0;
    std::size_t first = frame;
    while (first > 0 && frame - first <= max_frames_before) {
        const std::optional<double> before = time_of_(first - 1);
        if (before && *before < time - *pre_roll) break;
        --first;
    }
    return first;
}

Result<> Motion::advance(Composer& composer, std::size_t frame, double time, const std::function<void()>& each) {
    if (ui_.has_controllers()) {
        DARKROOM_TRY_VALUE(const std::size_t first, first_for(composer, frame, time));
        if (frame > first && frame - first > max_frames_before)
            return darkroom::user_error(
                fmt::format("the controllers run in every frame, and there are {} before the first picture; allowed "
                            "are {}, and fewer run where each script states its engine.pre_roll",
                            frame - first, max_frames_before));
        const bool was_silent = ui_.silence(true);
        for (std::size_t before = first; before < frame; ++before) {
            const std::optional<double> then = time_of_(before);
            if (!then) continue;
            DARKROOM_TRY(move(composer, *then));
            each();
        }
        ui_.silence(was_silent);
        next_ = frame + 1;
    }
    DARKROOM_TRY(move(composer, time));
    each();
    return {};
}

Result<std::uint32_t> Motion::pre_roll(const darkroom::Look& look, double delta_time, std::size_t last) const {
    std::uint32_t frames = 0;
    if (!ui_.has_controllers()) return frames;
    Composer composer(darkroom::Device::assumed());
    DARKROOM_TRY(darkroom::apply(look, composer, {.keeps = timeline_.entries()}));
    Motion motion(look, timeline_, time_of_);
    motion.ui_.silence(true);
    const std::optional<double> time = time_of_(last);
    DARKROOM_TRY(motion.advance(composer, last, time.value_or(0),
                                [&] { frames = std::max(frames, composer.pre_roll(delta_time)); }));
    return frames;
}

}  // namespace app
