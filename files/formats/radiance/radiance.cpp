// SPDX-License-Identifier: MIT
// Radiance HDR (Ward 1991, Real Pixels; the file filefmts.pdf of Radiance): lines of text, an empty one, the order of
// the axes, and pixels of three mantissas and an exponent, packed by runs. A mantissa m stands for what became m when
// it was cut to a whole number, so it is read as (m + 0.5) / 256, as Radiance and libvips read it; OpenImageIO,
// OpenCV and Blender 5.0 have m / 256, half a step less.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "core/text/lower.hpp"
#include "formats/file_format.hpp"

namespace darkroom {

const FileFormat& radiance_format();

namespace {

constexpr std::array<std::string_view, 1> radiance_extensions{".hdr"};
constexpr std::array radiance_samples{SampleKind::Float};

using Rgbe = std::array<std::uint8_t, 4>;

/// Lines of so many pixels are packed component by component.
bool is_packed_width(std::size_t width) { return width >= 8 && width <= 32767; }

struct RadianceHeader {
    std::uint32_t width = 0, height = 0;  ///< pixels of a line, and lines
    int orientation = 1;                  ///< by EXIF
    std::array<float, 3> scale{1, 1, 1};  ///< light is so many times the samples
    std::vector<double> primaries;        ///< x and y of red, green, blue and white; empty: it does not say
    std::size_t size = 0;                 ///< in bytes
};

std::vector<double> numbers_behind(std::string_view text) {
    std::vector<double> out;
    while (out.size() < 9) {
        text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
        double number = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error != std::errc()) return out;
        out.push_back(number);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
    return out;
}

// "-Y 3 +X 2": three lines from the top down (the axes point up and right), of two pixels from left to right.
Result<> read_axes(std::string_view line, RadianceHeader& out) {
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
    const auto side = [](std::string_view word, std::uint32_t& to) {
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), to);
        return error == std::errc() && end == word.data() + word.size() && to >= 1;
    };
    const auto found = std::ranges::find(orders, std::pair(words[0], words[2]));
    if (found == orders.end() || !side(words[1], out.height) || !side(words[3], out.width))
        return user_error(fmt::format("\"{}\" for its axes: allowed is one of Y and X with a sign and a count each",
                                      one_printable_line(line)));
    out.orientation = static_cast<int>(found - orders.begin()) + 1;
    return {};
}

Result<RadianceHeader> read_header(FileFormat::Bytes file) {
    RadianceHeader out;
    std::array<double, 3> scale{1, 1, 1};
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    const auto next_line = [&]() -> std::optional<std::string_view> {
        const std::size_t end = text.find('\n', out.size);
        if (end == std::string_view::npos) return std::nullopt;
        const std::string_view line = text.substr(out.size, end - out.size);
        out.size = end + 1;
        return line;
    };
    for (auto line = next_line(); line != ""; line = next_line()) {
        if (!line) return user_error("damaged or truncated: its header has no end");
        const std::size_t equals = std::min(line->find('='), line->size());
        const std::string_view name = line->substr(0, equals), value = line->substr(std::min(equals + 1, line->size()));
        if (name == "FORMAT" && value.find("32-bit_rle_xyze") != std::string_view::npos)
            return user_error(
                "its pixels are CIE X, Y and Z (32-bit_rle_xyze): red, green and blue (32-bit_rle_rgbe) "
                "are read, to which Radiance's `ra_xyze -r` converts");
        if (name == "FORMAT" && value.find("32-bit_rle_rgbe") == std::string_view::npos)
            return user_error(fmt::format("a format of '{}': 32-bit_rle_rgbe is read", one_printable_line(value)));
        if (name != "EXPOSURE" && name != "COLORCORR" && name != "PRIMARIES") continue;
        const std::vector<double> found = numbers_behind(value);
        if (name == "PRIMARIES" && found.size() == 8) out.primaries = found;
        // The light was multiplied by all of them.
        if (name == "EXPOSURE" && found.size() == 1)
            for (double& one : scale) one /= found[0];
        if (name == "COLORCORR" && found.size() == 3)
            for (std::size_t i = 0; i < 3; ++i) scale[i] /= found[i];
    }
    for (std::size_t i = 0; i < 3; ++i)
        if (const auto one = static_cast<float>(scale[i]); std::isfinite(one) && one > 0) out.scale[i] = one;
    const auto axes = next_line();
    if (!axes) return user_error("damaged or truncated: its header has no end");
    DARKROOM_TRY(read_axes(*axes, out));
    return out;
}

