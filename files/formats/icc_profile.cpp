// SPDX-License-Identifier: MIT
#include "formats/icc_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

namespace darkroom {
namespace {

using Bytes = std::span<const std::byte>;

/// Empty where it lies outside.
Bytes piece(Bytes bytes, std::size_t offset, std::size_t size) {
    return offset <= bytes.size() && size <= bytes.size() - offset ? bytes.subspan(offset, size) : Bytes();
}

std::uint32_t number(Bytes bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (const std::byte byte : piece(bytes, offset, 4)) value = value << 8 | std::to_integer<std::uint32_t>(byte);
    return value;
}

bool is(Bytes bytes, std::size_t offset, std::string_view text) {
    return std::ranges::equal(piece(bytes, offset, 4), std::as_bytes(std::span(text)));
}

Bytes tag(Bytes profile, std::string_view name) {
    constexpr std::uint32_t max_tags = 100;
    const std::uint32_t count = std::min(number(profile, 128), max_tags);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::size_t entry = 132 + std::size_t{12} * i;
        if (is(profile, entry, name)) return piece(profile, number(profile, entry + 4), number(profile, entry + 8));
    }
    return {};
}

/// s15Fixed16Number.
double fixed(Bytes bytes, std::size_t offset) { return static_cast<std::int32_t>(number(bytes, offset)) / 65536.0; }

Chromaticity chromaticity(const std::array<double, 3>& xyz) {
    const double sum = xyz[0] + xyz[1] + xyz[2];
    return {xyz[0] / sum, xyz[1] / sum};
}

/// The curve that is known, where it is within half a code of 8 bits of `light` at every code of them.
std::optional<TransferCurve> nearest_curve(const std::function<double(double)>& light) {
    const double middle = light(0.5);
    std::vector<TransferCurve> known{{TransferCurve::Kind::Linear}, {TransferCurve::Kind::Srgb}};
    if (middle > 0 && middle < 1) known.push_back({TransferCurve::Kind::Power, std::log(middle) / std::log(0.5)});
    for (const TransferCurve& curve : known) {
        bool is_near = true;
        for (int code = 0; code <= 255 && is_near; ++code) {
            const double exact = light(code / 255.0);
            is_near = exact >= curve.decode(std::max(0.0, code - 0.5) / 255) - 1e-4 &&
                      exact <= curve.decode((code + 0.5) / 255) + 1e-4;
        }
        if (is_near) return curve;
    }
    return std::nullopt;
}

/// curveType (10.6) and parametricCurveType (10.18).
std::optional<TransferCurve> curve_of(Bytes curve) {
    const auto word = [&](std::size_t offset) { return static_cast<double>(number(curve, offset) >> 16); };
    if (is(curve, 0, "curv")) {
        const std::size_t count = number(curve, 8);
        if (count == 0) return TransferCurve{};
        if (piece(curve, 12, count * 2).empty()) return std::nullopt;
        const auto entry = [&](std::size_t i) {
            return std::to_integer<unsigned>(curve[12 + 2 * i]) * 256.0 + std::to_integer<unsigned>(curve[13 + 2 * i]);
        };
        if (count == 1) return nearest_curve([&](double code) { return std::pow(code, entry(0) / 256); });
        return nearest_curve([&](double code) {
            const double place = code * static_cast<double>(count - 1);
            const auto below = std::min(static_cast<std::size_t>(place), count - 2);
            return std::lerp(entry(below), entry(below + 1), place - static_cast<double>(below)) / 65535;
        });
    }
    const double type = word(8);
    constexpr std::array<std::size_t, 5> parameters{1, 3, 4, 5, 7};
    if (!is(curve, 0, "para") || type > 4) return std::nullopt;
    const std::size_t count = parameters[static_cast<std::size_t>(type)];
    if (piece(curve, 12, 4 * count).empty()) return std::nullopt;
    std::array<double, 7> p{};  // g, a, b, c, d, e, f
    for (std::size_t i = 0; i < count; ++i) p[i] = fixed(curve, 12 + 4 * i);
    auto [g, a, b, c, d, e, f] = p;
    if (type == 0) a = 1;
    if (type == 1 || type == 2) {
        e = f = type == 2 ? c : 0;  // behind both branches
        c = 0;
        d = a != 0 ? -b / a : 0;
    }
    return nearest_curve(
        [=](double code) { return code >= d ? std::pow(std::max(0.0, a * code + b), g) + e : c * code + f; });
}

}  // namespace

std::string profile_description(Bytes profile) {
    if (!is(profile, 36, "acsp")) return {};
    const Bytes desc = tag(profile, "desc");
    const bool is_text = is(desc, 0, "desc"), is_wide = is(desc, 0, "mluc");
    Bytes text;
    if (is_text) text = piece(desc, 12, number(desc, 8));
    if (is_wide) text = piece(desc, number(desc, 24), number(desc, 20));
    constexpr std::size_t longest = 100;
    std::string out;
    for (std::size_t i = is_wide ? 1 : 0; i < text.size() && out.size() < longest; i += is_wide ? 2 : 1) {
        const auto letter = std::to_integer<unsigned char>(text[i]);
        if (letter == 0) break;
        out += letter >= 0x20 && letter < 0x7f ? static_cast<char>(letter) : '?';
    }
    return out;
}

bool has_curves(Bytes profile) { return !tag(profile, "rTRC").empty(); }

