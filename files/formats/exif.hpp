// SPDX-License-Identifier: MIT
#pragma once
// What is read of EXIF, which is a TIFF file without a picture: how a picture is turned, and which colours it has.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace darkroom {

/// The directories of a TIFF file in memory (TIFF 6.0, 2, or BigTIFF as libtiff has it), which may be damaged: what
/// lies outside of it is not there.
class TiffTags {
  public:
    struct Value {
        std::size_t type = 0, count = 0;
        std::size_t at = 0;  ///< where it lies, of at most four bytes, in BigTIFF eight; else where its place stands
    };

    explicit TiffTags(std::span<const std::byte> file);
    [[nodiscard]] std::size_t first_directory() const { return (is_big_ ? number(8, 8) : number(4, 4)).value_or(0); }
    [[nodiscard]] std::optional<Value> find(std::size_t directory, std::size_t tag) const;
    /// A whole number of 16, 32 or, in BigTIFF, 64 bits.
    [[nodiscard]] std::optional<std::size_t> whole(std::size_t directory, std::size_t tag) const;
    /// Of so many bytes.
    [[nodiscard]] std::optional<std::size_t> number(std::size_t at, std::size_t size) const;
    [[nodiscard]] std::span<const std::byte> bytes(std::size_t at, std::size_t size) const;

  private:
    std::span<const std::byte> file_;
    bool is_little_ = false, is_big_ = false;
};

/// 1 to 8, of a TIFF file's first directory (EXIF 2.32, 4.6.4); 1, upright, where there is none, or it is damaged.
[[nodiscard]] std::uint8_t orientation_of_exif(std::span<const std::byte> file);

/// By ColorSpace and InteroperabilityIndex (EXIF 2.32, 4.6.5 and 4.6.9; DCF 2.0, the optional colour space).
enum class ExifColor {
    Unsaid,
    Srgb,
    AdobeRgb,
    Uncalibrated,   ///< another, and it does not say which
    Contradictory,  ///< sRGB by the one, Adobe RGB by the other
};
[[nodiscard]] ExifColor color_of_exif(std::span<const std::byte> file);

}  // namespace darkroom
