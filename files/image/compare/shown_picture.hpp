// SPDX-License-Identifier: MIT
#pragma once
// Pictures of a comparison as somebody looks at them: what a display shows of them, how they differ, and the bytes of a
// file for a page. They are made to be seen and not to be measured, which compare() does with the numbers of the files.

#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <vector>

#include "image/compare/flip.hpp"
#include "image/picture/picture.hpp"

namespace darkroom {

/// Display-encoded and opaque: floats are sRGB-encoded and cut off at 1, pixels that are not finite are magenta.
[[nodiscard]] Picture shown_picture(Picture picture, PictureEncoding encoding);

/// The absolute difference of what is shown, display-encoded codes times `gain`: the largest power of two, at most 128,
/// by which none is cut off. Pixels that are not finite, and not the same in both, are magenta.
struct ShownDifference {
    Picture picture;
    std::uint32_t gain = 1;
};
/// Both have one size.
[[nodiscard]] ShownDifference shown_difference(const Picture& reference, const Picture& test, PictureEncoding encoding);

/// Smaller where its longer side is above `most` texels, by resize(). `picture` is display-encoded.
[[nodiscard]] Result<Picture> no_larger_than(Picture picture, std::uint32_t most);

/// A PNG file of 8 bits without alpha, sRGB. `picture` is display-encoded and finite.
[[nodiscard]] Result<std::vector<std::byte>> png_of(const Picture& picture);

}  // namespace darkroom
