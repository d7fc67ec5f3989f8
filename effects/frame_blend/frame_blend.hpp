// SPDX-License-Identifier: MIT
#pragma once
// Frame blend: a ring of earlier frames, kept small, is laid over the present one with decreasing weights. The trail
// has an end, after `frames` / 60 s, and no ghost is left; it is blurred, since it is made of small pictures. A trail
// without an end that is sharp is recursive_blend.

#include <darkroom/param.hpp>

namespace darkroom {

struct EffectInfo;

/// Of the picture's area, how much a frame of the ring has.
enum class FrameBlendArea : std::uint32_t { Quarter, Sixteenth };

struct FrameBlend {
    /// Weight of all earlier frames together. [0, 1]
    float amount = 0.6f;
    /// Length of the trail, in steps of 1/60 s. [1, 7]
    std::int32_t frames = 7;
    /// Share of the picture's area that each earlier frame is kept at.
    FrameBlendArea area = FrameBlendArea::Sixteenth;
};

/// Slots of the ring: one more than the longest trail, so that a slot has no weight any more when it is written anew.
inline constexpr std::int32_t frame_blend_slots = 8;

/// The ring at the time of a frame. A step is 1/60 s; step n begins at (n - 0.382) / 60 s, which falls together with no
/// frame at usual rates, so that rounding decides nothing. Slot n mod 8 holds the first frame of step n.
struct FrameBlendRing {
    FrameBlendRing(double time, double delta_time);
    /// Does a step of this slot begin with this frame?
    [[nodiscard]] bool is_renewed(std::int32_t slot) const;
    /// Steps since that of the frame in a slot began, as it was before this frame.
    [[nodiscard]] double age(std::int32_t slot) const;

  private:
    double now_;                  ///< in steps
    std::int64_t last_, before_;  ///< number of the present step, and of that of the frame before
};

[[nodiscard]] const EffectInfo& effect_info(const FrameBlend&);

}  // namespace darkroom
