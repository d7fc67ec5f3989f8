// SPDX-License-Identifier: MIT
#include "formats/png/png_write.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <string_view>

#include "formats/icc_profile.hpp"

namespace darkroom {
namespace {

using Packed = std::vector<std::byte>;

void put_number(Packed& to, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) to.push_back(static_cast<std::byte>(value >> shift));
}

void put_chunk(Packed& to, std::string_view type, std::span<const std::byte> data) {
    put_number(to, static_cast<std::uint32_t>(data.size()));
    const std::size_t start = to.size();
    const std::span<const std::byte> name = std::as_bytes(std::span(type));
    to.insert(to.end(), name.begin(), name.end());
    to.insert(to.end(), data.begin(), data.end());
    put_number(to, libdeflate_crc32(0, to.data() + start, to.size() - start));
}

/// Of a row: its bytes, the most significant of a sample first.
void put_row(const EncodeDesc& desc, std::uint32_t row, std::uint8_t* to) {
    const std::size_t count = std::size_t{desc.width} * desc.channels;
    const auto* const from = static_cast<const std::uint8_t*>(desc.samples) + row * count * size_of(desc.kind);
    if (size_of(desc.kind) == 1) {
        std::memcpy(to, from, count);
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        std::uint16_t value;
        std::memcpy(&value, from + 2 * i, sizeof value);
        to[2 * i] = static_cast<std::uint8_t>(value >> 8);
        to[2 * i + 1] = static_cast<std::uint8_t>(value);
    }
}

// ISO/IEC 15948, 9.4: the neighbour that is nearest to left + above - above left.
void filter_paeth(const std::uint8_t* row, const std::uint8_t* above, std::size_t count, std::size_t pixel,
                  std::uint8_t* to) {
    for (std::size_t i = 0; i < pixel; ++i) to[i] = static_cast<std::uint8_t>(row[i] - above[i]);
    for (std::size_t i = pixel; i < count; ++i) {
        const std::int16_t left = row[i - pixel], up = above[i], corner = above[i - pixel];
        const auto to_left = static_cast<std::int16_t>(std::abs(up - corner));
        const auto to_up = static_cast<std::int16_t>(std::abs(left - corner));
        const auto to_corner = static_cast<std::int16_t>(std::abs(left + up - 2 * corner));
        const std::int16_t best_of_two = to_left <= to_up ? left : up;
        const std::int16_t smaller = to_left <= to_up ? to_left : to_up;
        to[i] = static_cast<std::uint8_t>(row[i] - (smaller <= to_corner ? best_of_two : corner));
    }
}

constexpr std::uint8_t none = 0, paeth = 4;

std::vector<std::uint8_t> filtered(const EncodeDesc& desc, std::uint8_t filter) {
    const std::size_t pixel = std::size_t{desc.channels} * size_of(desc.kind), count = desc.width * pixel;
    std::vector<std::uint8_t> out((count + 1) * desc.height);
    std::vector<std::uint8_t> row(count), above(count);
    for (std::uint32_t y = 0; y < desc.height; ++y) {
        std::uint8_t* const to = out.data() + y * (count + 1);
        to[0] = filter;
        put_row(desc, y, filter == none ? to + 1 : row.data());
        if (filter == paeth) filter_paeth(row.data(), above.data(), count, pixel, to + 1);
        row.swap(above);
    }
    return out;
}

struct FreeCompressor {
    void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
};

Packed deflated(std::span<const std::uint8_t> data, int level) {
    const std::unique_ptr<libdeflate_compressor, FreeCompressor> compressor(libdeflate_alloc_compressor(level));
    if (!compressor) throw std::bad_alloc();
    Packed out(libdeflate_zlib_compress_bound(compressor.get(), data.size()));
    out.resize(libdeflate_zlib_compress(compressor.get(), data.data(), data.size(), out.data(), out.size()));
    return out;
}

// Level 4 makes files of pictures as large as libpng does by default, or a few per cent larger. Flat ones, which are
// small, cost next to nothing: they are tried at level 7 as they are, which suits them better.
Packed compressed(const EncodeDesc& desc) {
    const std::vector<std::uint8_t> by_paeth = filtered(desc, paeth);
    if (!desc.compression.empty()) return deflated(by_paeth, std::stoi(desc.compression));
    constexpr std::size_t flat_ratio = 20;
    Packed out = deflated(by_paeth, 4);
    if (out.size() * flat_ratio > by_paeth.size()) return out;
    Packed other = deflated(filtered(desc, none), 7);
    return other.size() < out.size() ? other : out;
}

/// Primaries and curve by ITU-T H.273.
std::array<std::byte, 2> video_codes_of(const ColorState& state) {
    std::byte curve{13};
    if (state.transfer == Transfer::Pq) curve = std::byte{16};
    if (state.transfer == Transfer::Hlg) curve = std::byte{18};
    const unsigned primaries = state.primaries == Primaries::P3 ? 12 : state.primaries == Primaries::Rec2020 ? 9 : 1;
    return {std::byte(primaries), curve};
}

// PNG, third edition, 11.3.2.3. cICP goes before it.
void put_profile(Packed& out, std::span<const std::byte> profile) {
    constexpr std::string_view name("ICC profile\0\0", 13);  // behind its end the way of packing
    const std::span<const std::byte> start = std::as_bytes(std::span(name));
    Packed chunk(start.begin(), start.end());
    const Packed packed = deflated({reinterpret_cast<const std::uint8_t*>(profile.data()), profile.size()}, 9);
    chunk.insert(chunk.end(), packed.begin(), packed.end());
    put_chunk(out, "iCCP", chunk);
}

// Of PQ, in cd/m2: the display that it is made for, the brightest component of a pixel, and the mean of each pixel's
// brightest (CTA-861.3, MaxCLL and MaxFALL; PNG, third edition, 11.3.2.7 and 11.3.2.8). Without them browsers take the
// brightest that PQ holds for the picture's.
template <class Code>
void put_light(Packed& out, const EncodeDesc& desc) {
    constexpr std::size_t last = std::numeric_limits<Code>::max();
    const TransferCurve pq{TransferCurve::Kind::Pq};
    std::vector<double> nits(last + 1);
    for (std::size_t code = 0; code <= last; ++code)
        nits[code] = pq.decode(static_cast<double>(code) / last) * double{desc.color->white_nits};
    const auto* const samples = static_cast<const Code*>(desc.samples);
    const std::size_t pixels = std::size_t{desc.width} * desc.height;
    Code brightest = 0;
    double sum = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const Code* const pixel = samples + i * desc.channels;
        const Code own = std::max({pixel[0], pixel[1], pixel[2]});
        brightest = std::max(brightest, own);
        sum += nits[own];
    }
    const auto number = [](double value) { return static_cast<std::uint32_t>(std::lround(value * 10000)); };
    Packed display, content;
    const auto& [red, green, blue, white] = chromaticities_of(desc.color->primaries);
    for (const Chromaticity& point : {red, green, blue, white})
        for (const double value : {point.x, point.y}) {
            const auto place = static_cast<std::uint16_t>(std::lround(value * 50000));
            display.push_back(static_cast<std::byte>(place >> 8));
            display.push_back(static_cast<std::byte>(place & 0xff));
        }
    put_number(display, number(desc.color->peak_nits));
    put_number(display, 1);
    put_number(content, number(nits[brightest]));
    put_number(content, number(sum / static_cast<double>(pixels)));
    put_chunk(out, "mDCV", display);
    put_chunk(out, "cLLI", content);
}

}  // namespace

