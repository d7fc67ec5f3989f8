// SPDX-License-Identifier: MIT
#pragma once
// SMAA 1x in double precision (Jorge Jimenez et al., "SMAA: Enhanced Subpixel Morphological Antialiasing", 2012): edges
// with local contrast, the lines that they stand for along rows, columns and diagonals, and what each pixel takes of
// the one across. Areas under lines are integrated where the paper looks them up: a line at heights a and b over the
// edge at a pixel's sides has (a+^2 - b+^2) / (2 (a - b)) of area above it. And how long the steps before and behind
// are tells where in a step its line lies.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/smaa.hpp>
#include <darkroom/reference.hpp>
#include <utility>
#include <vector>

#include "shared/light_reference.hpp"
#include "smaa/smaa_line_reference.hpp"

namespace darkroom {

/// Of a quality: pairs of pixels that a search goes along a line, and steps along a diagonal.
struct SmaaSteps {
    int pairs, diagonal;
};
constexpr SmaaSteps smaa_steps(SmaaQuality quality) {
    constexpr std::array<SmaaSteps, 4> steps{{{4, 0}, {8, 0}, {16, 8}, {32, 16}}};
    return steps[static_cast<std::size_t>(quality)];
}

/// Jumps of the inverse distance, as a part of the larger one, that predication takes for the edge of a thing.
inline constexpr double smaa_depth_jump = 0.05;
/// By so much of itself a step goes on beside it where it is a slope, smooth already.
inline constexpr double smaa_slope = 0.75;
/// Steps of a stair, a side each, that make a diagonal: a corner has two, a step of two pixels beside one has three.
inline constexpr int smaa_least_diagonal = 5;

class SmaaReference {
  public:
    SmaaReference(const Smaa& smaa, const ReferenceInput& input)
        : smaa_(smaa),
          picture_(*input.picture),
          depth_(input.depth),
          color_(input.color),
          steps_(smaa_steps(smaa.quality)) {
        for (std::int64_t y = 0; y < picture_.height; ++y)
            for (std::int64_t x = 0; x < picture_.width; ++x) edges_.push_back(edges_of(x, y));
        for (std::int64_t y = 0; y < picture_.height; ++y)
            for (std::int64_t x = 0; x < picture_.width; ++x) weights_.push_back(weights_of(x, y));
    }

    ReferenceImage run() const {
        ReferenceImage out = picture_;
        for (std::int64_t y = 0; y < picture_.height; ++y)
            for (std::int64_t x = 0; x < picture_.width; ++x) blend(x, y, out);
        return out;
    }

