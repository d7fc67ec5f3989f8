// SPDX-License-Identifier: MIT
#include "recipe.hpp"

#include <darkroom/hud_inertia.hpp>

namespace darkroom::bench {

namespace {

Result<Row> inertia_row(Bed&, const std::string& name) {
    return Row{.name = name, .host = [inertia = HudInertia(), yaw = 0.0]() mutable {
                   for (int frame = 0; frame < frames_of_a_row; ++frame)
                       inertia.step(1.0 / 144, yaw += 1, frame % 100 < 50, 200);
               }};
}

}  // namespace

std::vector<Recipe> interface_recipes() { return {{"inertia, 1000 frames", inertia_row}}; }

}  // namespace darkroom::bench
