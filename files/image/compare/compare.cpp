// SPDX-License-Identifier: MIT
#include "image/compare/compare.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace darkroom {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double difference(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
    if (std::isnan(a) || std::isnan(b)) return infinity;
    return std::abs(a - b);
}

void count(NonFinite& counts, double value) {
    if (std::isnan(value))
        ++counts.nan;
    else if (std::isinf(value))
        ++counts.infinite;
}

// Every eighth entry and the last of the published table of 256, which is in the public domain (CC0). Between them we
// interpolate; no entry of the table is missed by more than 0.004, one code of 8 bits.
constexpr std::array<std::array<float, 3>, 33> magma_knots = {
    {{0.001462f, 0.000466f, 0.013866f}, {0.013708f, 0.011771f, 0.068667f}, {0.039608f, 0.031090f, 0.133515f},
     {0.074257f, 0.052017f, 0.202660f}, {0.113094f, 0.065492f, 0.276784f}, {0.159018f, 0.068354f, 0.352688f},
     {0.211718f, 0.061992f, 0.418647f}, {0.265447f, 0.060237f, 0.461840f}, {0.316654f, 0.071690f, 0.485380f},
     {0.366012f, 0.090314f, 0.497960f}, {0.414709f, 0.110431f, 0.504662f}, {0.463508f, 0.129893f, 0.507652f},
     {0.512831f, 0.148179f, 0.507648f}, {0.562866f, 0.165368f, 0.504692f}, {0.613617f, 0.181811f, 0.498536f},
     {0.664915f, 0.198075f, 0.488836f}, {0.716387f, 0.214982f, 0.475290f}, {0.767398f, 0.233705f, 0.457755f},
     {0.816914f, 0.255895f, 0.436461f}, {0.863320f, 0.283729f, 0.412403f}, {0.904281f, 0.319610f, 0.388137f},
     {0.937221f, 0.364929f, 0.368567f}, {0.960949f, 0.418323f, 0.359630f}, {0.976690f, 0.476226f, 0.364466f},
     {0.986700f, 0.535582f, 0.382210f}, {0.992785f, 0.594891f, 0.410283f}, {0.996096f, 0.653659f, 0.446213f},
     {0.997325f, 0.711848f, 0.488154f}, {0.996898f, 0.769591f, 0.534892f}, {0.995131f, 0.827052f, 0.585701f},
     {0.992440f, 0.884330f, 0.640099f}, {0.989434f, 0.941470f, 0.697519f}, {0.987053f, 0.991438f, 0.749504f}}};

template <class Sample>
SampleErrors errors_of(std::span<const Sample> reference, std::span<const Sample> test, const SampleLayout& layout,
                       std::optional<double> peak) {
    SampleErrors out{.pixels = reference.size() / layout.stride};
    double sum = 0.0;
    double squares = 0.0;
    double largest = 0.0;
    for (std::size_t i = layout.first; i < reference.size(); i += layout.stride) {
        bool is_same = true;
        for (std::uint32_t channel = 0; channel < layout.count; ++channel) {
            const double a = reference[i + channel], b = test[i + channel];
            count(out.reference, a);
            count(out.test, b);
            if (std::isfinite(a)) largest = std::max(largest, std::abs(a));
            const double error = difference(a, b);
            if (error == 0.0) continue;
            is_same = false;
            out.non_finite_differences += !std::isfinite(a) || !std::isfinite(b);
            sum += error;
            squares += error * error;
            if (error <= out.max_error) continue;
            const std::size_t pixel = i / layout.stride;
            out.max_error = error;
            out.worst = {static_cast<std::uint32_t>(pixel % layout.width),
                         static_cast<std::uint32_t>(pixel / layout.width), channel, a, b};
        }
        out.differing_pixels += is_same ? 0 : 1;
    }
    const double samples = static_cast<double>(out.pixels) * layout.count;
    const double top = peak.value_or(largest);
    out.mean_error = sum / samples;
    out.psnr = squares == 0.0 ? infinity : 10.0 * std::log10(top * top * samples / squares);
    return out;
}

}  // namespace

SampleErrors measure(std::span<const float> reference, std::span<const float> test, const SampleLayout& layout,
                     std::optional<double> peak) {
    return errors_of(reference, test, layout, peak);
}

SampleErrors measure(std::span<const std::uint32_t> reference, std::span<const std::uint32_t> test,
                     const SampleLayout& layout) {
    return errors_of(reference, test, layout, {});
}

Result<Comparison> compare(const Picture& reference, const Picture& test, const FlipDesc& desc) {
    DARKROOM_TRY_VALUE(FlipErrors errors, flip(reference, test, desc));
    const SampleLayout rgb{.width = reference.width};
    const SampleLayout alpha{.width = reference.width, .first = 3, .count = 1};
    std::optional<double> peak;
    if (desc.encoding == PictureEncoding::Display) peak = 1.0;
    Comparison out{measure(reference.pixels, test.pixels, rgb, peak)};
    out.alpha = measure(reference.pixels, test.pixels, alpha, 1.0);
    out.flip_mean = errors.mean;
    out.flip_weighted_median = errors.weighted_median;
    out.flip_max = errors.max;
    out.flip_map = paint_errors(errors.errors, errors.width, errors.height);
    return out;
}

std::array<float, 3> magma(float value) {
    const float entry = value > 0.0f ? std::min(value, 1.0f) * 255.0f : 0.0f;
    const std::size_t knot = std::min(static_cast<std::size_t>(entry / 8.0f), magma_knots.size() - 2);
    const float start = static_cast<float>(knot) * 8.0f;
    const float end = knot + 2 == magma_knots.size() ? 255.0f : start + 8.0f;
    const float t = (entry - start) / (end - start);
    std::array<float, 3> out{};
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = magma_knots[knot][i] + t * (magma_knots[knot + 1][i] - magma_knots[knot][i]);
    return out;
}

Picture paint_errors(std::span<const float> errors, std::uint32_t width, std::uint32_t height) {
    Picture out(width, height);
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const std::array<float, 3> color = magma(errors[i]);
        std::copy(color.begin(), color.end(), out.pixels.begin() + static_cast<std::ptrdiff_t>(4 * i));
        out.pixels[4 * i + 3] = 1.0f;
    }
    return out;
}

}  // namespace darkroom
