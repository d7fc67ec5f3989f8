// SPDX-License-Identifier: MIT
#pragma once
// A plan as a picture: its passes are columns in their order, its images bars over the passes in which they live.
// Images of the host and histories have a row each; below them lies the transient memory, where an image's height is
// its size and its place its offset, so that images that share bytes lie in one row, one behind the other. What is
// under the mouse shows who writes it, who reads it, and what it is.

#include <imgui.h>

#include <darkroom/plan.hpp>
#include <vector>

namespace darkroom::panels {

/// Where things of a plan lie in its picture, from its upper left corner.
struct PlanLayout {
    struct Bar {
        std::uint32_t image = 0;  ///< of Plan::images
        ImVec2 min, max;
    };
    float column_width = 0;
    float title_height = 0;   ///< of what passes belong to
    float header_height = 0;  ///< of that and the passes' names
    float memory_top = 0;     ///< of the transient memory
    ImVec2 size;              ///< of all; no smaller than what was asked for
    std::vector<Bar> bars;    ///< of the images that passes use
};
/// As wide as `size`, and at least as high; a row is `row` high, that of the passes' names as high as `names` at least.
[[nodiscard]] PlanLayout lay_out(const Plan& plan, ImVec2 size, float row, float names = 0);

/// Fills the rest of the present window, and scrolls in it; what is left out of the plan, and why, is listed below.
void draw_plan_picture(const Plan& plan);

}  // namespace darkroom::panels
