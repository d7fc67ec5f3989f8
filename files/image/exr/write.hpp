// SPDX-License-Identifier: MIT
#pragma once
// Internal to files/image: planes of floats made into an OpenEXR file in memory, by OpenEXR.

#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfHeader.h>

#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/primaries.hpp"
#include "formats/exr/exr.hpp"

namespace darkroom {

/// A channel of a plane whose pixels are `stride` floats apart.
struct ExrChannel {
    std::string name;
    SampleKind kind = SampleKind::Half;  ///< in the file, Half or Float
    const float* values = nullptr;       ///< of the first pixel
    std::size_t stride = 1;
    bool is_clamped = true;  ///< to the largest number of its kind, and NaN becomes 0
};

struct ExrPart {
    Imf::Header header;  ///< with the windows, the compression and all attributes; a name where there are several parts
    std::vector<ExrChannel> channels;
};

/// A header of a picture of this size, with Rec. 709 as its chromaticities where it is a picture in colour.
/// Compression: as OpenEXR calls it, empty: zip.
[[nodiscard]] Imf::Header exr_header(std::uint32_t width, std::uint32_t height, std::string_view compression = {});
/// Says of which primaries its light is, by chromaticities and by colorInteropID.
void add_primaries(Imf::Header& header, const Chromaticities& of);

/// Would a channel of this name and kind come back as other numbers? DWA packs the last names R, G, B, Y, RY and BY by
/// its cosine transform, PXR24 floats as 24 bits, B44 and B44A halves.
[[nodiscard]] bool is_changed_by(Imf::Compression compression, std::string_view channel, SampleKind kind);
/// The largest light that DWA gives back as a number: its rounding takes what is brighter beyond the largest half.
inline constexpr float largest_in_dwa = 60000.0F;

/// One part, or several, which share the display window, the pixel aspect, the chromaticities and the time code of the
/// first. `max_threads`: that compress, 0: as many as there are processors. Errors name no file.
[[nodiscard]] Result<std::vector<std::byte>> encode_exr(std::span<const ExrPart> parts, std::size_t max_threads = 0);

/// The same into a file. See WriteOptions::follows_links.
[[nodiscard]] Result<> write_exr(const std::filesystem::path& path, std::span<const ExrPart> parts,
                                 std::size_t max_threads = 0, bool follows_links = true);

}  // namespace darkroom
