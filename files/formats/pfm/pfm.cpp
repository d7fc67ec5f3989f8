// SPDX-License-Identifier: MIT
// PFM, the portable float map (Paul Debevec; Netpbm's page pfm(5)): "PF" or "Pf", width, height, a scale that is below
// zero where the least significant byte comes first, and floats, the bottom row first. Light, of one channel or three.
#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "formats/file_format.hpp"

namespace darkroom {

const FileFormat& pfm_format();

namespace {

constexpr std::array<std::string_view, 1> pfm_extensions{".pfm"};
constexpr std::array pfm_samples{SampleKind::Float};
constexpr std::string_view pfm_blanks = " \t\r\n";

struct PfmHeader {
    std::uint32_t channels = 0, width = 0, height = 0;
    bool is_little_endian = true;
    std::size_t size = 0;  ///< of the header, in bytes
};

/// Bytes of them.
std::uint64_t samples_of(const PfmHeader& header) {
    return std::uint64_t{4} * header.channels * header.width * header.height;
}

/// Four words, and a blank behind each; between them comments.
Result<PfmHeader> read_header(FileFormat::Bytes file) {
    constexpr std::size_t longest = 1000;
    const std::string_view text(reinterpret_cast<const char*>(file.data()), std::min(file.size(), longest));
    std::array<std::string_view, 4> words;
    std::size_t at = 0;
    for (std::string_view& word : words) {
        std::size_t start = text.find_first_not_of(pfm_blanks, at);
        // Netpbm's page has no comments; libvips writes them, as in other formats of its kind.
        while (start != std::string_view::npos && text[start] == '#')
            start = text.find_first_not_of(pfm_blanks, text.find('\n', start));
        at = start == std::string_view::npos ? start : text.find_first_of(pfm_blanks, start);
        if (at == std::string_view::npos) return user_error("damaged or truncated: its header has no end");
        word = text.substr(start, at - start);
    }
    PfmHeader out{.channels = words[0] == "PF" ? 3U : 1U, .size = at + 1};
    const auto side = [&](std::string_view word, std::uint32_t& to) -> Result<> {
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), to);
        if (error == std::errc() && end == word.data() + word.size() && to >= 1 && to <= max_picture_side) return {};
        return user_error(
            fmt::format("a side of '{}': [1, {}] is allowed", one_printable_line(word), max_picture_side));
    };
    DARKROOM_TRY(side(words[1], out.width));
    DARKROOM_TRY(side(words[2], out.height));
    double scale = 0;
    const auto [end, error] = std::from_chars(words[3].data(), words[3].data() + words[3].size(), scale);
    // What another size than 1 does to the numbers, the programs that write it do not agree on.
    if (error != std::errc() || end != words[3].data() + words[3].size() || std::abs(scale) != 1)
        return user_error(fmt::format("a scale of '{}': 1 and -1 are allowed", one_printable_line(words[3])));
    out.is_little_endian = scale < 0;
    // One blank ends the header, which is two where lines end with both, as the size of the file tells.
    if (text.substr(at).starts_with("\r\n") && file.size() - out.size == samples_of(out) + 1) ++out.size;
    return out;
}

Result<std::vector<std::byte>> check_pfm(FileFormat::Bytes file) {
    DARKROOM_TRY_VALUE(const PfmHeader header, read_header(file));
    const std::uint64_t bytes = samples_of(header);
    if (file.size() - header.size < bytes)
        return user_error(fmt::format("truncated: {} bytes of samples of {}", file.size() - header.size, bytes));
    return std::vector<std::byte>();
}

class PfmSource final : public PictureSource {
  public:
    PfmSource(FileFormat::Bytes file, const PfmHeader& header) : samples_(file.subspan(header.size)), header_(header) {
        parts_.push_back(FilePart{.channels = {"R", "G", "B"},
                                  .width = header.width,
                                  .height = header.height,
                                  .display_width = header.width,
                                  .display_height = header.height});
        if (header.channels == 1) parts_[0].channels = {"Y"};
        parts_[0].kinds.assign(header.channels, SampleKind::Float);
    }

    std::vector<double> numbers(std::size_t /*part*/, std::string_view /*attribute*/) const override { return {}; }
    std::vector<std::string> attributes(std::size_t /*part*/) const override { return {}; }
    std::uint32_t row_unit(std::size_t /*part*/) const override { return 1; }

  private:
    Result<> read(std::size_t /*part*/, std::uint32_t row, std::uint32_t rows,
                  std::span<const SamplePlace> places) override {
        const bool is_swapped = header_.is_little_endian != (std::endian::native == std::endian::little);
        const std::size_t row_bytes = std::size_t{4} * header_.channels * header_.width;
        for (const SamplePlace& place : places) {
            if (place.kind != SampleKind::Float)
                return user_error(fmt::format("floats are not read as {}", name_of(place.kind)));
            for (std::uint32_t y = 0; y < rows; ++y) {
                const std::byte* from =
                    samples_.data() + (header_.height - 1 - row - y) * row_bytes + 4 * place.channel;
                std::byte* to = place.first + static_cast<std::ptrdiff_t>(y) * place.row_bytes;
                for (std::uint32_t x = 0; x < header_.width; ++x, from += 4 * header_.channels, to += place.pixel_bytes)
                    for (std::size_t i = 0; i < 4; ++i) to[i] = from[is_swapped ? 3 - i : i];
            }
        }
        return {};
    }

    FileFormat::Bytes samples_;
    PfmHeader header_;
};

Result<FileFormat::Source> open_pfm(FileFormat::Bytes file, std::size_t /*max_threads*/) {
    DARKROOM_TRY_VALUE(const PfmHeader header, read_header(file));
    return std::make_unique<PfmSource>(file, header);
}

/// In the order of this machine.
Result<std::vector<std::byte>> encode_pfm(const EncodeDesc& desc) {
    const std::string header = fmt::format("PF\n{} {}\n{}\n", desc.width, desc.height,
                                           std::endian::native == std::endian::little ? "-1.0" : "1.0");
    const std::size_t row_bytes = std::size_t{4} * desc.channels * desc.width;
    std::vector<std::byte> out(header.size() + row_bytes * desc.height);
    std::memcpy(out.data(), header.data(), header.size());
    for (std::uint32_t y = 0; y < desc.height; ++y)
        std::memcpy(out.data() + header.size() + (desc.height - 1 - y) * row_bytes,
                    static_cast<const std::byte*>(desc.samples) + y * row_bytes, row_bytes);
    return out;
}

}  // namespace

const FileFormat& pfm_format() {
    static constexpr FileFormat row{
        .name = "PFM",
        .extensions = pfm_extensions,
        .begins =
            [](std::string_view start) {
                return (start.starts_with("PF") || start.starts_with("Pf")) && start.size() > 2 &&
                       pfm_blanks.find(start[2]) != std::string_view::npos;
            },
        .check = check_pfm,
        .open = open_pfm,
        .samples = pfm_samples,
        .encode = encode_pfm,
    };
    return row;
}

}  // namespace darkroom
