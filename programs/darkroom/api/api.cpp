// SPDX-License-Identifier: MIT
// darkroom api: what the C interface declares, for people and for programs that make bindings of it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "api_json.hpp"
#include "c_header.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

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

static Command add_api(CommandFlags program) {
    const CommandFlags command = program.add_command("api", "Lists what the C interface declares");
    command.examples(
        "darkroom api\n"
        "darkroom api --json > api.json\n"
        "darkroom api | grep -A1 '^DarkroomResult darkroom_composer_'");
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

CommandRow api_command() {
    return {.names = {"api"}, .place = 200, .is_of_lab = true, .add = [](const CommandHost& host) {
                return std::vector{add_api(host.program)};
            }};
}

}  // namespace app
