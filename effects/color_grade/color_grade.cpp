// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/color_grade.hpp>

#include "color_grade/color_grade_reference.hpp"

namespace darkroom {

namespace {

constexpr auto color_grade_rows = describe(
    field<&ColorGrade::temperature>(
        "Colour temperature of the light that becomes white: above 6504 the picture gets warmer, below it colder.",
        {2500, 25000, Scale::Log}, Unit{"K"}),
    field<&ColorGrade::tint>(
        "Green of the light that becomes white, in 3000ths of CIE 1960 uv: above 0 the picture turns magenta.",
        {-100, 100}),
    field<&ColorGrade::mixer_red>("Shares of red, green and blue in the new red.", {-2, 2}),
    field<&ColorGrade::mixer_green>("Shares of red, green and blue in the new green.", {-2, 2}),
    field<&ColorGrade::mixer_blue>("Shares of red, green and blue in the new blue.", {-2, 2}),
    field<&ColorGrade::shadows>("Factor of the dark range.", {0, 4}),
    field<&ColorGrade::midtones>("Factor of the range between dark and bright.", {0, 4}),
    field<&ColorGrade::highlights>("Factor of the bright range.", {0, 4}),
    field<&ColorGrade::shadows_range>("Luminance at which the shadows begin to fade, then the width of the fade.",
                                      {0, 64}),
    field<&ColorGrade::highlights_range>("Luminance at which the highlights begin, then the width of the fade.",
                                         {0, 64}),
    field<&ColorGrade::lift>("Light that is added (offset).", {-1, 1}),
    field<&ColorGrade::gamma>("Exponent 1 / gamma: above 1 the middle gets brighter.", {0.1, 10, Scale::Log}),
    field<&ColorGrade::gain>("Factor of the light (slope).", {0, 16}),
    field<&ColorGrade::contrast>("Factor of the distance from the pivot, in stops.", {0, 4}),
    field<&ColorGrade::pivot>("Light that the contrast leaves as it is; 0.18 is middle grey.", {0.001, 16, Scale::Log}),
    field<&ColorGrade::curve_red>(
        "Red out (y) for red in (x), both in stops from middle grey; an empty curve changes nothing.", {-16, 16}),
    field<&ColorGrade::curve_green>(
        "Green out (y) for green in (x), both in stops from middle grey; an empty curve changes nothing.", {-16, 16}),
    field<&ColorGrade::curve_blue>(
        "Blue out (y) for blue in (x), both in stops from middle grey; an empty curve changes nothing.", {-16, 16}),
    field<&ColorGrade::hue>("Angle by which hues turn; luminance stays.", {-180, 180}, unit::degrees),
    field<&ColorGrade::vibrance>("Saturation added to pale colours; colourful ones get less of it.", {-1, 1}),
    field<&ColorGrade::saturation>("Factor of the distance from grey; luminance stays.", {0, 4}));

using color_grade::Matrix3;
using color_grade::Triple;

// What the shader reads, three numbers a vector and one more:
constexpr std::size_t balance = 0;     // 3 rows; saturation, saturation * vibrance
constexpr std::size_t shadows = 3;     // factor; start / width of their range
constexpr std::size_t midtones = 4;    // factor; 1 / width of the shadows' range
constexpr std::size_t highlights = 5;  // factor; start / width of their range
constexpr std::size_t lift = 6;        // offset; 1 / width of the highlights' range
constexpr std::size_t gain = 7;        // factor; not 0: what follows in stops is to be done
constexpr std::size_t slope = 8;       // factor of log2; segments of the curves
constexpr std::size_t offset = 9;      // added to it
constexpr std::size_t turn = 10;       // 3 rows
constexpr std::size_t curves = 13;     // stops that are added below the first points
constexpr std::size_t segments = 14;   // of each: start, 1 / width, then the cubic of the stops that are added: what
                                       // goes with t^2, with t^3; with t, channel by channel, what the first three hold
constexpr std::size_t segment_vectors = 4;
constexpr std::size_t vectors = segments + segment_vectors * (Curve::capacity - 1);

const ColorGrade& grade_of(const void* parameters) { return *static_cast<const ColorGrade*>(parameters); }

PassVector vector_of(const Rgb& color, double last) { return {color.r, color.g, color.b, static_cast<float>(last)}; }

void put_rows(const Matrix3& matrix, std::span<PassVector> out) {
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t i = 0; i < 3; ++i) out[row][i] = static_cast<float>(matrix[row][i]);
}

/// Without a width it is a step.
double width_of(const Vec2& range) { return std::max(double{range.y}, 1e-6); }

/// One channel of the curves. The stops of a point are counted from middle grey, those of the shader from 1.
void put_curve(const Curve& curve, std::size_t channel, std::span<PassVector> out) {
    const double grey = std::log2(0.18);
    const std::size_t count = std::min<std::size_t>(curve.count, Curve::capacity);
    out[curves][channel] = count == 0 ? 0.0f : curve.y[0] - curve.x[0];
    for (std::size_t i = 0; i + 1 < Curve::capacity; ++i) {
        const bool is_there = i + 1 < count;
        const double start = is_there ? double{curve.x[i]} : 0.0, end = is_there ? double{curve.x[i + 1]} : 1.0;
        const double width = std::max(end - start, 1e-6);
        const double added = is_there ? double{curve.y[i + 1]} - double{curve.y[i]} - (end - start) : 0.0;
        // Of what is added, as the stops themselves rise with a slope of 1.
        const double first = is_there ? (color_grade_slope(curve, i) - 1) * width : 0.0;
        const double second = is_there ? (color_grade_slope(curve, i + 1) - 1) * width : 0.0;
        const std::size_t vector = segments + segment_vectors * i;
        out[vector][channel] = static_cast<float>(start + grey);
        out[vector + 1][channel] = static_cast<float>(1 / width);
        out[vector + 2][channel] = static_cast<float>(3 * added - 2 * first - second);
        out[vector + 3][channel] = static_cast<float>(first + second - 2 * added);
        out[vector + channel][3] = static_cast<float>(first);
    }
}

bool is_straight(const Curve& curve) {
    for (std::size_t i = 0; i < std::min<std::size_t>(curve.count, Curve::capacity); ++i)
        if (curve.x[i] != curve.y[i]) return false;
    return true;
}
bool has_curves(const ColorGrade& grade) {
    return !is_straight(grade.curve_red) || !is_straight(grade.curve_green) || !is_straight(grade.curve_blue);
}

void constants(const void* parameters, const PassContext&, std::span<PassVector> out) {
    const ColorGrade& grade = grade_of(parameters);
    const auto row = [](const Vec3& v) { return Triple{double{v.x}, double{v.y}, double{v.z}}; };
    const Matrix3 mixer{row(grade.mixer_red), row(grade.mixer_green), row(grade.mixer_blue)};
    const Matrix3 white = color_grade::white_balance(double{grade.temperature}, double{grade.tint});
    put_rows(color_grade::product(mixer, white), out.subspan(balance, 3));
    out[balance][3] = grade.saturation;
    out[balance + 1][3] = grade.saturation * grade.vibrance;

    const double dark = width_of(grade.shadows_range), bright = width_of(grade.highlights_range);
    out[shadows] = vector_of(grade.shadows, double{grade.shadows_range.x} / dark);
    out[midtones] = vector_of(grade.midtones, 1 / dark);
    out[highlights] = vector_of(grade.highlights, double{grade.highlights_range.x} / bright);
    out[lift] = vector_of(grade.lift, 1 / bright);

    const Rgb& gamma = grade.gamma;
    const bool has_curve = has_curves(grade);
    const bool has_stops = has_curve || grade.contrast != 1.0f || gamma.r != 1.0f || gamma.g != 1.0f || gamma.b != 1.0f;
    out[gain] = vector_of(grade.gain, has_stops ? 1 : 0);
    const Rgb steep{grade.contrast / gamma.r, grade.contrast / gamma.g, grade.contrast / gamma.b};
    const std::size_t points = std::max({std::size_t{grade.curve_red.count}, std::size_t{grade.curve_green.count},
                                         std::size_t{grade.curve_blue.count}});
    out[slope] =
        vector_of(steep, has_curve && points > 1 ? static_cast<double>(std::min(points, Curve::capacity) - 1) : 0);
    const float kept = (1 - grade.contrast) * std::log2(grade.pivot);
    out[offset] = {kept, kept, kept, 0};
    put_rows(color_grade::hue_rotation(double{grade.hue}), out.subspan(turn, 3));
    put_curve(grade.curve_red, 0, out);
    put_curve(grade.curve_green, 1, out);
    put_curve(grade.curve_blue, 2, out);
}

bool is_identity(const void* parameters) {
    const ColorGrade& grade = grade_of(parameters);
    constexpr ColorGrade neutral;
    const auto is_same = [](const auto& a, const auto& b) {
        using Words = std::array<float, sizeof(a) / sizeof(float)>;
        return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
    };
    return grade.temperature == neutral.temperature && grade.tint == neutral.tint &&
           is_same(grade.mixer_red, neutral.mixer_red) && is_same(grade.mixer_green, neutral.mixer_green) &&
           is_same(grade.mixer_blue, neutral.mixer_blue) && is_same(grade.shadows, neutral.shadows) &&
           is_same(grade.midtones, neutral.midtones) && is_same(grade.highlights, neutral.highlights) &&
           is_same(grade.lift, neutral.lift) && is_same(grade.gamma, neutral.gamma) &&
           is_same(grade.gain, neutral.gain) && grade.contrast == neutral.contrast && !has_curves(grade) &&
           grade.hue == neutral.hue && grade.vibrance == neutral.vibrance && grade.saturation == neutral.saturation;
}

}  // namespace

const EffectInfo& effect_info(const ColorGrade&) {
    static const EffectInfo info{
        .name = "color_grade",
        .doc = "Grades light: white balance, ranges, lift, gamma and gain, contrast, curves, mixer, hue, saturation.",
        .parameters = color_grade_rows.table(),
        .files = embedded_files("color_grade"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .flat = {.documented = 65, .scene_linear = 67, .starts_on = true},
        .works = {.in = WorkingSpace::Straight},
        .build = [](PassBuilder& builder) { builder.end_constants(vectors, constants); },
        .reference = pointwise_reference<ColorGrade, color_grade_reference>,
        .is_identity = is_identity,
    };
    return info;
}

}  // namespace darkroom
