// SPDX-License-Identifier: MIT
// Targets of every kind: encoded exactly once, whatever format the host's target has and whatever it was made for.

#include <fmt/format.h>

#include <bit>

#include "compose/test_stacks/host.hpp"
#include "shared/srgb_reference.hpp"

namespace darkroom {
namespace {

using test::add;

class ComposeTarget : public test::StackTest {};

double srgb(double v) { return srgb_encoded(std::clamp(v, 0.0, 1.0)); }
ReferenceImage encoded(const ReferenceImage& picture) {
    ReferenceImage out = picture;
    for (Rgba& p : out.pixels) p = {srgb(p.r), srgb(p.g), srgb(p.b), p.a};
    return out;
}
/// Different values in red, green and blue, so that exchanged channels are seen.
ReferenceImage ramp() {
    ReferenceImage picture(64, 17);
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) picture.at(x, y) = {x / 63.0, x * x / 3969.0, y / 16.0, 1};
    return test::round_to_float(picture);
}
/// `usage_without`: what the host's target was not made for.
ReferenceImage developed(VkFormat target, const std::function<void(Composer&)>& fill,
                         VkImageUsageFlags usage_without = 0, Plan* plan = nullptr,
                         KernelStage stage = KernelStage::Auto) {
    const test::Host host(ramp(), VK_FORMAT_R32G32B32A32_SFLOAT, target);
    Composer composer(host.device);
    fill(composer);
    CompileDesc desc = host.compile_desc();
    desc.target_domain.reset();
    desc.target.usage &= ~usage_without;
    desc.kernels = stage;
    auto made = composer.compile(desc);
    EXPECT_TRUE(made) << made.error().text;
    if (!made) return {};
    if (plan != nullptr) *plan = *made;
    return host.run(composer);
}
std::string last_stage(const Plan& plan) { return plan.passes.empty() ? "none" : plan.passes.back().stage; }
void encode_only(Composer& composer) { add(composer, "encode"); }

TEST_F(ComposeTarget, AnUnencodedPictureIsEncodedForAUnormTarget) {
    Plan plan;
    const auto expose = [](Composer& composer) { add(composer, "exposure", {{"exposure", 1}}); };
    const ReferenceImage out = developed(VK_FORMAT_R8G8B8A8_UNORM, expose, 0, &plan);
    EXPECT_LE(test::worst_codes(out, encoded(ramp())), 1);
    ASSERT_EQ(plan.remarks.size(), 1u);
    EXPECT_NE(plan.remarks[0].find("sRGB"), std::string::npos);
}

TEST_F(ComposeTarget, EncodeIsDoneOnce) {
    Plan plan;
    const ReferenceImage out = developed(VK_FORMAT_R8G8B8A8_UNORM, encode_only, 0, &plan);
    EXPECT_LE(test::worst_codes(out, encoded(ramp())), 1);
    EXPECT_TRUE(plan.remarks.empty());
}

void set_transfer(Composer& composer, std::string_view name) {
    const Handle encode = *composer.find("encode");
    const auto& choices = composer.info(encode)->parameters.find("transfer")->choices;
    const auto number = static_cast<std::uint32_t>(std::ranges::find(choices, name) - choices.begin());
    test::set_word(composer, encode, "transfer", number);
}
TEST_F(ComposeTarget, EncodedOnceWhateverChangesAfterCompile) {
    const std::array<std::function<void(Composer&)>, 5> edits{
        [](Composer& composer) { set_transfer(composer, "none"); },
        [](Composer& composer) { set_transfer(composer, "srgb"); },
        [](Composer& composer) { test::must(composer.set_enabled(*composer.find("encode"), false)); },
        [](Composer& composer) { test::must(composer.set_enabled(*composer.find("encode"), true)); },
        [](Composer& composer) { test::must(composer.set_opacity(*composer.find("encode"), 0)); },
    };
    for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB}) {
        for (const bool is_fused : {true, false}) {
            const test::Host host(ramp(), VK_FORMAT_R32G32B32A32_SFLOAT, format);
            Composer composer(host.device);
            add(composer, "exposure");
            add(composer, "encode");
            CompileDesc desc = host.compile_desc();
            desc.fuse = is_fused;
            test::must(composer.compile(desc));
            for (std::size_t i = 0; i < edits.size(); ++i) {
                SCOPED_TRACE(fmt::format("format {}, fused {}, edit {}", static_cast<int>(format), is_fused, i));
                edits[i](composer);
                EXPECT_LE(test::worst_codes(host.run(composer), encoded(ramp())), 1) << "by the complete kernel";
                composer.wait_for_kernels();
                EXPECT_LE(test::worst_codes(host.run(composer), encoded(ramp())), 1) << "by the lean kernel";
            }
        }
    }
}

TEST_F(ComposeTarget, AnSrgbTargetIsNotEncodedTwiceOnDemand) {
    const test::Host host(ramp(), VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R8G8B8A8_SRGB);
    Composer composer(host.device);
    add(composer, "exposure");
    CompileDesc desc = host.compile_desc();
    desc.encodes_target = true;
    test::must(composer.compile(desc));
    EXPECT_LE(test::worst_codes(host.run(composer), encoded(ramp())), 1);
}

