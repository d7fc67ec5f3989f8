// SPDX-License-Identifier: MIT
#include <algorithm>

#include "graph/solution.hpp"

namespace darkroom::graph {
namespace {

VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

/// The smallest gap between `taken` (sorted by offset) that holds the interval; else the place after the last.
VkDeviceSize best_offset(std::span<const Interval* const> taken, const Interval& wanted) {
    VkDeviceSize end = 0, best = ~VkDeviceSize{0}, best_gap = ~VkDeviceSize{0};
    for (const Interval* other : taken) {
        const VkDeviceSize offset = align_up(end, wanted.alignment);
        if (other->offset >= offset + wanted.size && other->offset - end < best_gap) {
            best_gap = other->offset - end;
            best = offset;
        }
        end = std::max(end, other->offset + other->size);
    }
    return best_gap != ~VkDeviceSize{0} ? best : align_up(end, wanted.alignment);
}

}  // namespace

// Offset assignment by decreasing size with best fit is the "greedy by size" of Pisarchyk and Lee, "Efficient Memory
// Management for Deep Neural Net Inference" (2020), section 5.2.
VkDeviceSize pack(std::span<Interval> intervals) {
    std::vector<Interval*> order;
    for (Interval& interval : intervals) order.push_back(&interval);
    std::stable_sort(order.begin(), order.end(),
                     [](const Interval* a, const Interval* b) { return a->size > b->size; });

    VkDeviceSize total = 0;
    std::vector<const Interval*> conflicting;
    for (std::size_t i = 0; i < order.size(); ++i) {
        Interval& wanted = *order[i];
        conflicting.clear();
        for (std::size_t j = 0; j < i; ++j) {
            if (order[j]->first <= wanted.last && wanted.first <= order[j]->last) conflicting.push_back(order[j]);
        }
        std::sort(conflicting.begin(), conflicting.end(),
                  [](const Interval* a, const Interval* b) { return a->offset < b->offset; });
        wanted.offset = best_offset(conflicting, wanted);
        total = std::max(total, wanted.offset + wanted.size);
    }
    return total;
}

}  // namespace darkroom::graph
