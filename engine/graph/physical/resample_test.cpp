// SPDX-License-Identifier: MIT
// What becomes of the texels of a history when the frame's extent changes, against the filter written out.
#include <gtest/gtest.h>

#include <cmath>

#include "graph/physical/test_physical.hpp"

namespace darkroom::graph::test {
namespace {

constexpr VkExtent2D largest{96, 64};
constexpr float junk = 50.0F;  ///< beyond the region: the rest of some larger frame

/// A history of `format`, half the frame's size, with whatever the test puts into it.
struct Bed {
    gpu::Context& context;
    VkFormat format;
    std::uint32_t mip_levels;
    std::optional<Compiled> compiled{};
    std::optional<Schedule> schedule{};
    Physical physical{};

    Bed(VkFormat of_format, std::uint32_t levels, gpu::Context& on = gpu::test::context())
        : context(on), format(of_format), mip_levels(levels) {
        Graph graph;
        const Graph::History history = graph.history(
            {.name = "trail", .format = format, .size = Size::fraction(2), .mip_levels = mip_levels}, {.owner = 1});
        graph.keep(graph.add({.name = "write",
                              .reads = {{history.previous, Use::SampledCompute}},
                              .writes = {{history.current, Use::StorageWrite}}})[0]);
        compiled = gpu::test::must(graph.compile(largest, measure_on(context)));
        schedule.emplace(*compiled);
        physical = gpu::test::must(Physical::create(context, *compiled));
    }

    [[nodiscard]] VkExtent2D region(VkExtent2D frame, std::uint32_t mip) const {
        return mip_extent(Size::fraction(2).of(frame), mip);
    }
    [[nodiscard]] const gpu::Image& previous() const { return physical.history(0)->images[1 - (physical.frame() & 1)]; }

    /// Copies every level of the previous image from, or to, one buffer after the other.
    void transfer(std::span<const gpu::Buffer> buffers, bool is_upload) const {
        gpu::test::must(gpu::submit_and_wait(context, "a transfer of a test", [&](VkCommandBuffer commands) {
            constexpr VkImageLayout rest = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
            constexpr VkImageLayout source = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
            constexpr VkImageLayout target = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
            const gpu::Image& image = previous();
            gpu::transition(context, commands, image, is_upload ? VK_IMAGE_LAYOUT_UNDEFINED : rest,
                            is_upload ? target : source);
            for (std::uint32_t mip = 0; mip < mip_levels; ++mip) {
                const VkExtent2D extent = region(largest, mip);
                const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1},
                                             .imageExtent = {extent.width, extent.height, 1}};
                const VkBuffer buffer = buffers[mip].handle;
                if (is_upload) {
                    context.vk.CmdCopyBufferToImage(commands, buffer, image.handle, target, 1, &copy);
                } else {
                    context.vk.CmdCopyImageToBuffer(commands, image.handle, source, buffer, 1, &copy);
                }
            }
            gpu::transition(context, commands, image, is_upload ? target : source, rest);
        }));
    }

    [[nodiscard]] std::vector<gpu::Buffer> buffers(gpu::Memory::Kind kind) const {
        std::vector<gpu::Buffer> made;
        for (std::uint32_t mip = 0; mip < mip_levels; ++mip) {
            const VkExtent2D extent = region(largest, mip);
            made.push_back(gpu::test::must(gpu::Buffer::create(
                context, std::size_t{4} * extent.width * extent.height,
                VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, kind, "test")));
        }
        return made;
    }

    /// What the last frame, of the extent `frame`, left: texel(x, y, mip), and junk around it. Four bytes a texel.
    template <class Texel, class Function>
    void put(VkExtent2D frame, Texel around, const Function& texel) const {
        const std::vector<gpu::Buffer> staging = buffers(gpu::Memory::Kind::Upload);
        for (std::uint32_t mip = 0; mip < mip_levels; ++mip) {
            const VkExtent2D whole = region(largest, mip), inside = region(frame, mip);
            auto* const texels = reinterpret_cast<Texel*>(staging[mip].memory.mapped);
            for (std::uint32_t y = 0; y < whole.height; ++y) {
                for (std::uint32_t x = 0; x < whole.width; ++x) {
                    const bool is_inside = x < inside.width && y < inside.height;
                    texels[std::size_t{y} * whole.width + x] = is_inside ? texel(x, y, mip) : around;
                }
            }
        }
        transfer(staging, true);
        wrote(frame);
    }
    void wrote(VkExtent2D frame) const {
        physical.histories().now.extents = frame;
        physical.history(0)->last_written = physical.histories().now.recordings;
    }

    /// The beginning of a frame.
    void begin(VkCommandBuffer commands, const gpu::Dispatch& vk, VkExtent2D extent) {
        physical.prepare(extent, true);
        schedule->derive({}, {}, physical.frame());
        physical.begin(commands, vk, *schedule);
    }
    void resample(VkExtent2D to) {
        gpu::test::must(gpu::submit_and_wait(context, "resampling",
                                             [&](VkCommandBuffer commands) { begin(commands, context.vk, to); }));
    }

