// SPDX-License-Identifier: MIT
#include <darkroom/effect.hpp>

#include "c/call.hpp"
#include "c/objects.hpp"

DarkroomEffectObject::DarkroomEffectObject(const darkroom::EffectInfo& description)
    : info(&description), owner(description.owner.lock()), name(description.name), doc(description.doc) {
    for (const darkroom::EffectFile& file : description.files)
        if (file.name.ends_with(".md")) page = file.text;
    // Of the final size before anything points into it.
    rows.reserve(description.parameters.rows.size());
    for (const darkroom::ParamInfo& row : description.parameters.rows) {
        Row& text = rows.emplace_back();
        text.name = row.name;
        text.doc = row.doc;
        text.unit = row.unit.symbol;
        text.choices.assign(row.choices.begin(), row.choices.end());
        for (const std::string& choice : text.choices) text.choice_names.push_back(choice.c_str());
    }
}

namespace darkroom::c {

namespace {

/// Of this build, by name.
const std::vector<std::unique_ptr<const DarkroomEffectObject>>& library_effects() {
    static const auto effects = [] {
        std::vector<std::unique_ptr<const DarkroomEffectObject>> out;
        for (const EffectInfo* info : all_effects()) out.push_back(std::make_unique<DarkroomEffectObject>(*info));
        return out;
    }();
    return effects;
}

}  // namespace

DarkroomEffect effect_of(const EffectInfo& info) {
    for (const auto& effect : library_effects())
        if (effect->info == &info) return effect.get();
    return nullptr;
}

}  // namespace darkroom::c

using namespace darkroom;
using namespace darkroom::c;

uint32_t darkroom_effect_count() { return static_cast<std::uint32_t>(all_effects().size()); }

DarkroomEffect darkroom_effect_at(uint32_t index) {
    return call_for<DarkroomEffect>("darkroom_effect_at", nullptr, [&]() -> DarkroomEffect {
        return index < library_effects().size() ? library_effects()[index].get() : nullptr;
    });
}

DarkroomEffect darkroom_effect_find(const char* name) {
    return call_for<DarkroomEffect>("darkroom_effect_find", nullptr, [&]() -> DarkroomEffect {
        const EffectInfo* const found = find_effect(view(name));
        return found == nullptr ? nullptr : effect_of(*found);
    });
}

DarkroomResult darkroom_effect_info(DarkroomEffect effect, DarkroomEffectInfo* info) {
    return call("darkroom_effect_info", [&]() -> Result<> {
        DARKROOM_TRY(needs("effect", effect, "info", info));
        const EffectInfo& from = *effect->info;
        DarkroomEffectInfo out{};
        out.parameter_count = static_cast<std::uint32_t>(from.parameters.rows.size());
        out.word_count = static_cast<std::uint32_t>(from.parameters.words());
        out.is_ui = from.flat.ui == UiPart::Layer;
        out.has_second = from.has_second();
        out.makes_output = from.output_scale.is_of_output;
        out.name = effect->name.c_str();
        out.doc = effect->doc.c_str();
        out.page = effect->page.c_str();
        return write(info, out, "DarkroomEffectInfo");
    });
}

DarkroomResult darkroom_effect_parameter(DarkroomEffect effect, uint32_t index, DarkroomParameterInfo* info) {
    return call("darkroom_effect_parameter", [&]() -> Result<> {
        DARKROOM_TRY(needs("effect", effect, "info", info));
        const ParamTable& table = effect->info->parameters;
        if (index >= table.rows.size())
            return user_error(fmt::format("index = {}: {} has {} parameters", index, effect->name, table.rows.size()));
        const ParamInfo& row = table.rows[index];
        const DarkroomEffectObject::Row& text = effect->rows[index];
        DarkroomParameterInfo out{};
        out.kind = static_cast<DarkroomKind>(row.kind);
        out.name = text.name.c_str();
        out.doc = text.doc.c_str();
        out.unit = text.unit.c_str();
        out.min = row.range.min;
        out.max = row.range.max;
        out.is_logarithmic = row.range.scale == Scale::Log;
        out.is_amount = row.is_amount;
        out.is_at_compile = row.is_at_compile;
        out.word = row.word;
        out.word_count = row.words;
        out.default_words = table.defaults.data() + row.word;
        out.choices = text.choice_names.data();
        out.choice_count = static_cast<std::uint32_t>(text.choice_names.size());
        return write(info, out, "DarkroomParameterInfo");
    });
}

DarkroomResult darkroom_custom_effect_load(const char* file, DarkroomCustomEffect* custom) {
    return call("darkroom_custom_effect_load", [&]() -> Result<> {
        DARKROOM_TRY(needs("file", file, "custom", custom));
        DARKROOM_TRY_VALUE(auto made, CustomEffect::load(file));
        *custom = new DarkroomCustomEffectObject(std::move(made));
        return {};
    });
}

DarkroomResult darkroom_custom_effect_parse(const char* text, const char* shown_name, DarkroomCustomEffect* custom) {
    return call("darkroom_custom_effect_parse", [&]() -> Result<> {
        DARKROOM_TRY(needs("text", text, "shown_name", shown_name, "custom", custom));
        DARKROOM_TRY_VALUE(auto made, CustomEffect::parse(text, shown_name));
        *custom = new DarkroomCustomEffectObject(std::move(made));
        return {};
    });
}

void darkroom_custom_effect_destroy(DarkroomCustomEffect custom) { delete custom; }

DarkroomEffect darkroom_custom_effect_info(DarkroomCustomEffect custom) {
    return custom == nullptr ? nullptr : &custom->effect;
}
