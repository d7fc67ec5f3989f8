// SPDX-License-Identifier: MIT
#pragma once
// One lamp moved over a picture, for effects that spread light by a smaller picture: what they add of it does not
// depend on where it lies, whatever the ratio of the two sizes is.
#include <gtest/gtest.h>

#include <array>
#include <darkroom/composer.hpp>
#include <functional>

#include "gpu/test_run.hpp"

namespace darkroom::test {

/// What a stack adds to pictures of one size on the test device.
class AddedLight {
  public:
    AddedLight(const std::function<void(Composer&)>& fill, VkExtent2D extent)
        : extent_(extent), composer_(gpu::test::device(), {.frames_in_flight = 1}) {
        fill(composer_);
        EXPECT_TRUE(composer_.compile({.max_extent = extent,
                                       .color = {format, gpu::test::all_usage(context_, format)},
                                       .target = {format, gpu::test::all_usage(context_, format)},
                                       .target_domain = Domain::Encoded}));
    }

    /// The sum of each channel.
    std::array<double, 3> of(const gpu::test::Pixels& pixels) {
        const gpu::test::Picture color = gpu::test::upload(context_, pixels, format, VK_IMAGE_LAYOUT_GENERAL);
        Result<> recorded{};
        EXPECT_TRUE(gpu::submit_and_wait(context_, "lamps", [&](VkCommandBuffer commands) {
            recorded = composer_.record(commands, {.color = image_of(color), .target = image_of(target_)});
        }));
        EXPECT_TRUE(recorded);
        const gpu::test::Pixels out = gpu::test::download(context_, target_);
        std::array<double, 3> sums{};
        for (std::size_t i = 0; i < out.rgba.size(); ++i)
            if (i % 4 < 3) sums[i % 4] += double{out.rgba[i]} - double{pixels.rgba[i]};
        return sums;
    }

  private:
    static constexpr VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
    ImageRef image_of(const gpu::test::Picture& picture) const {
        return {.image = picture.image.handle,
                .view = picture.image.mip_views[0],
                .format = format,
                .extent = extent_,
                .layout = picture.layout,
                .final_layout = picture.layout};
    }

    VkExtent2D extent_;
    gpu::Context& context_ = gpu::test::context();
    Composer composer_;
    gpu::test::Picture target_ = gpu::test::blank(context_, extent_, format);
};

/// What a stack adds of a pixel of light, in all, at every place of five sizes that is `border` from the edges, is
/// within 2 % of `share`, which is that of a red, a green and a blue one. Beside it, what lies on the way in 6 bits of
/// mantissa may be rounded to either side.
inline void expect_lamps_count_alike(const std::function<void(Composer&)>& fill, const std::array<double, 3>& share) {
    constexpr std::array<VkExtent2D, 5> sizes{{{104, 80}, {107, 81}, {101, 86}, {110, 87}, {103, 83}}};
    constexpr std::uint32_t border = 36;
    constexpr float light = 100;
    const double allowed = 0.02 + (gpu::test::is_lavapipe() ? 0 : 0x1p-6);
    for (const VkExtent2D size : sizes) {
        AddedLight added(fill, size);
        // A lamp of each colour at once, so far apart that none counts for another.
        const std::uint32_t apart = (size.width - 2 * border + 2) / 3;
        for (std::uint32_t y = border; y < size.height - border; ++y)
            for (std::uint32_t x = border; x < border + apart; ++x) {
                gpu::test::Pixels picture =
                    gpu::test::make_pixels(size.width, size.height, [](std::uint32_t, std::uint32_t) {
                        return std::array{0.f, 0.f, 0.f, 1.f};
                    });
                for (std::uint32_t c = 0; c < 3; ++c) picture.rgba[picture.index(x + c * apart, y) + c] = light;
                const std::array<double, 3> sums = added.of(picture);
                for (std::uint32_t c = 0; c < 3; ++c)
                    EXPECT_NEAR(sums[c] / double{light}, share[c], allowed * share[c])
                        << size.width << 'x' << size.height << ' ' << x + c * apart << ", " << y;
            }
    }
}

}  // namespace darkroom::test
