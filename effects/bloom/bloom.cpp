// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/bloom.hpp>
#include <string>

#include "bloom/bloom_reference.hpp"

namespace darkroom {

namespace {

constexpr auto bloom_rows = describe(
    field<&Bloom::intensity>(
        "How much of the glow is added; in the mode energy_conserving, how far the picture is mixed "
        "with it, where 1 and more mean wholly.",
        {0, 16})
        .as_amount(),
    field<&Bloom::threshold>("Light above this glows; not used in the mode energy_conserving.", {0, 65504}),
    field<&Bloom::soft_threshold>("Width of the soft knee as a part of the threshold: 0 is a hard edge.", {0, 1}),
    field<&Bloom::firefly_filter>("Averages the first level by inverse luminance, so that lone bright pixels do not "
                                  "flicker; not used in the mode energy_conserving, which keeps their light."),
    field<&Bloom::mode>("Whether the glow is added to the picture or mixed with it."),
    field<&Bloom::scatter>("Weight of each wider level relative to the one below it, in the mode energy_conserving.",
                           {0, 1}),
    field<&Bloom::levels>("Most levels of the pyramid that are used; small pictures have fewer.", {1, 5}));

constexpr std::uint32_t max_levels = 5;
constexpr float half_max = 65504.0f;

const Bloom& bloom_of(const void* parameters) { return *static_cast<const Bloom*>(parameters); }

std::uint32_t used_levels(const Bloom& bloom, VkExtent2D extent) {
    return std::min(bloom_level_count(extent), static_cast<std::uint32_t>(bloom.levels));
}

/// What a level is multiplied by when it is added onto the next finer one.
float gain(const Bloom& bloom) { return bloom.mode == BloomMode::Additive ? 1.0f : bloom.scatter; }

void prefilter_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Bloom& bloom = bloom_of(parameters);
    const std::uint32_t levels = std::max(used_levels(bloom, context.frame_extent), 1U);
    // The sum of all levels must stay finite in half precision. Of the 2 N - 1 writes on the longest way through the
    // pyramid all but the last may round up by 2^-11, and past 65504 a driver may write an infinity.
    const float most = half_max * (1.0f - static_cast<float>(levels - 1) * 0x1p-10f);
    if (bloom.mode == BloomMode::Additive) {
        out[0] = {bloom.threshold, bloom.threshold * bloom.soft_threshold, most / static_cast<float>(levels), 1.0f};
    } else {
        // Everything after this pass is linear, so the sum of the weights 1, s, s^2 ... is divided out here, once.
        float sum = 0.0f, weight = 1.0f;
        for (std::uint32_t level = 0; level < levels; ++level, weight *= bloom.scatter) sum += weight;
        out[0] = {0.0f, 0.0f, most, 1.0f / sum};
    }
    const bool is_filtered = bloom.firefly_filter && bloom.mode == BloomMode::Additive;
    out[1] = {is_filtered ? 1.0f : 0.0f, 0.0f, 0.0f, 0.0f};
}

void level_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Bloom& bloom = bloom_of(parameters);
    out[0] = {gain(bloom), static_cast<float>(used_levels(bloom, context.frame_extent)), 0.0f, 0.0f};
}

void end_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Bloom& bloom = bloom_of(parameters);
    const bool is_additive = bloom.mode == BloomMode::Additive;
    const bool glows = used_levels(bloom, context.frame_extent) > 0;
    out[0] = {glows ? is_additive ? bloom.intensity : std::min(bloom.intensity, 1.0f) : 0.0f, 0.0f, 0.0f, 0.0f};
}

/// Frames may be smaller than the largest one that the pyramid was made for.
bool is_level_used(const void* parameters, const PassContext& context, std::uint32_t level) {
    return level < used_levels(bloom_of(parameters), context.frame_extent);
}

/// A kernel for each level, on the way down and up again.
PassImage add_kernels(PassBuilder& builder, PassImage pyramid, std::uint32_t levels) {
    pyramid = builder.add({.name = "prefilter",
                           .shader = "bloom_prefilter.glsl",
                           .inputs = {{.name = "bloom_source", .image = builder.source(), .is_loaded = true}},
                           .output = pyramid,
                           .custom_vectors = 2,
                           .constants = prefilter_constants,
                           .condition = is_level_used,
                           .argument = 0});
    for (std::uint32_t level = 1; level < levels; ++level)
        pyramid = builder.add(
            {.name = "downsample " + std::to_string(level),
             .shader = level % 2 == 1 ? "bloom_downsample.glsl" : "bloom_downsample_texels.glsl",
             .inputs = {{.name = "bloom_above", .image = pyramid, .mip_level = level - 1, .is_loaded = true}},
             .output = pyramid,
             .output_mip_level = level,
             .condition = is_level_used,
             .argument = level});
    for (std::uint32_t level = levels - 1; level-- > 0;)
        pyramid = builder.add(
            {.name = "upsample " + std::to_string(level),
             .shader = "bloom_upsample.glsl",
             .inputs = {{.name = "bloom_below", .image = pyramid, .mip_level = level + 1, .is_loaded = true}},
             .output = pyramid,
             .output_mip_level = level,
             .is_additive = true,
             .custom_vectors = 1,
             .constants = level_constants,
             .condition = is_level_used,
             .argument = level + 1});
    return pyramid;
}

