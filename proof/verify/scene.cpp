// SPDX-License-Identifier: MIT
#include "verify/scene.hpp"

#include <algorithm>
#include <cmath>

#include "plan/text/half.hpp"

namespace darkroom::verify {

namespace {

constexpr double far_away = 1e9;

/// -1 or 1.
double side(std::mt19937& random) { return random() % 2 == 0 ? -1 : 1; }

double rounding_side(std::mt19937& random, Disturbance::Toward toward) {
    switch (toward) {
        case Disturbance::Toward::Zero:
            return -1;
        case Disturbance::Toward::Infinity:
            return 1;
        default:
            return side(random);
    }
}

/// Beside the picture's edge there may be black.
double span_around(const ReferenceImage& image, std::uint32_t x, std::uint32_t y, double Rgba::*channel) {
    double low = image.at(x, y).*channel, high = low;
    if (x == 0 || y == 0 || x + 1 == image.width || y + 1 == image.height) {
        low = std::min(low, 0.0);
        high = std::max(high, 0.0);
    }
    for (const int dy : {-1, 0, 1})
        for (const int dx : {-1, 0, 1}) {
            const double value = image.clamped(std::int64_t{x} + dx, std::int64_t{y} + dy).*channel;
            low = std::min(low, value);
            high = std::max(high, value);
        }
    return high - low;
}

}  // namespace

ReferenceImage moved(const ReferenceImage& image, std::mt19937& random, const Disturbance& by) {
    ReferenceImage out = image;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x)
            for (double Rgba::*const channel : {&Rgba::r, &Rgba::g, &Rgba::b, &Rgba::a}) {
                const double value = image.at(x, y).*channel;
                if (value > far_away) continue;
                double& number = out.at(x, y).*channel;
                number += by.relative * value * rounding_side(random, by.toward);
                if (by.absolute > 0) number += by.absolute * side(random);
                if (by.filter > 0) number += by.filter * span_around(image, x, y, channel) * side(random);
            }
    return out;
}

namespace {

constexpr double sky = 1e10;

/// To a number that a half holds.
double half_of(double value) {
    if (value == 0) return 0;
    const double step = std::ldexp(1.0, std::max(std::ilogb(value), -14) - 10);
    return std::nearbyint(value / step) * step;
}

/// PCG hash (Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020): the same numbers on every machine.
double noise(std::uint32_t value) {
    const std::uint32_t state = value * 747796405U + 2891336453U;
    const std::uint32_t word = ((state >> ((state >> 28U) + 4U)) ^ state) * 277803737U;
    return ((word >> 22U) ^ word) / 4294967296.0;
}

std::vector<float> floats_of(const ReferenceImage& image, std::size_t per_pixel) {
    std::vector<float> out;
    out.reserve(image.pixels.size() * per_pixel);
    for (const Rgba& p : image.pixels) {
        const std::array all{p.r, p.g, p.b, p.a};
        for (std::size_t i = 0; i < per_pixel; ++i) out.push_back(static_cast<float>(all[i]));
    }
    return out;
}

}  // namespace

SceneFrame::SceneFrame(VkExtent2D extent, std::uint32_t number, VkExtent2D output) : number_(number), output_(output) {
    const ReferenceImage blank(extent.width, extent.height, {0, 0, 0, 1});
    color_ = depth_ = normals_ = velocity_ = reactive_ = transparency_ = ui_ = blank;
    exposure_ = ReferenceImage(1, 1, {1.25, 0, 0, 1});
    make_layers(number);
    make_color();
    if (output.width == 0) make_ui();
    make_light();
    make_camera(number);
    keep_floats();
}

