// SPDX-License-Identifier: MIT
#include "formats/jpeg/gain_map_write.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace darkroom {
namespace {

constexpr double offset = 1.0 / 64;
/// Most of a picture is below white, where gains are small: its steps are the finer ones.
constexpr double gamma = 0.5;
/// Of the fractions that stand in files.
constexpr std::uint32_t fraction = 65536;

std::string number(std::uint32_t value, int bytes = 4) {
    std::string out;
    for (int shift = bytes * 8 - 8; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xffU);
    return out;
}

std::string segment(char application, std::string_view mark, std::string_view data) {
    return std::string("\xff") + application + number(static_cast<std::uint32_t>(mark.size() + data.size() + 2), 2) +
           std::string(mark) + std::string(data);
}

std::string xmp(const std::string& attributes, const std::string& elements) {
    return segment('\xe1', std::string_view("http://ns.adobe.com/xap/1.0/\0", 29),
                   "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
                   "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description rdf:about=\"\" "
                   "xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/1.0/\" hdrgm:Version=\"1.0\"" +
                       attributes + ">" + elements + "</rdf:Description></rdf:RDF></x:xmpmeta>");
}

std::string iso(const std::string& numbers) {
    return segment('\xe2', std::string_view("urn:iso:std:iso:ts:21496:-1\0", 28), number(0) + numbers);
}

std::string numbers_of(const MadeGainMap& map) {
    const auto ratio = [](double value) {
        return number(static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * fraction)))) +
               number(fraction);
    };
    const auto hdrgm = [](const char* name, double value) { return fmt::format(" hdrgm:{}=\"{:.8g}\"", name, value); };
    constexpr char uses_base_colors = 0x40;
    return xmp(hdrgm("GainMapMin", map.min) + hdrgm("GainMapMax", map.max) + hdrgm("Gamma", gamma) +
                   hdrgm("OffsetSDR", offset) + hdrgm("OffsetHDR", offset) + hdrgm("HDRCapacityMin", 0) +
                   hdrgm("HDRCapacityMax", map.headroom) + " hdrgm:BaseRenditionIsHDR=\"False\"",
               "") +
           iso(std::string(1, uses_base_colors) + ratio(0) + ratio(map.headroom) + ratio(map.min) + ratio(map.max) +
               ratio(gamma) + ratio(offset) + ratio(offset));
}

std::string directory_of(std::size_t length) {
    return xmp(" xmlns:Container=\"http://ns.google.com/photos/1.0/container/\" "
               "xmlns:Item=\"http://ns.google.com/photos/1.0/container/item/\"",
               fmt::format("<Container:Directory><rdf:Seq><rdf:li rdf:parseType=\"Resource\"><Container:Item "
                           "Item:Semantic=\"Primary\" Item:Mime=\"image/jpeg\"/></rdf:li><rdf:li "
                           "rdf:parseType=\"Resource\"><Container:Item Item:Semantic=\"GainMap\" "
                           "Item:Mime=\"image/jpeg\" Item:Length=\"{}\"/></rdf:li></rdf:Seq></Container:Directory>",
                           length));
}

/// CIPA DC-007 (2009), 5.2: a TIFF head, three tags, and two pictures, whose places count from that head.
std::string list_of(std::uint32_t first_size, std::uint32_t second_at, std::uint32_t second_size) {
    const auto tag = [](std::uint32_t name, std::uint32_t type, std::uint32_t count, const std::string& value) {
        return number(name, 2) + number(type, 2) + number(count) + value;
    };
    constexpr std::uint32_t primary = 0x030000, list_at = 50;
    return segment('\xe2', std::string_view("MPF\0", 4),
                   std::string("MM\0*", 4) + number(8) + number(3, 2) + tag(0xb000, 7, 4, "0100") +
                       tag(0xb001, 4, 1, number(2)) + tag(0xb002, 7, 32, number(list_at)) + number(0) +
                       number(primary) + number(first_size) + number(0) + number(0) + number(0) + number(second_size) +
                       number(second_at) + number(0));
}

/// Behind the start of the picture and its JFIF segment, which is to be the first.
std::string with_segments(std::string picture, const std::string& segments) {
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(picture[at]); };
    const bool has_jfif = byte(2) == 0xff && byte(3) == 0xe0;
    return picture.insert(has_jfif ? 4U + (byte(4) << 8U | byte(5)) : 2U, segments);
}

std::string string_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

MadeGainMap make_gain_map(std::span<const float> base, std::span<const float> light) {
    // The order of the comparison sends NaN to 0.
    const auto light_of = [](float value) { return value > 0 ? double{std::min(value, 65504.0f)} : 0.0; };
    std::vector<float> stops(base.size());
    double brightest = 1;
    for (std::size_t i = 0; i < stops.size(); ++i) {
        const double wanted = light_of(light[i / 3 * 4 + i % 3]);
        brightest = std::max(brightest, wanted);
        stops[i] = static_cast<float>(std::log2((wanted + offset) / (light_of(base[i]) + offset)));
    }
    // What the base has lost is small but for a few pixels, for which all the others would get coarser steps.
    constexpr double most_lost = 1.0 / 4;
    MadeGainMap out{.headroom = std::max(std::log2(brightest), 1.0 / fraction)};
    out.min = -most_lost;
    out.max = std::ceil((out.headroom + most_lost) * fraction) / fraction;
    out.codes.reserve(stops.size());
    for (const float value : stops)
        out.codes.push_back(static_cast<std::uint8_t>(
            std::lround(std::pow(std::clamp((double{value} - out.min) / (out.max - out.min), 0.0, 1.0), gamma) * 255)));
    return out;
}

std::vector<std::byte> join_gain_map(std::span<const std::byte> base, std::span<const std::byte> picture,
                                     const MadeGainMap& map) {
    const std::string second = with_segments(string_of(picture), numbers_of(map));
    const std::string before = directory_of(second.size()) + iso("");
    const auto list = [&](std::size_t size, std::size_t at) {
        return list_of(static_cast<std::uint32_t>(size), static_cast<std::uint32_t>(at),
                       static_cast<std::uint32_t>(second.size()));
    };
    const std::string start = with_segments(string_of(base), before + list(0, 0));
    const std::size_t head = start.find(list(0, 0)) + 8;
    const std::string out = with_segments(string_of(base), before + list(start.size(), start.size() - head)) + second;
    const auto bytes = std::as_bytes(std::span(out));
    return {bytes.begin(), bytes.end()};
}

}  // namespace darkroom
