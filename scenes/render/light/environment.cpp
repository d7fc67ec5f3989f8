// SPDX-License-Identifier: MIT
#include "render/light/environment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "core/thread/parallel.hpp"

namespace darkroom::render {

namespace {

using scene::vec2;
using scene::vec3;

constexpr double pi = std::numbers::pi;

/// The pixels of the source that one pixel of the target covers, and by how much, along one axis.
struct Cover {
    std::uint32_t first = 0;
    std::vector<double> weights;  ///< sum to 1
};

/// `cumulative(t)`: how much of the axis' measure lies before t, t in [0, 1].
template <class Cumulative>
std::vector<Cover> covers(std::uint32_t source, std::uint32_t target, Cumulative cumulative) {
    std::vector<Cover> out(target);
    for (std::uint32_t i = 0; i < target; ++i) {
        const double low = static_cast<double>(i) / target, high = static_cast<double>(i + 1) / target;
        Cover& cover = out[i];
        cover.first = static_cast<std::uint32_t>(static_cast<std::uint64_t>(i) * source / target);
        const std::uint64_t end = (static_cast<std::uint64_t>(i + 1) * source + target - 1) / target;
        const double whole = cumulative(high) - cumulative(low);
        for (std::uint64_t j = cover.first; j < end; ++j) {
            const double from = std::max(low, static_cast<double>(j) / source);
            const double to = std::min(high, static_cast<double>(j + 1) / source);
            cover.weights.push_back((cumulative(to) - cumulative(from)) / whole);
        }
    }
    return out;
}

float roughness_to_alpha(float roughness) { return roughness * roughness; }

/// Planes of one level of the prefiltered map's source: a pixel is a patch of constant light.
struct Source {
    std::uint32_t width = 0, height = 0;
    std::array<std::vector<float>, 3> planes;
    /// Of the angle between columns: first of those `phase` columns after a column of the result, by phase.
    std::vector<float> cosines;