std::optional<ColorCoding> profile_coding(Bytes profile) {
    if (!is(profile, 36, "acsp") || !is(profile, 16, "RGB ") || !is(profile, 20, "XYZ ")) return std::nullopt;
    // A table from numbers to colour goes before colorants.
    if (!tag(profile, "A2B0").empty()) return std::nullopt;
    ColorCoding out;
    std::array<double, 3> white{};
    for (const auto& [name, primary] : {std::pair("rXYZ", &out.primaries.red), std::pair("gXYZ", &out.primaries.green),
                                        std::pair("bXYZ", &out.primaries.blue)}) {
        const Bytes colorant = tag(profile, name);
        if (!is(colorant, 0, "XYZ ") || colorant.size() < 20) return std::nullopt;
        std::array<double, 3> xyz{};
        for (std::size_t i = 0; i < 3; ++i) white[i] += xyz[i] = fixed(colorant, 8 + 4 * i);
        *primary = chromaticity(xyz);
    }
    out.primaries.white = chromaticity(white);
    const std::optional<TransferCurve> curve = curve_of(tag(profile, "rTRC"));
    const std::optional<ColorMatrix> matrix = to_rec709(out.primaries);
    if (!matrix || !curve || curve_of(tag(profile, "gTRC")) != curve || curve_of(tag(profile, "bTRC")) != curve)
        return std::nullopt;
    out.curve = *curve;
    // Colorants are rounded; a picture in our primaries must stay as it is.
    for (const char* const name : {"srgb", "p3", "rec2020"}) {
        const Chromaticities known = find_input_space(name)->primaries;
        if (std::ranges::equal(*matrix, *to_rec709(known), [](double a, double b) { return std::abs(a - b) < 2e-3; }))
            out.primaries = known;
    }
    return out;
}

std::vector<std::byte> display_profile(std::string_view name, const Chromaticities& primaries) {
    constexpr std::array<double, 3> d50{0.9642, 1, 0.8249};
    std::vector<std::byte> tags, data;
    const auto put = [](std::vector<std::byte>& to, std::string_view text) {
        for (const char c : text) to.push_back(static_cast<std::byte>(c));
    };
    const auto put_word = [](std::vector<std::byte>& to, std::uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8) to.push_back(static_cast<std::byte>(value >> shift & 0xff));
    };
    const auto put_fixed = [&](std::vector<std::byte>& to, double value) {
        put_word(to, static_cast<std::uint32_t>(std::lround(value * 65536)));
    };
    constexpr std::uint32_t tag_count = 10, data_start = 128 + 4 + 12 * tag_count;
    const auto add = [&](std::initializer_list<std::string_view> names, const std::function<void()>& fill) {
        const std::size_t start = data.size();
        fill();
        for (const std::string_view tag : names) {
            put(tags, tag);
            put_word(tags, static_cast<std::uint32_t>(data_start + start));
            put_word(tags, static_cast<std::uint32_t>(data.size() - start));
        }
        data.resize((data.size() + 3) / 4 * 4);
    };
    const auto add_text = [&](std::string_view tag, std::string_view text) {
        add({tag}, [&] {
            put(data, std::string_view("mluc\0\0\0\0\0\0\0\1\0\0\0\x0c"
                                       "enUS",
                                       20));
            put_word(data, static_cast<std::uint32_t>(2 * text.size()));
            put_word(data, 28);
            for (const char c : text) put(data, std::string_view(std::array{'\0', c}.data(), 2));
        });
    };
    const auto add_xyz = [&](std::string_view tag, const std::array<double, 3>& xyz) {
        add({tag}, [&] {
            put(data, std::string_view("XYZ \0\0\0\0", 8));
            for (const double value : xyz) put_fixed(data, value);
        });
    };
    add_text("desc", name);
    add_text("cprt", "Public domain (CC0)");
    add_xyz("wtpt", d50);
    add({"chad"}, [&] {
        put(data, std::string_view("sf32\0\0\0\0", 8));
        // Bradford, from D65 to D50.
        for (const double value :
             {1.047886, 0.022919, -0.050216, 0.029582, 0.990484, -0.017079, -0.009252, 0.015073, 0.751678})
            put_fixed(data, value);
    });
    const Chromaticities connection{{1, 0}, {0, 1}, {0, 0}, {d50[0] / 2.7891, d50[1] / 2.7891}};
    const ColorMatrix matrix = *conversion(primaries, connection);  // of XYZ that is 1 at D50
    for (std::size_t i = 0; i < 3; ++i)
        add_xyz(std::array<std::string_view, 3>{"rXYZ", "gXYZ", "bXYZ"}[i],
                {matrix[i] * d50[0], matrix[3 + i] * d50[1], matrix[6 + i] * d50[2]});
    add({"rTRC", "gTRC", "bTRC"}, [&] {
        put(data, std::string_view("para\0\0\0\0\0\3\0\0", 12));
        for (const double value : {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045}) put_fixed(data, value);
    });
    std::vector<std::byte> out;
    put_word(out, static_cast<std::uint32_t>(data_start + data.size()));
    put(out, std::string_view("\0\0\0\0\x04\x30\0\0mntrRGB XYZ \x07\xe6\0\1\0\1\0\0\0\0\0\0acsp", 36));
    out.resize(68);
    for (const double value : d50) put_fixed(out, value);
    out.resize(128);
    put_word(out, tag_count);
    out.insert(out.end(), tags.begin(), tags.end());
    out.insert(out.end(), data.begin(), data.end());
    return out;
}

}  // namespace darkroom
