// SPDX-License-Identifier: MIT
#pragma once
// Looks over the chunks of a WebP file (RFC 9649) before a decoder may see it, and finds what it says of its picture.

#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <span>

namespace darkroom {

struct WebpPicture {
    std::uint32_t width = 0, height = 0;
    std::span<const std::byte> file;     ///< without what stands behind the last chunk
    std::span<const std::byte> profile;  ///< of its colours, empty: none
    std::span<const std::byte> exif;     ///< a TIFF file, empty: none
};

/// An error names no file. Refused: what is cut off, is animated, has no picture or one of another size than its
/// canvas, or would take more memory than its bytes allow.
[[nodiscard]] Result<WebpPicture> check_webp(std::span<const std::byte> file);

}  // namespace darkroom