    Source(const Picture& picture, std::uint32_t result_width) : width(picture.width), height(picture.height) {
        for (std::uint32_t phase = 0; phase < width / result_width; ++phase)
            for (std::uint32_t i = 0; i < result_width; ++i) {
                const double turn = (phase + 0.5) / width - (i + 0.5) / result_width;
                cosines.push_back(static_cast<float>(std::cos(2 * pi * turn)));
            }
        for (std::size_t channel = 0; channel < 3; ++channel) {
            planes[channel].resize(std::size_t{width} * height);
            for (std::size_t i = 0; i < planes[channel].size(); ++i)
                planes[channel][i] = picture.pixels[i * 4 + channel];
        }
    }
};

/// Karis' estimate with n = v = r is, as an integral, that of L(l) D(h) (n.l) over that of D(h) (n.l), h halfway
/// between n and l. Constant factors of D cancel.
float lobe(float n_dot_l, float alpha_squared) {
    const float n_dot_h_squared = (1 + n_dot_l) * 0.5F;
    const float denominator = n_dot_h_squared * (alpha_squared - 1) + 1;
    return std::max(n_dot_l, 0.0F) / (denominator * denominator);
}

double elevation(std::uint32_t row, std::uint32_t rows) { return (0.5 - (row + 0.5) / rows) * pi; }

/// The lobe depends on the angle alone, so that a row of the result is a sum of circular convolutions of rows of the
/// source: every patch of the sky counts, and no small sun becomes noise as it would with samples drawn at random.
void filter_row(const Source& source, float alpha, std::uint32_t row, Picture& out) {
    const std::uint32_t width = out.width, step = source.width / width;
    const double out_elevation = elevation(row, out.height);
    std::vector<double> sums(std::size_t{width} * 3);
    double weight_sum = 0;
    std::vector<float> kernel(std::size_t{width} * 2);  // twice the period
    std::vector<float> row_sums(std::size_t{width} * 3);
    for (std::uint32_t source_row = 0; source_row < source.height; ++source_row) {
        const double in_elevation = elevation(source_row, source.height);
        const auto sines = static_cast<float>(std::sin(out_elevation) * std::sin(in_elevation));
        const auto cosines = static_cast<float>(std::cos(out_elevation) * std::cos(in_elevation));
        const double solid_angle = std::cos(in_elevation);  // up to a factor that all rows share
        std::ranges::fill(row_sums, 0.0F);
        for (std::uint32_t phase = 0; phase < step; ++phase) {
            const float* const turns = source.cosines.data() + std::size_t{phase} * width;
            for (std::uint32_t i = 0; i < width; ++i) kernel[i] = lobe(sines + cosines * turns[i], alpha * alpha);
            std::copy_n(kernel.begin(), width, kernel.begin() + width);
            const double kernel_sum = std::accumulate(kernel.begin(), kernel.begin() + width, 0.0);
            weight_sum += kernel_sum * solid_angle;
            if (kernel_sum == 0) continue;
            for (std::uint32_t column = 0; column < width; ++column) {
                const float* const weights = kernel.data() + width - column;
                const std::size_t place = std::size_t{source_row} * source.width + column * step + phase;
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    const float light = source.planes[channel][place];
                    float* const sum = row_sums.data() + channel * width;
                    for (std::uint32_t i = 0; i < width; ++i) sum[i] += light * weights[i];
                }
            }
        }
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += row_sums[i] * solid_angle;
    }
    for (std::uint32_t x = 0; x < width; ++x) {
        float* const pixel = out.at(x, row);
        for (std::size_t channel = 0; channel < 3; ++channel)
            pixel[channel] = static_cast<float>(sums[channel * width + x] / weight_sum);
        pixel[3] = 1;
    }
}

/// How wide the source must be for `width` pixels of a lobe: finer than the result, and with four pixels across the
/// lobe's width at half its height, 4 atan(0.64 alpha), but not so coarse that a lobe's edge, the horizon, is a step.
std::uint32_t source_width(std::uint32_t width, float alpha) {
    constexpr std::uint32_t most = 2048;
    constexpr double least = 64;
    const double wanted = std::max(least, 4 * 2 * pi / (4 * std::atan(0.64 * static_cast<double>(alpha))));
    std::uint32_t out = width * 2;
    while (out < wanted && out * 2 <= std::max(most, width * 2)) out *= 2;
    return out;
}

/// A point of the unit disc that visible normals project to, and its part of the disc's area.
struct DiscPoint {
    double side, up, part;
};

/// Half of the disc, which the other half mirrors. Rings are evenly spaced in the height of the hemisphere above them,
/// so that the integrand stays smooth at the rim.
std::vector<DiscPoint> disc_points(int rings, int around) {
    std::vector<DiscPoint> out;
    for (int i = 0; i < rings; ++i) {
        const double height = (i + 0.5) / rings, radius = std::sqrt(1 - height * height);
        for (int j = 0; j < around; ++j) {
            const double angle = pi * ((j + 0.5) / around - 0.5);
            out.push_back({radius * std::cos(angle), radius * std::sin(angle), 2 * height / (rings * around)});
        }
    }
    return out;
}

/// Karis' split sum by quadrature over the half vectors that the viewer sees (Heitz, "Sampling the GGX Distribution of
/// Visible Normals", 2018, listing 1), with height-correlated masking (Heitz, "Understanding the Masking-Shadowing
/// Function in Microfacet-Based BRDFs", 2014, eq. 99), with which no more light leaves a surface than reaches it.
vec2 split_sum(double n_dot_v, double roughness, std::span<const DiscPoint> disc) {
    const double alpha = roughness * roughness;
    const auto lambda = [&](double cosine) {  // Heitz 2014, eq. 72
        return (std::sqrt(1 + alpha * alpha * (1 - cosine * cosine) / (cosine * cosine)) - 1) / 2;
    };
    // The view is in the plane of x and z, z along the normal.
    const double view_x = std::sqrt(1 - n_dot_v * n_dot_v), view_lambda = lambda(n_dot_v);
    const double stretch = std::hypot(alpha * view_x, n_dot_v);
    const double stretched_x = alpha * view_x / stretch, stretched_z = n_dot_v / stretch;
    double scale = 0, bias = 0;
    const double share = (1 + stretched_z) / 2;
    for (const auto& [side, across, part] : disc) {
        const double up = (1 - share) * std::sqrt(1 - side * side) + share * across;
        const double front = std::sqrt(std::max(0.0, 1 - side * side - up * up));
        glm::dvec3 half(alpha * (front * stretched_x - up * stretched_z), alpha * side,
                        std::max(0.0, front * stretched_z + up * stretched_x));
        half = glm::normalize(half);
        const double v_dot_h = view_x * half.x + n_dot_v * half.z, n_dot_l = 2 * v_dot_h * half.z - n_dot_v;
        if (n_dot_l <= 0) continue;
        const double weight = part * (1 + view_lambda) / (1 + view_lambda + lambda(n_dot_l));
        const double rest = 1 - std::clamp(v_dot_h, 0.0, 1.0), fresnel = rest * rest * rest * rest * rest;
        scale += (1 - fresnel) * weight;
        bias += fresnel * weight;
    }
    return {static_cast<float>(scale), static_cast<float>(bias)};
}

}  // namespace

