// SPDX-License-Identifier: MIT
// Stacks on the smallest device that Vulkan 1.3 allows: their pictures are those of the test device, and no call is
// refused. All suites of Composers and effects run on it with DARKROOM_TEST_DEVICE=smallest (tests/CMakeLists.txt).

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

class ComposeSmallestDevice : public test::StackTest {
  protected:
    Device& smallest = gpu::test::shared_device.smallest();

    /// The largest difference between the two devices.
    static double difference(const ReferenceImage& picture, VkFormat format, KernelStage kernels,
                             const std::function<void(Composer&)>& fill) {
        std::vector<ReferenceImage> out;
        for (Device* const device : {&gpu::test::device(), &gpu::test::shared_device.smallest()}) {
            const test::Host host(picture, format, VK_FORMAT_R32G32B32A32_SFLOAT, *device);
            Composer composer(*device);
            fill(composer);
            CompileDesc desc = host.compile_desc();
            desc.kernels = kernels;
            desc.color.usage |= VK_IMAGE_USAGE_STORAGE_BIT & host.color.image.info.usage;
            test::must(composer.compile(desc));
            out.push_back(host.run(composer));
        }
        return test::worst_difference(out[0], out[1]);
    }
};

TEST_F(ComposeSmallestDevice, ShowsThePictureThatOthersShow) {
    const ReferenceImage picture = test::round_to_half(test::random_display(64, 41, 7));
    const auto fill = [](Composer& composer) {
        test::add(composer, "bloom", {{"intensity", 0.5}});
        test::add(composer, "gaussian_blur", {{"radius", 3}});
        test::add(composer, "exposure", {{"exposure", 0.7}});
        test::add(composer, "tonemap");
        for (const std::string_view effect : {"lens_distortion", "chromatic_aberration", "fxaa"})
            if (find_effect(effect) != nullptr) test::add(composer, effect);
        test::add(composer, "vignette");
    };
    // Three effects fetch between texels of noise, one after another along two axes; the last doubles what it finds.
    const double filtered = (2 + 2 + 4) * 2 * gpu::test::filter_step();
    for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster}) {
        for (const VkFormat format : {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT})
            EXPECT_LE(difference(picture, format, kernels, fill), 1e-3 + filtered) << format;
    }
}

// Entries with tables that are loaded, until a kernel had more storage images than a shader may have.
TEST_F(ComposeSmallestDevice, SamplesTheTablesThatAreOneStorageImageTooMany) {
    const ReferenceImage picture = test::round_to_half(test::random_display(33, 20, 3));
    for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster}) {
        EXPECT_LE(difference(picture, VK_FORMAT_R32G32B32A32_SFLOAT, kernels,
                             [](Composer& composer) {
                                 for (int i = 0; i < 6; ++i)
                                     test::add(composer, "dither", {{"intensity", 0.01 * (i + 1)}});
                             }),
                  1e-4);
    }
}

TEST_F(ComposeSmallestDevice, SaysInOneLineWhatIsMissing) {
    Composer composer(smallest);
    test::add(composer, "exposure", {{"exposure", 2}});
    const auto error = [&](const CompileDesc& desc) {
        const auto made = composer.compile(desc);
        return made ? std::string("compiled") : made.error().text;
    };
    constexpr VkImageUsageFlags target = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    EXPECT_EQ(error({.max_extent = {4096, 16}, .target = {VK_FORMAT_R8G8B8A8_UNORM, target}}), "compiled");
    EXPECT_EQ(error({.max_extent = {4097, 16}, .target = {VK_FORMAT_R8G8B8A8_UNORM, target}}),
              "size 4097x16: this device allows 1x1 to 4096x4096");
    EXPECT_EQ(
        error({.max_extent = {16, 16}, .target = {VK_FORMAT_B10G11R11_UFLOAT_PACK32, target}}),
        "compile: target.format = B10G11R11_UFLOAT_PACK32: allowed are colour formats that this device can render "
        "to or store; depth, integer and block-compressed ones are none");
    EXPECT_EQ(error({.max_extent = {16, 16}, .color = {VK_FORMAT_R16G16B16A16_UNORM, VK_IMAGE_USAGE_SAMPLED_BIT}}),
              "compile: color.format = R16G16B16A16_UNORM: allowed are formats that this device can sample, "
              "and none of integers");
}

}  // namespace
}  // namespace darkroom
