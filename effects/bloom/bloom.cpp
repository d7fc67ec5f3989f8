// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/bloom.hpp>
#include <string>
#include <utility>

#include "bloom/bloom_reference.hpp"

namespace darkroom {

namespace {

constexpr auto bloom_rows = describe(
    field<&Bloom::intensity>("Amount of the glow added; with energy_conserving, share of the glow in the mix, where 1 "
                             "and more leave the glow alone.",
                             {0, 16})
        .as_amount(),
    field<&Bloom::threshold>("Light above this value glows; energy_conserving ignores it.", {0, 65504}),
    field<&Bloom::soft_threshold>("Width of the soft knee, as a share of the threshold; 0 is a hard edge.", {0, 1}),
    field<&Bloom::firefly_filter>("Weights the first level by inverse luminance, so that single bright pixels do not "
                                  "flicker; energy_conserving ignores it and keeps their light."),
    field<&Bloom::mode>("Way to join the glow: additive adds it, energy_conserving mixes the picture with it."),
    field<&Bloom::scatter>("Weight of each wider level relative to the narrower one, with energy_conserving.", {0, 1}),
    field<&Bloom::levels>("Number of pyramid levels at a height of 1080, each twice as wide; with reach = pixels, the "
                          "largest number at any height.",
                          {1, 5}),
    field<&Bloom::reach>("Unit of the glow's width: parts of the picture's height, or pixels."));

constexpr std::uint32_t max_levels_by_pixels = 5;
/// Of levels that are finer than the glow: they are stored as a multiple of the first one, which is not 0.
constexpr double least_weight = 0.125;
constexpr float half_max = 65504.0f;

const Bloom& bloom_of(const void* parameters) { return *static_cast<const Bloom*>(parameters); }

/// So that the last level is at least 8x8.
std::uint32_t levels_of_size(VkExtent2D extent) {
    const auto bits = static_cast<std::uint32_t>(std::bit_width(std::min(extent.width, extent.height)));
    return std::max(bits, 4u) - 4u;
}

/// Of any values in frames of at most this extent.
std::uint32_t max_levels(VkExtent2D extent) {
    const std::uint32_t by_height = bloom_weights({.reach = Reach::Height}, extent).count;
    return std::max(by_height, bloom_level_count(extent));
}

void prefilter_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Bloom& bloom = bloom_of(parameters);
    const BloomWeights levels = bloom_weights(bloom, context.frame_extent);
    // The sum of all levels must stay finite in half precision. Of the 2 N - 1 writes on the longest way through the
    // pyramid all but the last may round up by 2^-11, and past 65504 a driver may write an infinity.
    const double most = double{half_max} * (1 - (std::max(levels.count, 1u) - 1) * 0x1p-10);
    const double total = std::max(levels.total(), 1.0);
    if (bloom.mode == BloomMode::Additive)
        out[0] = {bloom.threshold, bloom.threshold * bloom.soft_threshold, static_cast<float>(most / total),
                  static_cast<float>(bloom_stored_weight(levels))};
    else  // Everything after this pass is linear, so the sum of the weights is divided out here, once.
        out[0] = {0.0f, 0.0f, static_cast<float>(most), static_cast<float>(bloom_stored_weight(levels) / total)};
    const bool is_filtered = bloom.firefly_filter && bloom.mode == BloomMode::Additive;
    out[1] = {is_filtered ? 1.0f : 0.0f, 0.0f, 0.0f, 0.0f};
}

/// Every level is stored with the same weight: what the next one is multiplied by when it is added onto this.
float gain_onto(const BloomWeights& levels, std::uint32_t level) {
    if (level + 1 >= std::min(levels.count, BloomWeights::capacity) || levels.weights[level] == 0) return 0.0f;
    return static_cast<float>(levels.weights[level + 1] / levels.weights[level]);
}

/// (gain onto `level`, levels in use from `base` on, gain onto the level behind `level`, tent of the last level).
template <std::uint32_t level, std::uint32_t base = level>
void gain_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const BloomWeights levels = bloom_weights(bloom_of(parameters), context.frame_extent);
    out[0] = {gain_onto(levels, level), static_cast<float>(levels.count) - static_cast<float>(base),
              gain_onto(levels, level + 1),
              static_cast<float>(bloom_last_tent(bloom_of(parameters), context.frame_extent))};
}
template <std::uint32_t... i>
constexpr std::array<ConstantsFunction, sizeof...(i)> gains_of(std::integer_sequence<std::uint32_t, i...>) {
    return {gain_constants<i>...};
}
constexpr std::array gains = gains_of(std::make_integer_sequence<std::uint32_t, BloomWeights::capacity>());
/// Of the wide levels that lie two behind `base`, which is even.
constexpr std::array<ConstantsFunction, 4> wide_gains{gain_constants<2, 0>, gain_constants<4, 2>, gain_constants<6, 4>,
                                                      gain_constants<8, 6>};