/// A floor that rises to a wall, sky above it, and a post that wanders to the right.
void SceneFrame::make_layers(std::uint32_t number) {
    const double shift = 1.5 * number;
    for (std::uint32_t y = 0; y < depth_.height; ++y)
        for (std::uint32_t x = 0; x < depth_.width; ++x) {
            const double u = (x + 0.5 - shift) / depth_.width, v = (y + 0.5) / depth_.height;
            const bool is_post = u > 0.3 && u < 0.45 && v > 0.25, is_sky = v < 0.2 && !is_post,
                       is_wall = !is_post && !is_sky && v < 0.45;
            const double behind = is_wall ? 18 + u : 3.6 / (v - 0.25);
            depth_.at(x, y).r = double{static_cast<float>(is_sky ? sky : is_post ? 4.5 : behind)};
            normals_.at(x, y) = is_sky ? Rgba{0, 0, 0, 1} : is_post || is_wall ? Rgba{0, 0, 1, 1} : Rgba{0, 1, 0, 1};
            // Far enough for a trail, and with a part of a pixel in it.
            velocity_.at(x, y) = is_post  ? Rgba{-9.5, 2.25, 0, 1}
                                 : is_sky ? Rgba{0, 0, 0, 1}
                                          : Rgba{half_of(14 * u - 7), half_of(3.5 * v), 0, 1};
            reactive_.at(x, y).r = u > 0.7 && u < 0.8 ? 0.5 : 0;
            const double seen_through = u > 0.6 && v > 0.6 ? 0.125 : 0;
            transparency_.at(x, y) = {seen_through, 2 * seen_through, seen_through, 1};
        }
}

/// Light as scenes have it: dark parts, a checked floor, lights, and some numbers below zero.
void SceneFrame::make_color() {
    for (std::uint32_t y = 0; y < color_.height; ++y)
        for (std::uint32_t x = 0; x < color_.width; ++x) {
            const std::uint32_t at = (y * color_.width + x) * 4;
            const double u = (x + 0.5) / color_.width, v = (y + 0.5) / color_.height;
            const double distance = depth_.at(x, y).r;
            const bool is_checked = distance < 18 && (x / 4 + y / 3) % 2 == 0, is_light = x % 31 == 5 && y % 17 == 3;
            const double shade = (distance >= sky ? 2.5 : 0.05 + 0.9 * u) * (is_checked ? 0.35 : 1);
            const double scale = is_light ? 30 : (x + 3 * y) % 97 == 11 ? -0.25 : 1;
            const auto part = [&](std::uint32_t channel, double tint) {
                return half_of(shade * scale * tint * (0.8 + 0.4 * noise(at + channel)));
            };
            color_.at(x, y) = {part(0, 1), part(1, 0.4 + 0.6 * v), part(2, 1.1 - 0.7 * u), x % 11 == 4 ? 0.5 : 1.0};
        }
}

void SceneFrame::make_ui() {
    ui_bytes_.clear();
    for (std::uint32_t y = 0; y < ui_.height; ++y)
        for (std::uint32_t x = 0; x < ui_.width; ++x) {
            const bool is_bar = y * 5 / ui_.height == 3 && x % 9 != 0, is_mark = (x + 2 * y) % 23 < 3;
            const std::uint32_t alpha = is_bar ? 200 : is_mark ? 255 : 0;
            const std::array<std::uint32_t, 4> codes{alpha * (x % 5) / 4, alpha * (y % 3) / 2, alpha / 2, alpha};
            for (const std::uint32_t code : codes) ui_bytes_.push_back(static_cast<std::uint8_t>(code));
            ui_.at(x, y) = {codes[0] / 255.0, codes[1] / 255.0, codes[2] / 255.0, codes[3] / 255.0};
        }
}

/// From before the camera, where it is seen in the sky, through a roof with holes. Any matrix will do: x and z go
/// across the map, and -y is the way of the light.
void SceneFrame::make_light() {
    ReferenceLight light{.light = {.direction = {0.15F, 0.3F, -1}, .color = {3, 2.5F, 2}, .volumetric_intensity = 1},
                         .resolution = 8};
    for (std::uint32_t cascade = 0; cascade < 2; ++cascade) {
        const float scale = cascade == 0 ? 0.1F : 0.04F;
        light.light.world_to_cascade[cascade] = {scale, 0, 0, 0, 0, 0, -scale / 2, 0, 0, scale, 0, 0, 0, 0, 0.5F, 1};
        light.light.splits[cascade] = cascade == 0 ? 9.0F : 1000.0F;
        std::vector<float>& depth = light.cascades.emplace_back();
        for (std::uint32_t i = 0; i < 64; ++i) depth.push_back((i / 8 * 3 + i % 8 + cascade) % 5 < 2 ? 0.1F : 1.0F);
    }
    lights_ = {light, {.light = {.direction = {-0.5F, 0.5F, 0.7F}, .color = {0.2F, 0.3F, 0.5F}}}};
}

