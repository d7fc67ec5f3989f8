// SPDX-License-Identifier: MIT
// darkroom_lab api: what the C interface declares, for people and for programs that make bindings of it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <darkroom/effect.hpp>
#include <memory>
#include <span>

#include "c_header.hpp"
#include "lab/lab.hpp"
#include "programs/darkroom/effects/effect_json.hpp"
#include "programs/darkroom/run/json.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

// The document of `api --json`: docs/bindings.md says what is in it.

/// "pointers": of each, from the name outwards, "const" or "mutable", which is what it points to.
Json json_of(const CType& type, bool is_parameter) {
    Json out{{"type", type.name}};
    Json pointers = Json::array();
    bool is_const = type.is_const;
    for (const bool is_star_const : type.stars) {
        pointers.push_back(is_const ? "const" : "mutable");
        is_const = is_star_const;
    }
    if (is_parameter && type.length != 0) pointers.push_back(is_const ? "const" : "mutable");
    if (!pointers.empty()) out["pointers"] = std::move(pointers);
    if (type.length != 0) out["length"] = type.length;
    return out;
}
Json json_of(const CVariable& variable, bool is_parameter) {
    Json out{{"name", variable.name}};
    out.update(json_of(variable.type, is_parameter));
    if (!variable.doc.empty()) out["doc"] = variable.doc;
    return out;
}
Json json_of(const CFunction& function) {
    Json parameters = Json::array();
    for (const CVariable& parameter : function.parameters) parameters.push_back(json_of(parameter, true));
    return {{"name", function.name},
            {"doc", function.doc},
            {"result", json_of(function.result, false)},
            {"parameters", std::move(parameters)}};
}
Json json_of(const CConstant& constant) {
    Json out{{"name", constant.name}, {"value", constant.value}, {"doc", constant.doc}};
    if (!constant.type.empty()) out["type"] = constant.type;
    return out;
}
Json json_of(const CEnum& type) {
    Json values = Json::array();
    for (const CConstant& value : type.values) values.push_back(json_of(value));
    return {{"name", type.name}, {"doc", type.doc}, {"values", std::move(values)}};
}
Json json_of(const CStruct& type) {
    Json members = Json::array();
    for (const CVariable& member : type.members) members.push_back(json_of(member, false));
    return {{"name", type.name}, {"doc", type.doc}, {"members", std::move(members)}};
}
Json json_of(const CHandle& handle) { return {{"name", handle.name}, {"doc", handle.doc}}; }
Json json_of(const CAlias& alias) { return {{"name", alias.name}, {"type", alias.type}, {"doc", alias.doc}}; }
Json json_of(const VulkanType& type) {
    Json out{{"name", type.name}, {"kind", name_of(type.kind)}, {"size", type.size}};
    if (type.members.empty()) return out;
    Json members = Json::array();
    for (const VulkanType::Member& member : type.members)
        members.push_back({{"name", member.name}, {"type", member.type}});
    out["members"] = std::move(members);
    return out;
}

template <class T>
Json list_of(std::span<const T> all, Json (*one_json)(const T&)) {
    Json out = Json::array();
    for (const T& one : all) out.push_back(one_json(one));
    return out;
}

Json api_json(const CHeader& header) {
    Json effects = Json::array();
    for (const darkroom::EffectInfo* const effect : darkroom::all_effects()) effects.push_back(effect_json(*effect));
    return {{"version", DARKROOM_VERSION},
            {"vulkan", list_of<VulkanType>(vulkan_types(), json_of)},
            {"constants", list_of<CConstant>(header.constants, json_of)},
            {"handles", list_of<CHandle>(header.handles, json_of)},
            {"aliases", list_of<CAlias>(header.aliases, json_of)},
            {"enums", list_of<CEnum>(header.enums, json_of)},
            {"structs", list_of<CStruct>(header.structs, json_of)},
            {"callbacks", list_of<CFunction>(header.callbacks, json_of)},
            {"functions", list_of<CFunction>(header.functions, json_of)},
            {"effects", std::move(effects)}};
}

struct Embedded {
    std::string_view name, text;
};
constexpr Embedded headers[] = {
#include "c_header_text.inc"
};
static_assert(std::size(headers) == 1 && headers[0].name == "darkroom.h");

void tell(std::string_view declaration, std::string_view doc) {
    fmt::print("{}\n", declaration);
    if (!doc.empty()) fmt::print("    {}\n", doc);
}
void tell(const CFunction& function) {
    std::vector<std::string> parameters;
    for (const CVariable& parameter : function.parameters) parameters.push_back(in_c(parameter));
    tell(fmt::format("{} {}({})", in_c(function.result), function.name, fmt::join(parameters, ", ")), function.doc);
}

void list(const CHeader& header) {
    for (const CConstant& constant : header.constants)
        tell(fmt::format("{} = {}", constant.name, constant.value), constant.doc);
    for (const CHandle& handle : header.handles) tell(handle.name, handle.doc);
    for (const CAlias& alias : header.aliases) tell(fmt::format("{} {}", alias.type, alias.name), alias.doc);
    for (const CEnum& type : header.enums) {
        tell(fmt::format("enum {}", type.name), type.doc);
        for (const CConstant& value : type.values) {
            const std::string doc = value.doc.empty() ? "" : ": " + value.doc;
            fmt::print("    {} = {}{}\n", value.name, value.value, doc);
        }
    }
    for (const CStruct& type : header.structs) {
        tell(fmt::format("struct {}", type.name), type.doc);
        for (const CVariable& member : type.members)
            fmt::print("    {}{}\n", in_c(member), member.doc.empty() ? "" : ": " + member.doc);
    }
    for (const CFunction& callback : header.callbacks) tell(callback);
    for (const CFunction& function : header.functions) tell(function);
}

}  // namespace

Command add_api(CommandFlags program) {
    const CommandFlags command = program.add_command("api", "Lists what the C interface declares");
    command.examples(
        "darkroom_lab api\n"
        "darkroom_lab api --json > api.json\n"
        "darkroom_lab api | grep -A1 '^DarkroomResult darkroom_composer_'");
    const auto is_json = std::make_shared<bool>(false);
    command.add_flag("--json", *is_json, "For programs that make bindings: types, functions and effects");
    return {command, [is_json] {
                const darkroom::Result<CHeader> header = parse_c_header(headers[0].text, headers[0].name);
                if (!header) return fail(header.error());
                if (*is_json)
                    fmt::print("{}\n", api_json(*header).dump(2));
                else
                    list(*header);
                return exit_ok;
            }};
}

}  // namespace app
