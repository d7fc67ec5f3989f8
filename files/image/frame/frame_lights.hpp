// SPDX-License-Identifier: MIT
#pragma once
// Internal to files/image: the lights of a frame as attributes of its part and as parts of their own, written and read.
// The names are in docs/conventions.md.

#include <span>
#include <vector>

#include "image/exr/write.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom {

/// Could read_lights give these back? An error is without the file name.
[[nodiscard]] Result<> check_lights(std::span<const FrameLight> lights);
/// The numbers, as attributes of the frame's part.
void add_lights(Imf::Header& frame, std::span<const FrameLight> lights);
/// The cascades, a part for each light that has some. Their channels refer to `lights`.
[[nodiscard]] std::vector<ExrPart> shadow_parts(const Imf::Header& frame, std::span<const FrameLight> lights);

/// `part`: that of the frame. Fills lights, counts and warnings of `frame`. An error may lack the file name.
[[nodiscard]] Result<> read_lights(Decoder& decoder, std::size_t part, const FrameOptions& options, FrameFile& frame);

}  // namespace darkroom
