// SPDX-License-Identifier: MIT
// Dynamic resolution and sub-rectangles: compiled once at the largest extent, recorded at any smaller one.

#include <limits>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using test::add;

class ComposeResolution : public test::StackTest {};

constexpr VkExtent2D largest{150, 110};

ReferenceImage picture_of(VkExtent2D extent) {
    ReferenceImage picture = test::random_display(extent.width, extent.height, extent.width * 7 + extent.height);
    for (Rgba& p : picture.pixels) p = {p.r * 2, p.g * 2, p.b * 2, 1};
    return test::round_to_float(picture);
}
void fill(Composer& composer) {
    add(composer, "bloom", {{"intensity", 0.5}, {"threshold", 0.5}}, {.source = scene_color});
    add(composer, "exposure", {{"exposure", 0.5}});
    add(composer, "gaussian_blur", {{"radius", 3}});
    add(composer, "tonemap");
    add(composer, "encode");
    add(composer, "dither");
    add(composer, "vignette");
}
/// A compile at the size of the picture itself.
ReferenceImage expected_of(const test::Host& host, const CompileDesc& like) {
    Composer composer(host.device);
    fill(composer);
    CompileDesc desc = like;
    desc.max_extent = host.compile_desc().max_extent;
    test::must(composer.compile(desc));
    return host.run(composer);
}

/// The edge of a region is mixed with one of the sampler's steps of the texel inside (gpu/kernel/kernel_source.cpp). Of
/// 8 bits that is within the bounds of these tests; a device may have fewer.
double edge_step() {
    const std::uint32_t bits = gpu::test::limits().subTexelPrecisionBits;
    return bits < 8 ? std::ldexp(1.0, -static_cast<int>(bits)) : 0;
}

TEST_F(ComposeResolution, EveryExtentEqualsACompileAtThatSize) {
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        Composer composer(gpu::test::device());
        fill(composer);
        CompileDesc desc = test::Host(picture_of({1, 1})).compile_desc();
        desc.max_extent = largest;
        desc.kernels = stage;
        test::must(composer.compile(desc));
        for (const VkExtent2D extent :
             {VkExtent2D{75, 55}, {150, 110}, {33, 29}, {149, 109}, {16, 16}, {31, 7}, {1, 1}, {150, 1}, {64, 64}}) {
            SCOPED_TRACE(std::to_string(extent.width) + "x" + std::to_string(extent.height));
            const test::Host host(picture_of(extent));
            const ReferenceImage out = host.run(composer);
            // The pyramid is in half floats, and its texel coordinates are rounded elsewhere in a larger image.
            EXPECT_LE(test::worst_difference(out, expected_of(host, desc)), 1e-3 + edge_step());
        }
    }
}

/// `inner` at (x, y) in a larger picture of `around`.
ReferenceImage framed(const ReferenceImage& inner, VkOffset2D at, VkExtent2D extent, Rgba around) {
    ReferenceImage out(extent.width, extent.height, around);
    for (std::uint32_t y = 0; y < inner.height; ++y)
        for (std::uint32_t x = 0; x < inner.width; ++x)
            out.at(x + static_cast<std::uint32_t>(at.x), y + static_cast<std::uint32_t>(at.y)) = inner.at(x, y);
    return out;
}

TEST_F(ComposeResolution, NothingLeaksIntoOrOutOfARegion) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const ReferenceImage picture = picture_of({75, 53});
    const VkOffset2D color_at{13, 7}, target_at{5, 31};
    const Rgba untouched{0.125, 0.25, 0.5, 0.75};
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        for (const bool is_fused : {true, false}) {
            const test::Host whole(picture);
            CompileDesc desc = whole.compile_desc();
            desc.kernels = stage;
            desc.fuse = is_fused;
            const ReferenceImage expected = expected_of(whole, desc);

            const test::Host host(framed(picture, color_at, {140, 90}, {nan, nan, nan, nan}));
            const gpu::test::Picture target =
                gpu::test::upload(host.device.context(), test::pixels_of(test::uniform(101, 97, untouched)),
                                  VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
            Composer composer(host.device);
            fill(composer);
            desc.max_extent = {99, 88};
            test::must(composer.compile(desc));
            test::must(host.record(composer, {.color = test::image_ref(host.color, {color_at, {75, 53}}),
                                              .target = test::image_ref(target, {target_at, {75, 53}})}));
            const ReferenceImage out = test::image_of(gpu::test::download(host.device.context(), target));
            ReferenceImage inside(75, 53);
            for (std::uint32_t y = 0; y < out.height; ++y) {
                for (std::uint32_t x = 0; x < out.width; ++x) {
                    const Rgba& p = out.at(x, y);
                    if (x >= 5 && x < 80 && y >= 31 && y < 84)
                        inside.at(x - 5, y - 31) = p;
                    else
                        ASSERT_TRUE(p.r == untouched.r && p.g == untouched.g && p.b == untouched.b &&
                                    p.a == untouched.a)
                            << x << " " << y;
                }
            }
            EXPECT_LE(test::worst_difference(inside, expected), 1e-3 + edge_step());
        }
    }
}

