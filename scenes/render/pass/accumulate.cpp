// SPDX-License-Identifier: MIT
#include "render/pass/accumulate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/assert.hpp"
#include "render/shader_text.hpp"

namespace darkroom::render {

namespace {

constexpr VkFormat sum_format = VK_FORMAT_R32G32B32A32_SFLOAT;

gpu::KernelSpec accumulating(std::vector<std::string> images, VkFormat output, std::string_view shade) {
    // shader_text() begins with a version line, which kernels have of their own.
    const std::string text = shader_text("accumulate.glsl");
    gpu::KernelSpec spec{.name = "scene accumulation",
                         .images = {},
                         .outputs = {output},
                         .is_whole = true,
                         .frame = {},
                         .members = {},
                         .custom_vectors = 1,
                         .body = text.substr(text.find("#line"))};
    for (std::string& name : images) spec.images.push_back({.name = std::move(name)});
    spec.body += "vec4 shade(Pixel pixel) { return ";
    spec.body += shade;
    spec.body += "; }\n";
    return spec;
}

gpu::Region whole(const gpu::Image& image) {
    const VkExtent2D size{image.info.extent.width, image.info.extent.height};
    return {.extent = size, .image = size};
}

gpu::Binding bound(const gpu::Image& image) { return {.view = image.view, .region = whole(image), .is_nearest = true}; }

}  // namespace

std::vector<scene::vec2> positions_in_pixel(std::uint32_t count) {
    // Points of an even lattice lie between the rows and columns of the next odd one, whose origin is left out.
    const auto half = static_cast<std::int32_t>(count / 2), size = 2 * half + 1;
    const bool has_centre = count % 2 == 1;
    const auto coprime = [&](double share) {
        auto step = static_cast<std::int32_t>(std::lround(size * share));
        while (std::gcd(step, size) != 1) ++step;
        return step;
    };
    // The golden ratio spreads the places; the order has another, so that it goes with no other spiral by that one.
    const std::int32_t down = coprime(0.6180339887498949), next = coprime(0.4142135623730951);
    const auto centred = [&](std::int32_t cell) { return (cell % size + size + half) % size - half; };
    const auto place = [&](std::int32_t cell) {
        const float shift = has_centre || cell == 0 ? 0.0F : std::copysign(0.5F, static_cast<float>(cell));
        return (static_cast<float>(cell) - shift) / static_cast<float>(count);
    };
    std::vector<scene::vec2> out;
    for (std::int32_t i = 0; i < size; ++i) {
        const std::int32_t x = centred(i * next), y = centred(x * down);
        if (x == 0 && !has_centre) continue;
        out.emplace_back(place(x), place(y));
    }
    std::ranges::iter_swap(out.begin(),
                           std::ranges::min_element(out, {}, [](scene::vec2 at) { return glm::dot(at, at); }));
    return out;
}

Result<Accumulate> Accumulate::create(gpu::Context& context, VkFormat color, std::uint32_t positions, bool is_weighed) {
    DARKROOM_ASSERT(positions >= 2 && positions <= scene::max_samples);
    Accumulate out;
    out.context_ = &context;
    out.positions_ = positions;
    out.is_weighed_ = is_weighed;
    const auto make = [&](std::unique_ptr<gpu::Kernel>& kernel, gpu::KernelSpec spec) -> Result<> {
        spec.workgroup = gpu::usual_workgroup(context);
        DARKROOM_TRY_VALUE(kernel, gpu::Kernel::create(context, spec, gpu::preferred_stage(context, spec)));
        return {};
    };
    const std::string drawn = "drawn_color", sum = "sum";
    Result<> made = make(out.first_, accumulating({drawn}, sum_format, "weighed(load(drawn_color, pixel.texel))"));
    if (made)
        made = make(out.next_, accumulating({drawn, sum}, sum_format,
                                            "load(sum, pixel.texel) + weighed(load(drawn_color, pixel.texel))"));
    if (made) made = make(out.mean_, accumulating({sum}, color, "unweighed(load(sum, pixel.texel))"));
    if (!made) return failure(std::move(made));
    const std::array layouts{out.first_->set_layout(), out.next_->set_layout(), out.next_->set_layout(),
                             out.mean_->set_layout()};
    DARKROOM_TRY_VALUE(out.sets_, gpu::DescriptorSets::create(context, layouts));
    const VkDeviceSize alignment = context.traits.uniform_alignment;
    // That of the form with the most images is the largest.
    out.block_stride_ = (gpu::own_block_size(out.next_->spec()) + alignment - 1) / alignment * alignment;
    DARKROOM_TRY_VALUE(out.blocks_,
                       gpu::Buffer::create(context, out.block_stride_ * layouts.size(), gpu::block_usage,
                                           gpu::Memory::Kind::Constants, "blocks of the scene's accumulation"));
    return out;
}

Result<> Accumulate::resize(const Targets& targets) {
    const VkExtent3D extent = targets.color.info.extent;
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    if (context_->supports(sum_format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    std::array<gpu::Image, 2> larger;
    for (gpu::Image& sum : larger) {
        DARKROOM_TRY_VALUE(
            sum, gpu::Image::create(*context_,
                                    {.name = "scene sum", .format = sum_format, .extent = extent, .usage = usage}));
    }
    sums_ = std::move(larger);
    const gpu::Binding color = bound(targets.color);
    const std::array sums{bound(sums_[0]), bound(sums_[1])};
    const std::array<std::array<float, 4>, 1> custom{
        std::array{1 / static_cast<float>(positions_), is_weighed_ ? 1.0F : 0.0F, 0.0F, 0.0F}};
    const auto write = [&](const gpu::Kernel& kernel, std::size_t set, std::span<const gpu::Binding> images,
                           const gpu::Binding& output) {
        const gpu::Kernel::Block block{blocks_.handle, set * block_stride_, gpu::own_block_size(kernel.spec())};
        gpu::write_own_block(kernel.spec(), output.region, images, custom, {},
                             {blocks_.memory.mapped + block.offset, block.size});
        kernel.write_set({.set = sets_.sets[set], .own = block, .images = images, .outputs = {&output, 1}});
    };
    write(*first_, 0, {&color, 1}, sums[0]);
    write(*next_, 1, std::array{color, sums[1]}, sums[0]);
    write(*next_, 2, std::array{color, sums[0]}, sums[1]);
    write(*mean_, 3, {&sums[(positions_ - 1) % 2], 1}, color);
    return {};
}

void Accumulate::record(VkCommandBuffer commands, const gpu::Image& color, VkImageLayout from,
                        std::uint32_t place) const {
    const gpu::Kernel& kernel = place == 0 ? *first_ : *next_;
    const gpu::Image& to = sums_[place % 2];
    gpu::transition(*context_, commands, color, from, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    gpu::transition(*context_, commands, to, VK_IMAGE_LAYOUT_UNDEFINED, use_of(kernel).write_layout);
    kernel.record(commands, sets_.sets[place == 0 ? 0 : 1 + place % 2], std::array{bound(to)});
    gpu::transition(*context_, commands, to, use_of(kernel).write_layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

void Accumulate::record_mean(VkCommandBuffer commands, const gpu::Image& color) const {
    gpu::transition(*context_, commands, color, VK_IMAGE_LAYOUT_UNDEFINED, use().write_layout);
    mean_->record(commands, sets_.sets[3], std::array{bound(color)});
}

ResolveUse Accumulate::use() const { return use_of(*mean_); }

}  // namespace darkroom::render