/// Shared memory of the three passes below, in bytes.
constexpr std::uint32_t narrow_bytes = 8 * 38 * 38, wide_bytes = 8 * (34 * 34 + 14 * 14),
                        join_bytes = 8 * (36 * 21 + 22 * 14);

/// The same arithmetic with the levels between in shared memory: levels 1 and 2 are made by one pass, 3 and 4 and their
/// sum with 2 by another, and the sum with 1 and 0 by a third.
PassImage add_tiles(PassBuilder& builder, PassImage pyramid, std::uint32_t levels, VkFormat format) {
    const auto add = [&](ComputePassDesc pass) {
        pass.condition = is_level_used;
        const std::vector<PassImage> made = builder.add_compute(pass);
        return made.empty() ? PassImage{} : made.back();
    };
    pyramid = add({.name = "prefilter",
                   .shader = "bloom_prefilter_pairs.glsl",
                   .inputs = {{.name = "bloom_source", .image = builder.source()}},
                   .outputs = {{"bloom_level_0", pyramid}},
                   .workgroup = {8, 16},
                   .tile = {16, 16},
                   .custom_vectors = 2,
                   .constants = prefilter_constants});
    const auto add_levels = [&](ComputePassDesc pass) {
        pass.workgroup = {128, 1};
        pass.custom_vectors = 1;
        pass.constants = level_constants;
        pass.argument = 1;
        return add(std::move(pass));
    };
    pyramid = add_levels({.name = "downsample",
                          .shader = "bloom_narrow.glsl",
                          .inputs = {{.name = "bloom_level_0", .image = pyramid}},
                          .outputs = {{"bloom_level_1", pyramid, 1}, {"bloom_level_2", pyramid, 2}},
                          .shared_bytes = narrow_bytes,
                          .tile = {32, 32}});
    KernelPassDesc::Input sum{.name = "bloom_sum", .image = pyramid, .mip_level = 2};
    if (levels > 3)
        sum = {.name = "bloom_sum",
               .image = add_levels(
                   {.name = "wide levels",
                    .shader = "bloom_wide.glsl",
                    .inputs = {{.name = "bloom_level_2", .image = pyramid, .mip_level = 2}},
                    .outputs = {{"bloom_sum",
                                 builder.create({.name = "wide levels", .format = format, .denominator = 8})}},
                    .shared_bytes = wide_bytes,
                    .tile = {32, 32}})};
    return add_levels({.name = "upsample",
                       .shader = "bloom_join.glsl",
                       .inputs = {{.name = "bloom_level_1", .image = pyramid, .mip_level = 1}, sum},
                       .outputs = {{"bloom_level_0", pyramid}},
                       .shared_bytes = join_bytes,
                       .tile = {64, 32},
                       .is_additive = true});
}

void build(PassBuilder& builder) {
    const PassVector neutral{0.0f, 0.0f, 0.0f, 0.0f};
    const std::uint32_t levels = builder.from_max_extent(bloom_level_count);
    builder.end_constants(1, end_constants);
    if (levels == 0) {
        builder.side("bloom_pyramid", PassImage{}, neutral);
        return;
    }
    const VkFormat packed = VK_FORMAT_B10G11R11_UFLOAT_PACK32,
                   format = builder.is_stored(packed) ? packed : VK_FORMAT_R16G16B16A16_SFLOAT;
    // With fewer levels they are no more than so many passes anyway.
    const bool has_tiles = levels > 2 && builder.tiles_pay(format, std::max({narrow_bytes, wide_bytes, join_bytes}));
    const PassImage pyramid =
        builder.create({.name = "pyramid", .format = format, .denominator = 2, .mip_levels = has_tiles ? 3 : levels});
    builder.loaded_side("bloom_pyramid",
                        has_tiles ? add_tiles(builder, pyramid, levels, format) : add_kernels(builder, pyramid, levels),
                        neutral);
}

bool is_identity(const void* parameters) { return bloom_of(parameters).intensity == 0.0f; }

}  // namespace

std::uint32_t bloom_level_count(VkExtent2D extent) {
    const auto bits = static_cast<std::uint32_t>(std::bit_width(std::min(extent.width, extent.height)));
    return std::clamp(bits, 4u, 4u + max_levels) - 4u;
}

const EffectInfo& effect_info(const Bloom&) {
    static const EffectInfo info{
        .name = "bloom",
        .doc = "Light above a threshold glows around its source.",
        .parameters = bloom_rows.table(),
        .files = embedded_files("bloom"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .flat = {.documented = 50, .scene_linear = 62, .starts_on = true},
        .toggle_key = 5,
        .build = build,
        .reference = bloom_reference,
        .is_identity = is_identity,
        .threshold = [](const void* parameters) -> std::optional<float> {
            const Bloom& bloom = bloom_of(parameters);
            if (bloom.intensity == 0.0f || bloom.mode != BloomMode::Additive) return {};
            return bloom.threshold;
        },
    };
    return info;
}

}  // namespace darkroom
