// SPDX-License-Identifier: MIT
#pragma once
// What is known of an image file before its samples are taken out, and what its samples are called.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom {

enum class SampleKind { Integer8, Integer16, Integer32, Half, Float };

[[nodiscard]] std::string_view name_of(SampleKind kind);
/// Of 8 or 16 bits: code values. Others are light, or counts.
[[nodiscard]] constexpr bool is_integer(SampleKind kind) {
    return kind == SampleKind::Integer8 || kind == SampleKind::Integer16;
}
/// Bytes of one sample.
[[nodiscard]] std::size_t size_of(SampleKind kind);

/// One picture in a file. Only OpenEXR has several, and only there the data window differs from the display window.
/// A rectangle of pixels.
struct PixelWindow {
    int x = 0, y = 0;
    std::uint32_t width = 0, height = 0;
};

struct FilePart {
    std::string name;
    std::string view;                   ///< of a stereo pair: "left", "right"; else empty
    std::vector<std::string> views;     ///< that share the part; channels of the first have no name of a view
    std::string compression;            ///< "zip", as OpenEXR calls it; else empty
    std::string color_space;            ///< colorInteropID of OpenEXR; else empty
    bool has_primaries = false;         ///< OpenEXR says them, by that or by chromaticities
    std::vector<std::string> channels;  ///< by layer; red, green, blue, alpha first, the others by name
    std::vector<SampleKind> kinds;      ///< one per channel
    int x = 0;                          ///< of the data window, relative to the display window
    int y = 0;
    std::uint32_t width = 0;  ///< of the data window
    std::uint32_t height = 0;
    std::uint32_t display_width = 0;
    std::uint32_t display_height = 0;
    /// The file's colours are multiplied by alpha: light in OpenEXR, light or code values in TIFF, by its tag.
    bool is_associated = false;
};

/// The text with everything but printable ASCII replaced, one line, at most 300 characters: names and messages out of
/// files are not to be trusted on a terminal.
[[nodiscard]] std::string one_printable_line(std::string_view text);

}  // namespace darkroom
