// SPDX-License-Identifier: MIT
#pragma once
// A frame at another size. Colour is filtered with a triangle, which has no negative lobes, so that bright pixels get
// no dark rings. Depth, normals and motion take the nearest pixel, since a mean of two surfaces lies on neither; motion
// is scaled with the picture.

#include <cstdint>
#include <darkroom/result.hpp>

#include "image/frame/frame_file.hpp"

namespace darkroom {

/// Sizes of 0 are refused.
[[nodiscard]] Result<FrameFile> resize(FrameFile frame, std::uint32_t width, std::uint32_t height);

}  // namespace darkroom
