// SPDX-License-Identifier: MIT
#include "c/call.hpp"
#include "c/objects.hpp"

using namespace darkroom;
using namespace darkroom::c;

DarkroomResult darkroom_hud_inertia_create(DarkroomHudInertia* inertia) {
    return call("darkroom_hud_inertia_create", [&]() -> Result<> {
        DARKROOM_TRY(needs("inertia", inertia));
        *inertia = new DarkroomHudInertiaObject{};
        return {};
    });
}

void darkroom_hud_inertia_destroy(DarkroomHudInertia inertia) { delete inertia; }

DarkroomResult darkroom_hud_inertia_step(DarkroomHudInertia inertia, double delta_time, double yaw,
                                         VkBool32 is_on_ground, double velocity_z, float offset[2]) {
    return call("darkroom_hud_inertia_step", [&]() -> Result<> {
        DARKROOM_TRY(needs("inertia", inertia, "offset", offset));
        const Vec2 moved = inertia->inertia.step(delta_time, yaw, is_on_ground != 0, velocity_z);
        offset[0] = moved.x;
        offset[1] = moved.y;
        return {};
    });
}

DarkroomResult darkroom_hud_inertia_offset(DarkroomHudInertia inertia, float offset[2]) {
    return call("darkroom_hud_inertia_offset", [&]() -> Result<> {
        DARKROOM_TRY(needs("inertia", inertia, "offset", offset));
        offset[0] = inertia->inertia.offset().x;
        offset[1] = inertia->inertia.offset().y;
        return {};
    });
}

DarkroomResult darkroom_hud_inertia_reset(DarkroomHudInertia inertia) {
    return call("darkroom_hud_inertia_reset", [&]() -> Result<> {
        DARKROOM_TRY(needs("inertia", inertia));
        inertia->inertia.reset();
        return {};
    });
}
