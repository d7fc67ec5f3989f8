// SPDX-License-Identifier: MIT
#pragma once
// For tests only: several frames through one stack, on the test device and by the references. Not part of the library.

#include <gtest/gtest.h>

#include <functional>
#include <span>
#include <vector>

#include "compose/test_stacks/support.hpp"
#include "develop/developer.hpp"
#include "develop/reference_chain.hpp"
#include "gpu/test_run.hpp"

namespace darkroom::test {

/// A frame of a sequence. Layers without pixels are not given.
struct Shot {
    ReferenceImage color, depth{}, velocity{};
    Camera camera{.depth = DepthKind::Planar};
    double time = 0;
    double delta_time = 1.0 / 60;
};
using Fill = std::function<void(Composer&)>;

/// What the references make of each, in scene-linear floats: nothing is encoded.
inline std::vector<ReferenceImage> reference_sequence(const Fill& fill, std::span<const Shot> shots) {
    Composer composer(Device::assumed());
    fill(composer);
    ReferenceHistories histories;
    std::vector<ReferenceImage> out;
    const auto given = [](const ReferenceImage& image) { return image.pixels.empty() ? nullptr : &image; };
    for (const Shot& shot : shots)
        out.push_back(gpu::test::must(run_reference(composer, {.color = &shot.color,
                                                               .images = {{FrameImage::Depth, given(shot.depth)},
                                                                          {FrameImage::Velocity, given(shot.velocity)}},
                                                               .camera = shot.camera,
                                                               .time = shot.time,
                                                               .delta_time = shot.delta_time,
                                                               .frame_index = out.size(),
                                                               .histories = &histories,
                                                               .target_domain = Domain::SceneLinear}))
                          .picture);
    return out;
}

/// The same on the test device, under validation.
inline std::vector<ReferenceImage> developed_sequence(const Fill& fill, std::span<const Shot> shots,
                                                      KernelStage kernels = KernelStage::Auto) {
    Device& device = gpu::test::device();
    const std::uint64_t messages = device.validation_messages();
    Composer composer(device, {.frames_in_flight = 1});
    fill(composer);
    Developer developer(device, {.target = DevelopTarget::SceneLinear, .kernels = kernels});
    const auto numbers = [](const ReferenceImage& image, std::size_t channels) {
        std::vector<float> out;
        for (const Rgba& pixel : image.pixels) {
            const std::array all{pixel.r, pixel.g, pixel.b, pixel.a};
            for (std::size_t i = 0; i < channels; ++i) out.push_back(static_cast<float>(all[i]));
        }
        return out;
    };
    std::vector<ReferenceImage> out;
    for (const Shot& shot : shots) {
        const std::vector<float> color = numbers(shot.color, 4), depth = numbers(shot.depth, 1),
                                 velocity = numbers(shot.velocity, 2);
        const DevelopedPicture picture =
            gpu::test::must(developer.develop(composer, {.extent = {shot.color.width, shot.color.height},
                                                         .color = color,
                                                         .depth = depth,
                                                         .velocity = velocity,
                                                         .camera = shot.camera,
                                                         .time = shot.time,
                                                         .delta_time = shot.delta_time,
                                                         .frame_index = out.size()}));
        ReferenceImage& image = out.emplace_back(picture.extent.width, picture.extent.height);
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            const float* const p = picture.pixels.data() + i * 4;
            image.pixels[i] = {p[0], p[1], p[2], p[3]};
        }
    }
    EXPECT_EQ(device.validation_messages(), messages) << "the validation layer complains";
    return out;
}

}  // namespace darkroom::test
