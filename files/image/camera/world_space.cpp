// SPDX-License-Identifier: MIT
#include "image/camera/world_space.hpp"

#include <Imath/half.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "image/frame/layer_read.hpp"

namespace darkroom {
namespace {

using Vector = std::array<double, 3>;
using Turn = std::array<Vector, 3>;  // rows

constexpr Turn none{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr Turn z_up_to_y_up{{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}};

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector operator*(const Turn& m, const Vector& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }
Turn transposed(const Turn& m) {
    return {{{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}}};
}
Turn operator*(const Turn& a, const Turn& b) {
    const Turn columns = transposed(b);
    Turn out{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column) out[row][column] = dot(a[row], columns[column]);
    return out;
}
Turn rotation_of(const Matrix& m) {
    Turn out{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column) out[row][column] = double{m[column * 4 + row]};
    return out;
}

/// A normal of the file beside that which depth has there, in the space of the camera.
struct Pair {
    Vector stored, made;
};

class Surface {
  public:
    explicit Surface(const FrameFile& frame)
        : depth_(*frame.depth),
          projection_(frame.camera.projection.value_or(
              perspective(assumed_field_of_view, double{1} * frame.color.width / frame.color.height))) {}

    /// Where the surface is flat over its neighbours at a distance of `step`; else nothing.
    [[nodiscard]] std::optional<Vector> normal(std::uint32_t x, std::uint32_t y, std::uint32_t step) const {
        const double here = near(x, y);
        const std::array<double, 4> around{near(x - step, y), near(x + step, y), near(x, y - step), near(x, y + step)};
        // Over a plane 1 / distance is linear in the picture. Half floats keep eleven bits.
        constexpr double rounding = 2e-3;
        for (const std::size_t first : {0U, 2U})
            if (!(here > 0 && around[first] > 0 && around[first + 1] > 0) ||
                std::abs(around[first] + around[first + 1] - 2 * here) > rounding * here)
                return std::nullopt;
        const Vector right = minus(point(x + step, y), point(x - step, y));
        const Vector up = minus(point(x, y - step), point(x, y + step));
        Vector out{right[1] * up[2] - right[2] * up[1], right[2] * up[0] - right[0] * up[2],
                   right[0] * up[1] - right[1] * up[0]};
        const Vector there = point(x, y);
        const bool is_parallel = projection_[11] == 0;
        const double facing = is_parallel ? out[2] : -dot(out, there);
        const double length = std::sqrt(dot(out, out));
        if (!(length > 0)) return std::nullopt;
        for (double& value : out) value /= facing < 0 ? -length : length;
        return out;
    }

  private:
    [[nodiscard]] double near(std::uint32_t x, std::uint32_t y) const {
        const double distance = double{depth_.values[std::size_t{y} * depth_.width + x]};
        return distance < 1e9 && distance != 0 ? 1 / distance : 0;
    }
    static Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
    /// What the projection shows in the middle of a pixel at its distance.
    [[nodiscard]] Vector point(std::uint32_t x, std::uint32_t y) const {
        const double z = -1 / near(x, y);
        const double u = (x + 0.5) / depth_.width * 2 - 1, v = (y + 0.5) / depth_.height * 2 - 1;
        const auto row = [&](std::size_t of, double at, std::size_t column) {
            return double{projection_[column * 4 + of]} - at * double{projection_[column * 4 + 3]};
        };
        const double a = row(0, u, 0), b = row(0, u, 1), c = -(row(0, u, 2) * z + row(0, u, 3));
        const double d = row(1, v, 0), e = row(1, v, 1), f = -(row(1, v, 2) * z + row(1, v, 3));
        const double scale = a * e - b * d;
        return {(c * e - b * f) / scale, (a * f - c * d) / scale, z};
    }

    const Plane<1>& depth_;
    Matrix projection_;
};

Vector stored_normal(const FrameFile& frame, std::uint32_t x, std::uint32_t y) {
    if (const std::vector<std::uint16_t>& halves = frame.halves.normals; !halves.empty()) {
        const std::uint16_t* const at = &halves[(std::size_t{y} * frame.color.width + x) * 4];
        return {double{imath_half_to_float(at[0])}, double{imath_half_to_float(at[1])},
                double{imath_half_to_float(at[2])}};
    }
    const float* const at = frame.normals->at(x, y);
    return {double{at[0]}, double{at[1]}, double{at[2]}};
}

/// Some hundreds, spread over the picture.
std::vector<Pair> pairs_of(const FrameFile& frame) {
    constexpr std::uint32_t across = 32;
    std::vector<Pair> out;
    const std::uint32_t width = frame.color.width, height = frame.color.height;
    const std::uint32_t step = std::max(1U, std::min(width, height) / 256);
    if (width <= 2 * step || height <= 2 * step) return out;
    const Surface surface(frame);
    const auto spread = [&](std::uint32_t side) { return std::max(1U, (side - 2 * step) / across); };
    for (std::uint32_t y = step; y + step < height; y += spread(height))
        for (std::uint32_t x = step; x + step < width; x += spread(width)) {
            const Vector stored = stored_normal(frame, x, y);
            const double length = std::sqrt(dot(stored, stored));
            if (!(length > 0.5 && length < 1.5)) continue;
            if (const std::optional<Vector> made = surface.normal(x, y, step))
                out.push_back({{stored[0] / length, stored[1] / length, stored[2] / length}, *made});
        }
    return out;
}

/// The cosine that half of them reach. Stored ones are of either side.
double agreement(const std::vector<Pair>& pairs, const Turn& to_camera) {
    std::vector<double> cosines;
    for (const Pair& pair : pairs) cosines.push_back(dot(to_camera * pair.stored, pair.made));
    const auto middle = cosines.begin() + static_cast<std::ptrdiff_t>(cosines.size() / 2);
    std::ranges::nth_element(cosines, middle);
    return *middle;
}

struct Reading {
    std::string_view what;
    Turn to_camera;
};

constexpr std::size_t fewest_pairs = 32;
constexpr double agrees = 0.8;  // a field of view that is assumed, and bumps, are within it

}  // namespace

void settle_world(FrameFile& frame, const FrameOptions& options, bool is_world_known) {
    FrameCamera& camera = frame.camera;
    const bool is_z_up = options.up ? *options.up == UpAxis::Z : camera.is_z_up;
    const Turn to_ours = is_z_up ? z_up_to_y_up : none;
    const std::optional<Turn> to_camera =
        camera.world_to_camera ? std::optional(rotation_of(*camera.world_to_camera)) : std::nullopt;
    const Turn from_camera = to_camera ? to_ours * transposed(*to_camera) : none;

    const auto leave_out = [&](std::string_view why) {
        frame.warnings.push_back(
            fmt::format("normals are left out: {}; --camera FILE says where it stands, --normals-space view what they "
                        "are, --map normals=none leaves them out",
                        why));
        frame.normals.reset();
        frame.halves.normals = {};
    };
    std::optional<Turn> turn;
    if (frame.normals) {
        const std::optional<NormalsSpace> told = is_world_known ? NormalsSpace::World : options.normals_space;
        const std::vector<Pair> pairs = !told && frame.depth ? pairs_of(frame) : std::vector<Pair>();
        const bool is_measured = pairs.size() >= fewest_pairs;
        std::vector<Reading> readings{
            {"of the camera, x right, y up, z toward the viewer", none},
            {"of the camera, x right, y down, z forward", {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}}},
            {"of the camera, x right, y up, z forward", {{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}}}};
        if (to_camera) {
            readings.push_back(
                {"of a world whose z is up, of which the camera knows nothing", *to_camera * z_up_to_y_up});
            readings.push_back(
                {"of a world whose y is up, of which the camera knows nothing", *to_camera * transposed(z_up_to_y_up)});
        }
        const double of_world = is_measured && to_camera ? agreement(pairs, *to_camera) : 1;
        const Reading* best = nullptr;
        double most = agrees;
        if (is_measured && !(to_camera && of_world > agrees))
            for (const Reading& reading : readings)
                if (const double cosine = agreement(pairs, reading.to_camera); cosine > most) {
                    most = cosine;
                    best = &reading;
                }
        if (told == NormalsSpace::View) {
            turn = from_camera;
        } else if (best != nullptr) {
            frame.warnings.push_back(
                fmt::format("normals are taken as those {}: so they agree with the depth; "
                            "--normals-space says otherwise",
                            best->what));
            turn = from_camera * best->to_camera;
        } else if (!to_camera) {
            leave_out("they are of a world, and no camera comes with them");
        } else {
            turn = to_ours;
            if (of_world < 0.5)
                frame.warnings.emplace_back(
                    "normals do not agree with the depth in any space that is known: taken as of the world");
        }
    }
    if (turn && *turn != none) {
        FrameFile floats{.normals = std::move(frame.normals), .halves = {.normals = std::move(frame.halves.normals)}};
        widen(floats);
        frame.halves.normals = {};
        frame.normals = std::move(floats.normals);
        for (std::size_t i = 0; i < frame.normals->values.size(); i += 3) {
            float* const normal = &frame.normals->values[i];
            const Vector out = *turn * Vector{double{normal[0]}, double{normal[1]}, double{normal[2]}};
            for (std::size_t k = 0; k < 3; ++k) normal[k] = static_cast<float>(out[k]);
        }
    }
    camera.is_z_up = false;
    if (!is_z_up) return;
    // Its columns are the axes of the file's world, which ours are: x, z and -y.
    for (std::optional<Matrix>* const matrix : {&camera.world_to_camera, &camera.previous_world_to_camera})
        if (*matrix)
            for (std::size_t row = 0; row < 4; ++row) {
                const float y = (**matrix)[4 + row];
                (**matrix)[4 + row] = (**matrix)[8 + row];
                (**matrix)[8 + row] = -y;
            }
}

}  // namespace darkroom
