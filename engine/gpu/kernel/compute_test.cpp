// SPDX-License-Identifier: MIT
// Compute passes: bodies of their own with shared memory, buffers, and several mip levels of an image at once.
#include <gtest/gtest.h>

#include <cstring>

#include "gpu/test_run.hpp"

namespace darkroom::gpu::test {
namespace {

constexpr VkFormat float4 = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkExtent2D extent{53, 37};
constexpr std::uint32_t bins = 64;

/// Each group counts its part in shared memory, then adds that to the whole.
constexpr std::string_view histogram_body = R"(
shared uint histogram_part[64];
void run() {
    if (gl_LocalInvocationIndex < 64u) histogram_part[gl_LocalInvocationIndex] = 0u;
    barrier();
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, size(scene))))
        atomicAdd(histogram_part[uint(clamp(load(scene, texel).r * 64.0, 0.0, 63.0))], 1u);
    barrier();
    if (gl_LocalInvocationIndex < 64u) atomicAdd(counts[gl_LocalInvocationIndex], histogram_part[gl_LocalInvocationIndex]);
}
)";

KernelSpec histogram_spec() {
    return {.name = "histogram",
            .images = {{.name = "scene"}},
            .outputs = {},
            .buffers = {{.name = "counts", .is_written = true}},
            .compute = ComputeBody{.outputs = {}, .shared_bytes = 4 * bins},
            .body = std::string(histogram_body),
            .workgroup = {16, 8}};
}

Pixels scene_of() {
    return make_pixels(extent.width, extent.height, [](std::uint32_t x, std::uint32_t y) {
        return std::array{static_cast<float>((x * 31 + y * 17) % 97) / 96.0F, 0.0F, 0.0F, 1.0F};
    });
}

}  // namespace

TEST(GpuCompute, HistogramCountsAsTheCpuDoes) {
    Context& context = test::context();
    const KernelSpec spec = histogram_spec();
    const auto kernel = must(Kernel::create(context, spec, Stage::Compute));
    const Pixels pixels = scene_of();
    const Picture scene = upload(context, pixels, float4, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    const Buffer counts =
        must(Buffer::create(context, 4 * bins, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::Kind::Upload, "counts"));
    std::memset(counts.memory.mapped, 0, 4 * bins);
    const std::size_t size = own_block_size(spec);
    const Buffer own = must(Buffer::create(context, size, block_usage, Memory::Kind::Upload, "test block"));
    const Binding image{.view = scene.image.mip_views[0], .region = scene.whole(), .is_nearest = true};
    write_own_block(spec, {.extent = extent, .image = extent}, {&image, 1}, {}, {}, {own.memory.mapped, size});
    const VkDescriptorSetLayout layout = kernel->set_layout();
    const DescriptorSets sets = must(DescriptorSets::create(context, {&layout, 1}));
    const Kernel::Block buffer{counts.handle, 0, 4 * bins};
    kernel->write_set({.set = sets.sets[0],
                       .own = {own.handle, 0, size},
                       .images = {&image, 1},
                       .outputs = {},
                       .buffers = {&buffer, 1}});
    must(submit_and_wait(context, "counting", [&](VkCommandBuffer commands) {
        kernel->record_groups(commands, sets.sets[0], {(extent.width + 15) / 16, (extent.height + 7) / 8});
    }));
    std::array<std::uint32_t, bins> expected{}, found{};
    for (std::uint32_t y = 0; y < extent.height; ++y)
        for (std::uint32_t x = 0; x < extent.width; ++x)
            ++expected[static_cast<std::size_t>(std::min(pixels.at(x, y)[0] * 64.0F, 63.0F))];
    std::memcpy(found.data(), counts.memory.mapped, sizeof found);
    EXPECT_EQ(found, expected);
}

TEST(GpuCompute, WritesMipLevelsOfTheirOwnExtents) {
    Context& context = test::context();
    const KernelSpec spec{.name = "levels",
                          .images = {},
                          .outputs = {float4, float4},
                          .compute = ComputeBody{.outputs = {"fine", "coarse"}},
                          .body =
                              "void run() {\n"
                              "    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);\n"
                              "    if (all(lessThan(texel, size(fine)))) store(fine, texel, vec4(size(fine), texel));\n"
                              "    if (all(lessThan(texel, size(coarse))))\n"
                              "        store(coarse, texel, vec4(size(coarse), texel));\n}\n",
                          .workgroup = {8, 8}};
    const auto kernel = must(Kernel::create(context, spec, Stage::Compute));
    std::array pictures{blank(context, extent, float4), blank(context, {26, 18}, float4)};
    std::array<Binding, 2> outputs;
    for (std::size_t i = 0; i < 2; ++i)
        outputs[i] = {.view = pictures[i].image.mip_views[0], .region = pictures[i].whole()};
    const std::size_t size = own_block_size(spec);
    const Buffer own = must(Buffer::create(context, size, block_usage, Memory::Kind::Upload, "test block"));
    write_own_block(spec, {.extent = extent, .image = extent}, {}, {}, {}, {own.memory.mapped, size}, outputs);
    const VkDescriptorSetLayout layout = kernel->set_layout();
    const DescriptorSets sets = must(DescriptorSets::create(context, {&layout, 1}));
    kernel->write_set({.set = sets.sets[0], .own = {own.handle, 0, size}, .images = {}, .outputs = outputs});
    must(submit_and_wait(context, "two levels", [&](VkCommandBuffer commands) {
        for (Picture& picture : pictures) {
            transition(context, commands, picture.image, picture.layout, VK_IMAGE_LAYOUT_GENERAL);
            picture.layout = VK_IMAGE_LAYOUT_GENERAL;
        }
        kernel->record_groups(commands, sets.sets[0], {7, 5});
    }));
    EXPECT_EQ(download(context, pictures[0]).at(52, 36)[0], 53.0F);
    EXPECT_EQ(download(context, pictures[0]).at(52, 36)[2], 52.0F);
    EXPECT_EQ(download(context, pictures[1]).at(25, 17)[0], 26.0F);
    EXPECT_EQ(download(context, pictures[1]).at(25, 17)[3], 17.0F);
}

TEST(GpuCompute, SaysWhatADeviceLacks) {
    Context& context = test::context();
    KernelSpec spec = histogram_spec();
    EXPECT_FALSE(usable(context, spec, Stage::Raster));
    EXPECT_EQ(preferred_stage(context, spec), Stage::Compute);
    spec.compute->shared_bytes = 1u << 30;
    const auto lacks_memory = usable(context, spec, Stage::Compute);
    ASSERT_FALSE(lacks_memory);
    EXPECT_EQ(lacks_memory.error().text,
              fmt::format("kernel \"histogram\" (compute): 1073741824 bytes of shared memory; the device has {}",
                          context.traits.max_shared_bytes));
    spec = histogram_spec();
    spec.workgroup = {1u << 20, 1};
    EXPECT_FALSE(usable(context, spec, Stage::Compute));
}

}  // namespace darkroom::gpu::test
