// SPDX-License-Identifier: MIT
#include "formats/exr/exr_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "formats/file_part.hpp"

namespace darkroom::exr {
namespace {

// A decoder keeps each attribute of each part under its name, several times over: 2 kB and 10 us for one of no bytes.
// Strings of a list count as attributes.
constexpr std::size_t max_attributes = 65536;
constexpr std::size_t max_attribute_bytes = std::size_t{32} << 20;

// The library reads what a type needs, whatever size stands before it, and takes what follows for the next attribute: a
// name, or a size to allocate. What it checks itself, or ends with its size, is not here; lists of channels are below.
struct TypeSize {
    std::string_view type;
    std::size_t bytes;
};
constexpr std::array<TypeSize, 24> type_sizes{{{"box2f", 16},
                                               {"box2i", 16},
                                               {"chromaticities", 32},
                                               {"compression", 1},
                                               {"deepImageState", 1},
                                               {"double", 8},
                                               {"envmap", 1},
                                               {"float", 4},
                                               {"int", 4},
                                               {"keycode", 28},
                                               {"lineOrder", 1},
                                               {"m33d", 72},
                                               {"m33f", 36},
                                               {"m44d", 128},
                                               {"m44f", 64},
                                               {"rational", 8},
                                               {"tiledesc", 9},
                                               {"timecode", 8},
                                               {"v2d", 16},
                                               {"v2f", 8},
                                               {"v2i", 8},
                                               {"v3d", 24},
                                               {"v3f", 12},
                                               {"v3i", 12}}};

Result<> check_size(std::string_view name, std::string_view type, std::size_t bytes) {
    const auto* const known = std::ranges::find(type_sizes, type, &TypeSize::type);
    if (known == type_sizes.end() || known->bytes == bytes) return {};
    return malformed(
        fmt::format("attribute {} has {} bytes, a {} has {}", one_printable_line(name), bytes, type, known->bytes));
}

Window read_window(Reader& reader) {
    Window window;
    window.left = reader.number<std::int32_t>();
    window.top = reader.number<std::int32_t>();
    window.right = reader.number<std::int32_t>();
    window.bottom = reader.number<std::int32_t>();
    return window;
}

Result<> read_channels(Reader reader, CheckedPart& part) {
    for (;;) {
        const std::string_view name = reader.text();
        if (reader.is_past_end()) return malformed("the channel list has no end");
        if (name.empty())
            return reader.left() == 0 ? Result<>() : malformed("the channel list ends before its attribute does");
        const auto type = reader.number<std::uint32_t>();
        reader.number<std::uint32_t>();
        const auto x_sampling = reader.number<std::int32_t>();
        const auto y_sampling = reader.number<std::int32_t>();
        if (reader.is_past_end()) return malformed("the channel list has no end");
        if (type > 2) return malformed(fmt::format("a channel has pixel type {}, [0, 2] is allowed", type));
        // Chroma at half the resolution is what there is.
        constexpr std::int32_t coarsest = 64;
        if (std::min(x_sampling, y_sampling) < 1 || std::max(x_sampling, y_sampling) > coarsest)
            return malformed(fmt::format("channel {} is sampled {}x{}, [1, {}] is allowed", one_printable_line(name),
                                         x_sampling, y_sampling, coarsest));
        part.bytes_per_pixel += (type == 1 ? 2.0 : 4.0) / (x_sampling * y_sampling);
        if (++part.channel_count > 1024) return malformed("more than 1024 channels");
    }
}

Result<> read_attribute(std::string_view name, std::string_view type, std::span<const std::byte> value,
                        CheckedPart& part) {
    Reader reader(value);
    if (name == "channels") return read_channels(reader, part);
    if (CheckedPart other; type == "chlist") return read_channels(reader, other);
    if (name == "dataWindow") part.data = read_window(reader);
    if (name == "displayWindow") part.display = read_window(reader);
    if (name == "compression") part.compression = reader.number<std::uint8_t>();
    if (name == "name")
        part.name.assign(reinterpret_cast<const char*>(value.data()), std::min<std::size_t>(value.size(), 256));
    if (name == "type")
        part.type.assign(reinterpret_cast<const char*>(value.data()), std::min<std::size_t>(value.size(), 32));
    if (name == "tiles") {
        Tiles tiles;
        tiles.width = reader.number<std::uint32_t>();
        tiles.height = reader.number<std::uint32_t>();
        const auto mode = reader.number<std::uint8_t>();
        tiles.level_mode = mode & 0xfu;
        tiles.rounds_up = (mode >> 4) != 0;
        part.tiles = tiles;
    }
    if (reader.is_past_end()) return malformed(fmt::format("attribute {} is too short", name));
    return {};
}

Result<> count_attribute(std::string_view type, std::span<const std::byte> value, AttributeCount& count) {
    ++count.number;
    count.bytes += value.size();
    if (type == "stringvector")
        for (Reader reader(value); reader.left() > 0; ++count.number) reader.block(reader.number<std::int32_t>());
    if (count.number > max_attributes) return malformed(fmt::format("more than {} attributes", max_attributes));
    if (count.bytes > max_attribute_bytes)
        return malformed(fmt::format("attributes of more than {} bytes", max_attribute_bytes));
    return {};
}

}  // namespace

Failure malformed(std::string_view what) { return user_error(fmt::format("malformed header: {}", what)); }
Failure cut_off() { return user_error("truncated: unexpected end of file in the header"); }

Result<> read_part(Reader& reader, CheckedPart& part, AttributeCount& count) {
    for (;;) {
        const std::string_view name = reader.text();
        if (reader.is_past_end()) return cut_off();
        if (name.empty()) return {};
        const std::string_view type = reader.text();
        const auto size = reader.number<std::int32_t>();
        if (size < 0) return malformed(fmt::format("an attribute of {} bytes", size));
        const auto value = reader.block(size);
        if (reader.is_past_end()) return cut_off();
        DARKROOM_TRY(count_attribute(type, value, count));
        DARKROOM_TRY(check_size(name, type, value.size()));
        DARKROOM_TRY(read_attribute(name, type, value, part));
    }
}

}  // namespace darkroom::exr
