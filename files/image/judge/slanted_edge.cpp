// SPDX-License-Identifier: MIT
#include "image/judge/slanted_edge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace darkroom {

namespace {

constexpr std::uint32_t least_side = 16;
constexpr double bins_a_pixel = 4;  // ISO 12233
constexpr double least_step = 1e-3;
constexpr double min_slope = 0.02, max_slope = 0.9;

struct Line {
    double at = 0, slope = 0;  ///< column of row 0, and columns a row
};

/// Where the change of each row has its middle, as a line through all rows.
Line edge_of(const Plane<1>& rows) {
    double n = 0, sum_y = 0, sum_x = 0, sum_yy = 0, sum_xy = 0;
    for (std::uint32_t y = 0; y < rows.height; ++y) {
        double weight = 0, middle = 0;
        for (std::uint32_t x = 0; x + 1 < rows.width; ++x) {
            const double change = double{*rows.at(x + 1, y)} - double{*rows.at(x, y)};
            weight += change;
            middle += change * (x + 1);
        }
        if (std::abs(weight) < least_step) continue;
        const double x = middle / weight;
        n += 1;
        sum_y += y;
        sum_x += x;
        sum_yy += static_cast<double>(y) * y;
        sum_xy += x * y;
    }
    const double slope = (n * sum_xy - sum_x * sum_y) / (n * sum_yy - sum_y * sum_y);
    return {(sum_x - slope * sum_y) / n, slope};
}

/// Means of pixels by their distance from the edge, four bins a pixel.
std::vector<double> spread_function(const Plane<1>& rows, const Line& edge) {
    const double across = 1 / std::hypot(1, edge.slope);
    const auto reach = static_cast<std::size_t>(rows.width / 2 * bins_a_pixel);
    std::vector<double> sums(2 * reach), counts(2 * reach);
    for (std::uint32_t y = 0; y < rows.height; ++y)
        for (std::uint32_t x = 0; x < rows.width; ++x) {
            const double distance = (x + 0.5 - edge.at - edge.slope * y) * across;
            const auto bin = static_cast<std::ptrdiff_t>(std::floor(distance * bins_a_pixel + double(reach)));
            if (bin < 0 || bin >= static_cast<std::ptrdiff_t>(sums.size())) continue;
            sums[static_cast<std::size_t>(bin)] += double{*rows.at(x, y)};
            counts[static_cast<std::size_t>(bin)] += 1;
        }
    std::vector<double> means;
    double last = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (counts[i] > 0) last = sums[i] / counts[i];
        if (counts[i] > 0 || !means.empty()) means.push_back(last);
    }
    return means;
}

/// The transfer function at a frequency in cycles a pixel, of a line spread function under a Hamming window.
double transfer(const std::vector<double>& line, double frequency) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < line.size(); ++i)
        sum += line[i] * std::polar(1.0, -2 * std::numbers::pi * frequency / bins_a_pixel * static_cast<double>(i));
    return std::abs(sum);
}

Plane<1> turned(const Plane<1>& plane) {
    Plane<1> out(plane.height, plane.width);
    for (std::uint32_t y = 0; y < plane.height; ++y)
        for (std::uint32_t x = 0; x < plane.width; ++x) *out.at(y, x) = *plane.at(x, y);
    return out;
}

double mean_change(const Plane<1>& plane) {
    double sum = 0;
    for (std::uint32_t y = 0; y < plane.height; ++y)
        sum += std::abs(double{*plane.at(plane.width - 1, y)} - double{*plane.at(0, y)});
    return sum / plane.height;
}

std::vector<double> line_spread(const std::vector<double>& spread) {
    std::vector<double> line(spread.size());
    for (std::size_t i = 1; i + 1 < line.size(); ++i) line[i] = (spread[i + 1] - spread[i - 1]) / 2;
    const auto middle = std::ranges::max_element(line, {}, [](double v) { return std::abs(v); }) - line.begin();
    const auto half = static_cast<double>(std::max(middle, static_cast<std::ptrdiff_t>(line.size()) - middle));
    for (std::size_t i = 0; i < line.size(); ++i)
        line[i] *=
            0.54 + 0.46 * std::cos(std::numbers::pi * (static_cast<double>(i) - static_cast<double>(middle)) / half);
    return line;
}

}  // namespace

Result<EdgeSharpness> edge_sharpness(const Plane<1>& luminance) {
    if (luminance.width < least_side || luminance.height < least_side)
        return user_error(fmt::format("an edge of {}x{} pixels; {}x{} and more are needed", luminance.width,
                                      luminance.height, least_side, least_side));
    const Plane<1> across = turned(luminance);
    const Plane<1>& rows = mean_change(luminance) >= mean_change(across) ? luminance : across;
    EdgeSharpness out{.contrast = mean_change(rows)};
    if (!(out.contrast >= least_step))
        return user_error(
            fmt::format("an edge with a contrast of {:g}; {:g} and more is needed", out.contrast, least_step));
    const Line edge = edge_of(rows);
    out.angle_degrees = std::atan(edge.slope) * 180 / std::numbers::pi;
    if (!(std::abs(edge.slope) >= min_slope && std::abs(edge.slope) <= max_slope))
        return user_error(fmt::format("an edge at {:.1f} degrees against the pixels; {:.1f} to {:.1f} are needed",
                                      std::abs(out.angle_degrees), std::atan(min_slope) * 180 / std::numbers::pi,
                                      std::atan(max_slope) * 180 / std::numbers::pi));
    const std::vector<double> line = line_spread(spread_function(rows, edge));
    const double whole = transfer(line, 0);
    // The difference of neighbours but one is itself a filter, whose transfer is known.
    const auto modulation = [&](double frequency) {
        const double argument = 2 * std::numbers::pi * frequency / bins_a_pixel;
        return transfer(line, frequency) / whole * (argument == 0 ? 1 : argument / std::sin(argument));
    };
    constexpr double step = 1.0 / 512;
    double last = 1;
    for (double frequency = step; frequency <= 1; frequency += step) {
        const double now = modulation(frequency);
        if (now <= 0.5) {
            out.mtf50 = frequency - step * (0.5 - now) / (last - now);
            return out;
        }
        last = now;
    }
    out.mtf50 = 1;
    return out;
}

}  // namespace darkroom
