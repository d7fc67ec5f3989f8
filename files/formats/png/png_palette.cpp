// SPDX-License-Identifier: MIT
#include "formats/png/png_palette.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <vector>

namespace darkroom {
namespace {

// PNG's third edition, section 8.1: where the passes of Adam7 start and how far their pixels lie apart.
struct Pass {
    std::uint32_t x, y, x_step, y_step;
};
constexpr std::array<Pass, 1> plain{{{0, 0, 1, 1}}};
constexpr std::array<Pass, 7> adam7{
    {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}};

std::uint32_t pixels_of(std::uint32_t size, std::uint32_t first, std::uint32_t step) {
    return size <= first ? 0 : (size - first + step - 1) / step;
}

// Section 9.4, for pixels of at most a byte.
std::uint8_t predicted(int filter, std::uint8_t left, std::uint8_t up, std::uint8_t corner) {
    switch (filter) {
        case 1:
            return left;
        case 2:
            return up;
        case 3:
            return static_cast<std::uint8_t>((left + up) / 2);
        case 4: {
            const int guess = left + up - corner;
            const int to_left = std::abs(guess - left), to_up = std::abs(guess - up);
            const int to_corner = std::abs(guess - corner);
            if (to_left <= to_up && to_left <= to_corner) return left;
            return to_up <= to_corner ? up : corner;
        }
        default:
            return 0;
    }
}

/// The largest number of a row, whose bytes are put in place of what was filtered. `above` is empty for a first row.
std::uint32_t largest_of_row(int filter, std::span<std::uint8_t> row, std::span<const std::uint8_t> above,
                             std::uint32_t width, std::uint32_t bits) {
    std::uint8_t left = 0, corner = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const std::uint8_t up = above.empty() ? std::uint8_t{0} : above[i];
        left = row[i] = static_cast<std::uint8_t>(row[i] + predicted(filter, left, up, corner));
        corner = up;
    }
    std::uint32_t largest = 0;
    const std::uint32_t per_byte = 8 / bits, mask = (1U << bits) - 1;
    for (std::uint32_t x = 0; x < width; ++x) {
        const std::uint32_t shift = 8 - bits * (x % per_byte + 1);
        largest = std::max(largest, row[x / per_byte] >> shift & mask);
    }
    return largest;
}

}  // namespace

Result<> check_palette(const PalettePicture& picture, std::span<const std::byte> packed) {
    if (picture.colors == 0) return user_error("malformed header: its pixels are of a palette, and there is none");
    const std::uint32_t bits = picture.bits;
    if (bits != 1 && bits != 2 && bits != 4 && bits != 8)
        return user_error(fmt::format("malformed header: color type 3 with {} bits", bits));
    if (picture.colors >= std::size_t{1} << bits) return {};

    const std::span<const Pass> passes = picture.is_interlaced ? std::span<const Pass>(adam7) : plain;
    const auto row_bytes = [&](std::uint32_t width) { return (std::size_t{width} * bits + 7) / 8; };
    std::size_t size = 0;
    for (const Pass& pass : passes) {
        const std::uint32_t width = pixels_of(picture.width, pass.x, pass.x_step);
        if (width > 0) size += (row_bytes(width) + 1) * pixels_of(picture.height, pass.y, pass.y_step);
    }
    std::vector<std::uint8_t> rows(size);
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflate(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    std::size_t inflated = 0;
    if (libdeflate_zlib_decompress(inflate.get(), packed.data(), packed.size(), rows.data(), size, &inflated) !=
            LIBDEFLATE_SUCCESS ||
        inflated != size)
        return user_error("damaged or truncated: its pixels cannot be inflated");
    std::span<std::uint8_t> rest(rows);
    for (const Pass& pass : passes) {
        const std::uint32_t width = pixels_of(picture.width, pass.x, pass.x_step);
        const std::uint32_t height = width == 0 ? 0 : pixels_of(picture.height, pass.y, pass.y_step);
        std::span<const std::uint8_t> above;
        for (std::uint32_t y = 0; y < height; ++y) {
            const std::span<std::uint8_t> row = rest.subspan(1, row_bytes(width));
            const std::uint32_t largest = largest_of_row(rest[0], row, above, width, bits);
            if (largest >= picture.colors)
                return user_error(fmt::format("a pixel has color {} of the palette, [0, {}] is allowed", largest,
                                              picture.colors - 1));
            above = row;
            rest = rest.subspan(row.size() + 1);
        }
    }
    return {};
}

}  // namespace darkroom
