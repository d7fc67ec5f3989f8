// SPDX-License-Identifier: MIT
#include "lab/judge/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/srgb.hpp"
#include "image/compare/flip.hpp"

namespace darkroom {

namespace {

float code_of(float encoded) { return std::nearbyint(std::clamp(encoded, 0.0F, 1.0F) * 255); }

template <class Map>
ShownCodes mapped(const Picture& picture, const Map& map) {
    ShownCodes out(picture.width, picture.height);
    for (std::size_t i = 0; i < out.values.size() / 3; ++i) map(&picture.pixels[4 * i], &out.values[3 * i]);
    return out;
}

}  // namespace

ShownCodes codes_of_light(const Picture& light) {
    return mapped(light, [](const float* from, float* to) {
        // A comparison with NaN is false.
        std::array<float, 3> rgb{};
        for (std::size_t c = 0; c < 3; ++c) rgb[c] = from[c] > 0 ? std::min(from[c], 65504.0F) : 0;
        const float most = std::max({rgb[0], rgb[1], rgb[2]});
        for (std::size_t c = 0; c < 3; ++c) to[c] = code_of(srgb_encode(rgb[c] / (1 + most)));
    });
}

ShownCodes codes_of_display(const Picture& encoded) {
    return mapped(encoded, [](const float* from, float* to) {
        for (std::size_t c = 0; c < 3; ++c) to[c] = code_of(from[c] > 0 ? from[c] : 0);
    });
}

Picture picture_of(const ShownCodes& codes) {
    Picture out(codes.width, codes.height);
    for (std::size_t i = 0; i < codes.values.size() / 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) out.pixels[4 * i + c] = codes.values[3 * i + c] / 255;
        out.pixels[4 * i + 3] = 1;
    }
    return out;
}

double ErrorSum::psnr() const {
    if (samples == 0) return std::numeric_limits<double>::quiet_NaN();
    if (squares == 0) return std::numeric_limits<double>::infinity();
    return 10 * std::log10(255.0 * 255 * static_cast<double>(samples) / squares);
}

Result<> Judge::add(long long number, const ShownCodes& truth, const ShownCodes& test, const RegionMap& map) {
    DARKROOM_TRY_VALUE(const FlipErrors flip_errors, flip(picture_of(truth), picture_of(test)));
    std::vector<float> error(truth.values.size());
    for (std::size_t i = 0; i < error.size(); ++i) error[i] = test.values[i] - truth.values[i];
    ErrorSum of_frame;
    const bool has_before = error_before_.size() == error.size();
    for (std::size_t pixel = 0; pixel < map.size(); ++pixel) {
        double square = 0, change = 0;
        for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
            square += double{error[i]} * double{error[i]};
            if (has_before) change += std::pow(double{error[i]} - double{error_before_[i]}, 2);
        }
        of_frame.add(square, 3);
        if (has_before) verdict_.flicker.add(change, 3);
        for (std::size_t r = 0; r < judged_region_count; ++r) {
            const auto region = static_cast<JudgedRegion>(r);
            if (!map.has(pixel, region)) continue;
            verdict_.regions[r].add(square, 3);
            if (has_before && map_before_.has(pixel, region)) verdict_.region_flicker[r].add(change, 3);
        }
        if (map.age(pixel) < max_recovery_frames) verdict_.recovery[map.age(pixel)].add(square, 3);
    }
    verdict_.error.add(of_frame.squares, of_frame.samples);
    verdict_.frames.push_back({.number = number, .psnr = of_frame.psnr(), .flip = flip_errors.mean});
    flips_ += flip_errors.mean;
    verdict_.flip_mean = flips_ / static_cast<double>(verdict_.frames.size());
    error_before_ = std::move(error);
    map_before_ = map;
    return {};
}

