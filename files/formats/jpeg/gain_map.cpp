// SPDX-License-Identifier: MIT
#include "formats/jpeg/gain_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/try.hpp"
#include "formats/jpeg/jpeg_marks.hpp"

namespace darkroom {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::string_view iso_mark("urn:iso:std:iso:ts:21496:-1\0", 28);

/// The numbers of a map, before its picture and its colours are known.
struct Numbers {
    std::array<GainRange, 3> ranges;
    bool is_base_brighter = false;
    bool is_of_base_colors = true;
};

class BigEndian {
  public:
    explicit BigEndian(Bytes bytes) : bytes_(bytes) {}
    [[nodiscard]] std::uint32_t next(std::size_t size) {
        std::uint32_t out = 0;
        for (std::size_t i = 0; i < size; ++i)
            out = out << 8 | (at_ + i < bytes_.size() ? std::to_integer<std::uint32_t>(bytes_[at_ + i]) : 0U);
        at_ += size;
        return out;
    }
    [[nodiscard]] bool has_ended_early() const { return at_ > bytes_.size(); }

  private:
    Bytes bytes_;
    std::size_t at_ = 0;
};

Result<> check_range(const GainRange& range) {
    constexpr double max_stops = 16;
    const auto is_in = [](double value, double least, double most) { return value >= least && value <= most; };
    for (const double stops : {range.min, range.max})
        if (!is_in(stops, -max_stops, max_stops))
            return user_error(fmt::format("its gain is {:g} stops, {:g} to {:g} are allowed", stops, -max_stops,
                                          max_stops));
    if (range.min > range.max)
        return user_error(fmt::format("its least gain is {:g} stops, its greatest {:g}", range.min, range.max));
    if (!is_in(range.gamma, 1.0 / 64, 64))
        return user_error(fmt::format("its gamma is {:g}, 1/64 to 64 is allowed", range.gamma));
    for (const double offset : {range.base_offset, range.brighter_offset})
        if (!is_in(offset, -1, 1))
            return user_error(fmt::format("its offset is {:g}, -1 to 1 is allowed", offset));
    return {};
}

// ISO 21496-1:2025, annex C.2. Where bit 3 of the flags is set (libultrahdr), all numbers share one denominator.
Result<Numbers> numbers_of_iso(Bytes bytes) {
    BigEndian in(bytes);
    if (const std::uint32_t version = in.next(2); version != 0)
        return user_error(fmt::format("it asks for version {} of ISO 21496-1, 0 is read", version));
    static_cast<void>(in.next(2));
    const std::uint32_t flags = in.next(1);
    constexpr std::uint32_t has_channels = 0x80, uses_base_colors = 0x40, has_one_denominator = 0x08;
    const double one = (flags & has_one_denominator) != 0 ? in.next(4) : 0;
    const auto ratio = [&](bool is_signed) {
        const std::uint32_t above = in.next(4);
        const double denominator = (flags & has_one_denominator) != 0 ? one : in.next(4);
        const double numerator = is_signed ? static_cast<std::int32_t>(above) : static_cast<double>(above);
        return numerator / denominator;
    };
    Numbers out{.is_of_base_colors = (flags & uses_base_colors) != 0};
    const double base_headroom = ratio(false), other_headroom = ratio(false);
    out.is_base_brighter = base_headroom > other_headroom;
    const std::size_t channels = (flags & has_channels) != 0 ? 3 : 1;
    for (std::size_t i = 0; i < channels; ++i) {
        GainRange& range = out.ranges[i];
        range.min = ratio(true), range.max = ratio(true), range.gamma = ratio(false);
        range.base_offset = ratio(true), range.brighter_offset = ratio(true);
    }
    for (std::size_t i = channels; i < 3; ++i) out.ranges[i] = out.ranges[0];
    if (in.has_ended_early()) return user_error("its numbers by ISO 21496-1 are cut off");
    return out;
}

/// An attribute, or an element with one value or a list of three. Empty: it is not there.
Result<std::vector<double>> xmp_numbers(std::string_view xmp, const std::string& name) {
    constexpr std::string_view blank = " \t\r\n";
    const auto skip = [&](std::string_view text) {
        return text.substr(std::min(text.find_first_not_of(blank), text.size()));
    };
    std::vector<double> out;
    const auto add = [&](std::string_view text) {
        text = skip(text);
        if (text.starts_with('+')) text.remove_prefix(1);
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const std::string_view rest = skip(text.substr(static_cast<std::size_t>(end - text.data())));
        if (error == std::errc() && rest.empty()) out.push_back(value);
        return error == std::errc() && rest.empty();
    };
    const Failure bad = user_error(fmt::format("its {} is no number", name));
    for (std::size_t at = xmp.find(name); at != std::string_view::npos; at = xmp.find(name, at + 1)) {
        std::string_view rest = skip(xmp.substr(at + name.size()));
        if (rest.starts_with('=')) {
            rest = skip(rest.substr(1));
            const std::size_t end = rest.size() > 1 ? rest.find(rest[0], 1) : std::string_view::npos;
            if (end == std::string_view::npos || !add(rest.substr(1, end - 1))) return bad;
            return out;
        }
        if (!rest.starts_with('>') || at == 0 || xmp[at - 1] != '<') continue;
        rest = rest.substr(1, std::min(rest.find("</" + name), rest.size()) - 1);
        if (rest.find('<') == std::string_view::npos) {
            if (!add(rest)) return bad;
            return out;
        }
        constexpr std::string_view item = "<rdf:li>";
        for (std::size_t from = rest.find(item); from != std::string_view::npos && out.size() < 4;
             from = rest.find(item, from + 1)) {
            const std::string_view value = rest.substr(from + item.size());
            if (!add(value.substr(0, value.find('<')))) return bad;
        }
        return out;
    }
    return out;
}

// Adobe, "Gain Map Specification", 1.0 (2023), whose defaults these are.
Result<Numbers> numbers_of_xmp(std::string_view xmp) {
    Numbers out;
    const auto put = [&](const char* name, double GainRange::*of) -> Result<> {
        DARKROOM_TRY_VALUE(const std::vector<double> values, xmp_numbers(xmp, fmt::format("hdrgm:{}", name)));
        if (values.empty() && std::string_view(name) == "GainMapMax")
            return user_error("it does not say hdrgm:GainMapMax");
        if (values.size() != 0 && values.size() != 1 && values.size() != 3)
            return user_error(fmt::format("hdrgm:{} has {} values, 1 or 3 are allowed", name, values.size()));
        for (std::size_t i = 0; i < 3 && !values.empty(); ++i) out.ranges[i].*of = values[values.size() == 3 ? i : 0];
        return {};
    };
    DARKROOM_TRY(put("GainMapMin", &GainRange::min));
    DARKROOM_TRY(put("GainMapMax", &GainRange::max));
    DARKROOM_TRY(put("Gamma", &GainRange::gamma));
    DARKROOM_TRY(put("OffsetSDR", &GainRange::base_offset));
    DARKROOM_TRY(put("OffsetHDR", &GainRange::brighter_offset));
    out.is_base_brighter = xmp.find("hdrgm:BaseRenditionIsHDR=\"True\"") != std::string_view::npos ||
                           xmp.find("<hdrgm:BaseRenditionIsHDR>True<") != std::string_view::npos;
    return out;
}

Result<GainMap> read_gain_map(Bytes file, Bytes picture, Bytes iso) {
    DARKROOM_TRY_VALUE(const Numbers numbers, iso.empty() ? numbers_of_xmp(xmp_of_jpeg(picture)) : numbers_of_iso(iso));
    if (numbers.is_base_brighter) return user_error("it makes the picture darker, for displays without room");
    for (const GainRange& range : numbers.ranges) DARKROOM_TRY(check_range(range));
    GainMap out{.ranges = numbers.ranges, .picture = picture, .said = iso.empty() ? "hdrgm" : "ISO 21496-1"};
    out.base = color_of_jpeg(file).coding.value_or(ColorCoding{}).primaries;
    out.result = out.base;
    if (!numbers.is_of_base_colors)
        if (const auto other = color_of_jpeg(picture).coding) out.result = other->primaries;
    return out;
}

}  // namespace