class RadianceSource final : public PictureSource {
  public:
    RadianceSource(FileFormat::Bytes file, RadianceHeader header) : file_(file), header_(std::move(header)) {
        parts_.push_back(FilePart{.channels = {"R", "G", "B"},
                                  .kinds = std::vector<SampleKind>(3, SampleKind::Float),
                                  .width = header_.width,
                                  .height = header_.height,
                                  .display_width = header_.width,
                                  .display_height = header_.height});
        starts_.push_back(header_.size);
    }

    std::vector<double> numbers(std::size_t /*part*/, std::string_view attribute) const override {
        return lower(attribute) == "chromaticities" ? header_.primaries : std::vector<double>();
    }
    std::vector<std::string> attributes(std::size_t /*part*/) const override {
        return header_.primaries.empty() ? std::vector<std::string>() : std::vector<std::string>{"chromaticities"};
    }
    std::uint32_t row_unit(std::size_t /*part*/) const override { return 1; }

  private:
    Result<> read(std::size_t /*part*/, std::uint32_t row, std::uint32_t rows,
                  std::span<const SamplePlace> places) override {
        line_.resize(header_.width);
        for (std::size_t y = std::min<std::size_t>(row, starts_.size() - 1); y < std::size_t{row} + rows; ++y) {
            std::size_t at = starts_[y];
            if (!unpack(at)) return user_error(fmt::format("damaged or truncated: bad scanline {} data", y));
            if (starts_.size() == y + 1) starts_.push_back(at);
            if (y < row) continue;
            for (const SamplePlace& place : places) {
                if (place.kind != SampleKind::Float)
                    return user_error(fmt::format("floats are not read as {}", name_of(place.kind)));
                std::byte* to = place.first + static_cast<std::ptrdiff_t>(y - row) * place.row_bytes;
                for (std::uint32_t x = 0; x < header_.width; ++x, to += place.pixel_bytes) {
                    const float value = light(line_[x], place.channel);
                    std::memcpy(to, &value, sizeof value);
                }
            }
        }
        return {};
    }

    [[nodiscard]] float light(const Rgbe& pixel, std::size_t channel) const {
        if (pixel[3] == 0) return 0;
        return std::ldexp(static_cast<float>(pixel[channel]) + 0.5f, pixel[3] - (128 + 8)) * header_.scale[channel];
    }

    /// The line that begins here; where the next one does. False: it does not fit.
    [[nodiscard]] bool unpack(std::size_t& at) {
        const auto byte = [&](std::size_t behind) { return std::to_integer<std::uint8_t>(file_[at + behind]); };
        if (is_packed_width(header_.width) && file_.size() - at >= 4 && byte(0) == 2 && byte(1) == 2 && byte(2) < 128) {
            if ((byte(2) << 8 | byte(3)) != static_cast<int>(header_.width)) return false;
            at += 4;
            for (std::size_t component = 0; component < 4; ++component)
                if (!unpack_component(at, component)) return false;
            return true;
        }
        // Pixels as they are; 1, 1, 1 and a count repeats the last one, a second such in a row counts 256 times as
        // much.
        std::size_t shift = 0;
        for (std::size_t x = 0; x < line_.size(); at += 4) {
            if (file_.size() - at < 4) return false;
            const Rgbe pixel{byte(0), byte(1), byte(2), byte(3)};
            if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
                line_[x++] = pixel;
                shift = 0;
                continue;
            }
            const std::size_t count = shift < 24 ? std::size_t{pixel[3]} << shift : 0;
            if (x == 0 || count > line_.size() - x || shift >= 24) return false;
            std::fill_n(line_.begin() + static_cast<std::ptrdiff_t>(x), count, line_[x - 1]);
            x += count;
            shift += 8;
        }
        return true;
    }

    /// More than 128: so many less 128 of the next byte; else so many bytes.
    [[nodiscard]] bool unpack_component(std::size_t& at, std::size_t component) {
        for (std::size_t x = 0; x < line_.size();) {
            if (at >= file_.size()) return false;
            const auto code = std::to_integer<std::size_t>(file_[at++]);
            const bool is_run = code > 128;
            const std::size_t count = is_run ? code - 128 : code, bytes = is_run ? 1 : count;
            if (count == 0 || count > line_.size() - x || bytes > file_.size() - at) return false;
            for (std::size_t i = 0; i < count; ++i)
                line_[x++][component] = std::to_integer<std::uint8_t>(file_[at + (is_run ? 0 : i)]);
            at += bytes;
        }
        return true;
    }

    FileFormat::Bytes file_;
    RadianceHeader header_;
    std::vector<std::size_t> starts_;  ///< of the lines that were unpacked, and of the one behind them
    std::vector<Rgbe> line_;
};

