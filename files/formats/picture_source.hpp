// SPDX-License-Identifier: MIT
#pragma once
// A picture whose file has been opened and whose samples have not been read: what every decoder is to its users.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/try.hpp"
#include "formats/file_part.hpp"

namespace darkroom {

/// The largest width or height of a picture, in pixels, of any format.
inline constexpr long long max_picture_side = 65536;

/// What the pixels of a file may take once they are decoded, of any format: 1 GiB always, beyond that 128 bytes for
/// each byte of the file. Flat pictures are packed up to 1000 times by deflate and 30000 times by DWAB, so one of 8K in
/// floats (531 MB, packed to 17 kB) is within the first, and what a camera or a renderer makes is never near the
/// second.
[[nodiscard]] Result<> check_decoded_size(std::uint64_t bytes, std::size_t file_size);

/// Where the samples of one channel go. Integers of a file become 0..1 as floats, as encoded; OpenEXR files give halves
/// and floats, and 32-bit integers as they are.
struct SamplePlace {
    std::size_t channel = 0;  ///< of FilePart::channels
    SampleKind kind = SampleKind::Float;
    std::byte* first = nullptr;      ///< of the leftmost sample of the first row that is read
    std::ptrdiff_t pixel_bytes = 0;  ///< from one sample to the next
    std::ptrdiff_t row_bytes = 0;    ///< from one row to the next
};

class PictureSource {
  public:
    PictureSource() = default;
    PictureSource(const PictureSource&) = delete;
    PictureSource& operator=(const PictureSource&) = delete;
    virtual ~PictureSource() = default;

    [[nodiscard]] std::span<const FilePart> parts() const { return parts_; }
    /// The numbers of an attribute (one number, a point, a matrix by rows), empty if the part has none of that name.
    /// Names are compared without regard to case.
    [[nodiscard]] virtual std::vector<double> numbers(std::size_t part, std::string_view attribute) const = 0;
    [[nodiscard]] virtual std::vector<std::string> attributes(std::size_t part) const = 0;
    /// Rows of the data window, 0 at its top. What lies between the samples of a place is not touched. Errors name no
    /// file; some rows may have been written then.
    [[nodiscard]] Result<> read_rows(std::size_t part, std::uint32_t row, std::uint32_t rows,
                                     std::span<const SamplePlace> places);
    /// Rows that are read together without decoding anything twice: a multiple of this many.
    [[nodiscard]] virtual std::uint32_t row_unit(std::size_t part) const = 0;
    /// Makes this the display window of all parts, in pixels of the one that they had.
    void set_display_window(const PixelWindow& window);
    /// Holds the bytes that it reads for as long as it lives, where they are not its caller's.
    void keep(std::vector<std::byte> bytes) { bytes_ = std::move(bytes); }

  protected:
    std::vector<FilePart> parts_;

  private:
    std::vector<std::byte> bytes_;
    /// May throw what the library under it throws. `places` is not empty.
    [[nodiscard]] virtual Result<> read(std::size_t part, std::uint32_t row, std::uint32_t rows,
                                        std::span<const SamplePlace> places) = 0;
};

}  // namespace darkroom
