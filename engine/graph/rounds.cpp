// SPDX-License-Identifier: MIT
// Which passes may run side by side. A barrier between two passes makes a GPU run dry, whatever images it names, so
// passes are recorded in rounds with barriers before each: a pass lies in the first round behind all that it has to
// wait for.
#include <algorithm>

#include "graph/solution.hpp"

namespace darkroom::graph {
namespace {

/// From which round on a slot may be read in `layout`, and from which on for anything else.
struct Front {
    std::uint32_t to_read = 0, to_change = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_MAX_ENUM;  ///< of those who read it since; MAX_ENUM: nobody has

    std::uint32_t earliest(Use use) const { return is_write(use) || layout_of(use) != layout ? to_change : to_read; }

    void read(VkImageLayout wanted, std::uint32_t round) {
        if (wanted != layout) to_read = to_change;
        layout = wanted;
        to_change = std::max(to_change, round + 1);
    }
    void write(std::uint32_t round) { *this = {.to_read = round + 1, .to_change = round + 1}; }
};

}  // namespace

std::vector<std::uint32_t> rounds_of(std::span<const Touch> touches, std::uint32_t pass_count,
                                     std::uint32_t slot_count) {
    std::vector<std::uint32_t> rounds(pass_count);
    std::vector<Front> fronts(slot_count);
    for (auto first = touches.begin(); first != touches.end();) {
        const std::uint32_t pass = first->pass;
        const auto last = std::find_if(first, touches.end(), [&](const Touch& touch) { return touch.pass != pass; });
        std::uint32_t& round = rounds[pass];
        for (auto touch = first; touch != last; ++touch)
            round = std::max(round, fronts[touch->slot].earliest(touch->use));
        for (auto touch = first; touch != last; ++touch)
            if (!is_write(touch->use)) fronts[touch->slot].read(layout_of(touch->use), round);
        for (auto touch = first; touch != last; ++touch)
            if (is_write(touch->use)) fronts[touch->slot].write(round);
        first = last;
    }
    return rounds;
}

}  // namespace darkroom::graph
