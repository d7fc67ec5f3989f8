#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""make_null_calls.py BINDINGS API.json OUT [null_instance]: a program in C that calls every function of darkroom.h with
nothing: with null pointers and zeroes, which has to be an error or to do nothing, and with zeroed memory and real objects,
which must not crash. An error is one line that begins with the function's name. `null_instance`: it calls those of
darkroom_load.h where there is no library, which have to be no error, and to give nothing."""

import sys

HEAD = r"""
#include <darkroom/darkroom.h>
#include <stdio.h>
#include <string.h>

static int faults = 0;
static void fault(const char* function, const char* what) {
    printf("%s: %s: '%s'\n", function, what, darkroom_error());
    ++faults;
}
static void check(const char* function, DarkroomResult result, int must_fail) {
    if (result == DARKROOM_OK) {
        if (must_fail) fault(function, "it took null for an argument");
        return;
    }
    const char* const text = darkroom_error();
    if (strncmp(text, function, strlen(function)) != 0 || text[strlen(function)] != ':')
        fault(function, "its error does not name it");
    if (strchr(text, '\n') != NULL) fault(function, "its error is not one line");
}
/* What a pointer may point to: 64 KiB for each argument. */
static union {
    uint64_t aligned;
    char bytes[65536];
} zeroes[16];
static void* zeroed(int argument) {
    memset(&zeroes[argument], 0, sizeof zeroes[argument]);
    return &zeroes[argument];
}
"""

NULL_INSTANCE = r"""
#include <darkroom/darkroom_load.h>