namespace {

/// What lies nearer than this, in parts of a distance, is another thing.
constexpr float edge_ratio = 1.05F;
constexpr double hidden_ratio = 0.98;
constexpr float least_motion = 0.5F;  ///< pixels
constexpr float least_contrast = 16;  ///< codes
constexpr int thin_reach = 2;         ///< pixels
constexpr float endless = 1e6F;       ///< metres: sky, without overflow in what follows

constexpr std::array<std::string_view, judged_region_count> names{"edges", "thin", "disoccluded", "moving_texture"};

std::uint8_t bit(JudgedRegion region) { return static_cast<std::uint8_t>(1U << static_cast<unsigned>(region)); }

/// A value of the nearest pixel inside.
template <std::uint32_t Channels>
const float* clamped(const Plane<Channels>& plane, long long x, long long y) {
    return plane.at(static_cast<std::uint32_t>(std::clamp<long long>(x, 0, plane.width - 1)),
                    static_cast<std::uint32_t>(std::clamp<long long>(y, 0, plane.height - 1)));
}

/// Is it nearer than what lies `thin_reach` off on both sides, in one of four directions?
bool is_thin(const Plane<1>& depth, std::uint32_t x, std::uint32_t y) {
    const float own = *depth.at(x, y) * edge_ratio;
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1), std::pair(1, 1), std::pair(1, -1)}) {
        const long long along = thin_reach * dx, down = thin_reach * dy;
        if (own < *clamped(depth, x + along, y + down) && own < *clamped(depth, x - along, y - down)) return true;
    }
    return false;
}

/// Row by row of a matrix that is stored by columns, in double precision.
std::array<double, 4> product(const Matrix& matrix, const std::array<double, 4>& vector) {
    std::array<double, 4> out{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            out[row] += double{matrix[4 * column + row]} * vector[column];
    return out;
}

/// Into the world, of a camera that is turned and moved and not scaled.
std::array<double, 4> to_world(const Matrix& view, const std::array<double, 4>& point) {
    std::array<double, 4> out{0, 0, 0, 1};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            out[row] += double{view[4 * row + column]} * (point[column] - double{view[12 + column]});
    return out;
}

/// Of the camera's space, at this place of clip space and distance along the axis; of any projection.
std::array<double, 4> seen_point(const Matrix& projection, double clip_x, double clip_y, double distance) {
    const double w = double{projection[15]} - double{projection[11]} * distance;
    const auto along = [&](double clip, std::size_t axis) {
        const double moved = double{projection[12 + axis]} - double{projection[8 + axis]} * distance;
        return (clip * w - moved) / double{projection[5 * axis]};
    };
    return {along(clip_x, 0), along(clip_y, 1), -distance, 1};
}

}  // namespace

std::string_view name_of(JudgedRegion region) { return names[static_cast<std::size_t>(region)]; }

void RegionFinder::find_edges(const FrameFile& frame, RegionMap& map) const {
    const Plane<1>& depth = *frame.depth;
    for (std::uint32_t y = 0; y < depth.height; ++y)
        for (std::uint32_t x = 0; x < depth.width; ++x) {
            float low = *depth.at(x, y), high = low;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const float near = *clamped(depth, static_cast<long long>(x) + dx, static_cast<long long>(y) + dy);
                    low = std::min(low, near);
                    high = std::max(high, near);
                }
            if (high > low * edge_ratio) map.bits_[std::size_t{y} * depth.width + x] |= bit(JudgedRegion::Edges);
            if (!is_thin(depth, x, y)) continue;
            // Of a line thinner than a pixel the centres hit a part alone.
            for (int dy = -thin_reach; dy <= thin_reach; ++dy)
                for (int dx = -thin_reach; dx <= thin_reach; ++dx) {
                    const long long at_x = static_cast<long long>(x) + dx, at_y = static_cast<long long>(y) + dy;
                    if (at_x < 0 || at_y < 0 || at_x >= depth.width || at_y >= depth.height) continue;
                    map.bits_[static_cast<std::size_t>(at_y * depth.width + at_x)] |= bit(JudgedRegion::Thin);
                }
        }
}

