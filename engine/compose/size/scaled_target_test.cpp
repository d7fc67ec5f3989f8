// SPDX-License-Identifier: MIT
// Targets of another extent than the picture: the last kernel samples it into them, bilinearly.

#include "compose/test_stacks/host.hpp"
#include "shared/srgb_reference.hpp"

namespace darkroom {
namespace {

class ComposeScaledTarget : public test::StackTest {};

/// The picture at a place of the target, bilinear between texel centres, its edge repeated.
Rgba sampled(const ReferenceImage& picture, double u, double v) {
    const double x = u * picture.width - 0.5, y = v * picture.height - 0.5;
    const double left = std::floor(x), top = std::floor(y), part_x = x - left, part_y = y - top;
    const auto texel = [&](double at_x, double at_y) {
        return picture.at(static_cast<std::uint32_t>(std::clamp(at_x, 0.0, picture.width - 1.0)),
                          static_cast<std::uint32_t>(std::clamp(at_y, 0.0, picture.height - 1.0)));
    };
    Rgba out{0, 0, 0, 0};
    for (const auto& [at_x, weight_x] : {std::pair{left, 1 - part_x}, {left + 1, part_x}})
        for (const auto& [at_y, weight_y] : {std::pair{top, 1 - part_y}, {top + 1, part_y}}) {
            const Rgba tap = texel(at_x, at_y);
            const double weight = weight_x * weight_y;
            out = {out.r + tap.r * weight, out.g + tap.g * weight, out.b + tap.b * weight, out.a + tap.a * weight};
        }
    return out;
}
ReferenceImage resampled(const ReferenceImage& picture, VkExtent2D extent) {
    ReferenceImage out(extent.width, extent.height);
    for (std::uint32_t y = 0; y < extent.height; ++y)
        for (std::uint32_t x = 0; x < extent.width; ++x)
            out.at(x, y) = sampled(picture, (x + 0.5) / extent.width, (y + 0.5) / extent.height);
    return out;
}
/// Smooth, so that how finely a sampler weighs its taps is worth less than what is tested.
ReferenceImage smooth(std::uint32_t width, std::uint32_t height) {
    ReferenceImage picture(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            picture.at(x, y) = {0.5 + 0.4 * std::sin(x * 0.5), 0.5 + 0.4 * std::cos(y * 0.4), (x + y) % 5 * 0.2, 1};
    return test::round_to_float(picture);
}

/// Samplers weigh in steps of 1/256 or finer, along both axes.
double sampler_error() { return std::max(0.004, 2 * gpu::test::filter_step()); }

constexpr VkExtent2D largest_target{101, 77};

TEST_F(ComposeScaledTarget, ThePictureIsSampledIntoTargetsOfEverySize) {
    const ReferenceImage picture = smooth(43, 31);
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster})
        for (const bool is_fused : {true, false}) {
            const test::Host host(picture);
            Composer composer(host.device);
            test::add(composer, "exposure", {{"exposure", 0.5}});
            test::add(composer, "gaussian_blur", {{"radius", 0}});
            test::add(composer, "negative");
            CompileDesc desc = host.compile_desc();
            desc.target_extent = largest_target;
            desc.kernels = stage;
            desc.fuse = is_fused;
            const Plan plan = test::must(composer.compile(desc));
            ReferenceImage expected = picture;
            for (Rgba& p : expected.pixels) p = {1 - p.r * 0.5, 1 - p.g * 0.5, 1 - p.b * 0.5, p.a};
            for (const VkExtent2D extent :
                 {largest_target, VkExtent2D{43, 31}, {86, 62}, {21, 15}, {7, 77}, {1, 1}, {100, 3}}) {
                SCOPED_TRACE(std::to_string(extent.width) + "x" + std::to_string(extent.height));
                const gpu::test::Picture target =
                    gpu::test::blank(host.device.context(), extent, VK_FORMAT_R32G32B32A32_SFLOAT);
                Frame frame = host.frame();
                frame.target = test::image_ref(target);
                test::must(host.record(composer, frame));
                const ReferenceImage out = test::image_of(gpu::test::download(host.device.context(), target));
                EXPECT_LE(test::worst_difference(out, resampled(expected, extent)), sampler_error());
            }
        }
}

TEST_F(ComposeScaledTarget, PartsOfImagesAreSampledIntoPartsOfTargets) {
    const ReferenceImage picture = smooth(43, 31);
    ReferenceImage around(64, 48, {9, 9, 9, 9});
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) around.at(x + 11, y + 5) = picture.at(x, y);
    const test::Host host(around);
    Composer composer(host.device);
    CompileDesc desc = host.compile_desc();
    desc.target_extent = largest_target;
    test::must(composer.compile(desc));
    const gpu::test::Picture target =
        gpu::test::blank(host.device.context(), largest_target, VK_FORMAT_R32G32B32A32_SFLOAT);
    Frame frame = host.frame();
    frame.color.region = {{11, 5}, {43, 31}};
    frame.target = test::image_ref(target, {{3, 2}, {90, 40}});
    test::must(host.record(composer, frame));
    const ReferenceImage whole = test::image_of(gpu::test::download(host.device.context(), target));
    ReferenceImage out(90, 40);
    for (std::uint32_t y = 0; y < 40; ++y)
        for (std::uint32_t x = 0; x < 90; ++x) out.at(x, y) = whole.at(x + 3, y + 2);
    EXPECT_LE(test::worst_difference(out, resampled(picture, {90, 40})), sampler_error());
    EXPECT_EQ(whole.at(2, 2).r, 0) << "written outside of its region";
    EXPECT_EQ(whole.at(93, 41).r, 0) << "written outside of its region";
}

