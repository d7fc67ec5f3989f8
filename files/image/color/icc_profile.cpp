// SPDX-License-Identifier: MIT
#include "image/color/icc_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
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
        // Two bytes at its end are read as four, of which the last two are not there.
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

}  // namespace darkroom
