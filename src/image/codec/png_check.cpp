// SPDX-License-Identifier: MIT
#include "image/codec/png_check.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <array>
#include <cstdint>
#include <string_view>

#include "image/exr/check.hpp"

namespace darkroom {
namespace {

std::uint32_t big_endian(std::span<const std::byte> bytes) {
    std::uint32_t value = 0;
    for (const std::byte byte : bytes.first(4)) value = value << 8 | std::to_integer<std::uint32_t>(byte);
    return value;
}

Result<> check_header(std::span<const std::byte> data, std::size_t file_size) {
    if (data.size() != 13) return user_error("malformed header: IHDR must have 13 bytes");
    const std::uint64_t width = big_endian(data);
    const std::uint64_t height = big_endian(data.subspan(4));
    constexpr auto most = static_cast<std::uint64_t>(max_picture_side);
    if (width == 0 || height == 0 || width > most || height > most)
        return user_error(fmt::format("the picture is {}x{}, [1, {}] a side is allowed", width, height, most));
    constexpr std::array<std::uint64_t, 7> samples_of_color_type{1, 0, 3, 1, 2, 0, 4};
    const auto depth = std::to_integer<std::uint64_t>(data[8]);
    const auto color_type = std::to_integer<std::size_t>(data[9]);
    if (color_type >= samples_of_color_type.size() || samples_of_color_type[color_type] == 0 || depth > 16)
        return user_error(fmt::format("malformed header: color type {} with {} bits", color_type, depth));
    // Deflate makes at most 1032 bytes from one.
    const std::uint64_t bytes = width * height * samples_of_color_type[color_type] * depth / 8;
    if (bytes / 1032 > file_size)
        return user_error(
            fmt::format("a picture of {}x{} cannot be in a file of {} bytes: truncated, or a damaged header", width,
                        height, file_size));
    return check_decoded_size(bytes, file_size);
}

}  // namespace

Result<> check_png(std::span<const std::byte> file) {
    std::size_t position = 8;
    for (bool is_first = true;; is_first = false) {
        if (file.size() < position + 12) return user_error("truncated: unexpected end of file");
        const std::size_t length = big_endian(file.subspan(position));
        const std::string_view type(reinterpret_cast<const char*>(file.data()) + position + 4, 4);
        if (length > file.size() - position - 12) return user_error("truncated: unexpected end of file");
        const auto covered = file.subspan(position + 4, length + 4);
        if (libdeflate_crc32(0, covered.data(), covered.size()) != big_endian(file.subspan(position + 8 + length)))
            return user_error(fmt::format("damaged: the checksum of the chunk at byte {} does not match", position));
        if (is_first && type != "IHDR") return user_error("malformed header: the first chunk must be IHDR");
        if (is_first)
            if (auto checked = check_header(covered.subspan(4), file.size()); !checked) return checked;
        if (type == "IEND") return {};
        position += length + 12;
    }
}

}  // namespace darkroom