static int faults = 0, said = 0;
static void fault(const char* function, const char* what) {
    printf("%s: %s\n", function, what);
    ++faults;
}
static void say(void* user, const char* text) {
    (void)user;
    said += strstr(text, "/nowhere/libdarkroom") != NULL ? 1 : 100;
}
/* What a pointer may point to, with something in it. */
static union {
    uint64_t aligned;
    char bytes[65536];
} memory[16];
static void* filled(int argument) {
    memset(&memory[argument], 0x5a, sizeof memory[argument]);
    return &memory[argument];
}
"""

# The objects that calls get in their last round, made with the fewest functions.
MAKERS = {
    "DarkroomDevice": "darkroom_device_assumed(DARKROOM_DEVICE_PROFILE_GPU, &{})",
    "DarkroomComposer": "darkroom_composer_create(made_DarkroomDevice, NULL, &{})",
    "DarkroomPlan": "darkroom_composer_plan(made_DarkroomComposer, &planned, &{})",
    "DarkroomLook": "darkroom_look_default(DARKROOM_LOOK_ORDER_SCENE_LINEAR, &{})",
    "DarkroomCustomEffect": "darkroom_custom_effect_parse(custom, \"custom.glsl\", &{})",
    "DarkroomKernelFile": "darkroom_kernel_file_create(&{})",
    "DarkroomHudInertia": "darkroom_hud_inertia_create(&{})",
}
CUSTOM = (r"// @effect plain: Does nothing.\n// @accepts scene_linear\n"
          r"vec4 plain(vec4 color, Pixel pixel, Plain parameters) { return color; }\n")


def argument(api, parameter, index, kind):
    type = parameter.type
    if type.pointers:
        return f"zeroed({index})" if kind == "zeroes" else "NULL"
    if api.kinds[type.name] == "handle":
        if kind == "null" or type.name.startswith("Vk"):
            return "NULL"
        return f"made_{type.name}" if type.name in MAKERS else "darkroom_effect_at(0)"
    if api.kinds[type.name] == "struct":
        return f"({type.name}){{0, 0}}"
    return f"({type.name})0"


def destroyed(api, function, index):
    """What a call has made, which is the pointer to a handle that can be destroyed."""
    parameter = function.parameters[index].type
    return (parameter.pointers == ["mutable"] and parameter.name in MAKERS)


def call(api, function, kind):
    arguments = [argument(api, parameter, i, kind) for i, parameter in enumerate(function.parameters)]
    expression = f"{function.name}({', '.join(arguments)})"
    takes_pointers = any(parameter.type.pointers or api.kinds[parameter.type.name] == "handle"
                         for parameter in function.parameters)
    if not function.can_fail:
        return f"    (void){expression};\n"
    out = f"    check(\"{function.name}\", {expression}, {int(kind == 'null' and takes_pointers)});\n"
    for i, parameter in enumerate(function.parameters):
        if kind == "zeroes" and destroyed(api, function, i):
            out += (f"    {destroyer(parameter.type.name)}(*({parameter.type.name}*)(void*)zeroes[{i}].bytes);\n")
    return out


def destroyer(handle):
    words = "".join("_" + c.lower() if c.isupper() else c for c in handle.removeprefix("Darkroom")).strip("_")
    return f"darkroom_{words}_destroy"


def write(api):
    missing = {row["name"] for row in api.handles} - set(MAKERS) - {"DarkroomEffect"}
    if missing:
        raise SystemExit(f"make_null_calls.py: how is a {sorted(missing)[0]} made?")
    out = HEAD + "static void with_nulls(void) {\n"
    out += "".join(call(api, function, "null") for function in api.functions) + "}\n\n"
    out += "static void with_zeroes(void) {\n    DarkroomCompileDesc planned;\n"
    out += "    memset(&planned, 0, sizeof planned);\n"
    out += "    planned.struct_size = sizeof planned;\n    planned.max_extent.width = planned.max_extent.height = 16;\n"
    out += f'    const char* const custom = "{CUSTOM}";\n    DarkroomResult made;\n'
    for handle, maker in MAKERS.items():
        # What a build lacks is not there to be called with.
        out += (f"    {handle} made_{handle} = NULL;\n"
                f"    made = {maker.format('made_' + handle)};\n"
                "    if (made != DARKROOM_OK && made != DARKROOM_ERROR_UNSUPPORTED) "
                f'fault("making a {handle}", "it failed");\n')
    last = {destroyer(handle) for handle in MAKERS}
    calls = [function for function in api.functions if function.name not in last]
    out += "".join(call(api, function, kind) for kind in ("objects", "zeroes") for function in calls)
    out += "".join(f"    {destroyer(handle)}(made_{handle});\n" for handle in reversed(MAKERS))
    return out + ("}\n\nint main(void) {\n    with_nulls();\n    with_zeroes();\n"
                  f'    printf("{len(api.functions)} functions, %d faults\\n", faults);\n    return faults != 0;\n}}\n')


def null_instance_call(api, function):
    """With nulls, and with memory: what is given there is a null object, no elements, or a text."""
    name = f'"{function.name}"'
    out = ""
    for is_filled in (False, True):
        arguments = ", ".join(f"filled({i})" if is_filled and parameter.type.pointers else argument(api, parameter, i, "null")
                              for i, parameter in enumerate(function.parameters))
        expression = f"darkroom.{function.short_name()}({arguments})"
        if function.can_fail:
            out += f'    if ({expression} != DARKROOM_OK) fault({name}, "it is an error");\n'
        elif function.result.is_void():
            out += f"    {expression};\n"
        else:
            is_text = function.result.is_text() and "index" not in [one.name for one in function.parameters]
            out += f'    if ({"!" if is_text else ""}{expression}) fault({name}, "it returns something else");\n'
    for i, parameter in enumerate(function.parameters):
        if parameter.name == "count" and parameter.type.pointers == ["mutable"]:
            given = f"*(uint32_t*)(void*)memory[{i}].bytes != 0"
        elif parameter.type.pointers == ["mutable"] and api.kinds[parameter.type.name] == "handle":
            given = f"*({parameter.type.name}*)(void*)memory[{i}].bytes != NULL"
        elif parameter.type.name == "char" and parameter.type.pointers == ["const", "mutable"]:
            given = f"**(const char**)(void*)memory[{i}].bytes != 0"
        else:
            continue
        out += f'    if ({given}) fault({name}, "it gives something in {parameter.name}");\n'
    return out


def write_null_instance(api):
    return (NULL_INSTANCE + "int main(void) {\n"
            "    const DarkroomInstance darkroom = darkroom_load(\"/nowhere/libdarkroom\", say, NULL);\n" +
            "".join(null_instance_call(api, function) for function in api.functions) +
            '    if (!darkroom.is_null || darkroom.reason != darkroom.error()) fault("darkroom_load", "there is a library");\n'
            '    if (said != 1) fault("darkroom_load", "it was not said once");\n'
            f'    printf("{len(api.functions)} functions, %d faults\\n", faults);\n    return faults != 0;\n}}\n')


if __name__ == "__main__":
    sys.path.insert(0, sys.argv[1])
    from api import Api

    with open(sys.argv[3], "w", encoding="utf-8") as file:
        file.write((write_null_instance if sys.argv[4:] == ["null_instance"] else write)(Api.read(sys.argv[2])))
