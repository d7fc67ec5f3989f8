// SPDX-License-Identifier: MIT
#include "sequence_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/thread/parallel.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom::bench {

namespace {

constexpr float noise_amount = 0.04F;

// Mark Jarzynski and Marc Olano, "Hash Functions for GPU Rendering", 2020: pcg.
std::uint32_t hash(std::uint32_t value) {
    const std::uint32_t state = value * 747796405U + 2891336453U;
    const std::uint32_t word = ((state >> ((state >> 28U) + 4U)) ^ state) * 277803737U;
    return (word >> 22U) ^ word;
}

/// In [-1, 1].
float noise(std::uint32_t seed) { return static_cast<float>(hash(seed) >> 8U) * 0x1p-23F - 1; }

/// Blocks of half a metre, each of a shade of its own, with a grain of a few centimetres.
float stone(const std::array<float, 3>& place) {
    const auto cell = [&](float size) {
        std::uint32_t seed = 0;
        for (const float x : place) seed = hash(seed + static_cast<std::uint32_t>(std::lround(x / size)));
        return noise(seed);
    };
    return 0.45F + 0.2F * cell(0.5F) + 0.1F * cell(0.04F);
}

FrameFile frame_of(const StreetView& view, VkExtent2D extent, std::uint32_t index) {
    FrameFile out;
    out.color = Picture(extent.width, extent.height);
    out.depth.emplace(extent.width, extent.height).values = view.distance;
    out.normals.emplace(extent.width, extent.height);
    out.camera.world_to_camera = view.camera.view;
    out.camera.projection = view.camera.projection;
    const Matrix& projection = view.camera.projection;
    const float sun = 0.5F + 0.005F * static_cast<float>(index);
    for (std::uint32_t y = 0; y < extent.height; ++y)
        for (std::uint32_t x = 0; x < extent.width; ++x) {
            const std::size_t pixel = std::size_t{y} * extent.width + x;
            const float* const normal = &view.normals[3 * pixel];
            const float distance = view.distance[pixel];
            const float right = (static_cast<float>(x) / static_cast<float>(extent.width) * 2 - 1) / projection[0];
            const float down = (static_cast<float>(y) / static_cast<float>(extent.height) * 2 - 1) / projection[5];
            const bool is_sky = distance >= sky_depth;
            const float lit = 0.03F + sun * std::max(0.4F * normal[0] + 0.7F * normal[1] + 0.6F * normal[2], 0.0F);
            const float light =
                is_sky ? 0.25F + 0.15F * down : lit * stone({right * distance, down * distance, distance});
            std::uint32_t seed = hash(index * 0x10001U + static_cast<std::uint32_t>(pixel));
            float* const color = out.color.at(x, y);
            const std::array tint{1.0F, 0.9F, is_sky ? 1.3F : 0.75F};
            for (std::size_t c = 0; c < 3; ++c) color[c] = light * tint[c] * (1 + noise_amount * noise(seed++));
            color[3] = 1;
            for (std::size_t axis = 0; axis < 3 && !is_sky; ++axis)
                out.normals->at(x, y)[axis] = normal[axis] + noise_amount * noise(seed++);
        }
    return out;
}

}  // namespace

std::filesystem::path frames_pattern(const std::filesystem::path& folder) { return folder / "in.%04d.exr"; }

std::filesystem::path frame_path(const std::filesystem::path& folder, std::uint32_t index) {
    return folder / fmt::format("in.{:04}.exr", index);
}

Result<> write_frames(const std::filesystem::path& folder, VkExtent2D extent, std::uint32_t count) {
    const StreetView view = view_street(extent);
    std::vector<Result<>> written(count);
    parallel_for(count, 0, [&](std::size_t i) {
        const auto index = static_cast<std::uint32_t>(i);
        written[i] = write_frame(frame_path(folder, index), frame_of(view, extent, index));
    });
    for (Result<>& result : written)
        if (!result) return std::move(result);
    return {};
}

}  // namespace darkroom::bench
