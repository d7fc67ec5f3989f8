// SPDX-License-Identifier: MIT
#pragma once
// Looks over the structure of a JPEG file before a decoder may see it: the sizes that its frame headers state, the
// number of its scans, and the end-of-image marker, so that half a picture is no picture.

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/try.hpp"

namespace darkroom {

/// A scan may go over all pixels again, for a few bytes: what the streams of a picture ask of a decoder, added up.
class JpegScans {
  public:
    static constexpr std::uint64_t max_scans = 100;                    ///< of a stream
    static constexpr std::uint64_t max_work = std::uint64_t{1} << 31;  ///< scans times pixels, of all streams

    [[nodiscard]] Result<> add(std::span<const std::byte> stream);

  private:
    std::uint64_t work_ = 0;
};

/// An error names no file.
[[nodiscard]] Result<> check_jpeg(std::span<const std::byte> file);

}  // namespace darkroom