Result<FileFormat::Source> open_radiance(FileFormat::Bytes file, std::size_t /*max_threads*/) {
    DARKROOM_TRY_VALUE(RadianceHeader header, read_header(file));
    return std::make_unique<RadianceSource>(file, std::move(header));
}

/// Mantissas are cut, so what is read is the nearest that there is.
Rgbe rgbe_of(const float* color) {
    const float largest = std::max({color[0], color[1], color[2]});
    int exponent = 0;
    std::frexp(largest, &exponent);
    if (largest <= 0 || exponent + 128 < 1) return {};
    Rgbe out{0, 0, 0, static_cast<std::uint8_t>(exponent + 128)};
    for (std::size_t i = 0; i < 3; ++i) out[i] = static_cast<std::uint8_t>(std::ldexp(color[i], 8 - exponent));
    return out;
}

void pack_component(std::vector<std::byte>& to, std::span<const Rgbe> line, std::size_t component) {
    constexpr std::size_t longest_run = 127, longest_copy = 128, shortest_run = 4;
    const auto run_at = [&](std::size_t x) {
        std::size_t end = x + 1;
        while (end < line.size() && end - x < longest_run && line[end][component] == line[x][component]) ++end;
        return end - x;
    };
    for (std::size_t x = 0; x < line.size();) {
        if (const std::size_t run = run_at(x); run >= shortest_run) {
            to.push_back(static_cast<std::byte>(128 + run));
            to.push_back(static_cast<std::byte>(line[x][component]));
            x += run;
            continue;
        }
        std::size_t end = x + 1;
        while (end < line.size() && end - x < longest_copy && run_at(end) < shortest_run) ++end;
        to.push_back(static_cast<std::byte>(end - x));
        for (; x < end; ++x) to.push_back(static_cast<std::byte>(line[x][component]));
    }
}

Result<std::vector<std::byte>> encode_radiance(const EncodeDesc& desc) {
    const std::string header =
        fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", desc.height, desc.width);
    const std::span<const std::byte> start = std::as_bytes(std::span(header));
    std::vector<std::byte> out(start.begin(), start.end());
    std::vector<Rgbe> line(desc.width);
    const auto* from = static_cast<const float*>(desc.samples);
    for (std::uint32_t y = 0; y < desc.height; ++y) {
        for (Rgbe& pixel : line) {
            pixel = rgbe_of(from);
            from += desc.channels;
        }
        if (!is_packed_width(line.size())) {
            const std::span<const std::byte> bytes = std::as_bytes(std::span(line));
            out.insert(out.end(), bytes.begin(), bytes.end());
            continue;
        }
        for (const std::size_t byte : {std::size_t{2}, std::size_t{2}, line.size() >> 8, line.size() & 0xff})
            out.push_back(static_cast<std::byte>(byte));
        for (std::size_t component = 0; component < 4; ++component) pack_component(out, line, component);
    }
    return out;
}

}  // namespace

const FileFormat& radiance_format() {
    static constexpr FileFormat row{
        .name = "Radiance HDR",
        .extensions = radiance_extensions,
        .begins = [](std::string_view start) { return start.starts_with("#?"); },
        .check = [](FileFormat::Bytes file) -> Result<std::vector<std::byte>> {
            DARKROOM_TRY(read_header(file));
            return std::vector<std::byte>();
        },
        // 4 bytes a line, and 2 for each run of at most 127 in each of the 4 components; lines shorter than 8 or longer
        // than 32767 pixels are not packed so.
        .least_bytes =
            [](const FilePart& part) {
                const double width = part.width;
                return part.height * (is_packed_width(part.width)
                                          ? 4 + 8 * static_cast<double>((part.width + 126) / 127)
                                          : 4 * width);
            },
        .open = open_radiance,
        .openimageio = "hdr",
        .orientation = [](FileFormat::Bytes file, const PictureSource&) -> Result<int> {
            DARKROOM_TRY_VALUE(const RadianceHeader header, read_header(file));
            return header.orientation;
        },
        .samples = radiance_samples,
        // No negative values, and a shared exponent of at most 2^127.
        .least = 0,
        .most = 1.7e38f,
        .encode = encode_radiance,
    };
    return row;
}

}  // namespace darkroom
