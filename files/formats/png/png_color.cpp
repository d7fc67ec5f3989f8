// SPDX-License-Identifier: MIT
#include "formats/png/png.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string_view>
#include <vector>

#include "formats/png/png_check.hpp"

namespace darkroom {
namespace {

using Bytes = std::span<const std::byte>;
using Kind = TransferCurve::Kind;

std::uint32_t number_of(Bytes bytes) {
    std::uint32_t value = 0;
    for (const std::byte byte : bytes.first(4)) value = value << 8 | std::to_integer<std::uint32_t>(byte);
    return value;
}

/// The chunks before the pixels, and EXIF, which may stand behind them; the first of each name.
std::map<std::string_view, Bytes> chunks_of(Bytes file) {
    std::map<std::string_view, Bytes> out;
    bool is_behind = false;
    for (std::size_t position = 8; file.size() >= position + 12;) {
        const std::size_t length = number_of(file.subspan(position));
        const std::string_view type(reinterpret_cast<const char*>(file.data()) + position + 4, 4);
        if (type == "IEND" || length > file.size() - position - 12) break;
        is_behind = is_behind || type == "IDAT";
        if (!is_behind || type == "eXIf") out.try_emplace(type, file.subspan(position + 8, length));
        position += length + 12;
    }
    return out;
}

/// The numbers of ITU-T H.273 for primaries and curves, as far as pictures have them. A picture is shown: those of
/// cameras (1, 6, 14, 15) stand for the display that they are made for, ITU-R BT.1886.
std::optional<ColorCoding> coding_of_video(unsigned primaries, unsigned curve) {
    ColorCoding out;
    switch (primaries) {
        case 1:
            break;
        case 9:
            out.primaries = find_input_space("rec2020")->primaries;
            break;
        case 12:
            out.primaries = find_input_space("p3")->primaries;
            break;
        default:
            return std::nullopt;
    }
    constexpr std::array<std::pair<unsigned, TransferCurve>, 10> curves{{{1, {Kind::Power, 2.4}},
                                                                         {4, {Kind::Power, 2.2}},
                                                                         {5, {Kind::Power, 2.8}},
                                                                         {6, {Kind::Power, 2.4}},
                                                                         {8, {Kind::Linear}},
                                                                         {13, {Kind::Srgb}},
                                                                         {14, {Kind::Power, 2.4}},
                                                                         {15, {Kind::Power, 2.4}},
                                                                         {16, {Kind::Pq}},
                                                                         {18, {Kind::Hlg}}}};
    for (const auto& [number, of] : curves)
        if (number == curve) {
            out.curve = of;
            return out;
        }
    return std::nullopt;
}

constexpr double gamma_unit = 100000, usual_gamma = 45455;

/// 1 / 2.2 stands for the curve of sRGB, for which it is the nearest that gAMA can say.
std::optional<TransferCurve> curve_of_gamma(std::uint32_t gamma) {
    if (std::abs(gamma - usual_gamma) <= 100) return TransferCurve{Kind::Srgb};
    if (gamma == static_cast<std::uint32_t>(gamma_unit)) return TransferCurve{Kind::Linear};
    if (gamma < gamma_unit / 10 || gamma > gamma_unit * 10) return std::nullopt;
    return TransferCurve{Kind::Power, gamma_unit / gamma};
}

std::optional<Chromaticities> primaries_of(Bytes data) {
    std::array<double, 8> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = number_of(data.subspan(i * 4)) / gamma_unit;
    const Chromaticities out{.red = {values[2], values[3]},
                             .green = {values[4], values[5]},
                             .blue = {values[6], values[7]},
                             .white = {values[0], values[1]}};
    return to_rec709(out) ? std::optional(out) : std::nullopt;
}

/// Of iCCP, unpacked: name, 0, method, deflate. check_png() has seen that it can be.
std::vector<std::byte> profile_of_png(Bytes chunk) {
    const auto name_end = std::ranges::find(chunk, std::byte{0});
    const auto begin = static_cast<std::size_t>(name_end - chunk.begin()) + 2;
    if (begin >= chunk.size()) return {};
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
        libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
    std::vector<std::byte> out(max_png_profile_bytes);
    std::size_t size = 0;
    const Bytes packed = chunk.subspan(begin);
    if (libdeflate_zlib_decompress(decompressor.get(), packed.data(), packed.size(), out.data(), out.size(), &size) !=
        LIBDEFLATE_SUCCESS)
        size = 0;
    out.resize(size);
    return out;
}

/// A chunk of this size.
std::optional<Bytes> chunk_of(const std::map<std::string_view, Bytes>& chunks, std::string_view type,
                              std::size_t bytes) {
    const auto found = chunks.find(type);
    return found == chunks.end() || found->second.size() != bytes ? std::nullopt : std::optional(found->second);
}

/// By the chunks behind cICP.
FileColor color_of_chunks(const std::map<std::string_view, Bytes>& chunks) {
    if (const auto found = chunks.find("iCCP"); found != chunks.end()) {
        const std::vector<std::byte> profile = profile_of_png(found->second);
        if (!profile.empty()) return color_of_profile(profile);
    }
    if (chunk_of(chunks, "sRGB", 1)) return {.coding = ColorCoding{}, .said = "sRGB"};
    const auto gamma = chunk_of(chunks, "gAMA", 4), primaries = chunk_of(chunks, "cHRM", 32);
    if (!gamma && !primaries) return {};
    FileColor out{.coding = ColorCoding{}, .said = gamma && primaries ? "gAMA and cHRM" : gamma ? "gAMA" : "cHRM"};
    if (gamma) {
        const std::optional<TransferCurve> curve = curve_of_gamma(number_of(*gamma));
        if (curve)
            out.coding->curve = *curve;
        else
            out.warning = fmt::format("gAMA {:g} is not read, [0.1, 10] is", number_of(*gamma) / gamma_unit);
    }
    if (primaries) {
        const std::optional<Chromaticities> found = primaries_of(*primaries);
        if (found)
            out.coding->primaries = *found;
        else
            out.warning = "cHRM spans no color space and is not read";
    }
    return out;
}

/// Content light levels (11.3.2.8), which change no number.
std::string light_of(const std::map<std::string_view, Bytes>& chunks) {
    const auto levels = chunk_of(chunks, "cLLI", 8);
    if (!levels) return {};
    return fmt::format(", light up to {:.6g} cd/m2, {:.6g} in the mean", number_of(*levels) / 1e4,
                       number_of(levels->subspan(4)) / 1e4);
}

FileColor color_by_chunks(const std::map<std::string_view, Bytes>& chunks) {
    const auto codes = chunk_of(chunks, "cICP", 4);
    if (!codes) return color_of_chunks(chunks);
    const auto number = [&](std::size_t i) { return std::to_integer<unsigned>((*codes)[i]); };
    const std::string said = fmt::format("cICP {} {} {} {}", number(0), number(1), number(2), number(3));
    // A matrix and a limited range belong to video, not to PNG.
    if (number(2) == 0 && number(3) == 1)
        if (const auto coding = coding_of_video(number(0), number(1)))
            return {.coding = coding, .said = said + light_of(chunks)};
    FileColor out = color_of_chunks(chunks);
    if (out.warning.empty())
        out.warning = fmt::format("{} is not read: taken {}", said, out.said.empty() ? "as sRGB" : "by " + out.said);
    return out;
}

}  // namespace

FileColor png_color(Bytes file) {
    const std::map<std::string_view, Bytes> chunks = chunks_of(file);
    const auto exif = chunks.find("eXIf");
    return with_exif(color_by_chunks(chunks), exif == chunks.end() ? Bytes() : exif->second);
}

std::string png_left_out(Bytes file) {
    const std::map<std::string_view, Bytes> chunks = chunks_of(file);
    const auto animation = chunk_of(chunks, "acTL", 8);
    const std::uint32_t frames = animation ? number_of(*animation) : 0;
    // W3C, PNG's third edition, 11.3.6.1: the picture is the animation's first frame where its control stands before
    // it.
    if (!chunks.contains("fcTL"))
        return frames == 0 ? ""
                           : fmt::format("has an animation of {} frame{} beside its picture: the picture is read",
                                         frames, frames == 1 ? "" : "s");
    return frames < 2 ? "" : fmt::format("is an animation of {} frames: the first is read", frames);
}

}  // namespace darkroom
