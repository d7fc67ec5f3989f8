// SPDX-License-Identifier: MIT
// Behind an effect whose result has another size, everything is of that size: what other entries made, what the frame
// brings, and what stands in for an entry that is off.

#include <fmt/format.h>

#include "compose/test_stacks/effects.hpp"
#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

class ComposeSize : public test::StackTest {};

/// Planar distances that differ from pixel to pixel, so that one that is read at the wrong place, or between two,
/// shows.
ReferenceImage distances(VkExtent2D extent) {
    ReferenceImage depth(extent.width, extent.height);
    for (std::uint32_t i = 0; i < depth.pixels.size(); ++i) depth.pixels[i].r = 5.0 + (i * 37) % 100;
    return depth;
}
/// Of the four texels around the centre of a pixel, or of fewer where it lies on one's, the one that is closest.
ReferenceImage closest(const ReferenceImage& image, const ReferenceImage& like) {
    ReferenceImage out(like.width, like.height);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double u = (x + 0.5) * image.width / out.width - 0.5, v = (y + 0.5) * image.height / out.height - 0.5;
            constexpr double rounding = 1e-9;
            out.at(x, y).r = 1e30;
            for (const double i : {std::floor(u + rounding), std::ceil(u - rounding)})
                for (const double j : {std::floor(v + rounding), std::ceil(v - rounding)})
                    out.at(x, y).r = std::min(
                        out.at(x, y).r, image.clamped(static_cast<std::int64_t>(i), static_cast<std::int64_t>(j)).r);
        }
    return out;
}

/// One frame of a stack on a picture, with a target of the size that the plan asks for.
ReferenceImage shown(Composer& composer, const test::Host& host, CompileDesc desc, const gpu::test::Picture* depth) {
    Frame frame = host.frame();
    frame.camera.depth = DepthKind::Planar;
    if (depth != nullptr) {
        desc.depth = {depth->image.info.format};
        frame.depth = test::image_ref(*depth);
    }
    const auto plan = composer.compile(desc);
    EXPECT_TRUE(plan) << plan.error().text;
    if (!plan) return {};
    const gpu::test::Picture target =
        gpu::test::blank(host.device.context(), plan->passes.back().extent, desc.target.format);
    frame.target = test::image_ref(target);
    test::must(host.record(composer, frame));
    return test::image_of(gpu::test::download(host.device.context(), target));
}

TEST_F(ComposeSize, DepthIsReadAtTheSizeOfThePicture) {
    const EffectInfo* const fog = find_effect("fog");
    if (fog == nullptr) GTEST_SKIP() << "this build has no effect fog";
    for (const VkExtent2D extent : {VkExtent2D{24, 16}, {19, 13}, {7, 3}}) {
        const ReferenceImage picture = test::round_to_float(test::random_display(extent.width, extent.height, 3));
        const ReferenceImage depth = distances(extent);
        const test::Host host(picture);
        const gpu::test::Picture depth_image = gpu::test::upload(host.device.context(), test::pixels_of(depth),
                                                                 VK_FORMAT_R32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
        for (const bool is_planar : {true, false}) {
            for (const bool is_fused : {true, false}) {
                SCOPED_TRACE(
                    fmt::format("{} x {}, planar {}, fused {}", extent.width, extent.height, is_planar, is_fused));
                Composer composer(host.device);
                // Before and behind: what both share has two sizes.
                const Handle before = test::add(composer, "fog", {{"density", 0.01}, {"start", 0}});
                const Handle halve = composer.add(test::halve_effect, nullptr);
                const Handle behind = test::add(composer, "fog", {{"density", 0.02}, {"start", 0}});
                CompileDesc desc = host.compile_desc();
                desc.fuse = is_fused;
                desc.is_depth_planar = is_planar;
                const ReferenceImage out = shown(composer, host, desc, &depth_image);

                const Camera camera{.depth = DepthKind::Planar};
                const ReferenceImage first =
                    fog->reference(composer.words(before).data(),
                                   {.picture = &picture, .source = &picture, .depth = &depth, .camera = camera});
                const ReferenceImage half =
                    test::halve_effect.reference(composer.words(halve).data(), {.picture = &first, .source = &first});
                const ReferenceImage half_depth = closest(depth, half);
                const ReferenceImage expected =
                    fog->reference(composer.words(behind).data(),
                                   {.picture = &half, .source = &half, .depth = &half_depth, .camera = camera});
                EXPECT_LE(test::worst_difference(out, expected), 1e-5);
            }
        }
    }
}

TEST_F(ComposeSize, AnEntryThatIsOffKeepsItsSize) {
    const ReferenceImage picture = test::round_to_float(test::random_display(24, 16, 5));
    const test::Host host(picture);
    const auto out = [&](bool is_fused, float opacity) {
        Composer composer(host.device);
        composer.add(test::halve_effect, nullptr, {.enabled = false, .opacity = opacity});
        composer.add(test::shift_effect, nullptr, {.enabled = false});
        CompileDesc desc = host.compile_desc();
        desc.fuse = is_fused;
        return shown(composer, host, desc, nullptr);
    };
    for (const float opacity : {1.0F, 0.5F}) {
        const ReferenceImage made = out(true, opacity);
        ASSERT_EQ(made.width, 12U);
        EXPECT_EQ(test::worst_difference(made, out(false, opacity)), 0);
        // Each pixel is the mean of the four that it covers.
        for (std::uint32_t y = 0; y < made.height; ++y)
            for (std::uint32_t x = 0; x < made.width; ++x)
                ASSERT_NEAR(made.at(x, y).g,
                            (picture.at(2 * x, 2 * y).g + picture.at(2 * x + 1, 2 * y).g +
                             picture.at(2 * x, 2 * y + 1).g + picture.at(2 * x + 1, 2 * y + 1).g) /
                                4,
                            1e-3);
    }
}

TEST_F(ComposeSize, ASourceIsReadAtTheSizeOfThePicture) {
    ReferenceImage picture(24, 16);
    for (std::uint32_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = {i % 24 < 12 ? 0.25 : 0.75, i < 24 * 8 ? 0.25 : 0.75, 0.5, 1};
    const test::Host host(picture);
    Composer composer(host.device);
    composer.add(test::halve_effect, nullptr);
    composer.add(test::glow_effect, nullptr, {.source = scene_color});
    const ReferenceImage out = shown(composer, host, host.compile_desc(), nullptr);
    ASSERT_EQ(out.width, 12U);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            ASSERT_NEAR(out.at(x, y).r, picture.at(2 * x, 2 * y).r * 1.25, 1e-5) << x << ", " << y;
}

}  // namespace
}  // namespace darkroom