TEST_F(ComposeResolution, ADifferentRegionEveryFrame) {
    const ReferenceImage large = picture_of(largest);
    const test::Host host(large);
    Composer composer(host.device);
    add(composer, "exposure", {{"exposure", 2}});
    test::must(composer.compile(host.compile_desc()));
    for (std::uint32_t i = 0; i < 6; ++i) {
        const VkRect2D region{{static_cast<std::int32_t>(3 * i), static_cast<std::int32_t>(5 * i + 1)},
                              {150 - 11 * i - 3 * i, 60 - 7 * i}};
        Frame frame = host.frame();
        frame.color.region = frame.target.region = region;
        test::must(host.record(composer, frame));
        const ReferenceImage out = host.read_target();
        const auto x = static_cast<std::uint32_t>(region.offset.x), y = static_cast<std::uint32_t>(region.offset.y);
        EXPECT_EQ(out.at(x, y).r, large.at(x, y).r * 2);
        const std::uint32_t right = x + region.extent.width - 1, bottom = y + region.extent.height - 1;
        EXPECT_EQ(out.at(right, bottom).b, large.at(right, bottom).b * 2);
    }
}

/// One level of one layer of an image with several.
class Layered {
  public:
    Layered(gpu::Context& owner, VkExtent2D extent, VkFormat format, std::uint32_t mip_level, std::uint32_t array_layer)
        : context_(owner), extent_(extent), mip_level_(mip_level), array_layer_(array_layer) {
        image_ =
            test::must(gpu::Image::create(owner, {.name = "layered",
                                                  .format = format,
                                                  .extent = {extent.width << mip_level, extent.height << mip_level, 1},
                                                  .mip_levels = mip_level + 2,
                                                  .array_layers = array_layer + 2,
                                                  .usage = gpu::test::all_usage(owner, format)}));
        const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                         .image = image_.handle,
                                         .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                         .format = format,
                                         .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, mip_level, 1, array_layer, 1}};
        test::must(owner.check(owner.vk.CreateImageView(owner.device, &info, nullptr, &view_), "view"));
    }
    Layered(const Layered&) = delete;
    Layered& operator=(const Layered&) = delete;
    ~Layered() { context_.vk.DestroyImageView(context_.device, view_, nullptr); }

    /// Copies from or to a picture of the same size and format that is in GENERAL. The whole image is in GENERAL after.
    void copy(const gpu::test::Picture& picture, bool is_upload) {
        test::must(gpu::submit_and_wait(context_, "copying a layer", [&](VkCommandBuffer commands) {
            const gpu::Image &from = is_upload ? picture.image : image_, &to = is_upload ? image_ : picture.image;
            gpu::transition(context_, commands, from, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
            gpu::transition(context_, commands, to, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
            const VkImageSubresourceLayers own{VK_IMAGE_ASPECT_COLOR_BIT, mip_level_, array_layer_, 1};
            const VkImageSubresourceLayers other{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            const VkImageCopy region{.srcSubresource = is_upload ? other : own,
                                     .dstSubresource = is_upload ? own : other,
                                     .extent = {extent_.width, extent_.height, 1}};
            context_.vk.CmdCopyImage(commands, from.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle,
                                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
            gpu::transition(context_, commands, from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
            gpu::transition(context_, commands, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
        }));
    }
    [[nodiscard]] ImageRef ref() const {
        return {.image = image_.handle,
                .view = view_,
                .format = image_.info.format,
                .extent = extent_,
                .mip_level = mip_level_,
                .array_layer = array_layer_,
                .layout = VK_IMAGE_LAYOUT_GENERAL,
                .final_layout = VK_IMAGE_LAYOUT_GENERAL};
    }

  private:
    gpu::Context& context_;
    VkExtent2D extent_;
    std::uint32_t mip_level_, array_layer_;
    gpu::Image image_;
    VkImageView view_ = VK_NULL_HANDLE;
};

TEST_F(ComposeResolution, OneLevelOfOneLayerOfTheHostsImages) {
    const test::Host host(picture_of({44, 36}));
    const CompileDesc desc = host.compile_desc();
    const ReferenceImage expected = expected_of(host, desc);
    for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
        Layered color(host.device.context(), {44, 36}, desc.color.format, 1, 1),
            target(host.device.context(), {44, 36}, desc.target.format, 2, 1);
        color.copy(host.color, true);
        target.copy(host.target, true);
        Composer composer(host.device);
        fill(composer);
        CompileDesc with = desc;
        with.kernels = stage;
        test::must(composer.compile(with));
        test::must(host.record(composer, {.color = color.ref(), .target = target.ref()}));
        target.copy(host.target, false);
        EXPECT_LE(test::worst_difference(host.read_target(), expected), gpu::test::code_between_kernels());
    }
}

}  // namespace
}  // namespace darkroom
