// SPDX-License-Identifier: MIT
#pragma once
// Pictures that are stored lying or mirrored, and shown upright: JPEG, TIFF and WebP by the orientation of EXIF,
// Radiance HDR by the order of its axes. What is read from here on is upright. Textures of models are taken as they are
// stored, as their format wants it, and come past this.

#include "image/picture/picture_source.hpp"

namespace darkroom {

/// As EXIF numbers them, 1 to 8; 1 is upright, from 5 on rows are stored as columns.
[[nodiscard]] Result<int> orientation_of(const OpenedSource& opened, std::span<const std::byte> bytes);

/// open_source, upright.
[[nodiscard]] Result<OpenedSource> open_upright(std::span<const std::byte> bytes, std::size_t max_threads = 0,
                                                DecodingPlace place = DecodingPlace::Confined);

}  // namespace darkroom
