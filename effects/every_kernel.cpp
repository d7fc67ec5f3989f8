// SPDX-License-Identifier: MIT
#include "every_kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <darkroom/effects.hpp>
#include <utility>

namespace darkroom {

namespace {

struct NamedStack {
    std::string name;
    std::vector<plan::Entry> entries;
};

plan::Entry entry_of(const EffectInfo& info) {
    plan::Entry entry{.info = &info};
    entry.desc.name = info.name;
    if (info.has_second()) entry.desc.second = scene_color;
    entry.base.assign(info.parameters.defaults.begin(), info.parameters.defaults.end());
    return entry;
}

NamedStack chain_of(std::string name, std::int32_t FlatPlace::*rank) {
    std::vector<const EffectInfo*> chain;
    for (const EffectInfo* const info : all_effects())
        if (info->flat.*rank >= 0) chain.push_back(info);
    std::ranges::sort(chain, {}, [&](const EffectInfo* info) { return info->flat.*rank; });
    NamedStack out{.name = std::move(name), .entries = {}};
    for (const EffectInfo* const info : chain) out.entries.push_back(entry_of(*info));
    return out;
}

/// The effect alone with every other value of a choice or toggle, one at a time: "ssao[method=hemisphere]".
void append_choices(const EffectInfo& info, std::vector<NamedStack>& out) {
    constexpr std::array<std::string_view, 2> switches{"false", "true"};
    for (const ParamInfo& row : info.parameters.rows) {
        if (row.kind != Kind::Choice && row.kind != Kind::Toggle) continue;
        const std::span<const std::string_view> names = row.kind == Kind::Toggle ? switches : row.choices;
        for (std::uint32_t value = 0; value < names.size(); ++value) {
            plan::Entry entry = entry_of(info);
            if (std::exchange(entry.base[row.word], value) == value) continue;
            out.push_back({fmt::format("{}[{}={}]", info.name, row.name, names[value]), {std::move(entry)}});
        }
    }
}

std::vector<NamedStack> stacks(bool has_every_choice) {
    std::vector<NamedStack> out;
    for (const EffectInfo* const info : all_effects()) {
        out.push_back({std::string(info->name), {entry_of(*info)}});
        if (has_every_choice) append_choices(*info, out);
    }
    out.push_back(chain_of("documented", &FlatPlace::documented));
    out.push_back(chain_of("scene_linear", &FlatPlace::scene_linear));
    return out;
}

plan::Shape usual_shape(const plan::ProgramPass& pass, std::span<const plan::Entry> entries) {
    plan::Shape shape{.flags = plan::Shape::is_whole | plan::Shape::rays_meet};
    const std::span<const plan::FusedStep> steps = pass.steps();
    if (pass.as<plan::FusedPass>() != nullptr)
        for (std::size_t i = 0; i < steps.size(); ++i) shape.set_step(i, true);
    for (const plan::Literal& literal : pass.literals) {
        if (literal.row == nullptr) continue;  // for a picture of light
        const std::uint32_t value = entries[steps[literal.step].entry].base[literal.row->word];
        shape.choices |= (value & literal.mask()) << literal.bit;
    }
    return shape;
}

}  // namespace

Result<std::vector<NamedKernel>> every_kernel(const plan::PlannerTraits& traits, bool has_every_choice) {
    const CompileDesc desc{.max_extent = {1920, 1080},
                           .depth = {VK_FORMAT_D32_SFLOAT},
                           .normals = {VK_FORMAT_R16G16B16A16_SFLOAT},
                           .velocity = {VK_FORMAT_R16G16_SFLOAT},
                           .ui = {VK_FORMAT_R8G8B8A8_UNORM},
                           .has_shadows = true,
                           .target_domain = Domain::Encoded};
    std::vector<NamedKernel> out;
    for (const NamedStack& stack : stacks(has_every_choice)) {
        DARKROOM_TRY_VALUE(const auto program, plan::plan_program(stack.entries, desc, traits));
        for (const plan::ProgramPass& pass : program.passes) {
            for (const bool is_lean : {false, true}) {
                DARKROOM_TRY_VALUE(auto spec, is_lean ? plan::lean_spec(pass, usual_shape(pass, stack.entries))
                                                      : plan::complete_spec(pass));
                out.push_back({stack.name + ": " + pass.name, is_lean, std::move(spec)});
            }
        }
    }
    return out;
}

}  // namespace darkroom