FoundGainMap find_gain_map(Bytes file) {
    // Cameras write two or three; each that a list names may be as long as the file.
    constexpr std::size_t max_looked_into = 8;
    const std::vector<Bytes> further = further_jpegs(file);
    for (const Bytes picture : std::span(further).first(std::min(further.size(), max_looked_into))) {
        const std::string_view xmp = xmp_of_jpeg(picture);
        if (xmp.find("aux:hdrgainmap") != std::string_view::npos && xmp.find("hdrgm:Version") == std::string_view::npos)
            return {.why_not = "it is of Apple's kind"};
        const Bytes iso = jpeg_segment(picture, 2, iso_mark);
        if (iso.empty() && xmp.find("hdrgm:Version") == std::string_view::npos) continue;
        Result<GainMap> map = read_gain_map(file, picture, iso);
        return map ? FoundGainMap{.map = std::move(*map)} : FoundGainMap{.why_not = map.error().text};
    }
    return {};
}

GainRows::GainRows(const GainMap& map, std::vector<std::uint8_t> samples, std::uint32_t width, std::uint32_t height)
    : map_(map),
      samples_(std::move(samples)),
      width_(width),
      height_(height),
      channels_(samples_.size() / (std::size_t{width} * height)) {
    if (map.base != map.result) to_result_ = conversion(map.base, map.result);
}