/// At (0.1 n, 2, 6), looking at (0, 1, -4) through a field of view of one radian, up to 1000 m.
void SceneFrame::make_camera(std::uint32_t number) {
    const double aspect = static_cast<double>(color_.width) / color_.height, scale = 1 / std::tan(0.5);
    const double length = std::hypot(1.0, 10.0), sine = 1 / length, cosine = 10 / length;
    const auto view_at = [&](double x) {
        // Rows: right, up, back.
        const double up = -(cosine * 2 - sine * 6), back = -(sine * 2 + cosine * 6);
        return Matrix{1,
                      0,
                      0,
                      0,
                      0,
                      static_cast<float>(cosine),
                      static_cast<float>(sine),
                      0,
                      0,
                      static_cast<float>(-sine),
                      static_cast<float>(cosine),
                      0,
                      static_cast<float>(-x),
                      static_cast<float>(up),
                      static_cast<float>(back),
                      1};
    };
    const double near = double{camera_.near_distance}, far = double{camera_.far_distance};
    camera_.view = view_at(0.1 * number);
    camera_.projection = {};
    camera_.projection[0] = static_cast<float>(scale / aspect);
    camera_.projection[5] = static_cast<float>(-scale);
    camera_.projection[10] = static_cast<float>(-far / (far - near));
    camera_.projection[11] = -1;
    camera_.projection[14] = static_cast<float>(-far * near / (far - near));
    camera_.previous_view = view_at(0.1 * (number - 1.0));
    camera_.previous_projection = camera_.projection;
    camera_.is_cut = number == 0;
}

void SceneFrame::keep_floats() {
    color_floats_ = floats_of(color_, 4);
    depth_floats_ = floats_of(depth_, 1);
    normal_floats_ = floats_of(normals_, 3);
    velocity_floats_ = floats_of(velocity_, 2);
    reactive_floats_ = floats_of(reactive_, 1);
    transparency_floats_ = floats_of(transparency_, 3);
    exposure_floats_ = floats_of(exposure_, 1);
}

SceneFrame SceneFrame::disturbed(std::mt19937& random, const Disturbance& by) const {
    SceneFrame out = *this;
    Disturbance unfiltered = by;
    unfiltered.filter = 0;
    for (ReferenceImage SceneFrame::*const image : {&SceneFrame::color_, &SceneFrame::velocity_, &SceneFrame::reactive_,
                                                    &SceneFrame::transparency_, &SceneFrame::ui_})
        out.*image = moved(this->*image, random, by);
    for (ReferenceImage SceneFrame::*const image : {&SceneFrame::depth_, &SceneFrame::normals_, &SceneFrame::exposure_})
        out.*image = moved(this->*image, random, unfiltered);
    return out;
}

DevelopInput SceneFrame::input() const {
    return {.extent = extent(),
            .color = color_floats_,
            .depth = depth_floats_,
            .normals = normal_floats_,
            .velocity = velocity_floats_,
            .reactive = reactive_floats_,
            .transparency = transparency_floats_,
            .exposure = exposure_floats_,
            .ui = ui_bytes_,
            .lights = lights_,
            .camera = camera_,
            .time = 2.5 + number_ / 60.0,
            .frame_index = 150 + number_};
}

ReferenceChainInput SceneFrame::reference_input() const {
    return {.color = &color_,
            .images = {{FrameImage::Depth, &depth_},
                       {FrameImage::Normals, &normals_},
                       {FrameImage::Velocity, &velocity_},
                       {FrameImage::Ui, output_.width == 0 ? &ui_ : nullptr},
                       {FrameImage::Reactive, &reactive_},
                       {FrameImage::Transparency, &transparency_},
                       {FrameImage::Exposure, &exposure_}},
            .target_extent = output_,
            .lights = lights_,
            .camera = camera_,
            .time = 2.5 + number_ / 60.0,
            .frame_index = 150 + number_,
            .encodes_target = false};
}

}  // namespace darkroom::verify