Result<std::vector<std::byte>> encode_png(const EncodeDesc& desc) {
    constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
    const std::span<const std::byte> start = std::as_bytes(std::span(signature));
    Packed out(start.begin(), start.end());
    Packed header;
    put_number(header, desc.width);
    put_number(header, desc.height);
    const std::uint8_t color_type = desc.channels == 4 ? 6 : 2;
    for (const std::uint32_t value :
         {static_cast<std::uint32_t>(8 * size_of(desc.kind)), std::uint32_t{color_type}, 0u, 0u, 0u})
        header.push_back(static_cast<std::byte>(value));
    put_chunk(out, "IHDR", header);
    if (desc.color == srgb_color) {
        put_chunk(out, "sRGB", std::array{std::byte{0}});  // rendering intent: perceptual
    } else if (desc.color) {
        // PNG, third edition, 11.3.2.6; no matrix, and the full range.
        const auto [primaries, curve] = video_codes_of(*desc.color);
        put_chunk(out, "cICP", std::array{primaries, curve, std::byte{0}, std::byte{1}});
        // For those who do not know these numbers.
        if (desc.color == p3_color) put_profile(out, display_profile("Display P3", chromaticities_of(Primaries::P3)));
        if (desc.color->transfer == Transfer::Pq)
            desc.kind == SampleKind::Integer8 ? put_light<std::uint8_t>(out, desc)
                                              : put_light<std::uint16_t>(out, desc);
    }
    const Packed data = compressed(desc);
    // A chunk has at most 2^31 - 1 bytes.
    constexpr std::size_t longest = std::size_t{1} << 30;
    for (std::size_t at = 0; at < data.size(); at += longest)
        put_chunk(out, "IDAT", std::span(data).subspan(at, std::min(longest, data.size() - at)));
    put_chunk(out, "IEND", {});
    return out;
}

}  // namespace darkroom
