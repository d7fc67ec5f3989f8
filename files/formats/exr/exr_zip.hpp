// SPDX-License-Identifier: MIT
#pragma once
// Chunks of scan lines that OpenEXR packed by ZIP or ZIPS, unpacked by libdeflate in a third of
// the time that the zlib under OpenEXR 3.1 takes. The layout is that of "OpenEXR File Layout" and of ImfZip.cpp.

#include <OpenEXR/ImfInputPart.h>

#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <span>

#include "formats/picture_source.hpp"

namespace darkroom {

/// A channel in the order of the file, and where its samples go.
struct ZipChannel {
    SampleKind kind = SampleKind::Half;  ///< in the file: Half, Float or Integer32
    const SamplePlace* place = nullptr;  ///< null: nobody wants it
};

/// Reads `rows` rows from `row` on of a part without tiles and without subsampled channels.
[[nodiscard]] Result<> read_zip_rows(const Imf::InputPart& part, std::span<const ZipChannel> channels,
                                     std::uint32_t row, std::uint32_t rows, std::size_t max_threads);

}  // namespace darkroom
