// SPDX-License-Identifier: MIT
#pragma once
// For tests only: stacks of effects found by name, so that a tree without one of them still builds, and a host that
// lends its images to a Composer and waits for what was recorded. Not part of the library.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <darkroom/composer.hpp>
#include <darkroom/effects.hpp>
#include <initializer_list>
#include <string_view>

#include "compose/test_stacks/support.hpp"
#include "gpu/test_run.hpp"

namespace darkroom::test {

using gpu::test::must;

/// Skips where the build lacks an effect that these tests put into stacks.
class StackTest : public ::testing::Test {
  protected:
    void SetUp() override {
        for (const std::string_view name : {"blend", "bloom", "dither", "encode", "exposure", "gaussian_blur",
                                            "grayscale", "negative", "tonemap", "vignette"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    }
};

struct Value {
    std::string_view parameter;
    double value = 0;
};

inline void set_word(Composer& composer, Handle handle, std::string_view parameter, std::uint32_t word) {
    must(composer.set(handle, parameter, std::span<const std::uint32_t>(&word, 1)));
}
inline Handle add(Composer& composer, std::string_view effect, std::initializer_list<Value> values = {},
                  const EntryDesc& desc = {}) {
    const Handle handle = composer.add(*find_effect(effect), nullptr, desc);
    for (const Value& value : values) must(composer.set(handle, value.parameter, value.value));
    return handle;
}

inline gpu::test::Pixels pixels_of(const ReferenceImage& image) {
    return gpu::test::make_pixels(image.width, image.height, [&](std::uint32_t x, std::uint32_t y) {
        const Rgba& p = image.at(x, y);
        return std::array{static_cast<float>(p.r), static_cast<float>(p.g), static_cast<float>(p.b),
                          static_cast<float>(p.a)};
    });
}
inline ReferenceImage image_of(const gpu::test::Pixels& pixels) {
    ReferenceImage out(pixels.width, pixels.height);
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const float* const p = pixels.rgba.data() + i * 4;
        out.pixels[i] = {p[0], p[1], p[2], p[3]};
    }
    return out;
}

/// Largest difference in codes of 8 bits; not finite counts as 1e9.
inline double worst_codes(const ReferenceImage& a, const ReferenceImage& b) {
    if (a.pixels.size() != b.pixels.size() || a.pixels.empty()) return 1e9;
    const auto code = [](double v) { return std::floor(std::clamp(v, 0.0, 1.0) * 255 + 0.5); };
    double worst = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Rgba &p = a.pixels[i], &q = b.pixels[i];
        for (const auto& [v, w] : {std::pair{p.r, q.r}, {p.g, q.g}, {p.b, q.b}, {p.a, q.a}})
            worst = std::max(worst, std::isfinite(v) && std::isfinite(w) ? std::abs(code(v) - code(w)) : 1e9);
    }
    return worst;
}

inline ImageRef image_ref(const gpu::test::Picture& picture, VkRect2D region = {}) {
    return {.image = picture.image.handle,
            .view = picture.image.mip_views[0],
            .format = picture.image.info.format,
            .extent = {picture.image.info.extent.width, picture.image.info.extent.height},
            .region = region,
            .layout = picture.layout,
            .final_layout = picture.layout};
}

/// A picture to develop and a target, on the test device or another one.
struct Host {
    explicit Host(const ReferenceImage& picture, VkFormat color_format = VK_FORMAT_R32G32B32A32_SFLOAT,
                  VkFormat target_format = VK_FORMAT_R32G32B32A32_SFLOAT, Device& on = gpu::test::device())
        : device(on),
          color(gpu::test::upload(on.context(), pixels_of(picture), color_format, VK_IMAGE_LAYOUT_GENERAL)),
          target(gpu::test::blank(on.context(), {picture.width, picture.height}, target_format)) {}

    /// Encoded, and pictures between kernels in 32 bits.
    [[nodiscard]] CompileDesc compile_desc() const {
        const gpu::ImageInfo& info = color.image.info;
        return {.max_extent = {info.extent.width, info.extent.height},
                .color = {info.format, info.usage},
                .target = {target.image.info.format, target.image.info.usage},
                .target_domain = Domain::Encoded,
                .intermediate = VK_FORMAT_R32G32B32A32_SFLOAT};
    }
    [[nodiscard]] Frame frame() const { return {.color = image_ref(color), .target = image_ref(target)}; }

    [[nodiscard]] Result<> record(Composer& composer, const Frame& frame) const {
        Result<> recorded{};
        must(gpu::submit_and_wait(device.context(), "a test frame",
                                  [&](VkCommandBuffer commands) { recorded = composer.record(commands, frame); }));
        return recorded;
    }
    /// What the target holds after one recording of the whole picture.
    [[nodiscard]] ReferenceImage run(Composer& composer) const {
        must(record(composer, frame()));
        return read_target();
    }
    [[nodiscard]] ReferenceImage read_target() const { return image_of(gpu::test::download(device.context(), target)); }

    Device& device;
    gpu::test::Picture color, target;
};

}  // namespace darkroom::test
