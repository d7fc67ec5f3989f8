// SPDX-License-Identifier: MIT
#include "effect_json.hpp"

#include "core/text/param_text.hpp"
#include "plan/frame_inputs.hpp"

namespace app {

namespace {

using darkroom::EffectInfo;

std::string_view type_of(darkroom::Kind kind) {
    switch (kind) {
        case darkroom::Kind::Float:
            return "float";
        case darkroom::Kind::Int:
            return "int";
        case darkroom::Kind::Toggle:
            return "bool";
        case darkroom::Kind::Choice:
            return "choice";
        case darkroom::Kind::Vec2:
            return "vec2";
        case darkroom::Kind::Vec3:
            return "vec3";
        case darkroom::Kind::Vec4:
            return "vec4";
        case darkroom::Kind::Rgb:
            return "rgb";
        case darkroom::Kind::Curve:
            return "curve";
        case darkroom::Kind::Resource:
            return "resource";
    }
    return "";
}

Json json_of(const EffectInfo& effect, const darkroom::ParamInfo& row) {
    const std::string key = darkroom::flat_key(effect.name, row.name);
    Json out{{"name", row.name},
             {"key", key},
             {"flag", darkroom::flag_name(key)},
             {"type", type_of(row.kind)},
             {"doc", row.doc},
             {"default", Json::value_or_text(darkroom::format(row, effect.parameters.defaults))},
             {"switches_effect", row.is_amount || row.switched_word < effect.parameters.words()},
             {"at_compile", row.is_at_compile}};
    if (row.kind == darkroom::Kind::Choice)
        out["choices"] = row.choices;
    else if (row.kind != darkroom::Kind::Toggle && row.kind != darkroom::Kind::Resource)
        out.update({{"min", row.range.min}, {"max", row.range.max}, {"unit", row.unit.symbol}});
    return out;
}

}  // namespace

Json effect_json(const EffectInfo& effect) {
    Json needs = Json::array(), rows = Json::array();
    for (const darkroom::plan::FrameInput& input : darkroom::plan::frame_inputs)
        if (effect.needs.contains(input.image)) needs.push_back(input.name);
    if (effect.needs.perspective) needs.push_back("perspective");
    if (effect.has_second()) needs.push_back("second");
    for (const darkroom::ParamInfo& row : effect.parameters.rows) rows.push_back(json_of(effect, row));
    const bool is_flat = effect.flat.documented >= 0 || effect.flat.scene_linear >= 0;
    return {{"name", effect.name},
            {"doc", effect.doc},
            {"is_flat", is_flat},
            {"starts_on", is_flat && effect.flat.starts_on},
            {"flag", darkroom::flag_name(darkroom::flat_key(effect.name, "enabled"))},
            {"toggle_key", effect.flat.toggle_key},
            {"needs", std::move(needs)},
            {"parameters", std::move(rows)}};
}

}  // namespace app
