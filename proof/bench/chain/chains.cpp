// SPDX-License-Identifier: MIT
#include "chains.hpp"

#include <algorithm>
#include <array>

#include "core/text/param_text.hpp"

namespace darkroom::bench {

namespace {

struct Value {
    std::string_view parameter;
    ParamValue value;
};
struct NamedStep {
    std::string_view effect;
    std::vector<Value> values{};
    bool joins_scene = false;
};

constexpr std::string_view noise_effect = "dither";
/// Stands for a table until a Composer has one.
constexpr std::uint32_t some_table = 1;

/// A cube of the usual size, which darkens a little.
ColorTable usual_table() {
    ColorTable table{.size = 33};
    for (std::uint32_t b = 0; b < table.size; ++b)
        for (std::uint32_t g = 0; g < table.size; ++g)
            for (std::uint32_t r = 0; r < table.size; ++r)
                for (const std::uint32_t entry : {r, g, b})
                    table.cube.push_back(0.95f / 32 * static_cast<float>(entry));
    return table;
}

Step step_of(const EffectInfo& effect) {
    return {.effect = &effect, .words = {effect.parameters.defaults.begin(), effect.parameters.defaults.end()}};
}

std::vector<NamedStep> tail_steps(const TailValues& values) {
    return {{"exposure", {{"exposure", double{values.exposure}}}},
            {"tonemap", {{"curve", std::string("aces_narkowicz")}}},
            {"vignette",
             {{"intensity", double{values.vignette_intensity}}, {"smoothness", double{values.vignette_smoothness}}}},
            {"encode", {{"transfer", std::string("srgb")}}},
            {noise_effect, {{"intensity", double{values.dither_intensity}}}}};
}

/// Empty where an effect or one of its parameters is not there.
Stack stack_of(const std::vector<NamedStep>& steps) {
    Stack stack;
    for (const NamedStep& named : steps) {
        const EffectInfo* const effect = find_effect(named.effect);
        if (effect == nullptr) return {};
        stack.push_back(step_of(*effect));
        stack.back().joins_scene = named.joins_scene;
        for (const Value& value : named.values) {
            const ParamInfo* const row = effect->parameters.find(value.parameter);
            if (row == nullptr || !assign(*row, stack.back().words, value.value)) return {};
        }
    }
    return stack;
}

/// Sets the first number, or names a table, that makes the effect do something.
void make_visible(Step& step) {
    const EffectInfo& effect = *step.effect;
    if (effect.is_identity == nullptr || !effect.is_identity(step.words.data())) return;
    for (const ParamInfo& row : effect.parameters.rows) {
        if (row.is_picture) continue;
        if (row.kind == Kind::Resource) {
            step.words[row.word] = some_table;
            if (!effect.is_identity(step.words.data())) return;
            step.words[row.word] = 0;
            continue;
        }
        for (const double value : {0.5 * (row.range.min + row.range.max), row.range.max, row.range.min}) {
            std::vector<std::uint32_t> words = step.words;
            if (!assign(row, words, value) || effect.is_identity(words.data())) continue;
            step.words = words;
            return;
        }
    }
}

}  // namespace

Stack tail_stack(const TailValues& values) { return stack_of(tail_steps(values)); }

Stack foggy_tail_stack(const TailValues& values) {
    std::vector<NamedStep> steps = tail_steps(values);
    steps.insert(std::ranges::find(steps, "tonemap", &NamedStep::effect) + 1, {.effect = "fog"});
    return stack_of(steps);
}

Stack graded_tail_stack(const TailValues& values) {
    std::vector<NamedStep> steps = tail_steps(values);
    steps.insert(std::ranges::find(steps, "encode", &NamedStep::effect), {.effect = "lut"});
    Stack stack = stack_of(steps);
    for (Step& step : stack) make_visible(step);
    return stack;
}

Stack high_range_tail_stack(const TailValues& values) {
    std::vector<NamedStep> steps = tail_steps(values);
    steps.resize(3);  // it is neither encoded nor dithered
    steps[1].values = {{"curve", std::string("bt2390")}, {"white", 16.0}, {"peak_nits", 1000.0}};
    return stack_of(steps);
}

Stack ui_tail_stack(const TailValues& values, bool is_neutral) {
    const double on = is_neutral ? 0 : 1;
    std::vector<NamedStep> steps = tail_steps(values);
    const std::vector<NamedStep> ui{{"ui_warp", {{"strength", -0.15 * on}}},
                                    {"ui_chroma", {{"strength", 0.005 * on}}},
                                    {"ui_echo", {{"strength", 0.1 * on}, {"size", 1.01}}},
                                    {"ui_composite"},
                                    {"contrast_gamma"}};
    steps.insert(std::ranges::find(steps, "encode", &NamedStep::effect) + 1, ui.begin(), ui.end());
    return stack_of(steps);
}

const EffectInfo* tail_noise_effect() { return find_effect(noise_effect); }

Stack bloom_stack() { return stack_of({{"bloom", {{"levels", std::int64_t{5}}}}}); }

Stack gaussian_stack(double radius, const std::string& resolution) {
    return stack_of({{"gaussian_blur", {{"radius", radius}, {"resolution", resolution}}}});
}

Stack plain_bloom_stack() {
    return stack_of({{"high_pass"},
                     {"gaussian_blur", {{"radius", 24.0}}},
                     {"blend", {{"mode", std::string("add")}, {"amount", 0.15}}, true},
                     {"exposure"},
                     {"tonemap"},
                     {"encode"}});
}

Stack ssao_stack(const std::string& method, const std::string& resolution) {
    return stack_of({{"ssao", {{"method", method}, {"resolution", resolution}}}});
}

Stack motion_blur_stack(const std::string& resolution) {
    return stack_of({{"motion_blur", {{"resolution", resolution}}}});
}

Stack depth_of_field_stack(const std::string& resolution) {
    // A lens whose circles are as large as they may be where the frame's depth is not in focus.
    return stack_of({{"depth_of_field", {{"resolution", resolution}, {"f_stop", 1.0}, {"sensor_height", 240.0}}}});
}

Stack flat_stack(bool keeps_what_is_off) {
    Stack stack;
    for (const EffectInfo* const effect : all_effects()) {
        if (effect->flat.documented < 0 || effect->flat.is_of_ui()) continue;
        // As looks do: of what is off, only pointwise effects without images have a place unless the host keeps them,
        // and what moves coordinates but moves nothing at its defaults has none.
        const bool is_still = effect->touch == Touch::Warp && effect->is_identity != nullptr &&
                              effect->is_identity(effect->parameters.defaults.data());
        const bool has_passes = effect->touch != Touch::Pointwise || effect->build;
        if (is_still || (!effect->flat.starts_on && has_passes && !keeps_what_is_off)) continue;
        stack.push_back(step_of(*effect));
        stack.back().is_on = effect->flat.starts_on;
    }
    std::ranges::stable_sort(stack, {}, [](const Step& step) { return step.effect->flat.documented; });
    return stack;
}

Stack default_stack() { return flat_stack(false); }

Stack documented_stack(const std::string& ssao_method) {
    Stack stack = default_stack();
    for (Step& step : stack) {
        if (step.effect->name == "vignette") {
            step.is_on = true;
            make_visible(step);
        }
        if (step.effect->name == "ssao") (void)assign(*step.effect->parameters.find("method"), step.words, ssao_method);
    }
    return stack;
}

Stack single_stack(const EffectInfo& effect) {
    Stack stack{step_of(effect)};
    make_visible(stack.front());
    return stack;
}

void fill(Composer& composer, const Stack& stack) {
    Handle before = scene_color;
    for (const Step& step : stack) {
        EntryDesc desc{.source = scene_color, .is_ui = step.effect->flat.ui == UiPart::Layer, .enabled = step.is_on};
        if (step.joins_scene) desc.input = scene_color;
        if (step.effect->has_second() && !step.effect->joins_ui())
            desc.second = step.joins_scene ? before : scene_color;
        std::vector<std::uint32_t> words = step.words;
        for (const ParamInfo& row : step.effect->parameters.rows)
            if (row.kind == Kind::Resource && words[row.word] == some_table)
                words[row.word] = composer.define(usual_table()).value_or(Resource{}).id;
        before = composer.add(*step.effect, words.data(), desc);
    }
}

Result<Chain> compile_chain(Bed& bed, const Stack& stack, const ChainDesc& desc) {
    if (desc.world != WorldUse::None) DARKROOM_TRY(bed.make_world());
    Chain chain{.composer = std::make_shared<Composer>(
                    bed.device, ComposerDesc{.frames_in_flight = 1, .has_timers = desc.has_timers}),
                .world = desc.world};
    fill(*chain.composer, stack);
    CompileDesc compile_desc = bed.compile_desc(desc.world);
    compile_desc.kernels = desc.kernels;
    compile_desc.fuse = desc.fuse;
    compile_desc.target_color = desc.target_color;
    DARKROOM_TRY_VALUE(chain.plan, chain.composer->compile(compile_desc));
    chain.compiled_for = compile_desc;
    chain.composer->wait_for_kernels();
    return chain;
}

Row chain_row(Bed& bed, std::string name, const Chain& chain) {
    return {.name = std::move(name),
            .record = [&bed, composer = chain.composer, world = chain.world](
                          VkCommandBuffer commands) { return composer->record(commands, bed.frame(world)); },
            .moved_bytes = static_cast<double>(chain.plan.bytes_read() + chain.plan.bytes_written())};
}

}  // namespace darkroom::bench
