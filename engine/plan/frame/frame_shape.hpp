// SPDX-License-Identifier: MIT
#pragma once
// Which lean kernel of a pass a frame gets: its shape, from the frame's values and the regions of its images. Allocates
// nothing.

#include "graph/schedule.hpp"
#include "plan/frame/frame_values.hpp"

namespace darkroom::plan {

[[nodiscard]] Shape shape_of(const ProgramPass& pass, std::span<const Entry* const> entries, const FrameValues& values,
                             const gpu::Region& output, std::span<const gpu::Binding> inputs);

/// The shape that a frame of extent `largest` has, in whole images, with a perspective camera: what most frames are.
/// `schedule` was derived from the gates of `values`; `entries` may be other ones of the same stack.
[[nodiscard]] Shape expected_shape(const Program& program, const graph::Compiled& compiled,
                                   const graph::Schedule& schedule, const FrameValues& values,
                                   std::span<const Entry* const> entries, const ProgramPass& pass,
                                   const graph::Extents& largest);

}  // namespace darkroom::plan