    /// Calls visit(value, x, y, mip) for what the next frame gets as previous.
    template <class Texel, class Visit>
    void get(VkExtent2D frame, const Visit& visit) const {
        const std::vector<gpu::Buffer> staging = buffers(gpu::Memory::Kind::Readback);
        transfer(staging, false);
        for (std::uint32_t mip = 0; mip < mip_levels; ++mip) {
            const VkExtent2D whole = region(largest, mip), inside = region(frame, mip);
            const auto* const texels = reinterpret_cast<const Texel*>(staging[mip].memory.mapped);
            for (std::uint32_t y = 0; y < inside.height; ++y) {
                for (std::uint32_t x = 0; x < inside.width; ++x)
                    visit(texels[std::size_t{y} * whole.width + x], x, y, mip);
            }
        }
    }
};

struct Change {
    VkExtent2D from, to;
};
// Up, down, one direction each, odd sizes, the whole image, one texel.
constexpr std::array<Change, 8> changes{{{{61, 35}, {83, 47}},
                                         {{83, 47}, {61, 35}},
                                         {{61, 47}, {83, 35}},
                                         {{96, 64}, {95, 63}},
                                         {{95, 63}, {96, 64}},
                                         {{50, 30}, {96, 64}},
                                         {{2, 2}, {90, 7}},
                                         {{90, 7}, {2, 2}}}};

/// The texel on the axis at which a texel of the target looks: where its centre lies, inside the region.
double place(std::uint32_t target, std::uint32_t from, std::uint32_t to) {
    const double centre = (target + 0.5) * from / to - 0.5;
    return std::clamp(centre, 0.0, from - 1.0);
}

}  // namespace

TEST(GraphPhysicalResample, AGradientGoesOnWithinHalfACode) {
    if (!gpu::test::context().is_filterable(VK_FORMAT_R32_SFLOAT))
        GTEST_SKIP() << "this device filters no floats of 32 bits: a history of them keeps its nearest texels";
    for (const Change& change : changes) {
        SCOPED_TRACE(
            fmt::format("{}x{} to {}x{}", change.from.width, change.from.height, change.to.width, change.to.height));
        Bed bed(VK_FORMAT_R32_SFLOAT, 3);
        const auto gradient = [](double x, double y, std::uint32_t mip) {
            return 0.1 + 0.3 * mip + 0.01 * x + 0.005 * y;
        };
        bed.put<float>(change.from, junk, [&](std::uint32_t x, std::uint32_t y, std::uint32_t mip) {
            return static_cast<float>(gradient(x, y, mip));
        });
        bed.resample(change.to);
        double worst = 0;
        bed.get<float>(change.to, [&](float value, std::uint32_t x, std::uint32_t y, std::uint32_t mip) {
            const VkExtent2D from = bed.region(change.from, mip), to = bed.region(change.to, mip);
            const double wanted = gradient(place(x, from.width, to.width), place(y, from.height, to.height), mip);
            worst = std::max(worst, std::abs(value - wanted));
        });
        EXPECT_LT(worst, 0.5 / 255);
    }
}

TEST(GraphPhysicalResample, IntegersKeepTheirNearestTexel) {
    Bed bed(VK_FORMAT_R32_UINT, 1);
    constexpr Change change{{14, 10}, {22, 18}};  // 7x5 to 11x9: no centre lies between two texels.
    bed.put<std::uint32_t>(change.from, 999999u,
                           [](std::uint32_t x, std::uint32_t y, std::uint32_t) { return 1000 * y + x; });
    bed.resample(change.to);
    bed.get<std::uint32_t>(change.to, [](std::uint32_t value, std::uint32_t x, std::uint32_t y, std::uint32_t) {
        EXPECT_EQ(value, 1000 * ((2 * y + 1) * 5 / 18) + (2 * x + 1) * 7 / 22) << x << ", " << y;
    });
}

TEST(GraphPhysicalResample, WhatCannotBeBlittedStartsFromZero) {
    static PFN_vkGetPhysicalDeviceFormatProperties ask;
    // Of its own: a context asks for a format once.
    const Device own = gpu::test::must(Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"}));
    gpu::Context& context = own.context();
    ask = context.vk.GetPhysicalDeviceFormatProperties;
    context.vk.GetPhysicalDeviceFormatProperties = [](VkPhysicalDevice device, VkFormat format,
                                                      VkFormatProperties* properties) {
        ask(device, format, properties);
        properties->optimalTilingFeatures &= ~VkFormatFeatureFlags{VK_FORMAT_FEATURE_BLIT_DST_BIT};
    };
    Bed bed(VK_FORMAT_R32_SFLOAT, 2, context);
    context.vk.GetPhysicalDeviceFormatProperties = ask;
    static std::uint32_t clears, blits;
    clears = blits = 0;
    gpu::Dispatch counting = context.vk;
    counting.CmdPipelineBarrier2 = [](VkCommandBuffer, const VkDependencyInfo*) {};
    counting.CmdClearColorImage = [](VkCommandBuffer, VkImage, VkImageLayout, const VkClearColorValue*, std::uint32_t,
                                     const VkImageSubresourceRange*) { ++clears; };
    counting.CmdBlitImage = [](VkCommandBuffer, VkImage, VkImageLayout, VkImage, VkImageLayout, std::uint32_t,
                               const VkImageBlit*, VkFilter) { ++blits; };
    bed.wrote({50, 30});
    bed.begin(VK_NULL_HANDLE, counting, {60, 40});
    EXPECT_EQ(clears, 2u);
    EXPECT_EQ(blits, 0u);
}

}  // namespace darkroom::graph::test
