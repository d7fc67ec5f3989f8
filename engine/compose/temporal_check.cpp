// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/temporal_check.hpp>
#include <limits>
#include <optional>
#include <string_view>

namespace darkroom {

namespace {

using Vector = std::array<double, 2>;
using Point = std::array<double, 4>;

constexpr double least_jitter = 0.05;  ///< pixels; what is less cannot be told from rounding
constexpr double least_motion = 0.5;   ///< pixels
constexpr std::size_t max_samples = 20'000;
constexpr std::size_t min_samples = 16;

Point product(const Matrix& matrix, const Point& point) {
    Point out{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column) out[row] += double{matrix[4 * column + row]} * point[column];
    return out;
}

/// Into the world, of a camera that is turned and moved and not scaled.
Point to_world(const Matrix& view, const Point& point) {
    Point out{0, 0, 0, 1};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            out[row] += double{view[4 * row + column]} * (point[column] - double{view[12 + column]});
    return out;
}

/// Distance along the axis of what has this device depth; none: sky, or behind the camera.
std::optional<double> planar(const Matrix& projection, double depth) {
    // depth = (m10 z + m14) / (m11 z + m15)
    const double below = double{projection[10]} - depth * double{projection[11]};
    const double z = (depth * double{projection[15]} - double{projection[14]}) / below;
    return below != 0 && std::isfinite(z) && z < 0 && z > -1e9 ? std::optional(-z) : std::nullopt;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// A pixel's motion as it was found and as the camera alone would have moved it, in pixels, y down, without jitter.
struct Sample {
    Vector found{}, expected{};
};

class Checker {
  public:
    explicit Checker(const TemporalFrame& frame) : frame_(frame), camera_(frame.camera) {}

    std::vector<std::string> run() {
        if (!check_sizes()) return std::move(out_);
        check_projection();
        check_depth_direction();
        if (!frame_.velocity.empty()) check_vectors();
        return std::move(out_);
    }

  private:
    [[nodiscard]] double size(std::size_t axis) const { return axis == 0 ? frame_.extent.width : frame_.extent.height; }
    [[nodiscard]] Vector jitter_change() const {
        return {double{camera_.jitter[0]} - double{camera_.previous_jitter[0]},
                double{camera_.jitter[1]} - double{camera_.previous_jitter[1]}};
    }

    bool check_sizes() {
        const std::size_t pixels = std::size_t{frame_.extent.width} * frame_.extent.height;
        const auto check = [&](std::string_view start, std::size_t count, std::size_t wanted) {
            if (count != 0 && count != wanted)
                out_.push_back(fmt::format("{}{} numbers, {}x{} pixels have {}", start, count, frame_.extent.width,
                                           frame_.extent.height, wanted));
        };
        check("depth: ", frame_.depth.size(), pixels);
        check("velocity: ", frame_.velocity.size(), 2 * pixels);
        return out_.empty() && pixels > 0;
    }

    /// By how many pixels, y down, the projection's centre moved since the frame before.
    [[nodiscard]] double centre_change(std::size_t axis) const {
        const auto centre = [&](const Matrix& projection) {
            const double w = double{projection[11]};
            return w != 0 ? double{projection[8 + axis]} / w : double{projection[12 + axis]} / double{projection[15]};
        };
        const double change = centre(camera_.projection) - centre(camera_.previous_projection);
        return change * size(axis) / 2 * (axis == 1 && !camera_.is_y_down ? -1 : 1);
    }

    /// Has the projection the jitter that the camera tells of? A lens that zooms or shifts meanwhile tells nothing.
    void check_projection() {
        const Vector told = jitter_change();
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (std::abs(told[axis]) < least_jitter) continue;
            const double found = centre_change(axis), near = 0.25 * std::abs(told[axis]);
            const char* const name = axis == 0 ? "x" : "y";
            if (std::abs(found) < near)
                out_.push_back(
                    fmt::format("camera.projection: has no jitter; camera.jitter tells of {:.3f} pixels more "
                                "in {} than in the frame before",
                                told[axis], name));
            else if (std::abs(found + told[axis]) < near)
                out_.push_back(
                    fmt::format("camera.jitter: has the wrong sign in {}; the projection moves the picture "
                                "by {:.3f} pixels, y down, and {:.3f} are told",
                                name, found, told[axis]));
        }
    }

    void check_depth_direction() {
        if (camera_.depth == DepthKind::Planar) return;
        const auto depth_at = [&](double distance) {
            const Point clip = product(camera_.projection, {0, 0, -distance, 1});
            return clip[2] / clip[3];
        };
        const double near = double{camera_.near_distance};
        const bool is_reversed = depth_at(near) > depth_at(2 * near);
        if (is_reversed == (camera_.depth == DepthKind::Reversed)) return;
        out_.push_back(fmt::format("camera.depth: {} is told, and the projection makes depth {} with distance",
                                   is_reversed ? "Standard" : "Reversed", is_reversed ? "smaller" : "larger"));
    }

    /// As its host means it, in our own convention; the jitter stays where it is in it.
    [[nodiscard]] Vector found_motion(std::size_t pixel) const {
        const VelocityKind& kind = camera_.velocity;
        Vector out{};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            double value = double{frame_.velocity[2 * pixel + axis]};
            if (kind.unit == VelocityKind::Unit::Uv) value *= size(axis);
            if (kind.unit == VelocityKind::Unit::Ndc) value *= size(axis) / 2;
            if (kind.sign == VelocityKind::Sign::CurrentMinusPrevious) value = -value;
            if (axis == 1 && !kind.is_y_down) value = -value;
            out[axis] = value;
        }
        return out;
    }

