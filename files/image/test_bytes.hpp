// SPDX-License-Identifier: MIT
#pragma once
// For the tests of hostile image files, which are written byte by byte.

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace darkroom {

template <class T>
std::string little_endian(T value) {
    return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

inline std::string big_endian(std::uint32_t value, int bytes) {
    std::string out;
    for (int shift = bytes * 8 - 8; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
    return out;
}

inline std::uint32_t crc_of(const std::string& text) {
    std::uint32_t crc = 0xffffffffU;
    for (const char c : text) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xedb88320U ^ (crc >> 1) : crc >> 1;
    }
    return ~crc;
}

inline const std::string png_start = "\x89PNG\r\n\x1a\n";

inline std::string png_chunk(const std::string& type, const std::string& data) {
    return big_endian(static_cast<std::uint32_t>(data.size()), 4) + type + data + big_endian(crc_of(type + data), 4);
}

/// Colour types: 0 grey, 2 colour, 3 of a palette, 6 colour and alpha.
inline std::string png_header(std::uint32_t width, std::uint32_t height, char bits, char color_type,
                              bool is_interlaced = false) {
    return png_chunk("IHDR", big_endian(width, 4) + big_endian(height, 4) + bits + color_type + '\0' + '\0' +
                                 static_cast<char>(is_interlaced ? 1 : 0));
}

/// A stream of zlib that packs nothing.
inline std::string stored(const std::string& text) {
    std::uint32_t low = 1, high = 0;
    for (const unsigned char c : text) {
        low = (low + c) % 65521;
        high = (high + low) % 65521;
    }
    std::string out = "\x78\x01";
    constexpr std::size_t most = 65535;
    for (std::size_t at = 0; at == 0 || at < text.size(); at += most) {
        const std::string block = text.substr(at, most);
        const auto size = static_cast<std::uint16_t>(block.size());
        out += (at + most < text.size() ? '\0' : '\1') + little_endian(size) +
               little_endian(static_cast<std::uint16_t>(~size)) + block;
    }
    return out + big_endian(high << 16 | low, 4);
}

inline std::string exr_attribute(const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + little_endian(static_cast<std::int32_t>(value.size())) + value;
}

/// A file of OpenEXR of a pixel a part, whose layers have a channel each.
inline std::string exr_of_layers(std::size_t parts, int layers) {
    const auto& attribute = exr_attribute;
    std::string channels;
    for (int i = 0; i < layers; ++i)
        channels += fmt::format("L{:04}.X", i) + '\0' + little_endian(1U) + little_endian(0U) + little_endian(1U) +
                    little_endian(1U);
    std::string header = little_endian(0x01312f76U) + little_endian(0x1002U);
    for (std::size_t part = 0; part < parts; ++part)
        header += attribute("channels", "chlist", channels + '\0') + attribute("chunkCount", "int", little_endian(1)) +
                  attribute("compression", "compression", std::string(1, '\0')) +
                  attribute("dataWindow", "box2i", std::string(16, '\0')) +
                  attribute("displayWindow", "box2i", std::string(16, '\0')) +
                  attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
                  attribute("name", "string", fmt::format("p{}", part)) +
                  attribute("pixelAspectRatio", "float", little_endian(1.0F)) +
                  attribute("screenWindowCenter", "v2f", std::string(8, '\0')) +
                  attribute("screenWindowWidth", "float", little_endian(1.0F)) +
                  attribute("type", "string", "scanlineimage") + '\0';
    header += '\0';
    std::string places, chunks;
    for (std::size_t part = 0; part < parts; ++part) {
        places += little_endian(static_cast<std::uint64_t>(header.size() + 8 * parts + chunks.size()));
        chunks += little_endian(static_cast<std::int32_t>(part)) + little_endian(0) + little_endian(2 * layers) +
                  std::string(static_cast<std::size_t>(2 * layers), '\0');
    }
    return header + places + chunks;
}

/// A TIFF file: its directory, what lists of the tags need, and its samples, which lie at the end.
struct TestTiff {
    std::map<std::uint32_t, std::vector<std::uint32_t>> tags;
    std::string samples;
    std::uint32_t next = 0;  ///< where another directory lies

    /// Grey of 8 bits, in one strip.
    static TestTiff gray(std::uint32_t width, std::uint32_t height) {
        TestTiff out{.samples = std::string(std::size_t{width} * height, 'x')};
        const std::map<std::uint32_t, std::uint32_t> values{{256, width}, {257, height}, {258, 8},
                                                            {259, 1},     {262, 1},      {273, samples_here},
                                                            {277, 1},     {278, height}, {279, width * height}};
        for (const auto& [tag, value] : values) out.tags[tag].push_back(value);
        return out;
    }
    /// As one of a tag's values: where the samples begin.
    static constexpr std::uint32_t samples_here = 0xffffffffU;

    [[nodiscard]] std::string text() const {
        std::uint32_t lists = static_cast<std::uint32_t>(8 + 2 + 12 * tags.size() + 4), end = lists;
        for (const auto& [tag, values] : tags)
            if (values.size() > 1) end += static_cast<std::uint32_t>(4 * values.size());
        std::string directory, rest;
        for (const auto& [tag, values] : tags) {
            std::string all;
            for (const std::uint32_t value : values) all += little_endian(value == samples_here ? end : value);
            directory += little_endian(static_cast<std::uint16_t>(tag)) + little_endian(std::uint16_t{4}) +
                         little_endian(static_cast<std::uint32_t>(values.size()));
            directory += values.size() == 1 ? all : little_endian(lists);
            if (values.size() == 1) continue;
            rest += all;
            lists += static_cast<std::uint32_t>(all.size());
        }
        return std::string("II*\0", 4) + little_endian(8U) + little_endian(static_cast<std::uint16_t>(tags.size())) +
               directory + little_endian(next) + rest + samples;
    }
};

}  // namespace darkroom