TEST_F(ComposeTarget, BlueFirstFormatsKeepTheirChannels) {
    for (const KernelStage stage : {KernelStage::Raster, KernelStage::Compute}) {
        const ReferenceImage out = developed(VK_FORMAT_B8G8R8A8_UNORM, encode_only, 0, nullptr, stage);
        EXPECT_LE(test::worst_codes(out, encoded(ramp())), 1);
    }
}

TEST_F(ComposeTarget, AnSrgbTargetGetsTheSameCodes) {
    Plan plan;
    const ReferenceImage out = developed(VK_FORMAT_R8G8B8A8_SRGB, encode_only, 0, &plan);
    EXPECT_LE(test::worst_codes(out, encoded(ramp())), 1);
    EXPECT_EQ(last_stage(plan), "raster");
    // Unencoded: the hardware's own curve is the one encoding.
    const ReferenceImage linear =
        developed(VK_FORMAT_R8G8B8A8_SRGB, [](Composer& composer) { add(composer, "exposure"); });
    EXPECT_LE(test::worst_codes(linear, encoded(ramp())), 1);
}

TEST_F(ComposeTarget, ATargetWithoutStorageGetsARasterLastKernel) {
    Plan plan;
    const ReferenceImage out =
        developed(VK_FORMAT_R8G8B8A8_UNORM, encode_only, VK_IMAGE_USAGE_STORAGE_BIT, &plan, KernelStage::Compute);
    EXPECT_EQ(last_stage(plan), "raster");
    EXPECT_LE(test::worst_codes(out, encoded(ramp())), 1);
    (void)developed(VK_FORMAT_R8G8B8A8_UNORM, encode_only, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, &plan,
                    KernelStage::Raster);
    EXPECT_EQ(last_stage(plan), "compute");
}

// Kernels of both forms: one that is made for whole images may take a texel's place in the picture for that in the
// target.
TEST_F(ComposeTarget, AWholePictureLandsInItsPartOfTheTarget) {
    const ReferenceImage picture = test::round_to_float(test::random_display(21, 13, 5));
    const test::Host host(picture);
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        Composer composer(host.device, {.max_threads = 0});
        test::add(composer, "negative");
        CompileDesc desc = host.compile_desc();
        desc.kernels = stage;
        test::must(composer.compile(desc));
        const gpu::test::Picture target =
            gpu::test::blank(host.device.context(), {40, 30}, VK_FORMAT_R32G32B32A32_SFLOAT);
        Frame frame = host.frame();
        frame.target = test::image_ref(target, {{7, 4}, {21, 13}});
        for (const bool is_lean : {false, true}) {
            if (is_lean) composer.wait_for_kernels();
            test::must(host.record(composer, frame));
            const ReferenceImage out = test::image_of(gpu::test::download(host.device.context(), target));
            for (std::uint32_t y = 0; y < 30; ++y)
                for (std::uint32_t x = 0; x < 40; ++x) {
                    const bool is_inside = x >= 7 && x < 28 && y >= 4 && y < 17;
                    const double expected = is_inside ? 1 - picture.at(x - 7, y - 4).r : 0;
                    ASSERT_NEAR(out.at(x, y).r, expected, 1e-6) << is_lean << " at " << x << ", " << y;
                }
        }
    }
}

TEST_F(ComposeTarget, FloatTargetsTakeLinearLight) {
    const auto fill = [](Composer& composer) {
        add(composer, "exposure", {{"exposure", 2}});
        add(composer, "encode");
        add(composer, "dither");
    };
    const ReferenceImage out = developed(VK_FORMAT_R32G32B32A32_SFLOAT, fill);
    ReferenceImage expected = ramp();
    for (Rgba& p : expected.pixels) p = {p.r * 2, p.g * 2, p.b * 2, p.a};
    EXPECT_EQ(test::worst_difference(out, expected), 0);
}

TEST_F(ComposeTarget, AColorImageWithoutStorageIsSampled) {
    const test::Host host(ramp());
    Composer composer(host.device);
    add(composer, "exposure", {{"exposure", 2}});
    CompileDesc desc = host.compile_desc();
    desc.color.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    test::must(composer.compile(desc));
    const ReferenceImage sampled = host.run(composer);
    test::must(composer.compile(host.compile_desc()));
    EXPECT_EQ(test::worst_difference(sampled, host.run(composer)), 0);
}

TEST_F(ComposeTarget, AlphaPassesUnchanged) {
    ReferenceImage picture = ramp();
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i].a = static_cast<double>(i % 5) / 4;
    const test::Host host(picture);
    Composer composer(host.device);
    add(composer, "bloom", {{"intensity", 1}});
    for (const char* const name : {"exposure", "tonemap", "encode", "dither", "vignette"}) add(composer, name);
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage out = host.run(composer);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) ASSERT_EQ(out.pixels[i].a, picture.pixels[i].a) << i;
}

}  // namespace
}  // namespace darkroom
