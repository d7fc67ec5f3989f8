// SPDX-License-Identifier: MIT
#pragma once
// What follows the occlusion of each pixel, in double precision: mean over the tile, mean over five tiles, upsampling.
// Surfaces are compared by their nearness, one over the planar distance, and by their normals.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

namespace darkroom {

/// How far normals with this cosine count as of one surface.
[[nodiscard]] inline double ssao_turned(double cosine) { return std::clamp((cosine - 0.8) / 0.15, 0.0, 1.0); }

/// What the filter knows of a pixel beside its visibility.
struct SsaoSurface {
    double nearness = 0;
    std::array<double, 3> normal{};  ///< in view space
    std::array<double, 2> plane{};   ///< slope of the plane with that normal, as a share of the nearness
};

class SsaoFilterReference {
  public:
    /// How wide so many pixels of the frame are at a nearness, as a share of the distance.
    using PixelWidth = std::function<double(double near, int pixels)>;

    SsaoFilterReference(int width, int height, int step, PixelWidth pixel_width)
        : width_(width), height_(height), step_(step), pixel_width_(std::move(pixel_width)) {}

    /// Both row by row.
    void compute(std::vector<SsaoSurface> surfaces, const std::vector<double>& raw) {
        surfaces_ = std::move(surfaces);
        std::vector<double> tile(raw.size());
        slopes_.resize(raw.size());
        covered_.resize(raw.size());
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                slopes_[index(x, y)] = {slope(x, y, 0), slope(x, y, 1)};
                tile[index(x, y)] = blur(raw, x, y);
            }
        blurred_.resize(raw.size());
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) blurred_[index(x, y)] = widen(tile, x, y);
    }

    [[nodiscard]] double blurred(int x, int y) const { return blurred_[index(x, y)]; }

    /// Of the full-size pixel (2 base_x + part_x, 2 base_y + part_y) at this distance. `turned` says how far the normal
    /// of a half-size pixel counts there.
    [[nodiscard]] double upsampled(int base_x, int base_y, int part_x, int part_y, double planar,
                                   const std::function<double(int x, int y)>& turned) const {
        double seen = 0, weights = 0;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const double across = part_x == 0 ? 0.5 : i, down = part_y == 0 ? 0.5 : j;
                const std::size_t from = index(base_x + i, base_y + j);
                const double expected = surfaces_[from].nearness * (1 + slopes_[from][0] * (part_x / 2.0 - i) +
                                                                    slopes_[from][1] * (part_y / 2.0 - j));
                const double unlike = (expected * planar - 1) * 0.7 / std::max(pixel_width_(1 / planar, 1), 4e-4);
                const double weight = (across * down + 0.05) / std::pow(1 + unlike * unlike, 2) *
                                      turned(std::min(base_x + i, width_ - 1), std::min(base_y + j, height_ - 1));
                seen += blurred_[from] * weight;
                weights += weight;
            }
        return seen / weights;
    }

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(std::clamp(y, 0, height_ - 1)) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(std::clamp(x, 0, width_ - 1));
    }
    /// To the next pixel of the row or column, as a share of the nearness here.
    [[nodiscard]] double slope(int x, int y, std::size_t axis) const {
        const int dx = axis == 0 ? 1 : 0, dy = 1 - dx;
        const double own = surfaces_[index(x, y)].nearness, plane = surfaces_[index(x, y)].plane[axis];
        const double before = 1 - surfaces_[index(x - dx, y - dy)].nearness / own;
        const double after = surfaces_[index(x + dx, y + dy)].nearness / own - 1;
        return std::clamp(std::clamp(plane, std::min(before, after), std::max(before, after)), -0.999, 0.999);
    }

    /// Of a pixel so far away in the surface of (x, y), whose slopes over the distance of a tap are `spans` times those
    /// to the next pixel.
    [[nodiscard]] double likeness(int x, int y, int i, int j, int spans) const {
        const SsaoSurface& own = surfaces_[index(x, y)];
        const SsaoSurface& other = surfaces_[index(x + i, y + j)];
        const auto [across, down] = slopes_[index(x, y)];
        const double above = other.nearness / own.nearness - (1 + across * i + down * j);
        const double width = std::max(pixel_width_(own.nearness, step_), 3e-4);
        const double tolerance = width + 0.4 * spans * (std::abs(across) + std::abs(down));
        const double cosine = std::inner_product(own.normal.begin(), own.normal.end(), other.normal.begin(), 0.0);
        // Within the tile, what lies before the surface, across a corner of a room, counts in full.
        const double before = spans == 1 ? std::clamp(2 * above / width, 0.0, 1.0) : 0;
        return std::clamp(2 - std::abs(above) / tolerance, 0.0, 1.0) * std::max(ssao_turned(cosine), before);
    }

    [[nodiscard]] double blur(const std::vector<double>& raw, int x, int y) {
        double seen = 0, weights = 0;
        for (int j = -2; j <= 1; ++j)
            for (int i = -2; i <= 1; ++i) {
                const double weight = likeness(x, y, i, j, 1);
                seen += raw[index(x + i, y + j)] * weight;
                weights += weight;
            }
        covered_[index(x, y)] = std::floor(weights * 4 + 0.5) / 64;
        return seen / weights;
    }

    [[nodiscard]] double widen(const std::vector<double>& tile, int x, int y) const {
        const double here = covered_[index(x, y)];
        double seen = tile[index(x, y)] * here, weights = here;
        for (const auto& [i, j] : {std::array{-4, 0}, std::array{4, 0}, std::array{0, -4}, std::array{0, 4}}) {
            const double own = likeness(x, y, i, j, 4), both = std::min(own, likeness(x, y, -i, -j, 4));
            const double weight = std::lerp(own, both, 0.85 * here) * covered_[index(x + i, y + j)];
            seen += tile[index(x + i, y + j)] * weight;
            weights += weight;
        }
        return seen / weights;
    }

    int width_, height_, step_;
    PixelWidth pixel_width_;
    std::vector<SsaoSurface> surfaces_;
    std::vector<double> blurred_;
    std::vector<double> covered_;  ///< share of the tile's pixels that the mean is of, in quarters of a pixel
    std::vector<std::array<double, 2>> slopes_;
};

}  // namespace darkroom