vec2 direction_to_uv(vec3 direction) {
    return {std::atan2(direction.x, -direction.z) / static_cast<float>(2 * pi) + 0.5F,
            0.5F - std::asin(std::clamp(direction.y, -1.0F, 1.0F)) / static_cast<float>(pi)};
}

vec3 uv_to_direction(vec2 uv) {
    const double longitude = (uv.x - 0.5) * 2 * pi, latitude = (0.5 - uv.y) * pi;
    return {static_cast<float>(std::cos(latitude) * std::sin(longitude)), static_cast<float>(std::sin(latitude)),
            static_cast<float>(-std::cos(latitude) * std::cos(longitude))};
}

std::array<vec3, 9> irradiance_harmonics(const Picture& skybox) {
    using dvec3 = glm::dvec3;
    // Every pixel is a patch of constant light, over which the harmonics are integrated exactly: with longitude p and
    // latitude e, x = cos e sin p, y = sin e, z = -cos e cos p, each is a product of a function of p and one of e.
    struct Column {
        double one, sine, cosine, sine_cosine, sine_squared;
    };
    const auto longitude_integrals = [](double p) {
        return Column{p, -std::cos(p), std::sin(p), std::sin(p) * std::sin(p) / 2, p / 2 - std::sin(2 * p) / 4};
    };
    std::vector<Column> columns(skybox.width);
    for (std::uint32_t x = 0; x < skybox.width; ++x) {
        const Column low = longitude_integrals((static_cast<double>(x) / skybox.width - 0.5) * 2 * pi);
        const Column high = longitude_integrals((static_cast<double>(x + 1) / skybox.width - 0.5) * 2 * pi);
        columns[x] = {high.one - low.one, high.sine - low.sine, high.cosine - low.cosine,
                      high.sine_cosine - low.sine_cosine, high.sine_squared - low.sine_squared};
    }
    std::vector<std::array<dvec3, 9>> rows(skybox.height);
    parallel_for(skybox.height, 0, [&](std::size_t y) {
        dvec3 one(0), sine(0), cosine(0), sine_cosine(0), sine_squared(0);
        for (std::uint32_t x = 0; x < skybox.width; ++x) {
            const float* const pixel = skybox.at(x, static_cast<std::uint32_t>(y));
            const dvec3 light(pixel[0], pixel[1], pixel[2]);
            const Column& column = columns[x];
            one += light * column.one;
            sine += light * column.sine;
            cosine += light * column.cosine;
            sine_cosine += light * column.sine_cosine;
            sine_squared += light * column.sine_squared;
        }
        const double high = (0.5 - static_cast<double>(y) / skybox.height) * pi;
        const double low = (0.5 - static_cast<double>(y + 1) / skybox.height) * pi;
        const auto between = [&](auto integral) { return integral(high) - integral(low); };
        const double cos_1 = between([](double e) { return std::sin(e); });
        const double cos_2 = between([](double e) { return e / 2 + std::sin(2 * e) / 4; });
        const double cos_3 = between([](double e) { return std::sin(e) - std::pow(std::sin(e), 3) / 3; });
        const double sin_cos = between([](double e) { return std::sin(e) * std::sin(e) / 2; });
        const double sin_cos_2 = between([](double e) { return -std::pow(std::cos(e), 3) / 3; });
        const double sin_2_cos = between([](double e) { return std::pow(std::sin(e), 3) / 3; });
        rows[y] = {one * cos_1,
                   one * sin_cos,
                   -cosine * cos_2,
                   sine * cos_2,
                   sine * sin_cos_2,
                   -cosine * sin_cos_2,
                   (one - sine_squared) * cos_3 * 3.0 - one * cos_1,
                   -sine_cosine * cos_3,
                   sine_squared * cos_3 - one * sin_2_cos};
    });
    const double band_0 = 0.5 / std::sqrt(pi), band_1 = std::sqrt(3 / pi) / 2, band_2 = std::sqrt(15 / pi) / 2;
    const std::array basis{band_0, band_1, band_1, band_1, band_2, band_2, band_2 / std::sqrt(12), band_2, band_2 / 2};
    // Ramamoorthi and Hanrahan 2001, eq. 8: pi, 2 pi / 3, pi / 4, here over pi.
    constexpr std::array cosine_lobe{1.0, 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.25, 0.25, 0.25, 0.25, 0.25};
    std::array<vec3, 9> out{};
    for (std::size_t i = 0; i < 9; ++i) {
        dvec3 sum(0);
        for (const std::array<dvec3, 9>& row : rows) sum += row[i];
        out[i] = vec3(sum * basis[i] * cosine_lobe[i]);
    }
    return out;
}