void end_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const Bloom& bloom = bloom_of(parameters);
    const bool is_additive = bloom.mode == BloomMode::Additive;
    const BloomWeights levels = bloom_weights(bloom, context.frame_extent);
    if (levels.count == 0) {
        out[0] = {0.0f, 1.0f, 0.0f, 0.0f};
        return;
    }
    const float share = is_additive ? bloom.intensity : std::min(bloom.intensity, 1.0f);
    out[0] = {share * static_cast<float>(levels.weights[0] / bloom_stored_weight(levels)),
              is_additive ? 1.0f : 1.0f - share, 0.0f, 0.0f};
}

/// Frames may be smaller than the largest one that the pyramid was made for.
bool is_level_used(const void* parameters, const PassContext& context, std::uint32_t level) {
    return level < bloom_weights(bloom_of(parameters), context.frame_extent).count;
}

/// A kernel for each level, on the way down and up again.
PassImage add_kernels(PassBuilder& builder, PassImage pyramid, std::uint32_t levels) {
    pyramid = builder.add({.name = "prefilter",
                           .shader = "bloom.glsl#prefilter",
                           .inputs = {{.name = "bloom_source", .image = builder.source()}},
                           .output = pyramid,
                           .custom_vectors = 2,
                           .constants = prefilter_constants,
                           .condition = is_level_used,
                           .argument = 0});
    for (std::uint32_t level = 1; level < levels; ++level)
        pyramid = builder.add({.name = "downsample " + std::to_string(level),
                               .shader = level % 2 == 1 ? "bloom.glsl#downsample" : "bloom.glsl#downsample_texels",
                               .inputs = {{.name = "bloom_above", .image = pyramid, .mip_level = level - 1}},
                               .output = pyramid,
                               .output_mip_level = level,
                               .condition = is_level_used,
                               .argument = level});
    for (std::uint32_t level = levels - 1; level-- > 0;)
        pyramid = builder.add({.name = "upsample " + std::to_string(level),
                               .shader = "bloom.glsl#upsample",
                               .inputs = {{.name = "bloom_below", .image = pyramid, .mip_level = level + 1}},
                               .output = pyramid,
                               .output_mip_level = level,
                               .is_additive = true,
                               .custom_vectors = 1,
                               .constants = gains[level],
                               .condition = is_level_used,
                               .argument = level + 1});
    return pyramid;
}

/// Invocations of a workgroup of the last of the three passes below, which has the most to do, and of the others.
constexpr std::uint32_t join_threads = 256, threads = 128;
/// Their shared memory, in bytes.
constexpr std::uint32_t narrow_bytes = 8 * 38 * 38, wide_bytes = 8 * (34 * 34 + 14 * 14),
                        join_bytes = 8 * (36 * 21 + 22 * 14);

/// The levels from `base` on, which is there, and their sum in its place: the two behind it are made by one pass, the
/// sum of the second with two more by another, and the sum with the first and with `base` by a third. Where there are
/// more, the second one takes the place of `base`.
PassImage add_tiles_from(PassBuilder& builder, PassImage pyramid, std::uint32_t base, std::uint32_t levels,
                         VkFormat format) {
    const auto name = [&](const char* what, std::uint32_t level) {
        return base == 0 ? std::string(what) : fmt::format("{} {}", what, level);
    };
    const auto add = [&](ComputePassDesc pass, std::uint32_t invocations, ConstantsFunction constants) {
        pass.workgroup = {invocations, 1};
        pass.custom_vectors = 1;
        pass.constants = constants;
        pass.condition = is_level_used;
        pass.argument = base + 1;
        const std::vector<PassImage> made = builder.add_compute(pass);
        return made.empty() ? PassImage{} : made.back();
    };
    pyramid = add({.name = name("downsample", base + 1),
                   .shader = "bloom_tiles.glsl#narrow",
                   .inputs = {{.name = "bloom_level_0", .image = pyramid, .mip_level = base}},
                   .outputs = {{"bloom_level_1", pyramid, base + 1}, {"bloom_level_2", pyramid, base + 2}},
                   .shared_bytes = narrow_bytes,
                   .tile = {32, 32}},
                  threads, gains[base]);
    const std::uint32_t behind = levels - base;
    if (behind > 5) pyramid = add_tiles_from(builder, pyramid, base + 2, levels, format);
    KernelPassDesc::Input sum{.name = "bloom_sum", .image = pyramid, .mip_level = base + 2};
    if (behind == 4 || behind == 5) {
        const PassImage wide =
            builder.create({.name = name("wide levels", base), .format = format, .denominator = 8u << base});
        sum = {.name = "bloom_sum",
               .image = add({.name = name("wide levels", base),
                             .shader = "bloom_tiles.glsl#wide",
                             .inputs = {{.name = "bloom_level_2", .image = pyramid, .mip_level = base + 2}},
                             .outputs = {{"bloom_sum", wide}},
                             .shared_bytes = wide_bytes,
                             .tile = {32, 32}},
                            threads, wide_gains[base / 2])};
    }
    return add({.name = name("upsample", base),
                .shader = "bloom_tiles.glsl#join",
                .inputs = {{.name = "bloom_level_1", .image = pyramid, .mip_level = base + 1}, sum},
                .outputs = {{"bloom_level_0", pyramid, base}},
                .shared_bytes = join_bytes,
                .tile = {64, 32},
                .is_additive = true},
               join_threads, gains[base]);
}

