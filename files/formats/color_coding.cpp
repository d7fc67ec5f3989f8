// SPDX-License-Identifier: MIT
#include "formats/color_coding.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/srgb.hpp"
#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

using Kind = TransferCurve::Kind;

constexpr Chromaticity d65{0.3127, 0.3290}, aces_white{0.32168, 0.33767};
constexpr TransferCurve linear{}, srgb{Kind::Srgb}, bt1886{Kind::Power, 2.4};

// Rec. 2020: ITU-R BT.2020-2. P3: SMPTE EG 432-1 with D65. ACES: SMPTE ST 2065-1 and S-2014-004. Integers of the two
// spaces of television are shown by the curve of ITU-R BT.1886.
constexpr std::array<InputSpace, 6> spaces{{
    {"srgb", {}, srgb, srgb},
    {"rec709", {}, linear, bt1886},
    {"rec2020", {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, d65}, linear, bt1886},
    {"p3", {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, d65}, linear, srgb},
    {"acescg", {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, aces_white}, linear, linear},
    {"aces2065-1", {{0.7347, 0.2653}, {0, 1}, {0.0001, -0.0770}, aces_white}, linear, linear},
}};

std::vector<std::string> names() {
    std::vector<std::string> out;
    for (const InputSpace& space : spaces) out.emplace_back(space.name);
    return out;
}

double decode_pq(double code) {
    constexpr double m1 = 2610.0 / 16384, m2 = 2523.0 / 32, c1 = 3424.0 / 4096, c2 = 2413.0 / 128, c3 = 2392.0 / 128;
    const double root = std::pow(std::min(code, 1.0), 1 / m2);
    return 10000.0 / 203 * std::pow(std::max(root - c1, 0.0) / (c2 - c3 * root), 1 / m1);
}

double decode_hlg(double code) {
    constexpr double a = 0.17883277, b = 1 - 4 * a, c = 0.55991073, white = 0.75;
    const auto light = [&](double x) { return x <= 0.5 ? x * x / 3 : (std::exp((x - c) / a) + b) / 12; };
    return light(code) / light(white);
}

double decode_positive(const TransferCurve& curve, double code) {
    switch (curve.kind) {
        case Kind::Linear:
            return code;
        case Kind::Srgb:
            return srgb_decode(code);
        case Kind::Power:
            return std::pow(code, curve.exponent);
        case Kind::Pq:
            return decode_pq(code);
        case Kind::Hlg:
            return decode_hlg(code);
    }
    return code;
}

}  // namespace

double TransferCurve::decode(double code) const { return std::copysign(decode_positive(*this, std::abs(code)), code); }

Result<InputSpace> find_input_space(std::string_view name) {
    const auto* const found = std::ranges::find(spaces, lower(name), &InputSpace::name);
    if (found != spaces.end()) return *found;
    return user_error(fmt::format("'{}' is not a known color space{}", printable(name), alternatives(name, names())));
}

Chromaticities chromaticities_of(Primaries primaries) {
    if (primaries == Primaries::P3) return find_input_space("p3")->primaries;
    return primaries == Primaries::Rec2020 ? find_input_space("rec2020")->primaries : Chromaticities{};
}

std::string input_space_names() { return fmt::format("{}", fmt::join(names(), ", ")); }

}  // namespace darkroom
