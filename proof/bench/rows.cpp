// SPDX-License-Identifier: MIT
#include "rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "bench/chain/chains.hpp"
#include "bench/chain/hand_written.hpp"
#include "bench/chain/recipe.hpp"

namespace darkroom::bench {

namespace {

constexpr std::array stages{KernelStage::Auto, KernelStage::Compute, KernelStage::Raster};

std::string_view stage_name(KernelStage stage) {
    switch (stage) {
        case KernelStage::Compute:
            return "compute";
        case KernelStage::Raster:
            return "raster";
        case KernelStage::Auto:
            break;
    }
    return "auto";
}

std::string_view stage_name(gpu::Stage stage) { return stage == gpu::Stage::Compute ? "compute" : "raster"; }

Recipe chain_recipe(std::string name, Stack stack, const ChainDesc& desc) {
    return {.name = std::move(name),
            .make = [stack = std::move(stack), desc](Bed& bed, const std::string& row) -> Result<Row> {
                DARKROOM_TRY_VALUE(auto chain, compile_chain(bed, stack, desc));
                return chain_row(bed, row, chain);
            }};
}

std::vector<std::uint32_t> tail_words(const TailValues& values) {
    const auto word = [](float value) { return std::bit_cast<std::uint32_t>(value); };
    return {word(values.exposure), word(values.vignette_intensity), word(values.vignette_smoothness),
            word(values.dither_intensity), 0};
}

Result<TableDesc> noise_tile() {
    auto table = only_table_of(*tail_noise_effect());
    if (!table) return machine_error("the effect of the noise has no table of its own");
    return std::move(*table);
}

Recipe hand_written_recipe(gpu::Stage stage) {
    return {.name = fmt::format("tail/hand-written/{}", stage_name(stage)),
            .make = [stage](Bed& bed, const std::string& row) -> Result<Row> {
                DARKROOM_TRY_VALUE(const auto tile, noise_tile());
                return kernel_row(bed, row, tail_spec(bed.context), stage, tail_words({}), &tile);
            }};
}

Recipe plain_recipe(std::string_view name, PlainPass pass, gpu::Stage stage) {
    return {.name = fmt::format("{}/{}", name, stage_name(stage)),
            .make = [pass, stage](Bed& bed, const std::string& row) -> Result<Row> {
                DARKROOM_TRY_VALUE(const auto tile, noise_tile());
                return plain_row(bed, row, pass, stage, {}, tile);
            }};
}

Stack stack_of_one(std::string_view name) {
    const EffectInfo* const effect = find_effect(name);
    return effect == nullptr ? Stack{} : single_stack(*effect);
}

/// An empty stack: this build lacks one of its effects.
void add_chain(std::vector<Recipe>& recipes, std::string name, Stack stack, const ChainDesc& desc) {
    if (!stack.empty()) recipes.push_back(chain_recipe(std::move(name), std::move(stack), desc));
}

void add_chains(std::vector<Recipe>& recipes, const std::string& name, const Stack& stack,
                WorldUse world = WorldUse::None) {
    for (const KernelStage stage : stages)
        add_chain(recipes, fmt::format("{}/fused/{}", name, stage_name(stage)), stack,
                  {.kernels = stage, .world = world});
    for (const KernelStage stage : stages)
        add_chain(recipes, fmt::format("{}/unfused/{}", name, stage_name(stage)), stack,
                  {.kernels = stage, .fuse = false, .world = world});
}

/// What reads more than the colour: as an engine has it, and beside that where everything is given that may be.
void add_world_chains(std::vector<Recipe>& recipes) {
    constexpr WorldUse engine = WorldUse::WithoutNormals;
    for (const char* const resolution : {"half", "full"})
        for (const char* const method : {"hemisphere", "ground_truth"})
            add_chain(recipes, fmt::format("ssao/{}/{}", resolution, method), ssao_stack(method, resolution),
                      {.world = engine});
    for (const char* const method : {"hemisphere", "ground_truth"})
        add_chain(recipes, fmt::format("ssao/half/{}, all given", method), ssao_stack(method, "half"),
                  {.world = WorldUse::Planar});
    for (const KernelStage stage : stages)
        add_chain(recipes, fmt::format("volumetric/{}", stage_name(stage)), stack_of_one("volumetric"),
                  {.kernels = stage, .world = engine});
    add_chain(recipes, "volumetric/auto, all given", stack_of_one("volumetric"), {.world = WorldUse::Planar});
    for (const char* const resolution : {"half", "full"})
        add_chain(recipes, fmt::format("motion_blur/{}", resolution), motion_blur_stack(resolution), {.world = engine});
    add_chain(recipes, "motion_blur/half, all given", motion_blur_stack("half"), {.world = WorldUse::Planar});
    for (const char* const resolution : {"half", "full"})
        add_chain(recipes, fmt::format("depth_of_field/{}", resolution), depth_of_field_stack(resolution),
                  {.world = engine});
    add_chain(recipes, "tail/fog", foggy_tail_stack({}), {.world = engine});
    add_chain(recipes, "tail/fog, all given", foggy_tail_stack({}), {.world = WorldUse::Planar});
    add_chains(recipes, "documented", documented_stack(), engine);
    add_chain(recipes, "documented/fused/auto, all given", documented_stack(), {.world = WorldUse::Planar});
    add_chain(recipes, "documented/ground_truth", documented_stack("ground_truth"), {.world = engine});
}

/// As many bytes as the scene has, from one buffer into another.
Result<Row> floor_row(Bed& bed, const std::string& name) {
    struct Buffers {
        gpu::Buffer from, to;
    };
    const VkDeviceSize size = VkDeviceSize{8} * bed.extent.width * bed.extent.height;
    const auto make = [&](gpu::Buffer& buffer, VkBufferUsageFlags usage) -> Result<> {
        DARKROOM_TRY_VALUE(buffer, gpu::Buffer::create(bed.context, size, usage, gpu::Memory::Kind::Device, "floor"));
        return {};
    };
    const auto buffers = std::make_shared<Buffers>();
    DARKROOM_TRY(make(buffers->from, VK_BUFFER_USAGE_TRANSFER_SRC_BIT));
    DARKROOM_TRY(make(buffers->to, VK_BUFFER_USAGE_TRANSFER_DST_BIT));
    return Row{.name = name,
               .record = [&bed, buffers, size](VkCommandBuffer commands) -> Result<> {
                   const VkBufferCopy all{.size = size};
                   bed.context.vk.CmdCopyBuffer(commands, buffers->from.handle, buffers->to.handle, 1, &all);
                   return {};
               },
               .moved_bytes = 2 * static_cast<double>(size)};
}

std::vector<Recipe> recipes() {
    std::vector<Recipe> out;
    out.push_back({.name = std::string(calibration_name), .make = [](Bed& bed, const std::string& name) {
                       return kernel_row(bed, name, calibration_spec(), gpu::Stage::Raster);
                   }});
    out.push_back({.name = "null submit", .make = [](Bed&, const std::string& name) -> Result<Row> {
                       return Row{.name = name, .record = [](VkCommandBuffer) { return Result<>{}; }};
                   }});
    out.push_back({.name = std::string(floor_name), .make = floor_row});
    for (const EffectInfo* const effect : all_effects())
        out.push_back(chain_recipe(
            fmt::format("effect/{}", effect->name), single_stack(*effect),
            {.world = effect->needs.contains(FrameImage::Ui) ? WorldUse::Interface
                      : effect->needs.contains(FrameImage::Normals) || effect->needs.contains(FrameImage::Velocity)
                          ? WorldUse::Full
                          : WorldUse::WithoutNormals}));
    if (const Stack tail = tail_stack({}); !tail.empty()) {
        add_chains(out, "tail", tail);
        for (const gpu::Stage stage : {gpu::Stage::Compute, gpu::Stage::Raster}) {
            out.push_back(hand_written_recipe(stage));
            out.push_back(plain_recipe("tail/hand-written/plain", PlainPass::Tail, stage));
            out.push_back(plain_recipe("copy/plain", PlainPass::Copy, stage));
        }
    }
    add_chain(out, "tail/lut", graded_tail_stack({}), {});
    add_chain(out, "tail/pq", high_range_tail_stack({}), {.target_color = pq_color});
    add_chain(out, "tail/ui, neutral", ui_tail_stack({}, true), {.world = WorldUse::Interface});
    add_chain(out, "tail/ui", ui_tail_stack({}, false), {.world = WorldUse::Interface});
    if (const Stack bloom = bloom_stack(); !bloom.empty())
        for (const KernelStage stage : stages)
            out.push_back(chain_recipe(fmt::format("bloom/{}", stage_name(stage)), bloom, {.kernels = stage}));
    for (const double radius : {4.0, 16.0, 64.0})
        for (const char* const resolution : {"automatic", "full"})
            for (const KernelStage stage : stages)
                add_chain(out, fmt::format("gaussian/{}/{}/{}", radius, resolution, stage_name(stage)),
                          gaussian_stack(radius, resolution), {.kernels = stage});
    add_chain(out, "plain bloom", plain_bloom_stack(), {});
    add_chains(out, "default", default_stack());
    add_world_chains(out);
    for (Recipe& recipe : interface_recipes()) out.push_back(std::move(recipe));
    for (Recipe& recipe : controller_recipes()) out.push_back(std::move(recipe));
    for (Recipe& recipe : scene_recipes()) out.push_back(std::move(recipe));
    return out;
}

}  // namespace

std::vector<std::string> row_names() {
    std::vector<std::string> names;
    for (const Recipe& recipe : recipes()) names.push_back(recipe.name);
    return names;
}

Result<std::vector<Row>> make_rows(Bed& bed, std::span<const std::string> filters) {
    const auto is_wanted = [&](const std::string& name) {
        return filters.empty() || name == calibration_name || name == floor_name ||
               std::ranges::any_of(filters, [&](const auto& filter) { return name.find(filter) != std::string::npos; });
    };
    std::vector<Row> rows;
    for (const Recipe& recipe : recipes()) {
        if (!is_wanted(recipe.name)) continue;
        auto row = recipe.make(bed, recipe.name);
        if (!row) return user_error(fmt::format("{}: {}", recipe.name, row.error().text));
        if (row->record || row->host) rows.push_back(std::move(*row));
    }
    return rows;
}

Result<std::vector<PassRow>> measure_passes(Bed& bed, std::uint32_t rounds) {
    struct Measured {
        std::string_view name;
        Stack stack;
        WorldUse world = WorldUse::None;
    };
    const std::vector<Measured> stacks{
        {"tail", tail_stack({})},
        {"bloom", bloom_stack()},
        {"default", default_stack()},
        {"ssao, ground_truth", ssao_stack("ground_truth", "half"), WorldUse::WithoutNormals},
        {"volumetric", stack_of_one("volumetric"), WorldUse::WithoutNormals},
        {"motion_blur", motion_blur_stack("half"), WorldUse::WithoutNormals},
        {"depth_of_field", depth_of_field_stack("half"), WorldUse::WithoutNormals},
        {"documented", documented_stack(), WorldUse::WithoutNormals}};
    DARKROOM_TRY_VALUE(auto submitter, Submitter::create(bed.context));
    std::vector<PassRow> out;
    for (const auto& [name, stack, world] : stacks) {
        if (stack.empty()) continue;
        DARKROOM_TRY_VALUE(auto chain, compile_chain(bed, stack, {.has_timers = true, .world = world}));
        const Row row = chain_row(bed, std::string(name), chain);
        std::vector<std::string> passes;
        std::vector<std::vector<double>> times;
        for (std::uint32_t round = 0; round <= rounds; ++round) {
            DARKROOM_TRY(submitter->run(row.record));
            const std::span<const PassTime> measured = chain.composer->times().passes;
            if (round == 0) {
                for (const PassTime& pass : measured) passes.emplace_back(pass.name);
                times.resize(passes.size());
                continue;
            }
            for (std::size_t i = 0; i < std::min(times.size(), measured.size()); ++i)
                times[i].push_back(measured[i].milliseconds);
        }
        for (std::size_t i = 0; i < passes.size(); ++i)
            out.push_back({.stack = row.name, .pass = passes[i], .milliseconds = median(times[i])});
    }
    return out;
}

}  // namespace darkroom::bench
