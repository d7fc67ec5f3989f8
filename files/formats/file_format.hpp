// SPDX-License-Identifier: MIT
#pragma once
// Formats of image files, a row each: how its bytes begin, what is looked over before they are decoded, what decodes
// them, what they say of their colours, and how pictures are written. A folder beside this file is a format:
// FOLDER/FOLDER.cpp defines `const FileFormat& FOLDER_format()`, and nobody lists it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <darkroom/color_state.hpp>
#include <darkroom/result.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/file_color.hpp"
#include "formats/file_part.hpp"
#include "formats/picture_source.hpp"

namespace darkroom {

/// A picture to encode: `samples` are of kind `kind`, rows from the top, `channels` a pixel (3, or 4 with alpha).
struct EncodeDesc {
    SampleKind kind = SampleKind::Integer8;
    std::uint32_t width = 0, height = 0, channels = 3;
    std::optional<int> quality;  ///< JPEG, 1 to 100
    std::string chroma;          ///< JPEG: 4:4:4, 4:2:2 or 4:2:0; empty: by the quality
    bool is_associated = false;  ///< colours were multiplied by alpha, and the file says so
    std::string compression;     ///< one of FileFormat::compressions; empty: the usual one
    /// Of integers; none: the file says nothing of its colour.
    std::optional<ColorState> color = srgb_color;
    const void* samples = nullptr;
};

struct FileFormat {
    using Bytes = std::span<const std::byte>;
    using Source = std::unique_ptr<PictureSource>;

    std::string_view name;                         ///< "PNG"
    std::span<const std::string_view> extensions;  ///< ".png", in lower case; the first is the usual one
    bool (*begins)(std::string_view start);        ///< is it the start of such a file? Of 16 bytes, or all of fewer
    /// Looks a file over. What a decoder may see of it; empty: all.
    Result<std::vector<std::byte>> (*check)(Bytes file);
    /// The fewest bytes that such a picture can take, so that a few damaged bytes of header cannot ask for gigabytes.
    /// Null: `check` sees to it.
    double (*least_bytes)(const FilePart& part) = nullptr;
    /// Of a file that `check` has passed, whose bytes outlive it, by so many threads at most. A null source: by
    /// OpenImageIO. May throw what its library throws. Null: OpenImageIO reads all of them.
    Result<Source> (*open)(Bytes file, std::size_t max_threads) = nullptr;
    std::string_view openimageio{};  ///< its name there; empty: it does not read it
    /// Of a checked file of integers or of floats. Null: nothing is said, but by attributes of OpenEXR.
    FileColor (*color)(Bytes file, bool is_integer) = nullptr;
    /// What the file holds beside the picture that is read, a line: "has 3 pages: the first is read"; empty: nothing.
    std::string (*left_out)(Bytes file) = nullptr;
    /// How the picture is turned, by EXIF, 1 to 8. Null: by the attribute "Orientation".
    Result<int> (*orientation)(Bytes file, const PictureSource& source) = nullptr;

    std::span<const SampleKind> samples{};  ///< that are written, the usual one first; none: none are
    bool has_alpha = false;
    bool has_quality = false, has_color_space = false;
    std::span<const std::string_view> compressions{};  ///< by name
    std::uint32_t max_side = 65536;
    /// Floats are clamped to these.
    float least = -std::numeric_limits<float>::max(), most = std::numeric_limits<float>::max();
    /// Null: by OpenImageIO, or, for OpenEXR, by image/exr/write.hpp.
    Result<std::vector<std::byte>> (*encode)(const EncodeDesc& desc) = nullptr;
};

/// Every format, by the names of their folders.
[[nodiscard]] std::span<const FileFormat* const> all_formats();
/// "OpenEXR, JPEG, PNG"
[[nodiscard]] std::string format_names();
/// The extensions of all of them: ".exr", ".jpg", ".jpeg".
[[nodiscard]] std::vector<std::string> picture_extensions();
/// The usual extensions of written formats, and of those alone of which something is so: ".exr .jpg .png".
[[nodiscard]] std::string written_extensions(bool (*is)(const FileFormat& format) = nullptr);

}  // namespace darkroom
