// SPDX-License-Identifier: MIT
#pragma once
// Display-encoded samples made into a PNG file in memory (ISO/IEC 15948), deflated by
// libdeflate: four to six times as fast as libpng with zlib, and no larger. It says that the samples are sRGB, where
// they are, or what else they are.

#include "formats/file_format.hpp"

namespace darkroom {

/// Of 8 or 16 bits. Without a level of compression: fast, and better where that costs little.
[[nodiscard]] Result<std::vector<std::byte>> encode_png(const EncodeDesc& desc);

}  // namespace darkroom
