// SPDX-License-Identifier: MIT
#include "formats/png/png_check.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "formats/exif.hpp"
#include "formats/exr/exr_check.hpp"
#include "formats/file_part.hpp"
#include "formats/png/png_palette.hpp"

namespace darkroom {
namespace {

std::uint32_t big_endian(std::span<const std::byte> bytes) {
    std::uint32_t value = 0;
    for (const std::byte byte : bytes.first(4)) value = value << 8 | std::to_integer<std::uint32_t>(byte);
    return value;
}

/// The most bytes that the picture may be packed in, since what lies behind its last row is inflated, too: twice what
/// its rows take unpacked, with a filter for each and what fills them up, in all passes of Adam7.
Result<std::uint64_t> check_header(std::span<const std::byte> data, std::size_t file_size) {
    if (data.size() != 13) return user_error("malformed header: IHDR must have 13 bytes");
    const std::uint64_t width = big_endian(data);
    const std::uint64_t height = big_endian(data.subspan(4));
    constexpr auto most = static_cast<std::uint64_t>(max_picture_side);
    if (width == 0 || height == 0 || width > most || height > most)
        return user_error(fmt::format("the picture is {}x{}, [1, {}] a side is allowed", width, height, most));
    constexpr std::array<std::uint64_t, 7> samples_of_color_type{1, 0, 3, 1, 2, 0, 4};
    const auto depth = std::to_integer<std::uint64_t>(data[8]);
    const auto color_type = std::to_integer<std::size_t>(data[9]);
    if (color_type >= samples_of_color_type.size() || samples_of_color_type[color_type] == 0 || depth == 0 ||
        depth > 16)
        return user_error(fmt::format("malformed header: color type {} with {} bits", color_type, depth));
    // Deflate makes at most 1032 bytes from one.
    const std::uint64_t bytes = width * height * samples_of_color_type[color_type] * depth / 8;
    if (bytes / 1032 > file_size)
        return user_error(
            fmt::format("a picture of {}x{} cannot be in a file of {} bytes: truncated, or a damaged header", width,
                        height, file_size));
    DARKROOM_TRY(check_decoded_size(bytes, file_size));
    return 2 * (bytes + 4 * height) + (std::uint64_t{1} << 16);
}

struct Chunk {
    std::string_view type;
    std::span<const std::byte> data, whole;
};

void append(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
}

std::vector<std::byte> chunk_of(std::string_view type, std::span<const std::byte> data) {
    std::vector<std::byte> out;
    const auto number = [&](std::uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::byte>(value >> shift & 0xff));
    };
    number(static_cast<std::uint32_t>(data.size()));
    append(out, std::as_bytes(std::span(type)));
    append(out, data);
    number(libdeflate_crc32(0, out.data() + 4, out.size() - 4));
    return out;
}

// Chunks of PNG's third edition (W3C, 2025), section 11, that say of few numbers how colours or pixels are meant.
bool is_small_and_known(const Chunk& chunk) {
    struct Known {
        std::string_view type;
        std::size_t least, most;
    };
    constexpr std::array<Known, 8> known{{{"gAMA", 4, 4},
                                          {"cHRM", 32, 32},
                                          {"sRGB", 1, 1},
                                          {"cICP", 4, 4},
                                          {"sBIT", 1, 4},
                                          {"bKGD", 1, 6},
                                          {"pHYs", 9, 9},
                                          {"tRNS", 1, 256}}};
    return std::ranges::any_of(known, [&](const Known& one) {
        return one.type == chunk.type && chunk.data.size() >= one.least && chunk.data.size() <= one.most;
    });
}

// A name of at most 79 letters, a zero, the method (0), and a stream of zlib.
Result<> check_profile(std::span<const std::byte> data) {
    const auto end = std::find(data.begin(), data.end(), std::byte{0});
    const auto start = static_cast<std::size_t>(end - data.begin()) + 2;
    if (start > 81 || start > data.size()) return user_error("damaged: the profile of its colors has no name");
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflate(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    std::vector<std::byte> profile(std::min(max_png_profile_bytes, (data.size() - start) * 1032));
    std::size_t size = 0;
    const libdeflate_result result = libdeflate_zlib_decompress(inflate.get(), data.data() + start, data.size() - start,
                                                                profile.data(), profile.size(), &size);
    if (result == LIBDEFLATE_INSUFFICIENT_SPACE)
        return user_error(fmt::format("the profile of its colors has more than {} bytes", max_png_profile_bytes));
    if (result != LIBDEFLATE_SUCCESS) return user_error("damaged: the profile of its colors cannot be inflated");
    return {};
}

std::vector<std::byte> exif_of(std::uint8_t orientation) {
    std::array<char, 26> text{'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1, 18, 0, 3, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0};
    text[19] = static_cast<char>(orientation);
    return chunk_of("eXIf", std::as_bytes(std::span(text)));
}

/// Chunk by chunk, into a file that holds what a decoder shall see.
class PngChecker {
  public:
    explicit PngChecker(std::span<const std::byte> file) : file_(file) {}

    Result<std::vector<std::byte>> run() {
        if (file_.size() < 8) return user_error("truncated: unexpected end of file");
        append(out_, file_.first(8));
        for (std::size_t position = 8;;) {
            DARKROOM_TRY_VALUE(const Chunk chunk, chunk_at(position));
            DARKROOM_TRY(take(chunk, position == 8));
            position += chunk.whole.size();
            if (chunk.type == "IEND") break;
        }
        if (header_[9] == std::byte{3})
            DARKROOM_TRY(check_palette({.width = big_endian(header_),
                                        .height = big_endian(std::span(header_).subspan(4)),
                                        .bits = std::to_integer<std::uint32_t>(header_[8]),
                                        .is_interlaced = header_[12] != std::byte{0},
                                        .colors = colors_},
                                       packed_));
        return is_as_it_was_ ? std::vector<std::byte>() : std::move(out_);
    }

  private:
    [[nodiscard]] Result<Chunk> chunk_at(std::size_t position) const {
        if (file_.size() < position + 12) return user_error("truncated: unexpected end of file");
        const std::size_t length = big_endian(file_.subspan(position));
        const std::string_view type(reinterpret_cast<const char*>(file_.data()) + position + 4, 4);
        if (length > file_.size() - position - 12) return user_error("truncated: unexpected end of file");
        const auto covered = file_.subspan(position + 4, length + 4);
        if (libdeflate_crc32(0, covered.data(), covered.size()) != big_endian(file_.subspan(position + 8 + length)))
            return user_error(fmt::format("damaged: the checksum of the chunk at byte {} does not match", position));
        return Chunk{type, covered.subspan(4), file_.subspan(position, length + 12)};
    }

    Result<> take(const Chunk& chunk, bool is_first) {
        if (is_first != (chunk.type == "IHDR"))
            return user_error("malformed header: the first chunk alone must be IHDR");
        if (is_first) {
            DARKROOM_TRY_VALUE(max_packed_, check_header(chunk.data, file_.size()));
            std::ranges::copy(chunk.data, header_.begin());
        }
        if (chunk.type == "PLTE") {
            if (colors_ != 0) return user_error("malformed header: two palettes");
            colors_ = chunk.data.size() / 3;
            if (chunk.data.size() % 3 != 0 || colors_ < 1 || colors_ > 256)
                return user_error(fmt::format("malformed header: a palette of {} bytes", chunk.data.size()));
        }
        if (chunk.type == "IDAT") {
            packed_size_ += chunk.data.size();
            if (packed_size_ > max_packed_)
                return user_error(fmt::format(
                    "its pixels are packed in {} bytes, {} are allowed for a picture of {}x{}", packed_size_,
                    max_packed_, big_endian(header_), big_endian(std::span(header_).subspan(4))));
        }
        if (chunk.type == "IDAT" && header_[9] == std::byte{3}) append(packed_, chunk.data);
        const bool is_of_picture =
            chunk.type == "IHDR" || chunk.type == "PLTE" || chunk.type == "IDAT" || chunk.type == "IEND";
        constexpr char lower_case = 0x20;  // of the first letter: a chunk that decoders need not know
        if (!is_of_picture && (chunk.type[0] & lower_case) == 0)
            return user_error(fmt::format("a chunk of the unknown kind {}", one_printable_line(chunk.type)));
        if (is_of_picture) {
            append(out_, chunk.whole);
            return {};
        }
        const bool is_again = std::ranges::find(seen_, chunk.type) != seen_.end();
        if (is_again || !(is_small_and_known(chunk) || chunk.type == "iCCP" || chunk.type == "eXIf")) {
            is_as_it_was_ = false;
            return {};
        }
        seen_.push_back(chunk.type);
        if (chunk.type == "iCCP") DARKROOM_TRY(check_profile(chunk.data));
        is_as_it_was_ = is_as_it_was_ && chunk.type != "eXIf";
        if (chunk.type == "eXIf")
            append(out_, exif_of(orientation_of_exif(chunk.data)));
        else
            append(out_, chunk.whole);
        return {};
    }

    std::span<const std::byte> file_;
    std::vector<std::byte> out_, packed_;
    std::array<std::byte, 13> header_{};
    std::vector<std::string_view> seen_;
    std::size_t colors_ = 0;
    std::uint64_t packed_size_ = 0, max_packed_ = 0;
    bool is_as_it_was_ = true;
};

}  // namespace

Result<std::vector<std::byte>> check_png(std::span<const std::byte> file) { return PngChecker(file).run(); }

}  // namespace darkroom
