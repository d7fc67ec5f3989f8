// SPDX-License-Identifier: MIT
#pragma once
// What an effect that meters light tells of it: how much of the picture lies at which stop, what counts, and the
// exposure. It comes as the effect's value EFFECT.histogram (Composer::value), whose numbers are the stops from middle
// grey at which the bins begin, the stops of a bin, the two stops between which is metered, the metered ones, those of
// the exposure, and then the share of all in each bin.

#include <imgui.h>

#include <optional>
#include <span>

namespace darkroom::panels {

struct LightHistogram {
    float first = 0, step = 1;     ///< stops
    float low = 0, high = 0;       ///< what is metered lies between
    float metered = 0, added = 0;  ///< stops, of the picture and by the exposure
    std::span<const float> shares;
};

/// Nothing: these are not the numbers of one, or there is none yet.
[[nodiscard]] std::optional<LightHistogram> light_histogram_of(std::span<const float> numbers);

/// Into the host's present window, as wide as it is: what is metered is bright, the metered stops are a line.
void draw_light_histogram(const LightHistogram& histogram);

}  // namespace darkroom::panels
