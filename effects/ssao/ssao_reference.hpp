// SPDX-License-Identifier: MIT
#pragma once
// Ambient occlusion in double precision: both methods, both sizes and merge. It follows the shaders'
// choice of pixels and sectors, and takes its points from the camera's matrices; no packed bits.

#include <algorithm>
#include <bit>
#include <cmath>
#include <darkroom/effects/ssao.hpp>
#include <darkroom/reference.hpp>
#include <numbers>

#include "shared/camera_reference.hpp"
#include "ssao/ssao_filter_reference.hpp"

namespace darkroom {

/// Equation 7 of Jimenez et al. (ssao_occlusion.glsl) from the surface's plane to the view vector, by the sine of the
/// angle n between normal and view vector, positive toward the plane: cos n + (n + pi / 2) sin n, within 0.01.
[[nodiscard]] inline double ssao_arc(double sine) {
    const double squared = sine * sine;
    return 1 + squared * (0.5 + 0.0707963 * squared) + sine * std::numbers::pi / 2;
}
/// How many sectors of that arc lie below the direction with this cosine to the view vector: equation 7 within 0.02,
/// and 0.05 where the normal leans over by more than 75 degrees.
[[nodiscard]] inline double ssao_sector(double cosine, double sine) {
    const double x = std::clamp(1 - (1 - cosine) / std::max(1 + sine, 1e-4), 0.0, 1.0), bend = 1 / (1 - 0.6 * sine);
    return ssao_sectors * x * x * (bend + (1 - bend) * x);
}

/// The numbers of every pixel, or of every second pixel of every second row.
class SsaoReference {
  public:
    SsaoReference(const Ssao& parameters, const ReferenceInput& input)
        : ssao_(parameters),
          input_(input),
          camera_(input.camera),
          step_(parameters.resolution == SsaoResolution::Half ? 2 : 1),
          width_(std::max(1, static_cast<int>(input.depth->width) / step_)),
          height_(std::max(1, static_cast<int>(input.depth->height) / step_)) {}

    /// What each pixel of the picture is multiplied by.
    [[nodiscard]] double visibility(std::uint32_t x, std::uint32_t y) const {
        const auto [column, row] = std::array{static_cast<int>(x), static_cast<int>(y)};
        if (step_ == 1) return filter_.blurred(column, row);
        // The last of an odd number of pixels takes its neighbour's.
        const int base_x = std::min(column / 2, width_ - 1), base_y = std::min(row / 2, height_ - 1);
        const int part_x = std::min(column - base_x * 2, 1), part_y = std::min(row - base_y * 2, 1);
        const double planar = input_.depth->clamped(base_x * 2 + part_x, base_y * 2 + part_y).r;
        if (!is_surface(planar)) return 1;
        return filter_.upsampled(base_x, base_y, part_x, part_y, planar, [&](int half_x, int half_y) {
            if (input_.normals == nullptr) return 1.0;
            const Rgba& own = input_.normals->clamped(base_x * 2 + part_x, base_y * 2 + part_y);
            const Rgba& other = input_.normals->clamped(half_x * 2, half_y * 2);
            return ssao_turned(own.r * other.r + own.g * other.g + own.b * other.b) + 0.001;
        });
    }

    void compute() {
        std::vector<SsaoSurface> surfaces;
        std::vector<double> raw;
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                const double planar = planar_at(x, y);
                surfaces.push_back(surface(x, y, is_surface(planar) ? planar : 1e10));
                raw.push_back(is_surface(planar) && has_normal(x, y) ? occlusion(x, y, planar) : 1);
            }
        filter_.compute(std::move(surfaces), raw);
    }

