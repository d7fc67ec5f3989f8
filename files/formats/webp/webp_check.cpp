// SPDX-License-Identifier: MIT
#include "formats/webp/webp_check.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "formats/exr/exr_check.hpp"
#include "formats/file_part.hpp"

namespace darkroom {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::size_t chunk_head = 8, file_head = 12;

std::uint32_t little_endian(Bytes bytes, std::size_t at, std::size_t count) {
    std::uint32_t out = 0;
    for (std::size_t i = 0; i < count; ++i) out |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
    return out;
}

struct Extent {
    std::uint32_t width = 0, height = 0;
    bool operator==(const Extent&) const = default;
};

// RFC 6386, 9.1: a key frame, its mark, and two sides of 14 bits with two of a scale that nobody uses.
std::optional<Extent> extent_of_lossy(Bytes data) {
    constexpr std::uint32_t mark = 0x2a019d;
    if (data.size() < 10 || (little_endian(data, 0, 1) & 1) != 0 || little_endian(data, 3, 3) != mark)
        return std::nullopt;
    return Extent{little_endian(data, 6, 2) & 0x3fff, little_endian(data, 8, 2) & 0x3fff};
}

// RFC 9649, 3.4: a mark, and two sides less one of 14 bits each.
std::optional<Extent> extent_of_lossless(Bytes data) {
    if (data.size() < 5 || data[0] != std::byte{0x2f}) return std::nullopt;
    const std::uint32_t bits = little_endian(data, 1, 4);
    return Extent{(bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1};
}

struct Found {
    std::optional<Extent> canvas, picture;
    Bytes profile, exif;
};

// Some writers leave the head that EXIF has in JPEG.
Bytes without_head(Bytes exif) {
    constexpr std::string_view head("Exif\0\0", 6);
    const std::string_view text(reinterpret_cast<const char*>(exif.data()), exif.size());
    return text.starts_with(head) ? exif.subspan(head.size()) : exif;
}

Result<> look_at(std::string_view name, Bytes data, Found& found) {
    if (name == "VP8X") {
        constexpr std::uint32_t is_animated = 2;
        if (data.size() < 10) return user_error(fmt::format("truncated: chunk VP8X has {} bytes of 10", data.size()));
        if ((little_endian(data, 0, 1) & is_animated) != 0) return user_error("is animated, which is not read");
        found.canvas = Extent{little_endian(data, 4, 3) + 1, little_endian(data, 7, 3) + 1};
    } else if (name == "ANIM" || name == "ANMF") {
        return user_error("is animated, which is not read");
    } else if (name == "ICCP" && found.profile.empty()) {
        found.profile = data;
    } else if (name == "EXIF" && found.exif.empty()) {
        found.exif = without_head(data);
    } else if (name == "VP8 " || name == "VP8L") {
        if (found.picture) return user_error("has more than one picture");
        found.picture = name == "VP8 " ? extent_of_lossy(data) : extent_of_lossless(data);
        if (!found.picture) return user_error(fmt::format("chunk {} begins with no picture", name));
    }
    return {};
}

}  // namespace

Result<WebpPicture> check_webp(Bytes file) {
    if (file.size() < file_head + chunk_head)
        return user_error(fmt::format("truncated: {} bytes are not a WebP file", file.size()));
    const std::uint64_t end = std::uint64_t{little_endian(file, 4, 4)} + chunk_head;
    if (end > file.size()) return user_error(fmt::format("truncated: {} bytes of {}", file.size(), end));
    file = file.first(static_cast<std::size_t>(end));
    Found found;
    for (std::size_t at = file_head; at + chunk_head <= file.size();) {
        const std::string_view name(reinterpret_cast<const char*>(file.data() + at), 4);
        const std::size_t size = little_endian(file, at + 4, 4), left = file.size() - at - chunk_head;
        if (size > left)
            return user_error(
                fmt::format("truncated: chunk {} has {} bytes of {}", one_printable_line(name), left, size));
        DARKROOM_TRY(look_at(name, file.subspan(at + chunk_head, size), found));
        at += chunk_head + size + size % 2;
    }
    if (!found.picture) return user_error("has no picture");
    const Extent extent = *found.picture;
    if (extent.width == 0 || extent.height == 0)
        return user_error(fmt::format("the picture is {}x{}, at least 1x1 is needed", extent.width, extent.height));
    if (found.canvas && *found.canvas != extent)
        return user_error(fmt::format("the picture is {}x{} on a canvas of {}x{}", extent.width, extent.height,
                                      found.canvas->width, found.canvas->height));
    DARKROOM_TRY(check_decoded_size(std::uint64_t{4} * extent.width * extent.height, file.size()));
    return WebpPicture{extent.width, extent.height, file, found.profile, found.exif};
}

}  // namespace darkroom
