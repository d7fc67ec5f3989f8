// SPDX-License-Identifier: MIT
// Runs at build time: compiles every kernel of every effect alone, and of the chains of both shipped orders, in both
// stages, complete and lean, so that a mistake in a shader breaks the build with file and line.

#include <darkroom/effects.hpp>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "compose/variants.hpp"
#include "gpu/shader.hpp"

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

Result<> append_sources(const plan::Program& program, gpu::Stage stage, std::vector<gpu::ShaderSource>& out) {
    const bool is_compute = stage == gpu::Stage::Compute;
    for (const plan::ProgramPass& pass : program.passes) {
        std::vector<gpu::KernelSpec> specs{pass.spec};
        if (!pass.steps.empty()) {
            std::vector<plan::FusedStep> steps = pass.steps;
            for (plan::FusedStep& step : steps) step.is_certain = step.is_plain = true;
            auto lean = compose::lean_spec(pass, steps);
            if (!lean) return failure(std::move(lean));
            specs.push_back(std::move(*lean));
        }
        for (const gpu::KernelSpec& spec : specs)
            out.push_back({.name = spec.name + (is_compute ? " (compute)" : " (raster)"),
                           .text = gpu::kernel_source(spec, stage),
                           .stage = is_compute ? gpu::ShaderStage::Compute : gpu::ShaderStage::Fragment});
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