  private:
    static constexpr double pi = std::numbers::pi;
    static double dot(const Double3& a, const Double3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
    static Double3 cross(const Double3& a, const Double3& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    static Double3 sum(const Double3& a, const Double3& b, double weight) {
        return {a[0] + b[0] * weight, a[1] + b[1] * weight, a[2] + b[2] * weight};
    }
    static Double3 normalized(const Double3& v) {
        const double squared = dot(v, v);
        return squared > 0 && std::isfinite(squared) ? sum({}, v, 1 / std::sqrt(squared)) : Double3{0, 0, 1};
    }
    static bool is_surface(double planar) { return planar > 1e-6 && planar < 1e9; }
    [[nodiscard]] double planar_at(int x, int y) const { return input_.depth->clamped(x * step_, y * step_).r; }

    /// What has none, a sprite, neither occludes nor is occluded.
    [[nodiscard]] bool has_normal(int x, int y) const {
        if (input_.normals == nullptr) return true;
        const Rgba& normal = input_.normals->clamped(x * step_, y * step_);
        return normal.r * normal.r + normal.g * normal.g + normal.b * normal.b > 0;
    }

    /// View position of a pixel of the frame at a distance.
    [[nodiscard]] Double3 frame_position(double x, double y, double planar) const {
        return camera_.view_position((x + 0.5) / input_.depth->width, (y + 0.5) / input_.depth->height, planar);
    }
    [[nodiscard]] Double3 position(double x, double y, double planar) const {
        return frame_position(x * step_, y * step_, planar);
    }
    /// Where a point of view space is, in pixels of the occlusion; that of pixel i covers [i, i + 1).
    [[nodiscard]] std::array<double, 2> place(const Double3& view) const {
        const auto uv = camera_.uv(view);
        return {(uv[0] * input_.depth->width - 0.5) / step_ + 0.5, (uv[1] * input_.depth->height - 0.5) / step_ + 0.5};
    }
    [[nodiscard]] bool is_inside(const std::array<double, 2>& at) const {
        return at[0] >= 0 && at[1] >= 0 && at[0] <= width_ - 0.01 && at[1] <= height_ - 0.01;
    }

    [[nodiscard]] Double3 normal(int x, int y) const {
        const int column = x * step_, row = y * step_;
        if (input_.normals != nullptr) {
            const Rgba& world = input_.normals->clamped(column, row);
            return normalized(camera_.view_direction({world.r, world.g, world.b}));
        }
        const auto at = [&](int dx, int dy) {
            return frame_position(column + dx, row + dy, input_.depth->clamped(column + dx, row + dy).r);
        };
        const Double3 here = at(0, 0);
        const auto slope = [&](int dx, int dy, bool is_first, bool is_last) {
            const Double3 before = sum(here, at(-dx, -dy), -1), after = sum(at(dx, dy), here, -1);
            const bool takes_after = is_first || (!is_last && std::abs(after[2]) < std::abs(before[2]));
            return takes_after ? after : before;
        };
        const auto last_column = static_cast<int>(input_.depth->width) - 1;
        const auto last_row = static_cast<int>(input_.depth->height) - 1;
        return normalized(
            cross(slope(0, 1, row == 0, row == last_row), slope(1, 0, column == 0, column == last_column)));
    }

    [[nodiscard]] SsaoSurface surface(int x, int y, double planar) const {
        const Double3 up = normal(x, y), ray = sum(position(x, y, 2), position(x, y, 1), -1);
        const Double3 here = position(x, y, planar);
        const double toward = std::min(dot(up, ray), -0.02) * planar;
        return {1 / planar,
                up,
                {std::clamp(up[0] * (position(x + 1, y, planar)[0] - here[0]) / toward, -0.999, 0.999),
                 std::clamp(up[1] * (position(x, y + 1, planar)[1] - here[1]) / toward, -0.999, 0.999)}};
    }

    [[nodiscard]] double occlusion(int x, int y, double planar) const {
        const Double3 at = position(x, y, planar);
        const double seen = ssao_.method == SsaoMethod::Hemisphere ? hemisphere(x, y, at) : horizons(x, y, at);
        const double counted = std::clamp(1 - (1 - seen) * double{ssao_.intensity}, 0.0, 1.0);
        const double start = double{ssao_.fade_start}, end = double{ssao_.fade_end};
        const double fade = std::clamp((planar - start) / std::max(end - start, 1e-6), 0.0, 1.0);
        return std::lerp(counted, 1.0, fade * fade * (3 - 2 * fade));
    }

    /// A point for every sample in the half ball: is it behind what the picture shows there?
    [[nodiscard]] double hemisphere(int x, int y, const Double3& at) const {
        const auto noise = ssao_noise()[static_cast<std::size_t>(y % 4 * 4 + x % 4)];
        const Double3 up = normal(x, y), turn{double{noise[0]}, double{noise[1]}, 0};
        const Double3 flat = sum(turn, up, -dot(turn, up));
        const Double3 tangent = dot(flat, flat) > 1e-8 ? normalized(flat) : Double3{0, 0, 1};
        const Double3 bitangent = cross(up, tangent);
        const double bias = double{ssao_.bias}, radius = double{ssao_.radius};
        const auto kernel = ssao_kernel(static_cast<std::size_t>(ssao_.samples));
        double occlusion = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(ssao_.samples); ++i) {
            Double3 point = sum(at, tangent, double{kernel[i][0]} * radius);
            point = sum(point, bitangent, double{kernel[i][1]} * radius);
            point = sum(point, up, double{kernel[i][2]} * radius);
            const auto there = place(point);
            if (!is_inside(there)) continue;
            const int column = static_cast<int>(there[0]), row = static_cast<int>(there[1]);
            const double found = planar_at(column, row);
            const double height = dot(up, sum(position(column, row, found), at, -1));
            if (!(found < -point[2] - bias && height > bias && has_normal(column, row))) continue;
            const double near = std::clamp(2 - std::abs(at[2] + found) / radius, 0.0, 1.0);
            occlusion += near * near * (3 - 2 * near);
        }
        return 1 - occlusion / ssao_.samples;
    }

    /// 0 outside the picture, negative where nothing occludes. A place within one pixel before it is on its border.
    [[nodiscard]] double distance_or_zero(double x, double y) const {
        const bool is_near = x > -1 && y > -1 && x < width_ && y < height_;
        const int column = static_cast<int>(x), row = static_cast<int>(y);
        return is_near ? planar_at(column, row) * (has_normal(column, row) ? 1 : -1) : 0;
    }

    /// The shares of the arcs that are hidden, over what the open surface would see by the same directions.
    [[nodiscard]] double horizons(int x, int y, const Double3& at) const {
        const auto tile = static_cast<int>(ssao_.moves ? ssao_tile(input_.time, input_.frame_index) : 0U);
        const auto noise = ssao_noise()[static_cast<std::size_t>((y + tile / 4) % 4 * 4 + (x + tile % 4) % 4)];
        const Double3 up = normal(x, y);
        const Double3 view = normalized(sum(position(x, y, 1), position(x, y, 2), -1));
        const double a = 1 / (1 + view[2]), b = -view[0] * view[1] * a;
        const Double3 right{1 - view[0] * view[0] * a, b, -view[0]};
        const Double3 above{b, 1 - view[1] * view[1] * a, -view[1]};
        const std::int32_t slices = ssao_slices(ssao_.samples)[0];
        const double facing = std::max(dot(up, view), 0.0);
        double occluded = 0, open = 0;
        for (int i = 0; i < slices; ++i) {
            const double angle = (i + double{noise[2]} / 16) * pi / slices;
            const Double3 ahead = sum(sum({}, right, std::cos(angle)), above, std::sin(angle));
            for (const Double3& across : {ahead, sum({}, ahead, -1)}) {
                const double sideways = dot(up, across);
                const double length = std::sqrt(std::max(facing * facing + sideways * sideways, 1e-12));
                const double arc = length * ssao_arc(sideways / length);
                occluded += arc * hidden_share({x, y}, at, view, across, double{noise[3]}, {facing, sideways}, length);
                open += arc;
            }
        }
        return 1 - occluded / std::max(open, 1e-6);
    }

    /// Of the arc on one side of a slice, in whole sectors. `up` is the normal toward the eye and across, `length` its.
    [[nodiscard]] double hidden_share(const std::array<int, 2>& pixel, const Double3& at, const Double3& view,
                                      const Double3& across, double share, const std::array<double, 2>& up,
                                      double length) const {
        // The place moves with a step across the view as it does with a very small one.
        constexpr double small = 1e-6;
        const double scale = small * std::abs(at[2]), radius = double{ssao_.radius};
        const auto forth = place(sum(at, across, scale)), back = place(sum(at, across, -scale));
        const double motion_x = (forth[0] - back[0]) / (2 * scale), motion_y = (forth[1] - back[1]) / (2 * scale);
        const double texel = 1 / std::max({std::abs(motion_x), std::abs(motion_y), 1e-10});
        const double thickness = double{ssao_.thickness > 0 ? ssao_.thickness : ssao_endless};
        const std::int32_t steps = ssao_slices(ssao_.samples)[1];
        const double leave = std::min(4.0 / steps, 1.0);
        double room = radius, height = 0;
        std::uint32_t mask = 0;
        for (int i = 0; i < steps; ++i) {
            const double along = texel + (i + share) / steps * std::max(radius - texel, 0.0);
            const double there_x = pixel[0] + motion_x * along, there_y = pixel[1] + motion_y * along;
            const double found = distance_or_zero(there_x + 0.5, there_y + 0.5);
            // In the slice, so at the place itself and not at the middle of its texel.
            const Double3 offset = sum(position(there_x, there_y, found), at, -1);
            const double out = dot(offset, across), toward = dot(offset, view), distance = std::hypot(out, toward);
            const double inside = radius - distance;
            const double part = room / (room - std::min(inside, 0.0));
            const double top = i == 0 ? toward : height + part * (toward - height);
            const double cosine = top / (i == 0 ? distance : std::min(distance, radius));
            const double bottom = top - thickness, lower = bottom / std::hypot(bottom, out);
            const bool counts = inside > -leave * room && found > 0 &&
                                out * up[1] + toward * up[0] > std::max(double{ssao_.bias}, texel);
            if (counts)
                mask |= (1u << static_cast<std::uint32_t>(ssao_sector(cosine, up[1] / length) + 0.5)) -
                        (1u << static_cast<std::uint32_t>(ssao_sector(lower, up[1] / length) + 0.5));
            room = std::max(inside, 1e-6);
            height = toward;
        }
        return std::popcount(mask) / double{ssao_sectors};
    }

    /// How wide `pixels` of the frame are at this nearness, as a share of the distance.
    [[nodiscard]] double width(double near, int pixels) const {
        return std::abs(frame_position(pixels, 0, 1 / near)[0] - frame_position(0, 0, 1 / near)[0]) * near;
    }

    const Ssao& ssao_;
    const ReferenceInput& input_;
    ReferenceCamera camera_;
    int step_, width_, height_;
    SsaoFilterReference filter_{width_, height_, step_,
                                [this](double near, int pixels) { return width(near, pixels); }};
};

[[nodiscard]] inline ReferenceImage ssao_reference(const void* parameters, const ReferenceInput& input) {
    const Ssao& ssao = *static_cast<const Ssao*>(parameters);
    ReferenceImage out = *input.picture;
    if (input.depth == nullptr || ssao.intensity == 0.0f) return out;
    SsaoReference reference(ssao, input);
    reference.compute();
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            Rgba& color = out.at(x, y);
            double visibility = reference.visibility(x, y);
            if (ssao.merge == SsaoMerge::Luminance) {
                const double luma = std::clamp(0.299 * color.r + 0.587 * color.g + 0.114 * color.b, 0.0, 1.0);
                visibility = std::lerp(visibility, 1.0, luma * 0.5);
            }
            color = {color.r * visibility, color.g * visibility, color.b * visibility, color.a};
        }
    return out;
}

}  // namespace darkroom
