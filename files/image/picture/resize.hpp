// SPDX-License-Identifier: MIT
#pragma once
// A frame at another size. Colour is filtered with a triangle, which has no negative lobes, so that bright pixels get
// no dark rings. Depth, normals and motion take the nearest pixel, since a mean of two surfaces lies on neither; motion
// is scaled with the picture.

#include <cstdint>
#include <darkroom/result.hpp>

#include "image/frame/frame_file.hpp"

namespace darkroom {

/// What becomes of a frame whose sides have another ratio than the size that is asked for.
enum class Sizing {
    Fit,      ///< all of it, with one side shorter than asked for
    Fill,     ///< exactly that size: what is over is cut off, evenly at both ends, and the camera sees less
    Stretch,  ///< exactly that size
};

struct NewSize {
    std::uint32_t width = 0, height = 0;
    Sizing sizing = Sizing::Stretch;
    /// What a picture of width x height gets.
    [[nodiscard]] NewSize of(std::uint32_t old_width, std::uint32_t old_height) const;
};

/// Sizes of 0 are refused.
[[nodiscard]] Result<FrameFile> resize(FrameFile frame, const NewSize& size);

}  // namespace darkroom