Picture resampled(const Picture& sky, std::uint32_t width, std::uint32_t height) {
    const std::vector<Cover> columns = covers(sky.width, width, [](double t) { return t; });
    const std::vector<Cover> rows = covers(sky.height, height, [](double t) { return -std::cos(pi * t) / 2; });
    Picture out(width, height);
    parallel_for(height, 0, [&](std::size_t y) {
        std::vector<double> sums(std::size_t{sky.width} * 4);
        for (std::size_t i = 0; i < rows[y].weights.size(); ++i) {
            const float* const line = sky.at(0, rows[y].first + static_cast<std::uint32_t>(i));
            for (std::size_t j = 0; j < sums.size(); ++j) sums[j] += rows[y].weights[i] * line[j];
        }
        for (std::uint32_t x = 0; x < width; ++x) {
            std::array<double, 4> sum{};
            for (std::size_t i = 0; i < columns[x].weights.size(); ++i)
                for (std::size_t channel = 0; channel < 4; ++channel)
                    sum[channel] += columns[x].weights[i] * sums[(columns[x].first + i) * 4 + channel];
            std::ranges::transform(sum, out.at(x, static_cast<std::uint32_t>(y)),
                                   [](double value) { return static_cast<float>(value); });
        }
    });
    return out;
}

std::vector<Picture> prefilter(const Picture& skybox, std::uint32_t width, std::uint32_t levels) {
    std::vector<Picture> out;
    out.push_back(resampled(skybox, width, std::max(1U, width / 2)));
    for (std::uint32_t level = 1; level < levels; ++level) {
        const float alpha = roughness_to_alpha(static_cast<float>(level) / static_cast<float>(levels - 1));
        Picture picture(std::max(1U, width >> level), std::max(1U, width >> (level + 1)));
        const std::uint32_t wide = source_width(picture.width, alpha);
        const Source source(resampled(skybox, wide, wide / 2), picture.width);
        parallel_for(picture.height, 0,
                     [&](std::size_t row) { filter_row(source, alpha, static_cast<std::uint32_t>(row), picture); });
        out.push_back(std::move(picture));
    }
    return out;
}

Picture split_sum_table(std::uint32_t size) {
    Picture table(size, size);
    const std::vector<DiscPoint> disc = disc_points(16, 16);
    parallel_for(size, 0, [&](std::size_t y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            const vec2 pair = split_sum((x + 0.5) / size, (static_cast<double>(y) + 0.5) / size, disc);
            float* const pixel = table.at(x, static_cast<std::uint32_t>(y));
            pixel[0] = pair.x;
            pixel[1] = pair.y;
            pixel[3] = 1;
        }
    });
    return table;
}

}  // namespace darkroom::render