    [[nodiscard]] std::optional<double> distance(std::size_t pixel) const {
        const double depth = double{frame_.depth[pixel]};
        if (camera_.depth != DepthKind::Planar) return planar(camera_.projection, depth);
        return depth > 0 && depth < 1e9 ? std::optional(depth) : std::nullopt;
    }

    /// Of a point that stands still, without jitter.
    [[nodiscard]] Vector camera_motion(std::size_t pixel, double distance) const {
        const Matrix& projection = camera_.projection;
        const double down = camera_.is_y_down ? 1 : -1;
        const Vector at{static_cast<double>(pixel % frame_.extent.width) + 0.5,
                        static_cast<double>(pixel / frame_.extent.width) + 0.5};
        const double w = double{projection[15]} - double{projection[11]} * distance;
        Point seen{0, 0, -distance, 1};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const double clip = (at[axis] / size(axis) * 2 - 1) * (axis == 1 ? down : 1);
            const double moved = double{projection[12 + axis]} - double{projection[8 + axis]} * distance;
            seen[axis] = (clip * w - moved) / double{projection[5 * axis]};
        }
        const Point was =
            product(camera_.previous_projection, product(camera_.previous_view, to_world(camera_.view, seen)));
        Vector out{};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const double place = (was[axis] / was[3] * (axis == 1 ? down : 1) + 1) / 2 * size(axis);
            out[axis] = place - at[axis] + jitter_change()[axis];
        }
        return out;
    }

    void gather() {
        const bool is_still = camera_.view == camera_.previous_view;
        const std::size_t pixels = std::size_t{frame_.extent.width} * frame_.extent.height;
        const std::size_t step = std::max<std::size_t>(1, pixels / max_samples);
        for (std::size_t pixel = 0; pixel < pixels; pixel += step) {
            Sample sample{.found = found_motion(pixel)};
            if (!std::isfinite(sample.found[0]) || !std::isfinite(sample.found[1])) continue;
            if (!frame_.depth.empty()) {
                const std::optional<double> far = distance(pixel);
                if (!far) continue;
                sample.expected = camera_motion(pixel, *far);
                if (!std::isfinite(sample.expected[0]) || !std::isfinite(sample.expected[1])) continue;
            } else if (!is_still) {
                return;  // without depth a camera that moves tells nothing
            }
            samples_.push_back(sample);
        }
    }

    void check_vectors() {
        gather();
        if (samples_.size() < min_samples) return;
        check_signs(check_jitter_in_vectors());
    }

    /// What of most samples is left of their motion without the camera's, if it is this.
    [[nodiscard]] bool is_most_rest(const Vector& rest, double tolerance) const {
        const auto is_near = [&](const Sample& sample) {
            return std::hypot(sample.found[0] - sample.expected[0] - rest[0],
                              sample.found[1] - sample.expected[1] - rest[1]) < tolerance;
        };
        return 2 * static_cast<std::size_t>(std::ranges::count_if(samples_, is_near)) > samples_.size();
    }

    /// What a point that stands still moves by in the picture, previous minus current, where vectors hold the jitter.
    Vector check_jitter_in_vectors() {
        const Vector change{-jitter_change()[0], -jitter_change()[1]};
        const bool is_told = camera_.velocity.has_jitter;
        const double length = std::hypot(change[0], change[1]), tolerance = 0.25 * length;
        if (length < 2 * least_jitter) return is_told ? change : Vector{};
        if (!is_told && is_most_rest(change, tolerance)) {
            out_.push_back(
                fmt::format("velocity: holds the jitter, which camera.velocity.has_jitter does not say: what "
                            "stands still moves by {:.3f}, {:.3f} pixels",
                            change[0], change[1]));
            return change;
        }
        if (is_told && is_most_rest({}, tolerance)) {
            out_.push_back("velocity: holds no jitter, and camera.velocity.has_jitter says that it does");
            return {};
        }
        return is_told ? change : Vector{};
    }

    /// Of vectors that hold this of the jitter.
    void check_signs(const Vector& jitter) {
        std::array<bool, 2> is_turned{};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            std::vector<double> ratios;
            for (const Sample& sample : samples_)
                if (std::abs(sample.expected[axis]) >= least_motion)
                    ratios.push_back((sample.found[axis] - jitter[axis]) / sample.expected[axis]);
            if (ratios.size() < min_samples) continue;
            const double ratio = median(std::move(ratios));
            is_turned[axis] = ratio < -0.5 && ratio > -2;
            if (is_turned[axis] || (ratio > 0.5 && ratio < 2)) continue;
            out_.push_back(
                fmt::format("velocity: is {:.3g} times in {} what the camera's motion makes of still "
                            "surfaces; camera.velocity.unit, or the depth, is another one",
                            ratio, axis == 0 ? "x" : "y"));
        }
        if (is_turned[0] && is_turned[1])
            out_.push_back("velocity: has the other sign than camera.velocity.sign says");
        else if (is_turned[1])
            out_.push_back("velocity: has y the other way than camera.velocity.is_y_down says");
        else if (is_turned[0])
            out_.push_back("velocity: has x the other way");
    }

    const TemporalFrame& frame_;
    const Camera& camera_;
    std::vector<Sample> samples_;
    std::vector<std::string> out_;
};

}  // namespace

std::vector<std::string> check_temporal(const TemporalFrame& frame) { return Checker(frame).run(); }

}  // namespace darkroom
