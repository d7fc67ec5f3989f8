// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "image/judge/judge.hpp"

namespace darkroom {

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

}  // namespace darkroom
