// SPDX-License-Identifier: MIT
// Runs at build time: compiles every kernel of every effect alone, and of the chains of both shipped orders, in both
// stages, complete and lean, so that a mistake in a shader breaks the build with file and line.

#include <darkroom/effects.hpp>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "gpu/shader.hpp"
#include "plan/program.hpp"

namespace {

using namespace darkroom;

plan::Entry entry_of(const EffectInfo& info) {
    plan::Entry entry{.info = &info};
    entry.desc.name = info.name;
    if (info.has_second) entry.desc.second = scene_color;
    entry.base.assign(info.parameters.defaults.begin(), info.parameters.defaults.end());
    return entry;
}

std::vector<std::vector<plan::Entry>> stacks() {
    std::vector<std::vector<plan::Entry>> out;
    for (const EffectInfo* const info : all_effects()) out.push_back({entry_of(*info)});
    for (const auto rank : {&FlatPlace::documented, &FlatPlace::scene_linear}) {
        std::vector<const EffectInfo*> chain;
        for (const EffectInfo* const info : all_effects())
            if (info->flat.*rank >= 0) chain.push_back(info);
        std::ranges::sort(chain, {}, [&](const EffectInfo* info) { return info->flat.*rank; });
        out.emplace_back();
        for (const EffectInfo* const info : chain) out.back().push_back(entry_of(*info));
    }
    return out;
}

/// Every entry on, regions that are whole images, and the choices of the defaults.
plan::Shape usual_shape(const plan::ProgramPass& pass) {
    plan::Shape shape{.steps = plan::Shape::is_whole};
    for (std::size_t i = 0; i < pass.steps.size() && pass.is_fused; ++i) shape.steps |= std::uint64_t{1} << (2 * i);
    for (const plan::Literal& literal : pass.literals) {
        const std::uint32_t value = pass.steps[literal.step].info->parameters.defaults[literal.row->word];
        shape.choices |= (value & literal.mask()) << literal.bit;
    }
    return shape;
}

Result<> append_sources(const plan::Program& program, gpu::Stage stage, std::vector<gpu::ShaderSource>& out) {
    const bool is_compute = stage == gpu::Stage::Compute;
    for (const plan::ProgramPass& pass : program.passes) {
        for (auto& made : {plan::complete_spec(pass), plan::lean_spec(pass, usual_shape(pass))}) {
            if (!made) return failure(made.error());
            out.push_back({.name = pass.name + (is_compute ? " (compute)" : " (raster)"),
                           .text = gpu::kernel_source(*made, stage),
                           .stage = is_compute ? gpu::ShaderStage::Compute : gpu::ShaderStage::Fragment});
        }
    }
    return {};
}

}  // namespace

int main() {
    std::vector<gpu::ShaderSource> sources;
    for (const auto& stack : stacks()) {
        for (const gpu::Stage stage : {gpu::Stage::Compute, gpu::Stage::Raster}) {
            const CompileDesc desc{.max_extent = {1920, 1080},
                                   .depth = {VK_FORMAT_D32_SFLOAT},
                                   .normals = {VK_FORMAT_R16G16B16A16_SFLOAT},
                                   .velocity = {VK_FORMAT_R16G16_SFLOAT},
                                   .ui = {VK_FORMAT_R8G8B8A8_UNORM},
                                   .has_shadows = true,
                                   .target_domain = Domain::Encoded};
            auto program = plan::plan_program(
                stack, desc, {.stage_of = [&](const gpu::KernelSpec&) { return Result<gpu::Stage>(stage); }});
            Result<> ok = program ? append_sources(*program, stage, sources) : Result<>(failure(std::move(program)));
            if (!ok) {
                std::fprintf(stderr, "error: %s\n", ok.error().text.c_str());
                return 1;
            }
        }
    }
    gpu::ShaderCompiler compiler{std::filesystem::path()};
    int failures = 0;
    for (const auto& spirv : compiler.compile_all(sources)) {
        if (spirv) continue;
        std::fprintf(stderr, "%s\n", spirv.error().text.c_str());
        ++failures;
    }
    return failures == 0 ? 0 : 1;
}