void RegionFinder::find_texture(const FrameFile& frame, const ShownCodes& codes, RegionMap& map) const {
    const Plane<2>& velocity = *frame.velocity;
    for (std::uint32_t y = 0; y < velocity.height; ++y)
        for (std::uint32_t x = 0; x < velocity.width; ++x) {
            const std::size_t pixel = std::size_t{y} * velocity.width + x;
            const float* const motion = velocity.at(x, y);
            if (map.has(pixel, JudgedRegion::Edges) || !(std::hypot(motion[0], motion[1]) > least_motion)) continue;
            for (std::size_t c = 0; c < 3; ++c) {
                float low = 255, high = 0;
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx) {
                        const float near =
                            clamped(codes, static_cast<long long>(x) + dx, static_cast<long long>(y) + dy)[c];
                        low = std::min(low, near);
                        high = std::max(high, near);
                    }
                if (high - low >= least_contrast) map.bits_[pixel] |= bit(JudgedRegion::MovingTexture);
            }
        }
}

// Where the motion says that the pixel was, the frame before had something nearer than the point would have been, had
// only the camera moved.
void RegionFinder::find_disoccluded(const FrameFile& frame, RegionMap& map) const {
    const Plane<1>& depth = *frame.depth;
    std::ranges::fill(map.ages_, std::uint8_t{max_recovery_frames});
    if (depth_before_.width != depth.width || depth_before_.height != depth.height) return;
    const Matrix& view = *frame.camera.world_to_camera;
    const Matrix& projection = *frame.camera.projection;
    const Matrix& past = frame.camera.previous_world_to_camera.value_or(view);
    for (std::uint32_t y = 0; y < depth.height; ++y)
        for (std::uint32_t x = 0; x < depth.width; ++x) {
            const std::size_t pixel = std::size_t{y} * depth.width + x;
            const float* const motion = frame.velocity->at(x, y);
            const double was_x = x + double{motion[0]}, was_y = y + double{motion[1]};
            const auto left = static_cast<long long>(std::floor(was_x)),
                       top = static_cast<long long>(std::floor(was_y));
            // What comes in over the border was hidden by nothing.
            if (left < 0 || top < 0 || left >= depth.width - 1 || top >= depth.height - 1) continue;
            const double distance = double{std::min(*depth.at(x, y), endless)};
            const double clip_x = (x + 0.5) / depth.width * 2 - 1, clip_y = (y + 0.5) / depth.height * 2 - 1;
            const std::array<double, 4> point = seen_point(projection, clip_x, clip_y, distance);
            const double expected = -product(past, to_world(view, point))[2];
            double seen = 0;
            for (const auto& [dx, dy] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)})
                seen = std::max(seen, double{*clamped(depth_before_, left + dx, top + dy)});
            if (seen < expected * hidden_ratio) {
                map.bits_[pixel] |= bit(JudgedRegion::Disoccluded);
                map.ages_[pixel] = 0;
                continue;
            }
            const auto nearest_x = static_cast<std::size_t>(std::lround(was_x)),
                       nearest_y = static_cast<std::size_t>(std::lround(was_y));
            const std::uint8_t before = ages_before_[nearest_y * depth.width + nearest_x];
            map.ages_[pixel] = static_cast<std::uint8_t>(std::min<std::size_t>(before + 1U, max_recovery_frames));
        }
}

Result<RegionMap> RegionFinder::find(const FrameFile& frame, const ShownCodes& codes) {
    if (!frame.depth || !frame.velocity || !frame.camera.world_to_camera || !frame.camera.projection)
        return user_error("the truth has no depth, velocity or camera, from which regions are found");
    RegionMap map;
    map.bits_.resize(frame.depth->values.size());
    map.ages_.resize(map.bits_.size());
    find_edges(frame, map);
    find_texture(frame, codes, map);
    find_disoccluded(frame, map);
    depth_before_ = *frame.depth;
    ages_before_ = map.ages_;
    return map;
}

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
