// SPDX-License-Identifier: MIT
// Velocity in every convention that a host may have reaches effects in the library's own.

#include "compose/test_stacks/host.hpp"
#include "shared/scene_images.hpp"

namespace darkroom {
namespace {

using Sign = VelocityKind::Sign;
using Unit = VelocityKind::Unit;

constexpr std::uint32_t width = 29, height = 18;

constexpr EffectFile files[] = {
    {"moved.glsl",
     "vec4 moved(vec4 color, Pixel pixel, Moved parameters) {\n"
     "    return vec4(load(moved_velocity, pixel.texel).rg, 0.0, 1.0);\n}\n"},
};
/// Shows the velocity that effects see.
const EffectInfo moved{.name = "moved",
                       .doc = "Shows velocity.",
                       .parameters = {.struct_name = "Moved"},
                       .files = files,
                       .needs = {FrameImage::Velocity},
                       .build = [](PassBuilder& builder) { builder.side("moved_velocity", velocity(builder), {}); }};

/// A point of the picture, in pixels from its top left, y down, as a projection without jitter shows it.
struct Point {
    double x = 0, y = 0;
};
Point current(std::uint32_t x, std::uint32_t y) { return {x + 0.5, y + 0.5}; }
Point previous(std::uint32_t x, std::uint32_t y) {
    return {x + 0.5 + std::sin(x * 0.7 + y) * 9, y + 0.5 + std::cos(x - y * 1.3) * 6};
}

/// Where a host with such a convention says that the point is.
Point told(Point point, const VelocityKind& kind, const std::array<float, 2>& jitter) {
    if (kind.has_jitter) point = {point.x + double{jitter[0]}, point.y + double{jitter[1]}};
    Point out = point;
    if (kind.unit != Unit::Pixels) out = {point.x / width, point.y / height};
    if (kind.unit == Unit::Ndc) out = {out.x * 2 - 1, out.y * 2 - 1};
    if (!kind.is_y_down) out.y = (kind.unit == Unit::Pixels ? height : kind.unit == Unit::Uv ? 1 : 0) - out.y;
    return out;
}

class ComposeVelocity : public ::testing::Test {
  protected:
    /// What the effect sees of a host's velocity; `passes`: of the plan.
    ReferenceImage seen(const Camera& camera, bool is_plain, VkFormat format = VK_FORMAT_R32G32_SFLOAT,
                        std::size_t* passes = nullptr, const OutputScale& scale = {}) {
        const VelocityKind& kind = camera.velocity;
        const auto pixels = gpu::test::make_pixels(width, height, [&](std::uint32_t x, std::uint32_t y) {
            const Point now = told(current(x, y), kind, camera.jitter),
                        then = told(previous(x, y), kind, camera.previous_jitter);
            const double sign = kind.sign == Sign::PreviousMinusCurrent ? 1 : -1;
            return std::array{static_cast<float>((then.x - now.x) * sign), static_cast<float>((then.y - now.y) * sign),
                              0.0F, 0.0F};
        });
        const test::Host host(ReferenceImage(width, height, {}));
        const gpu::test::Picture velocity =
            gpu::test::upload(host.device.context(), pixels, format, VK_IMAGE_LAYOUT_GENERAL);
        Composer composer(host.device);
        composer.add(moved, nullptr, {.scale = scale});
        CompileDesc desc = host.compile_desc();
        desc.velocity = {format};
        desc.is_velocity_plain = is_plain;
        const Plan plan = test::must(composer.compile(desc));
        if (passes != nullptr) *passes = plan.passes.size();
        Frame frame = host.frame();
        const gpu::test::Picture target =
            gpu::test::blank(host.device.context(), plan.passes.back().extent, desc.target.format);
        frame.target = test::image_ref(target);
        frame.velocity = test::image_ref(velocity);
        frame.camera = camera;
        test::must(host.record(composer, frame));
        return test::image_of(gpu::test::download(host.device.context(), target));
    }
};

double worst_error(const ReferenceImage& out) {
    double worst = 0;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const Point now = current(x, y), then = previous(x, y);
            worst = std::max(
                {worst, std::abs(out.at(x, y).r - (then.x - now.x)), std::abs(out.at(x, y).g - (then.y - now.y))});
        }
    return worst;
}

TEST_F(ComposeVelocity, EveryConventionBecomesTheLibrarysOwn) {
    for (const Sign sign : {Sign::PreviousMinusCurrent, Sign::CurrentMinusPrevious})
        for (const Unit unit : {Unit::Pixels, Unit::Uv, Unit::Ndc})
            for (const bool is_y_down : {true, false})
                for (const bool has_jitter : {true, false}) {
                    const Camera camera{.velocity = {sign, unit, is_y_down, has_jitter},
                                        .jitter = {0.375F, -0.25F},
                                        .previous_jitter = {-0.125F, 0.4375F}};
                    // A unit in the last place of halves near 9, which some drivers cut off, and rounding of the host's
                    // floats.
                    EXPECT_LE(worst_error(seen(camera, false)), 0x1p-7 + 1e-5)
                        << "sign " << static_cast<int>(sign) << ", unit " << static_cast<int>(unit) << ", y down "
                        << is_y_down << ", jitter " << has_jitter;
                }
}

TEST_F(ComposeVelocity, BehindAnotherSizeItIsInThePixelsOfThatPicture) {
    for (const OutputScale& scale : {OutputScale{1, 2}, {3, 1}})
        for (const Unit unit : {Unit::Pixels, Unit::Uv, Unit::Ndc})
            for (const bool is_plain : {false, true}) {
                if (is_plain && unit != Unit::Pixels) continue;
                Camera camera{.velocity = {.unit = unit, .has_jitter = !is_plain},
                              .jitter = {0.375F, -0.25F},
                              .previous_jitter = {-0.125F, 0.4375F}};
                const ReferenceImage out = seen(camera, is_plain, VK_FORMAT_R32G32_SFLOAT, nullptr, scale);
                ASSERT_EQ(out.width, width * scale.numerator / scale.denominator);
                const double wider = 1.0 * out.width / width, higher = 1.0 * out.height / height;
                for (std::uint32_t y = 0; y < out.height; ++y)
                    for (std::uint32_t x = 0; x < out.width; ++x) {
                        const std::uint32_t i = (2 * x + 1) * width / (2 * out.width);
                        const std::uint32_t j = (2 * y + 1) * height / (2 * out.height);
                        const Point now = current(i, j), then = previous(i, j);
                        // Of halves near 27.
                        ASSERT_NEAR(out.at(x, y).r, (then.x - now.x) * wider, 0x1p-6 + 1e-4) << x << ", " << y;
                        ASSERT_NEAR(out.at(x, y).g, (then.y - now.y) * higher, 0x1p-6 + 1e-4) << x << ", " << y;
                    }
            }
}

TEST_F(ComposeVelocity, WhatIsPromisedToBePlainIsReadWithoutAPass) {
    std::size_t with_pass = 0, without_pass = 0;
    const ReferenceImage through = seen({}, false, VK_FORMAT_R16G16_SFLOAT, &with_pass),
                         direct = seen({}, true, VK_FORMAT_R16G16_SFLOAT, &without_pass);
    EXPECT_EQ(with_pass, 2u);
    EXPECT_EQ(without_pass, 1u);
    EXPECT_LE(worst_error(direct), 0x1p-8);
    EXPECT_EQ(test::worst_difference(through, direct), 0) << "a pass that changes nothing";
}

}  // namespace
}  // namespace darkroom