/// The same arithmetic with levels between in shared memory.
PassImage add_tiles(PassBuilder& builder, PassImage pyramid, std::uint32_t levels, VkFormat format) {
    const std::vector<PassImage> made =
        builder.add_compute({.name = "prefilter",
                             .shader = "bloom.glsl#prefilter_pairs",
                             .inputs = {{.name = "bloom_source", .image = builder.source()}},
                             .outputs = {{"bloom_level_0", pyramid}},
                             .workgroup = {8, 16},
                             .tile = {16, 16},
                             .custom_vectors = 2,
                             .constants = prefilter_constants,
                             .condition = is_level_used});
    return made.empty() ? PassImage{} : add_tiles_from(builder, made.back(), 0, levels, format);
}

/// Of those, how many are images?
std::uint32_t stored_levels(std::uint32_t levels) {
    std::uint32_t base = 0;
    while (levels - base > 5) base += 2;
    return base + 3;
}

void build(PassBuilder& builder) {
    const PassVector neutral{0.0f, 0.0f, 0.0f, 0.0f};
    const std::uint32_t levels = builder.from_max_extent(max_levels);
    builder.end_constants(1, end_constants);
    if (levels == 0) {
        builder.side("bloom_pyramid", PassImage{}, neutral);
        return;
    }
    const VkFormat packed = VK_FORMAT_B10G11R11_UFLOAT_PACK32,
                   format = builder.is_stored(packed) ? packed : VK_FORMAT_R16G16B16A16_SFLOAT;
    // With fewer levels they are no more than so many passes anyway.
    const bool has_tiles =
        levels > 2 && builder.tiles_pay(format, {.workgroup_invocations = join_threads,
                                                 .shared_bytes = std::max({narrow_bytes, wide_bytes, join_bytes})});
    const PassImage pyramid = builder.create({.name = "pyramid",
                                              .format = format,
                                              .denominator = 2,
                                              .mip_levels = has_tiles ? stored_levels(levels) : levels});
    builder.side("bloom_pyramid",
                 has_tiles ? add_tiles(builder, pyramid, levels, format) : add_kernels(builder, pyramid, levels),
                 neutral);
}

bool is_identity(const void* parameters) { return bloom_of(parameters).intensity == 0.0f; }

}  // namespace

std::uint32_t bloom_level_count(VkExtent2D extent) { return std::min(levels_of_size(extent), max_levels_by_pixels); }

double BloomWeights::total() const {
    double sum = 0;
    for (std::uint32_t i = 0; i < count; ++i) sum += weights[i];
    return sum;
}

BloomWeights bloom_weights(const Bloom& bloom, VkExtent2D extent) {
    const double share = bloom.mode == BloomMode::Additive ? 1 : double{bloom.scatter}, levels = bloom.levels;
    BloomWeights out{.count = std::min(bloom_level_count(extent), static_cast<std::uint32_t>(bloom.levels))};
    double finer = 0;  // octaves by which the first level here is wider than that of a picture of the known height
    if (bloom.reach == Reach::Height && out.count > 0) {
        finer = std::log2(bloom_known_height / extent.height);
        const auto needed = static_cast<std::uint32_t>(std::ceil(std::max(levels - finer, 1.0) - 1e-9));
        out.count = std::min({needed, levels_of_size(extent), BloomWeights::capacity});
    }
    // What the octaves from a to b count together: at whole numbers the sum of share^i.
    const auto octaves = [&](double a, double b) {
        return share == 1 ? b - a : (std::pow(share, a) - std::pow(share, b)) / (1 - share);
    };
    double lent = 0;  // what finer levels count that the glow has not
    for (std::uint32_t i = 0; i < out.count; ++i) {
        const double from = i == 0 ? 0 : std::clamp(i + finer, 0.0, levels),
                     to = std::clamp(i + 1 + finer, 0.0, levels);
        const double own = octaves(from, to) - lent;
        out.weights[i] = std::max(own, i + finer < 0 ? least_weight : 0.0);
        lent = out.weights[i] - own;
    }
    // The last level is wider than the part of an octave that it stands for, even where it is brought up more sharply
    // (bloom_last_tent()): so it gives some of its light to the one before.
    const double part = bloom_last_part(bloom, extent);
    if (out.count > 1 && part < 1) {
        const double given = out.weights[out.count - 1] * 0.45 * (1 - part) * (1 - part);
        out.weights[out.count - 1] -= given;
        out.weights[out.count - 2] += given;
    }
    return out;
}

const EffectInfo& effect_info(const Bloom&) {
    static const EffectInfo info{
        .name = "bloom",
        .doc = "Lets light above a threshold glow around its source.",
        .parameters = bloom_rows.table(),
        .files = embedded_files("bloom"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .flat = {.documented = 50, .scene_linear = 62, .starts_on = true, .toggle_key = 5},
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
