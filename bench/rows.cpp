// SPDX-License-Identifier: MIT
#include "rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "chains.hpp"
#include "hand_written.hpp"
#include "recipe.hpp"
#include "scene.hpp"

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

Recipe chain_recipe(std::string name, Stack stack, const ChainDesc& desc) {
    return {.name = std::move(name),
            .make = [stack = std::move(stack), desc](Bed& bed, const std::string& row) -> Result<Row> {
                auto chain = compile_chain(bed, stack, desc);
                if (!chain) return failure(std::move(chain));
                return chain_row(bed, row, *chain);
            }};
}

std::vector<std::byte> tail_constants(const TailValues& values) {
    const std::array numbers{values.exposure, values.vignette_intensity, values.vignette_smoothness,
                             values.dither_intensity};
    std::vector<std::byte> bytes(sizeof numbers + sizeof(std::uint32_t));
    std::memcpy(bytes.data(), numbers.data(), sizeof numbers);
    return bytes;
}

Recipe hand_written_recipe(gpu::Stage stage) {
    const std::string_view name = stage == gpu::Stage::Compute ? "compute" : "raster";
    return {.name = fmt::format("tail/hand-written/{}", name),
            .make = [stage](Bed& bed, const std::string& row) -> Result<Row> {
                const auto table = only_table_of(*tail_noise_effect());
                if (!table) return machine_error("the effect of the noise has no table of its own");
                return kernel_row(bed, row, tail_spec(), stage, tail_constants({}), &*table);
            }};
}

bool needs_scene_data(const EffectInfo& effect) {
    const Needs& needs = effect.needs;
    return needs.depth || needs.normals || needs.velocity || needs.shadows || needs.ui;
}

void add_chains(std::vector<Recipe>& recipes, const std::string& name, const Stack& stack) {
    if (stack.empty()) return;
    for (const KernelStage stage : stages)
        recipes.push_back(chain_recipe(fmt::format("{}/fused/{}", name, stage_name(stage)), stack, {.kernels = stage}));
    for (const KernelStage stage : stages)
        recipes.push_back(chain_recipe(fmt::format("{}/unfused/{}", name, stage_name(stage)), stack,
                                       {.kernels = stage, .fuse = false}));
}

Result<Row> memcpy_row(const Bed& bed, const std::string& name) {
    const auto from = std::make_shared<std::vector<std::byte>>(std::size_t{bed.extent.width} * bed.extent.height * 8);
    const auto to = std::make_shared<std::vector<std::byte>>(from->size());
    return Row{.name = name, .host = [from, to] { std::memcpy(to->data(), from->data(), from->size()); }};
}

std::vector<Recipe> recipes() {
    std::vector<Recipe> out;
    out.push_back({.name = std::string(calibration_name), .make = [](Bed& bed, const std::string& name) {
                       return kernel_row(bed, name, calibration_spec(), gpu::Stage::Raster);
                   }});
    out.push_back({.name = "null submit", .make = [](Bed&, const std::string& name) -> Result<Row> {
                       return Row{.name = name, .record = [](VkCommandBuffer) { return Result<>{}; }};
                   }});
    out.push_back({.name = "memcpy of the scene (floor)", .make = memcpy_row});
    for (const EffectInfo* const effect : all_effects())
        if (!needs_scene_data(*effect))
            out.push_back(chain_recipe(fmt::format("effect/{}", effect->name), single_stack(*effect), {}));
    if (const Stack tail = tail_stack({}); !tail.empty()) {
        add_chains(out, "tail", tail);
        for (const gpu::Stage stage : {gpu::Stage::Compute, gpu::Stage::Raster})
            out.push_back(hand_written_recipe(stage));
    }
    if (const Stack bloom = bloom_stack(); !bloom.empty())
        for (const KernelStage stage : stages)
            out.push_back(chain_recipe(fmt::format("bloom/{}", stage_name(stage)), bloom, {.kernels = stage}));
    add_chains(out, "default", default_stack());
    for (Recipe& recipe : scene_recipes()) out.push_back(std::move(recipe));
    return out;
}

}  // namespace

std::vector<std::string> row_names() {
    std::vector<std::string> names;
    for (const Recipe& recipe : recipes()) names.push_back(recipe.name);
    return names;
}

Result<std::vector<Row>> make_rows(Bed& bed, std::string_view filter) {
    std::vector<Row> rows;
    for (const Recipe& recipe : recipes()) {
        if (recipe.name != calibration_name && recipe.name.find(filter) == std::string::npos) continue;
        auto row = recipe.make(bed, recipe.name);
        if (!row) return user_error(fmt::format("{}: {}", recipe.name, row.error().text));
        if (row->record || row->host) rows.push_back(std::move(*row));
    }
    return rows;
}

Result<std::vector<PassRow>> measure_passes(Bed& bed, std::uint32_t rounds) {
    const std::array<std::pair<std::string_view, Stack>, 3> stacks{
        {{"tail", tail_stack({})}, {"bloom", bloom_stack()}, {"default", default_stack()}}};
    auto submitter = Submitter::create(bed.context);
    if (!submitter) return failure(std::move(submitter));
    std::vector<PassRow> out;
    for (const auto& [name, stack] : stacks) {
        if (stack.empty()) continue;
        auto chain = compile_chain(bed, stack, {.has_timers = true});
        if (!chain) return failure(std::move(chain));
        const Row row = chain_row(bed, std::string(name), *chain);
        std::vector<std::string> passes;
        std::vector<std::vector<double>> times;
        for (std::uint32_t round = 0; round <= rounds; ++round) {
            if (const auto sample = (*submitter)->run(row.record); !sample) return failure(sample.error());
            const std::span<const PassTime> measured = chain->composer->times();
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