TEST_F(ComposeScaledTarget, TheLastKernelEncodesWhatItSamples) {
    const ReferenceImage picture = smooth(43, 31);
    const test::Host host(picture);
    Composer composer(host.device);
    test::add(composer, "exposure");
    CompileDesc desc = host.compile_desc();
    desc.target_extent = {64, 64};
    desc.encodes_target = true;
    test::must(composer.compile(desc));
    const gpu::test::Picture target = gpu::test::blank(host.device.context(), {64, 50}, VK_FORMAT_R32G32B32A32_SFLOAT);
    Frame frame = host.frame();
    frame.target = test::image_ref(target);
    test::must(host.record(composer, frame));
    ReferenceImage expected = resampled(picture, {64, 50});
    for (Rgba& p : expected.pixels) p = {srgb_encoded(p.r), srgb_encoded(p.g), srgb_encoded(p.b), p.a};
    EXPECT_LE(test::worst_difference(test::image_of(gpu::test::download(host.device.context(), target)), expected),
              0.01);
}

TEST_F(ComposeScaledTarget, ThePlanSaysSo) {
    Composer composer(gpu::test::device());
    test::add(composer, "negative");
    CompileDesc desc{.max_extent = {1280, 720}, .target_extent = {1920, 1080}};
    const Plan plan = test::must(composer.plan(desc));
    ASSERT_EQ(plan.passes.size(), 2u);
    EXPECT_EQ(plan.passes[0].extent.width, 1280u);
    EXPECT_EQ(plan.passes[1].extent.width, 1920u);
    EXPECT_EQ(plan.passes[1].extent.height, 1080u);
    EXPECT_NE(plan.passes[1].boundary.find("the target has an extent of its own"), std::string::npos);
    EXPECT_NE(plan.text().find("up to 1920x1080: the last kernel samples the picture into it"), std::string::npos)
        << plan.text();
}

TEST_F(ComposeScaledTarget, ALargerTargetThanCompiledIsRefused) {
    const test::Host host(smooth(43, 31));
    Composer composer(host.device);
    CompileDesc desc = host.compile_desc();
    desc.target_extent = {60, 40};
    test::must(composer.compile(desc));
    Frame frame = host.frame();
    for (const VkExtent2D extent : {VkExtent2D{61, 40}, {60, 41}, {0, 40}}) {
        frame.target.extent = {64, 64};
        frame.target.region = {{0, 0}, extent};
        // A region of no width stands for the whole image.
        const auto recorded = composer.record(VK_NULL_HANDLE, frame);
        ASSERT_FALSE(recorded);
        EXPECT_NE(recorded.error().text.find("allowed is 1x1 to 60x40"), std::string::npos) << recorded.error().text;
    }
}

}  // namespace
}  // namespace darkroom
