// SPDX-License-Identifier: MIT
// The images that a plan knows: those of the host, neutral ones, what may stand behind each, and how a kernel reads it.

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "gpu/resource/formats.hpp"
#include "plan/planner/planner_state.hpp"
#include "plan/text/half.hpp"

namespace darkroom::plan {

namespace {

/// Which of four distances is closest to the eye: the smallest number, or the largest.
void depth_constants(const void*, const PassContext& context, std::span<PassVector> out) {
    out[0] = {context.camera->depth == DepthKind::Reversed ? 1.0f : 0.0f, 0, 0, 0};
}

/// A motion in pixels is one in the pixels of its image.
void velocity_constants(const void*, const PassContext& context, std::span<PassVector> out) {
    const bool is_in_pixels = context.camera->velocity.unit == VelocityKind::Unit::Pixels;
    const auto ratio = [&](std::uint32_t made, std::uint32_t given) {
        return is_in_pixels ? static_cast<float>(made) / static_cast<float>(given) : 1.0f;
    };
    out[0] = {ratio(context.output_extent.width, context.scene_extent.width),
              ratio(context.output_extent.height, context.scene_extent.height), 1, 1};
}

ConstantsFunction constants_of(Resampling resampling) {
    return resampling == Resampling::Closest  ? depth_constants
           : resampling == Resampling::Motion ? velocity_constants
                                              : nullptr;
}

}  // namespace

std::string size_text(graph::Size size) {
    if (size.width != 0) return fmt::format("{}x{}", size.width, size.height);
    return fmt::format("{}/{}{}", size.numerator, size.denominator,
                       size.extent == graph::Extent::Output ? " of the output" : "");
}

std::string Planner::own_name(const std::string& name) {
    std::string own = name;
    for (std::uint32_t number = 2; !image_names_.insert(own).second; ++number) own = fmt::format("{}#{}", name, number);
    return own;
}

graph::Version Planner::create_picture(const std::string& name, graph::Size size, VkFormat format) {
    const graph::ImageDesc desc{.name = own_name(name), .format = format, .size = size};
    const graph::Version image = program_.graph.create(desc);
    facts_[image.index] = {
        .root = image.index, .size = size, .format = format, .usage = own_usage, .fall_backs = {}, .name = desc.name};
    return image;
}

graph::Version Planner::import_host(HostImage image, const std::string& name, const ImageUse& use, graph::Size size) {
    if (const auto found = host_images_.find(image); found != host_images_.end()) return found->second;
    program_.imports.emplace_back(image);
    const graph::ImageDesc desc{.name = own_name(name), .format = use.format, .size = size};
    const graph::Version version = program_.graph.import({.image = desc, .usage = use.usage});
    host_images_[image] = version;
    facts_[version.index] = {.root = version.index,
                             .size = size,
                             .format = use.format,
                             .usage = use.usage,
                             .fall_backs = {},
                             .name = desc.name};
    return version;
}

graph::Version Planner::import_input(const FrameInput& input) {
    const graph::Size size = input.extent == InputExtent::Scene   ? graph::Size{}
                             : input.extent == InputExtent::Texel ? graph::Size{.width = 1, .height = 1}
                                                                  : frame_output();
    const graph::Version version =
        import_host(host_input(input.image), std::string(input.name), desc_.*input.use, size);
    facts_[version.index].is_single = input.extent == InputExtent::Texel;
    return version;
}

/// One texel, in the format of the images it stands in for where that holds the value.
graph::Version Planner::import_neutral(VkFormat format, const PassVector& value) {
    TableDesc desc{.name = "neutral", .format = VK_FORMAT_R32G32B32A32_SFLOAT};
    const auto put = [&](const auto& texel) {
        desc.data.resize(sizeof texel);
        std::memcpy(desc.data.data(), &texel, sizeof texel);
    };
    put(value);
    std::array<std::optional<std::uint16_t>, 4> halves;
    std::ranges::transform(value, halves.begin(), exact_half);
    if (format == VK_FORMAT_R32_SFLOAT) {
        desc.format = format;
        put(value[0]);
    } else if (format == VK_FORMAT_R16G16B16A16_SFLOAT &&
               std::ranges::all_of(halves, [](auto h) { return h.has_value(); })) {
        desc.format = format;
        put(std::array{*halves[0], *halves[1], *halves[2], *halves[3]});
    }
    const graph::Version version = import_constant(std::move(desc), {.width = 1, .height = 1});
    facts_[version.index].size = {};
    facts_[version.index].is_single = true;
    return version;
}

graph::Version Planner::import_constant(TableDesc desc, graph::Size size) {
    constexpr VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
    const graph::ImageDesc image{.name = desc.name, .format = desc.format, .size = size};
    program_.fixed_images.push_back(
        {.desc = std::move(desc), .import_index = static_cast<std::uint32_t>(program_.imports.size())});
    program_.imports.emplace_back(std::nullopt);
    const graph::Version version = program_.graph.import({.image = image, .usage = usage, .is_constant = true});
    facts_[version.index] = {.root = version.index, .size = size, .format = image.format, .usage = usage};
    return version;
}

void Planner::fall_back(graph::Version version, graph::Version instead) {
    program_.graph.fall_back(version, instead);
    facts_[version.index].fall_backs.push_back(instead);
}

gpu::KernelImage Planner::kernel_image(std::string name, const PassInput& input) const {
    if (input.is_shadow_map) return {.name = std::move(name), .sampler_type = "sampler2DArrayShadow"};
    if (input.table == no_table)
        return {.name = std::move(name),
                .is_single = input.version.is_valid() && facts_.at(input.version.index).is_single};
    const TableDesc& desc = program_.fixed_images[input.table].desc;
    return {.name = std::move(name),
            .storage_format = desc.is_load_only ? desc.format : VK_FORMAT_UNDEFINED,
            .sampler_type = desc.extent.depth > 1 ? "sampler3D" : "sampler2D"};
}

/// The images that may stand behind a version, by the version they began as.
void Planner::collect_roots(graph::Version version, std::vector<std::uint32_t>& roots) const {
    const Facts& facts = facts_.at(version.index);
    roots.push_back(facts.root);
    for (const graph::Version instead : facts.fall_backs) collect_roots(instead, roots);
}

bool Planner::may_share(graph::Version a, graph::Version b) const {
    std::vector<std::uint32_t> of_a, of_b;
    collect_roots(a, of_a);
    collect_roots(b, of_b);
    return std::ranges::find_first_of(of_a, of_b) != of_a.end();
}

/// The format for imageLoad where every image that may stand behind `version` has it and the device can, else
/// UNDEFINED: sampled.
VkFormat Planner::storage_format(graph::Version version) const {
    const Facts& facts = facts_.at(version.index);
    if ((facts.usage & VK_IMAGE_USAGE_STORAGE_BIT) == 0 || gpu::format_traits(facts.format).glsl_qualifier.empty())
        return VK_FORMAT_UNDEFINED;
    if (traits_.can_load && !traits_.can_load(facts.format)) return VK_FORMAT_UNDEFINED;
    for (const graph::Version instead : facts.fall_backs)
        if (storage_format(instead) != facts.format) return VK_FORMAT_UNDEFINED;
    return facts.format;
}

Result<graph::Version> Planner::input_at_size(const FrameInput& input, graph::Size size) {
    const graph::Version version = import_input(input);
    if (input.extent == InputExtent::Texel || has_size(version, size)) return version;
    const FrameImage which = input.image;
    if (const auto found = resampled_.find({which, size}); found != resampled_.end()) return found->second;
    const VkFormat format = input.resampled == VK_FORMAT_UNDEFINED ? desc_.intermediate : input.resampled;
    const std::string name = fmt::format("{} at {}", input.name, size_text(size));
    kernels_.push_back({.picture = version,
                        .size = size,
                        .boundary = "it is read behind a picture of another size",
                        .resampling = input.resampling,
                        .constants = constants_of(input.resampling)});
    auto out = close_kernel(kernels_.size() - 1, create_picture(name, size, format), format, Finish::None, true);
    if (out) resampled_.emplace(std::pair(which, size), *out);
    return out;
}

}  // namespace darkroom::plan
