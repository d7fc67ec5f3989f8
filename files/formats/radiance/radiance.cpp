// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "formats/file_format.hpp"

namespace darkroom {

const FileFormat& radiance_format();

namespace {

constexpr std::array<std::string_view, 1> radiance_extensions{".hdr"};
constexpr std::array radiance_samples{SampleKind::Float};

// Behind the header's empty line stands "-Y 3 +X 2": three lines from the top down (the axes point up and right), of
// two pixels from left to right (Ward 1991, Real Pixels; the file filefmts.pdf of Radiance).
Result<int> orientation_of_radiance(FileFormat::Bytes bytes, const FilePart& stored) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t at = text.find("\n\n");
    if (at == std::string_view::npos) return 1;
    std::string_view line = text.substr(at + 2, 100);
    line = line.substr(0, line.find('\n'));
    constexpr std::array<std::pair<std::string_view, std::string_view>, 8> orders{{{"-Y", "+X"},
                                                                                   {"-Y", "-X"},
                                                                                   {"+Y", "-X"},
                                                                                   {"+Y", "+X"},
                                                                                   {"+X", "-Y"},
                                                                                   {"-X", "-Y"},
                                                                                   {"-X", "+Y"},
                                                                                   {"+X", "+Y"}}};
    std::array<std::string_view, 4> words;
    std::string_view rest = line;
    for (std::string_view& word : words) {
        rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
        word = rest.substr(0, rest.find(' '));
        rest.remove_prefix(word.size());
    }
    const auto is_number = [](std::string_view word, std::uint32_t expected) {
        std::uint32_t number = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        return error == std::errc() && end == word.data() + word.size() && number == expected;
    };
    const auto found = std::ranges::find(orders, std::pair(words[0], words[2]));
    if (found != orders.end() && is_number(words[1], stored.height) && is_number(words[3], stored.width))
        return static_cast<int>(found - orders.begin()) + 1;
    return user_error(fmt::format("\"{}\" for its axes: allowed is one of Y and X with a sign and a count each",
                                  one_printable_line(line)));
}

}  // namespace

const FileFormat& radiance_format() {
    static constexpr FileFormat row{
        .name = "Radiance HDR",
        .extensions = radiance_extensions,
        .begins = [](std::string_view start) { return start.starts_with("#?"); },
        .check = [](FileFormat::Bytes) -> Result<std::vector<std::byte>> { return std::vector<std::byte>(); },
        // 4 bytes a line, and 2 for each run of at most 127 in each of the 4 components; lines shorter than 8 or longer
        // than 32767 pixels are not packed.
        .least_bytes =
            [](const FilePart& part) {
                const double width = part.width;
                return part.height *
                       (width < 8 || width > 32767 ? 4 * width : 4 + 8 * static_cast<double>((part.width + 126) / 127));
            },
        .openimageio = "hdr",
        .orientation = [](FileFormat::Bytes file,
                          const PictureSource& source) { return orientation_of_radiance(file, source.parts()[0]); },
        .samples = radiance_samples,
        // No negative values, and a shared exponent of at most 2^127.
        .least = 0,
        .most = 1.7e38f,
    };
    return row;
}

}  // namespace darkroom
