// SPDX-License-Identifier: MIT
#pragma once
// What follows the occlusion of each pixel, in double precision: mean over the tile, tent over tiles, upsampling.
// Surfaces are compared by their nearness, one over the planar distance.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace darkroom {

class SsaoFilterReference {
  public:
    /// How wide so many pixels of the frame are at a nearness, as a share of the distance.
    using PixelWidth = std::function<double(double near, int pixels)>;

    SsaoFilterReference(int width, int height, int step, PixelWidth pixel_width)
        : width_(width), height_(height), step_(step), pixel_width_(std::move(pixel_width)) {}

    /// Both row by row.
    void compute(std::vector<double> nearness, const std::vector<double>& raw) {
        nearness_ = std::move(nearness);
        std::vector<double> tile(raw.size());
        slopes_.resize(raw.size());
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                slopes_[index(x, y)] = {slope(x, y, 1, 0), slope(x, y, 0, 1)};
                tile[index(x, y)] = blur(raw, x, y);
            }
        blurred_.resize(raw.size());
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) blurred_[index(x, y)] = widen(tile, x, y);
    }

    [[nodiscard]] double blurred(int x, int y) const { return blurred_[index(x, y)]; }

    /// Of the full-size pixel (2 base_x + part_x, 2 base_y + part_y) at this distance.
    [[nodiscard]] double upsampled(int base_x, int base_y, int part_x, int part_y, double planar) const {
        double seen = 0, weights = 0;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const double across = part_x == 0 ? 0.5 : i, down = part_y == 0 ? 0.5 : j;
                const std::size_t from = index(base_x + i, base_y + j);
                const double expected = nearness_[from] * (1 + slopes_[from][0] * (part_x / 2.0 - i) +
                                                           slopes_[from][1] * (part_y / 2.0 - j));
                const double unlike = (expected * planar - 1) * 2 / std::max(pixel_width_(1 / planar, 1), 4e-4);
                const double weight = (across * down + 0.05) / std::pow(1 + unlike * unlike, 2);
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
    /// To the next pixel, as a share of the nearness here.
    [[nodiscard]] double slope(int x, int y, int dx, int dy) const {
        const auto nearness = [&](int steps) { return nearness_[index(x + steps * dx, y + steps * dy)]; };
        const double own = nearness(0), before = own - nearness(-1), after = nearness(1) - own;
        const double lesser = std::max(std::min(before, after), 0.0) + std::min(std::max(before, after), 0.0);
        const double bend = std::abs(nearness(-1) - nearness(-2) - before) / own;
        const double straight = std::clamp(2 - bend / std::max(0.15 * pixel_width_(own, step_), 3e-4), 0.0, 1.0);
        const double chosen = std::lerp(lesser, before, straight);
        return std::clamp(chosen / own, -0.999, 0.999);
    }

    /// Of a pixel so far away in the surface of (x, y), whose slopes over the distance of a tap are `spans` times those
    /// to the next pixel.
    [[nodiscard]] double likeness(int x, int y, int i, int j, int spans) const {
        const double own = nearness_[index(x, y)];
        const auto [across, down] = slopes_[index(x, y)];
        const double unlike = std::abs(nearness_[index(x + i, y + j)] / own - (1 + across * i + down * j));
        const double tolerance =
            std::max(pixel_width_(own, step_), 3e-4) + 0.1 * spans * (std::abs(across) + std::abs(down));
        return std::clamp(2 - unlike / tolerance, 0.0, 1.0);
    }

    [[nodiscard]] double blur(const std::vector<double>& raw, int x, int y) const {
        double seen = 0, weights = 0;
        for (int j = -2; j <= 1; ++j)
            for (int i = -2; i <= 1; ++i) {
                const double weight = likeness(x, y, i, j, 1);
                seen += raw[index(x + i, y + j)] * weight;
                weights += weight;
            }
        return seen / weights;
    }

    [[nodiscard]] double widen(const std::vector<double>& tile, int x, int y) const {
        double seen = 0, weights = 0;
        for (int j = -4; j <= 4; j += 4)
            for (int i = -4; i <= 4; i += 4) {
                const double weight = std::min(likeness(x, y, i, j, 4), likeness(x, y, -i, -j, 4)) *
                                      (i == 0 ? 1 : 0.5) * (j == 0 ? 1 : 0.5);
                seen += tile[index(x + i, y + j)] * weight;
                weights += weight;
            }
        return seen / weights;
    }

    int width_, height_, step_;
    PixelWidth pixel_width_;
    std::vector<double> nearness_, blurred_;
    std::vector<std::array<double, 2>> slopes_;
};

}  // namespace darkroom