void GainRows::apply(std::span<float> rgb, std::uint32_t row, std::uint32_t height) const {
    const std::size_t width = rgb.size() / 3;
    struct Between {
        std::size_t first = 0, second = 0;
        float share = 0;
    };
    // A map covers all of the picture, whatever its size: places are those of pixels' middles.
    const auto between = [](std::size_t at, std::size_t count, std::uint32_t own) {
        const double place = (static_cast<double>(at) + 0.5) * own / static_cast<double>(count) - 0.5;
        const double inside = std::clamp(place, 0.0, own - 1.0);
        const auto first = static_cast<std::size_t>(inside);
        return Between{first, std::min<std::size_t>(first + 1, own - 1),
                       static_cast<float>(inside - static_cast<double>(first))};
    };
    const Between y = between(row, height, height_);
    for (std::size_t x = 0; x < width; ++x) {
        const Between column = between(x, width, width_);
        const auto sample = [&](std::size_t channel) {
            const auto at = [&](std::size_t line, std::size_t place) {
                return static_cast<float>(samples_[(line * width_ + place) * channels_ + channel]) / 255;
            };
            const float above = std::lerp(at(y.first, column.first), at(y.first, column.second), column.share);
            const float below = std::lerp(at(y.second, column.first), at(y.second, column.second), column.share);
            return std::lerp(above, below, y.share);
        };
        float* const pixel = &rgb[x * 3];
        if (to_result_) {
            const auto turned = multiply(*to_result_, {double{pixel[0]}, double{pixel[1]}, double{pixel[2]}});
            for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<float>(turned[c]);
        }
        float share = sample(0);
        for (std::size_t c = 0; c < 3; ++c) {
            const GainRange& range = map_.ranges[c];
            if (c > 0 && channels_ == 3) share = sample(c);
            const float linear = range.gamma == 1 ? share : std::pow(share, static_cast<float>(1 / range.gamma));
            const float stops = std::lerp(static_cast<float>(range.min), static_cast<float>(range.max), linear);
            pixel[c] = (pixel[c] + static_cast<float>(range.base_offset)) * std::exp2(stops) -
                       static_cast<float>(range.brighter_offset);
        }
    }
}

}  // namespace darkroom
