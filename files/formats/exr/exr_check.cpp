// SPDX-License-Identifier: MIT
#include "formats/exr/exr_check.hpp"

#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/OpenEXRConfig.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/exr/exr_header.hpp"
#include "formats/picture_source.hpp"

namespace darkroom {
namespace {

using namespace exr;

constexpr std::uint32_t tiled_flag = 0x200;
constexpr std::uint32_t deep_flag = 0x800;
constexpr std::uint32_t multi_part_flag = 0x1000;

// By the number that the file stores: lines in a chunk, and how many bytes of pixels one byte of file can become at
// most. Run lengths: 128 from 2. Deflate: 258 bytes from 2 bits. PIZ: a Huffman run of 255 words from 10 bits. B44A: 32
// bytes from 3. DWA keeps one deflated coefficient of 64.
struct Compression {
    Wide lines;
    Wide largest_ratio;
};
constexpr std::array<Compression, 12> compressions{{{1, 1},
                                                    {1, 64},
                                                    {1, 1100},
                                                    {16, 1100},
                                                    {32, 512},
                                                    {16, 1100},
                                                    {32, 11},
                                                    {32, 11},
                                                    {32, 70000},
                                                    {256, 70000},
                                                    {256, 70000},
                                                    {32, 70000}}};

/// Those that came behind dwab, with the version of OpenEXR that did.
struct NewerCompression {
    std::string_view name, version;
};
constexpr std::array<NewerCompression, 4> newer_compressions{
    {{"HTJ2K256", "3.4"}, {"HTJ2K32", "3.4"}, {"LJ2K", "3.5"}, {"ZSTD", "3.5"}}};

Result<> check_compression(std::size_t number) {
    constexpr std::size_t dwab = 9, known = std::min<std::size_t>(compressions.size(), Imf::NUM_COMPRESSION_METHODS);
    if (number < known) return {};
    if (number - dwab - 1 < newer_compressions.size()) {
        const NewerCompression& newer = newer_compressions[number - dwab - 1];
        return user_error(fmt::format("is packed by {}, which OpenEXR {} brought; this build has OpenEXR {}",
                                      newer.name, newer.version, OPENEXR_VERSION_STRING));
    }
    return malformed(fmt::format("compression {}, [0, {}] is allowed", number, known - 1));
}

// A chunk is unpacked in one piece, with its packed bytes and a copy beside it. 4096x4096 pixels of RGBA in floats.
constexpr Wide largest_chunk = Wide{1} << 28;

Result<> check_window(const Window& window, const char* name) {
    if (window.width() <= 0 || window.height() <= 0)
        return user_error(fmt::format("the {} is empty ({}), at least 1x1 is needed", name, window.text()));
    if (window.width() > max_picture_side || window.height() > max_picture_side)
        return user_error(
            fmt::format("the {} is {}, at most {} a side is allowed", name, window.text(), max_picture_side));
    constexpr Wide farthest = 1 << 30;
    if (std::min(window.left, window.top) < -farthest || std::max(window.right, window.bottom) > farthest)
        return user_error(
            fmt::format("the {} is {}, coordinates in [-{}, {}] are allowed", name, window.text(), farthest, farthest));
    return {};
}

Wide divide_up(Wide a, Wide b) { return (a + b - 1) / b; }

std::vector<Wide> level_sizes(Wide size, Wide longest, bool rounds_up) {
    std::vector<Wide> sizes;
    for (Wide scale = 1;; scale *= 2) {
        sizes.push_back(std::max<Wide>(1, rounds_up ? divide_up(size, scale) : size / scale));
        const Wide reached = rounds_up ? divide_up(longest, scale) : longest / scale;
        if (reached <= 1) return sizes;
    }
}

Wide count_tiles(const Window& data, const Tiles& tiles) {
    const auto count = [](Wide size, Wide tile) { return divide_up(size, tile); };
    if (tiles.level_mode == 0) return count(data.width(), tiles.width) * count(data.height(), tiles.height);
    const Wide longest = std::max(data.width(), data.height());
    const bool is_mip = tiles.level_mode == 1;
    const auto widths = level_sizes(data.width(), is_mip ? longest : data.width(), tiles.rounds_up);
    const auto heights = level_sizes(data.height(), is_mip ? longest : data.height(), tiles.rounds_up);
    Wide total = 0;
    for (std::size_t y = 0; y < heights.size(); ++y)
        for (std::size_t x = 0; x < widths.size(); ++x)
            if (!is_mip || x == y) total += count(widths[x], tiles.width) * count(heights[y], tiles.height);
    return total;
}

Result<> check_chunk(Wide width, Wide height, const CheckedPart& part) {
    const auto bytes = static_cast<Wide>(static_cast<double>(width * height) * part.bytes_per_pixel);
    if (bytes <= largest_chunk) return {};
    return user_error(fmt::format("chunks of {}x{} pixels need {} bytes each, at most {} are allowed", width, height,
                                  bytes, largest_chunk));
}

Result<> check_part(CheckedPart& part, bool is_tiled, std::size_t file_size) {
    if (!part.data || !part.display || !part.compression) return malformed("a window or the compression is missing");
    DARKROOM_TRY(check_window(*part.display, "display window"));
    DARKROOM_TRY(check_window(*part.data, "data window"));
    if (part.channel_count == 0) return user_error("has no channels");
    DARKROOM_TRY(check_compression(*part.compression));
    const Compression compression = compressions[*part.compression];

    const Wide bytes = part.bytes =
        static_cast<Wide>(static_cast<double>(part.data->width() * part.data->height()) * part.bytes_per_pixel);
    if (bytes / compression.largest_ratio > static_cast<Wide>(file_size))
        return user_error(
            fmt::format("the data window is {} and needs {} bytes of pixels, which a file of {} bytes "
                        "cannot hold: truncated (unexpected end of file) or damaged",
                        part.data->text(), bytes, file_size));
    if (!is_tiled) {
        part.chunk_count = divide_up(part.data->height(), compression.lines);
        return check_chunk(part.data->width(), std::min(compression.lines, part.data->height()), part);
    }
    if (!part.tiles) return malformed("a tiled part without a tile description");
    const Tiles& tiles = *part.tiles;
    if (tiles.width < 1 || tiles.height < 1 || tiles.width > 8192 || tiles.height > 8192)
        return malformed(fmt::format("tiles of {}x{}, [1, 8192] a side is allowed", tiles.width, tiles.height));
    if (tiles.level_mode > 2) return malformed(fmt::format("tile level mode {}, [0, 2] is allowed", tiles.level_mode));
    part.chunk_count = count_tiles(*part.data, tiles);
    return check_chunk(tiles.width, tiles.height, part);
}

// Pixels outside the data window cost no file but memory all the same: up to 8K is always fine, beyond that the display
// window may be 64 times the largest data window. Parts share the display window and need not fill it.
Result<> check_proportions(std::span<const CheckedPart> parts) {
    const auto area = [](const Window& window) { return window.width() * window.height(); };
    const auto data = std::max_element(parts.begin(), parts.end(), [&](const CheckedPart& a, const CheckedPart& b) {
        return area(*a.data) < area(*b.data);
    });
    for (const CheckedPart& part : parts)
        if (area(*part.display) > (Wide{1} << 25) && area(*part.display) / 64 > area(*data->data))
            return user_error(fmt::format("the display window ({}) is out of proportion to the data window ({})",
                                          part.display->text(), data->data->text()));
    return {};
}

// A chunk starts with its part (in files of several parts), its place, and the size of what follows.
Result<> check_chunks(Reader table, const CheckedPart& part, bool is_tiled, bool is_multi_part,
                      std::span<const std::byte> file, std::size_t first_chunk) {
    const std::size_t place = (is_multi_part ? 4u : 0u) + (is_tiled ? 16u : 4u);
    for (Wide chunk = 0; chunk < part.chunk_count; ++chunk) {
        const auto offset = table.number<std::uint64_t>();
        if (offset == 0)
            return user_error(
                fmt::format("unfinished: its table has no place for chunk {} of {}; a writer that is ended "
                            "before its time leaves none",
                            chunk + 1, part.chunk_count));
        if (offset < first_chunk)
            return user_error(fmt::format("chunk {} of {} lies in the header", chunk + 1, part.chunk_count));
        const bool fits = offset <= file.size() && file.size() - offset >= place + 4;
        const Wide size = fits ? Reader(file, static_cast<std::size_t>(offset) + place).number<std::int32_t>() : 0;
        if (size < 0) return user_error(fmt::format("chunk {} of {} has no size", chunk + 1, part.chunk_count));
        if (!fits || file.size() - offset - place - 4 < static_cast<std::size_t>(size))
            return user_error(
                fmt::format("truncated: unexpected end of file in chunk {} of {}", chunk + 1, part.chunk_count));
    }
    return {};
}

}  // namespace

Result<> check_exr(std::span<const std::byte> file) {
    Reader reader(file);
    if (reader.number<std::uint32_t>() != 0x01312f76) return user_error("is not an OpenEXR file");
    const auto version = reader.number<std::uint32_t>();
    if (reader.is_past_end()) return cut_off();
    if ((version & 0xff) != 2) return user_error(fmt::format("OpenEXR version {}, 2 is read here", version & 0xff));
    const bool is_multi_part = (version & multi_part_flag) != 0;
    if ((version & deep_flag) != 0 && !is_multi_part)
        return user_error("has deep pixels, which are not read here; flatten it first");

    std::vector<CheckedPart> parts;
    AttributeCount attributes;
    for (;;) {
        CheckedPart part;
        DARKROOM_TRY(read_part(reader, part, attributes));
        parts.push_back(std::move(part));
        if (!is_multi_part) break;
        if (parts.size() > 256) return malformed("more than 256 parts");
        Reader ahead = reader;
        if (ahead.number<std::uint8_t>() == 0) {
            if (ahead.is_past_end()) return cut_off();
            reader = ahead;
            break;
        }
    }

    Wide total = 0;
    std::uint64_t decoded = 0;
    std::vector<bool> is_tiled;
    for (CheckedPart& part : parts) {
        is_tiled.push_back(is_multi_part ? part.type.starts_with("tiledimage") : (version & tiled_flag) != 0);
        if (part.type.starts_with("deep"))
            return user_error(
                fmt::format("part {} of {}, \"{}\", has deep pixels, which are not read here; flatten it first",
                            &part - parts.data() + 1, parts.size(), one_printable_line(part.name)));
        if (is_multi_part && part.type != "tiledimage" && part.type != "scanlineimage")
            return malformed("a part of a kind that is neither scanlineimage nor tiledimage");
        if (!part.type.empty() && part.type.starts_with("tiledimage") != is_tiled.back())
            return malformed(fmt::format("the type is {}, the version field says {}", one_printable_line(part.type),
                                         is_tiled.back() ? "tiled" : "scan lines"));
        DARKROOM_TRY(check_part(part, is_tiled.back(), file.size()));
        total += part.chunk_count;
        decoded += static_cast<std::uint64_t>(part.bytes);
    }
    DARKROOM_TRY(check_decoded_size(decoded, file.size()));
    DARKROOM_TRY(check_proportions(parts));
    if (static_cast<Wide>(reader.left() / 8) < total)
        return user_error(fmt::format("truncated: unexpected end of file in the table of {} chunks", total));
    const std::size_t first_chunk = reader.position() + static_cast<std::size_t>(total) * 8;
    Reader table = reader;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        DARKROOM_TRY(check_chunks(table, parts[i], is_tiled[i], is_multi_part, file, first_chunk));
        table.block(parts[i].chunk_count * 8);
    }
    return {};
}

}  // namespace darkroom