  private:
    struct Edges {
        bool left = false, top = false;
    };
    /// Of a pixel: what it takes of the one above, that of it, what it takes of the one to the left, that of it.
    struct Weights {
        double up = 0, of_above = 0, left = 0, of_left = 0;
    };
    using Step = std::array<double, 3>;
    /// What is compared, from (i, j) to (x, y).
    Step step(std::int64_t x, std::int64_t y, std::int64_t i, std::int64_t j) const {
        const Rgba &a = picture_.clamped(x, y), &b = picture_.clamped(i, j);
        if (smaa_.detection == SmaaDetection::Color) return {a.r - b.r, a.g - b.g, a.b - b.b};
        const auto luma = [](const Rgba& c) { return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b; };
        return {luma(a) - luma(b), 0, 0};
    }
    double difference(std::int64_t x, std::int64_t y, std::int64_t i, std::int64_t j) const {
        const Step apart = step(x, y, i, j);
        return std::max({std::abs(apart[0]), std::abs(apart[1]), std::abs(apart[2])});
    }
    /// Does what differs between (x, y) and the one before, (dx, dy) away, go on the same way on one of the sides?
    bool is_slope(std::int64_t x, std::int64_t y, std::int64_t dx, std::int64_t dy) const {
        const Step before = step(x + dx, y + dy, x + 2 * dx, y + 2 * dy), own = step(x, y, x + dx, y + dy),
                   behind = step(x - dx, y - dy, x, y);
        const auto product = [](const Step& a, const Step& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
        return std::max(product(before, own), product(own, behind)) >= smaa_slope * product(own, own);
    }

    double threshold(std::int64_t x, std::int64_t y, std::int64_t i, std::int64_t j) const {
        const double predication{smaa_.predication};
        if (depth_ == nullptr || predication == 0) return double{smaa_.threshold};
        const auto inverse = [&](std::int64_t u, std::int64_t v) {
            return 1 / std::max(depth_->clamped(u, v).r, 1e-4);
        };
        const double a = inverse(x, y), b = inverse(i, j);
        const bool is_jump = std::abs(a - b) > smaa_depth_jump * std::max(a, b);
        return double{smaa_.threshold} * (is_jump ? 1 - 0.5 * predication : 1 + predication);
    }

    Edges edges_of(std::int64_t x, std::int64_t y) const {
        const double left = difference(x, y, x - 1, y), top = difference(x, y, x, y - 1);
        const bool is_left = left >= threshold(x, y, x - 1, y), is_top = top >= threshold(x, y, x, y - 1);
        if (!is_left && !is_top) return {};
        const double most = std::max({left, top, difference(x, y, x + 1, y), difference(x, y, x, y + 1),
                                      difference(x - 1, y, x - 2, y), difference(x, y - 1, x, y - 2)});
        const double contrast{smaa_.contrast};
        return {is_left && left * contrast >= most && !is_slope(x, y, -1, 0),
                is_top && top * contrast >= most && !is_slope(x, y, 0, -1)};
    }

    Edges edges(std::int64_t x, std::int64_t y) const {
        const std::int64_t i = std::clamp<std::int64_t>(x, 0, picture_.width - 1),
                           j = std::clamp<std::int64_t>(y, 0, picture_.height - 1);
        return edges_[static_cast<std::size_t>(j * picture_.width + i)];
    }
    /// Of a search along the rows `k` pixels from (x, y), `across` of them up or down; or the same of the columns, with
    /// left and top changing places. `top` goes along the search then.
    Edges along(std::int64_t x, std::int64_t y, bool is_upright, std::int64_t k, std::int64_t across) const {
        const Edges e = is_upright ? edges(x + across, y + k) : edges(x + k, y + across);
        return is_upright ? Edges{e.top, e.left} : e;
    }

    /// How far the line goes on to either side, how it bends there (half a pixel toward the neighbour across, or away,
    /// or not), whether what crosses it there goes on, which makes a corner, and the length of the next step.
    struct End {
        std::int64_t distance = 0;
        double height = 0;
        bool is_corner_across = false, is_corner_own = false;
        bool crosses_both = false;
        std::int64_t next = 4;  ///< 4: or more
        [[nodiscard]] bool is_corner() const { return is_corner_across || is_corner_own; }
    };
    End end_of(std::int64_t x, std::int64_t y, bool is_upright, int direction) const {
        const auto at = [&](std::int64_t k, std::int64_t across) { return along(x, y, is_upright, k, across); };
        // What crosses the line lies before a pixel on the way back, behind it on the way on.
        const std::int64_t beside = direction < 0 ? 0 : 1;
        End end;
        const std::int64_t most = 2 * steps_.pairs - (direction < 0 ? 1 : 0);
        const auto crossing = [&] { return direction * end.distance + beside; };
        const auto is_crossed = [&] { return at(crossing(), 0).left || at(crossing(), -1).left; };
        while (end.distance < most && !is_crossed() && at(direction * (end.distance + 1), 0).top) ++end.distance;
        // What lies behind the last pair of pixels was not seen.
        if (direction > 0 && end.distance == most) return end;
        const bool is_own = at(crossing(), 0).left, is_across = at(crossing(), -1).left;
        end.height = is_own == is_across ? 0 : is_across ? 0.5 : -0.5;
        end.crosses_both = is_own && is_across;
        if (!is_own && !is_across) return end;
        // A line a pixel wide has an edge between both pixels that are crossed: that is a step of it, and no corner.
        end.is_corner_own = is_own && at(crossing(), 1).left && !at(crossing(), 1).top;
        end.is_corner_across = is_across && at(crossing(), -2).left && !at(crossing(), -1).top;
        for (std::int64_t k = 1; k < 4 && end.next == 4 && !end.crosses_both; ++k)
            if (at(crossing() + direction * k, is_across ? -2 : 1).left) end.next = k;
        return end;
    }

    SmaaAreas orthogonal(std::int64_t x, std::int64_t y, bool is_upright) const {
        End first = end_of(x, y, is_upright, -1), second = end_of(x, y, is_upright, 1);
        // Where something crosses on both sides, the line may go either way: opposite to the other end, if that bends.
        if (first.crosses_both) first.height = -second.height;
        if (second.crosses_both) second.height = -first.height;
        const double length = static_cast<double>(first.distance + second.distance + 1);
        const auto before = static_cast<double>(first.distance);
        SmaaAreas out;
        if (first.height * second.height < 0) {
            const auto step = [&](const End& end) {
                return end.next < 4 ? static_cast<double>(end.next) : std::max(length, 4.0);
            };
            double previous = step(first), next = step(second);
            // Steps of one line differ by a pixel at most.
            const auto [least, most] = std::minmax({previous, length, next});
            if (first.is_corner() || second.is_corner() || most - least > 1) previous = next = length;
            out = smaa_straight(before, length, previous, next).areas();
            if (first.height > 0) std::swap(out.own, out.other);
        } else {
            out = smaa_bent(first.height, second.height, before, length);
        }
        round_corners(first, second, out);
        return out;
    }

    void round_corners(const End& first, const End& second, SmaaAreas& out) const {
        const double keep = 1 - double{smaa_.corner_rounding};
        const bool is_first = first.distance <= second.distance, is_second = second.distance <= first.distance;
        const double part = is_first && is_second ? 0.5 : 1;
        const auto factor = [&](bool corner_first, bool corner_second) {
            return 1 - keep * part * ((is_first && corner_first ? 1 : 0) + (is_second && corner_second ? 1 : 0));
        };
        out.own *= factor(first.is_corner_own, second.is_corner_own);
        out.other *= factor(first.is_corner_across, second.is_corner_across);
    }

    /// The stair through a pixel's top that rises to the right, or to the left.
    struct Diagonal {
        int steps = 0;  ///< sides of pixels, its own top among them
        SmaaAreas areas;
    };
    Diagonal diagonal(std::int64_t x, std::int64_t y, bool is_rising) const {
        const std::int64_t ahead = is_rising ? 1 : -1;
        const auto top = [&](std::int64_t i, std::int64_t j) { return edges(x + i, y + j).top; };
        const auto side = [&](std::int64_t i, std::int64_t j) {
            return edges(x + i + (is_rising ? 0 : 1), y + j).left;
        };
        struct Arm {
            std::int64_t columns = 0;
            bool ends_upright = false;
            double end = 0.5;  ///< how far above, or below, the last step's level the line ends
        };
        Arm up, down;
        for (;; ++up.columns) {
            const std::int64_t k = up.columns, i = ahead * (k + 1), j = -(k + 1);
            if (k == steps_.diagonal) break;
            if (!side(i, j)) {
                if (top(ahead * (k + 1), -k)) up.end = 0;
                break;
            }
            if (!top(i, j)) {
                up.ends_upright = true;
                if (side(i, j - 1)) up.end = 1;
                break;
            }
        }
        for (;; ++down.columns) {
            const std::int64_t k = down.columns, i = -ahead * k, j = k;
            if (k == steps_.diagonal) break;
            if (!side(i, j)) {
                if (top(i - ahead, j)) down.end = 0;
                break;
            }
            if (!top(i - ahead, j + 1)) {
                down.ends_upright = true;
                if (side(i, j + 1)) down.end = 1;
                break;
            }
        }
        // Flat at one end and steep at the other: a curve, of which the stair is the part of slope 1.
        if (up.end + down.end == 1) up.end = down.end = 0.5;
        Diagonal out;
        out.steps = 1 + static_cast<int>(2 * (up.columns + down.columns)) + (up.ends_upright ? 1 : 0) +
                    (down.ends_upright ? 1 : 0);
        const auto columns = static_cast<double>(up.columns + down.columns);
        const double slope = (columns + up.end + down.end) / (columns + 1);
        const double at = static_cast<double>(down.columns) * (slope - 1) - down.end;
        out.areas = SmaaLine{at, at + slope}.areas();
        return out;
    }

    Weights weights_of(std::int64_t x, std::int64_t y) const {
        Weights out;
        const Edges own = edges(x, y);
        bool is_diagonal = false;
        // The side of a stair that rises is its own pixel's, that of one that falls the next pixel's.
        const bool is_beside = !own.top && own.left && edges(x - 1, y).top;
        SmaaAreas areas;
        if (steps_.diagonal > 0 && (own.top || is_beside)) {
            const std::int64_t of = is_beside ? x - 1 : x;
            const Diagonal rising = diagonal(of, y, true), falling = diagonal(of, y, false);
            const bool is_rising = rising.steps >= falling.steps;
            const Diagonal& longest = is_rising ? rising : falling;
            is_diagonal = longest.steps >= smaa_least_diagonal && !(is_beside && is_rising);
            areas = longest.areas;
        }
        if (own.top) {
            if (!is_diagonal) areas = orthogonal(x, y, false);
            out.up = areas.own, out.of_above = areas.other;
        }
        // A diagonal is smoothed from above and below alone.
        if (own.left && !is_diagonal) {
            areas = orthogonal(x, y, true);
            out.left = areas.own, out.of_left = areas.other;
        }
        // As an image of 8 bits keeps them.
        for (double Weights::*const weight : {&Weights::up, &Weights::of_above, &Weights::left, &Weights::of_left})
            out.*weight = std::round(out.*weight * 255) / 255;
        return out;
    }

    Weights weights(std::int64_t x, std::int64_t y) const {
        if (x >= picture_.width || y >= picture_.height) return {};
        return weights_[static_cast<std::size_t>(y * picture_.width + x)];
    }

    void blend(std::int64_t x, std::int64_t y, ReferenceImage& out) const {
        const Weights own = weights(x, y);
        const double up = own.up, down = weights(x, y + 1).of_above, left = own.left, right = weights(x + 1, y).of_left;
        const bool is_level = std::max(left, right) > std::max(up, down);
        const double before = is_level ? left : up, behind = is_level ? right : down;
        if (!(before + behind > 0)) return;
        const double scale = 1 / std::max(before + behind, 1.0);
        const auto light = [&](std::int64_t u, std::int64_t v) {
            return light_reference(picture_.clamped(u, v), color_);
        };
        const Rgba from = light(x, y), a = is_level ? light(x - 1, y) : light(x, y - 1),
                   b = is_level ? light(x + 1, y) : light(x, y + 1);
        out.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)) = coded_reference(
            toward_reference(toward_reference(from, from, a, scale * before), from, b, scale * behind), color_);
    }

    const Smaa& smaa_;
    const ReferenceImage& picture_;
    const ReferenceImage* depth_;
    ColorState color_;
    SmaaSteps steps_;
    std::vector<Edges> edges_;
    std::vector<Weights> weights_;
};

inline ReferenceImage smaa_reference(const void* parameters, const ReferenceInput& input) {
    return SmaaReference(*static_cast<const Smaa*>(parameters), input).run();
}

}  // namespace darkroom
