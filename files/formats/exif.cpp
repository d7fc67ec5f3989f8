// SPDX-License-Identifier: MIT
#include "formats/exif.hpp"

#include <string_view>

namespace darkroom {
namespace {

constexpr std::size_t short_type = 3, long_type = 4, directory_type = 13, long8_type = 16, directory8_type = 18;

}  // namespace

TiffTags::TiffTags(std::span<const std::byte> file)
    : file_(file), is_little_(!file.empty() && file[0] == std::byte{'I'}), is_big_(number(2, 2) == 43) {}

std::span<const std::byte> TiffTags::bytes(std::size_t at, std::size_t size) const {
    return at <= file_.size() && size <= file_.size() - at ? file_.subspan(at, size) : std::span<const std::byte>();
}

std::optional<std::size_t> TiffTags::number(std::size_t at, std::size_t size) const {
    const std::span<const std::byte> found = bytes(at, size);
    if (found.empty()) return std::nullopt;
    std::size_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
        value = value << 8 | std::to_integer<std::size_t>(found[is_little_ ? size - 1 - i : i]);
    return value;
}

std::optional<TiffTags::Value> TiffTags::find(std::size_t directory, std::size_t tag) const {
    const std::size_t pointer = is_big_ ? 8 : 4, counter = is_big_ ? 8 : 2, size = 4 + 2 * pointer;
    const std::size_t count = number(directory, counter).value_or(0);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = directory + counter + i * size;
        if (bytes(at, size).empty()) return std::nullopt;
        if (number(at, 2) == tag) return Value{*number(at + 2, 2), *number(at + 4, pointer), at + 4 + pointer};
    }
    return std::nullopt;
}

std::optional<std::size_t> TiffTags::whole(std::size_t directory, std::size_t tag) const {
    const std::optional<Value> found = find(directory, tag);
    if (!found) return std::nullopt;
    if (found->type == short_type) return number(found->at, 2);
    if (found->type == long_type || found->type == directory_type) return number(found->at, 4);
    if (is_big_ && (found->type == long8_type || found->type == directory8_type)) return number(found->at, 8);
    return std::nullopt;
}

std::uint8_t orientation_of_exif(std::span<const std::byte> file) {
    constexpr std::size_t orientation = 274;
    const TiffTags tags(file);
    const auto found = tags.find(tags.first_directory(), orientation);
    const std::size_t value = found && found->type == short_type ? tags.number(found->at, 2).value_or(1) : 1;
    return value >= 1 && value <= 8 ? static_cast<std::uint8_t>(value) : 1;
}

ExifColor color_of_exif(std::span<const std::byte> file) {
    constexpr std::size_t exif = 34665, color_space = 40961, interoperability = 40965, index = 1;
    constexpr std::size_t srgb = 1, uncalibrated = 65535;
    constexpr std::size_t adobe = 2;  // in no standard, and written by cameras
    const TiffTags tags(file);
    const auto directory = tags.whole(tags.first_directory(), exif);
    if (!directory) return ExifColor::Unsaid;
    const std::optional<std::size_t> space = tags.whole(*directory, color_space);
    bool is_adobe = space == adobe;
    if (const auto at = tags.whole(*directory, interoperability)) {
        const auto found = tags.find(*at, index);
        const std::span<const std::byte> name =
            found && found->count == 4 ? tags.bytes(found->at, 3) : tags.bytes(0, 0);
        is_adobe = is_adobe || std::string_view(reinterpret_cast<const char*>(name.data()), name.size()) == "R03";
    }
    if (space == srgb) return is_adobe ? ExifColor::Contradictory : ExifColor::Srgb;
    if (is_adobe) return ExifColor::AdobeRgb;
    return space == uncalibrated ? ExifColor::Uncalibrated : ExifColor::Unsaid;
}

}  // namespace darkroom
