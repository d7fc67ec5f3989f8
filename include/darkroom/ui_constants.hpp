// SPDX-License-Identifier: MIT
#pragma once
// For hosts that port from a pass which drew the interface itself: its push constants, and what they are here.

#include <cstddef>
#include <cstdint>
#include <darkroom/composer.hpp>

extern "C" {
/// 40 bytes, as such a pass pushes them to its fragment stage at offset 0.
struct DarkroomUiConstants {
    float gamma;               ///< offset 0: exponent of the composed picture
    float contrast;            ///< 4: [1, 2]
    float warp_strength;       ///< 8: barrel, either sign
    float chromatic_strength;  ///< 12: as pushed, so times 1080 / height already; 0 and less: none
    float ui_offset_x;         ///< 16: in uv
    float ui_offset_y;         ///< 20
    float ui_opacity;          ///< 24: [0.1, 1]
    float echo_strength;       ///< 28: 0 and less: none
    float echo_scale;          ///< 32: above 1 the ghost is smaller
    float ui_additive;         ///< 36: [0, 1]
};
}

namespace darkroom {

static_assert(sizeof(DarkroomUiConstants) == 40);
static_assert(offsetof(DarkroomUiConstants, contrast) == 4 && offsetof(DarkroomUiConstants, warp_strength) == 8 &&
              offsetof(DarkroomUiConstants, chromatic_strength) == 12 &&
              offsetof(DarkroomUiConstants, ui_offset_x) == 16 && offsetof(DarkroomUiConstants, ui_offset_y) == 20 &&
              offsetof(DarkroomUiConstants, ui_opacity) == 24 && offsetof(DarkroomUiConstants, echo_strength) == 28 &&
              offsetof(DarkroomUiConstants, echo_scale) == 32 && offsetof(DarkroomUiConstants, ui_additive) == 36);

/// Sets the parameters of the stack that these constants stand for, found by the names that consoles know them by
/// (`r_ui_warp`, `gamma`); numbers are brought into their rows' intervals, and what is not finite to the default.
/// `height`: of the target. Compiles nothing. Errors: the stack has none of a parameter.
Result<> set_ui_constants(Composer& composer, const DarkroomUiConstants& constants, std::uint32_t height);

}  // namespace darkroom
