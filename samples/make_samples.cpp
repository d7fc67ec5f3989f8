// SPDX-License-Identifier: MIT
// Makes samples/window.exr: scene-linear colour, depth, world-space normals, motion and camera of one frame, for trying
// effects without a renderer. Colour is the mean of 16 samples a pixel; the rest is what the pixel's centre sees.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>

#include "image/frame/frame_file.hpp"
#include "room.hpp"

namespace {

using darkroom::samples::Camera;
using darkroom::samples::Room;
using darkroom::samples::Surface;
using darkroom::samples::Vec3;

constexpr std::uint32_t width = 672;
constexpr std::uint32_t height = 378;
constexpr Camera camera = {.position = {0.25f, 1.62f, 6.3f}, .pitch_rad = 0.045f, .vertical_fov_rad = 0.78f};
constexpr Vec3 camera_motion = {0.035f, 0.0f, 0.0f};  // since the frame before

/// Keeps `bits` bits of the mantissa: what nobody sees would make the file three times as large.
float round_mantissa(float value, int bits) {
    if (value == 0.0f) return 0.0f;
    const float step = std::ldexp(1.0f, std::ilogb(value) - bits);
    return std::round(value / step) * step;
}

Vec3 color(const Room& room, std::uint32_t x, std::uint32_t y) {
    Vec3 sum;
    for (std::uint32_t sample = 0; sample < Room::samples; ++sample) {
        // The same lattice as the lights', turned, so that a place in the pixel says little about a place on a light.
        const float u = (static_cast<float>(sample * 3U % 16U) + 0.5f) / 16.0f;
        const float v = (static_cast<float>(sample * 5U % 16U) + 0.5f) / 16.0f;
        const Vec3 ray = camera.ray((static_cast<float>(x) + u) / width, (static_cast<float>(y) + v) / height);
        sum = sum + room.radiance(camera.position, ray, sample);
    }
    return sum * (1.0f / Room::samples);
}

void fill(darkroom::FrameFile& frame) {
    const Room room;
    Camera previous = camera;
    previous.position = camera.position - camera_motion;
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const Vec3 rgb = color(room, x, y);
            float* const pixel = frame.color.at(x, y);
            pixel[0] = round_mantissa(rgb.x, 7);
            pixel[1] = round_mantissa(rgb.y, 7);
            pixel[2] = round_mantissa(rgb.z, 6);  // the eye sees coarser steps in blue
            pixel[3] = 1.0f;
            const float u = (static_cast<float>(x) + 0.5f) / width;
            const float v = (static_cast<float>(y) + 0.5f) / height;
            const Surface surface = room.surface(camera.position, camera.ray(u, v));
            if (surface.is_sky) {
                // The camera did not turn, so the sky stood still.
                *frame.depth->at(x, y) = darkroom::sky_depth;
                continue;
            }
            *frame.depth->at(x, y) = round_mantissa(-camera.to_view(surface.position).z, 13);
            float* const normal = frame.normals->at(x, y);
            normal[0] = round_mantissa(surface.normal.x, 7);
            normal[1] = round_mantissa(surface.normal.y, 7);
            normal[2] = round_mantissa(surface.normal.z, 7);
            const std::array<float, 2> now = camera.project(camera.to_view(surface.position));
            const std::array<float, 2> before = previous.project(previous.to_view(surface.previous_position));
            constexpr float steps = 16.0f;  // a sixteenth of a pixel is far below what a blur shows
            frame.velocity->at(x, y)[0] = std::round((before[0] - now[0]) * width * steps) / steps;
            frame.velocity->at(x, y)[1] = std::round((before[1] - now[1]) * height * steps) / steps;
        }
    }
}

/// Column-major, for column vectors.
darkroom::Matrix world_to_camera() {
    const float c = std::cos(camera.pitch_rad);
    const float s = std::sin(camera.pitch_rad);
    const Vec3 origin = camera.to_view({});
    return {1.0f, 0.0f, 0.0f, 0.0f, 0.0f, c, -s, 0.0f, 0.0f, s, c, 0.0f, origin.x, origin.y, origin.z, 1.0f};
}

}  // namespace

int main(int argument_count, char** arguments) {
    if (argument_count != 2) {
        fmt::print(stderr, "make_samples: needs one argument, the file to write\n");
        return 1;
    }
    darkroom::FrameFile frame;
    frame.color = darkroom::Picture(width, height);
    frame.has_alpha = true;
    frame.depth.emplace(width, height);
    frame.normals.emplace(width, height);
    frame.velocity.emplace(width, height);
    constexpr double degrees = 180.0 / std::numbers::pi;
    frame.camera.world_to_camera = world_to_camera();
    frame.camera.projection = darkroom::perspective(camera.vertical_fov_rad * degrees, double{width} / height);
    fill(frame);
    if (const darkroom::Result<> written = darkroom::write_frame(arguments[1], frame); !written) {
        fmt::print(stderr, "make_samples: {}\n", written.error().text);
        return 2;
    }
    return 0;
}
