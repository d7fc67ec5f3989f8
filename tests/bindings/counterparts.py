#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""counterparts.py BINDINGS API.json INCLUDE: every public function of the C++ headers has its counterpart in C, called
darkroom_<class>_<function>, or the one that is named here, or a reason here why there is none."""

import os
import re
import sys

sys.path.insert(0, sys.argv[1])
from api import Api  # noqa: E402

# Whole headers that have none.
HEADERS = {
    "console.hpp": "of an optional library, which is C++ alone",
    "controllers.hpp": "of an optional library, which is C++ alone",
    "hud_document.hpp": "of an optional library, which is C++ alone",
    "describe.hpp": "for who writes an effect, in C++",
    "pass_builder.hpp": "for who writes an effect, in C++",
    "reference.hpp": "for who writes an effect, in C++",
    "warp_grid.hpp": "for who writes an effect, in C++",
    "name_of.hpp": "of the compiler",
    "result.hpp": "an error is a code and darkroom_error",
    "color_state.hpp": "members of a struct tell it",
    "param.hpp": "members of DarkroomParameterInfo tell it",
    "resource.hpp": "the host's own containers",
    "log.hpp": "the type of a callback",
}

# Names in C that are others; several where C takes what overloads tell apart.
OTHERS = {
    "Composer::Composer": ["darkroom_composer_create"],
    "Composer::add": ["darkroom_composer_add", "darkroom_composer_add_effect"],
    "Composer::ui": ["darkroom_composer_add"],  # DarkroomEntryDesc::is_ui
    "UiChain::UiChain": ["darkroom_composer_add"],
    "UiChain::add": ["darkroom_composer_add"],
    "Composer::define": ["darkroom_composer_define_table", "darkroom_composer_define_picture"],
    "Composer::set": ["darkroom_composer_set_words", "darkroom_composer_set_number", "darkroom_composer_set_all",
                      "darkroom_composer_set_float", "darkroom_composer_set_int", "darkroom_composer_set_vector"],
    "Composer::layer_names": ["darkroom_composer_layer_name"],
    "KernelFile::KernelFile": ["darkroom_kernel_file_create"],
    "library_version": ["darkroom_version"],
    "all_effects": ["darkroom_effect_count", "darkroom_effect_at"],
    "find_effect": ["darkroom_effect_find"],
    "set_ui_constants": ["darkroom_composer_set_ui_constants"],
    "default_look": ["darkroom_look_default"],
    "default_look_of_traced_light": ["darkroom_look_default_of_traced_light"],
    "parse_look": ["darkroom_look_parse"],
    "read_look": ["darkroom_look_read"],
    "write_look": ["darkroom_look_write"],
    "set_order": ["darkroom_look_set_order"],
    "switched_off": ["darkroom_look_switch_off"],
    "exposure_of": ["darkroom_look_exposure"],
    "add_ui": ["darkroom_look_add_ui"],
    "lay_over": ["darkroom_look_lay_over"],
    "place_entry": ["darkroom_look_place", "darkroom_look_place_custom"],
    "custom_entry": ["darkroom_look_place_custom"],
    "flat_entry": ["darkroom_look_place"],
    "entry_names": ["darkroom_look_entry_name"],
    "override_look": ["darkroom_look_override"],
    "apply": ["darkroom_look_apply"],
    "follow": ["darkroom_look_follow"],
}

NONE = {
    "Device::context": "of the library's own parts",
    "Device::shared_context": "of the library's own parts",
    "Needs::Needs": "for who writes an effect, in C++",
    "Needs::add": "for who writes an effect, in C++",
    "Needs::contains": "for who writes an effect, in C++",
    "Needs::and_perspective": "for who writes an effect, in C++",
    "EffectInfo::has_second": "a member of DarkroomEffectInfo tells it",
    "EffectInfo::joins_ui": "of the library's own parts",
    "FlatPlace::is_of_ui": "a look is opaque in C, and knows its tables",
    "embedded_files": "for who writes an effect, in C++; a page is DarkroomEffectInfo::page",
    "shared_files": "for who writes an effect, in C++",
    "ImageRef::is_given": "a null pointer says it",
    "ImageRef::used_region": "the host's own arithmetic",
    "Handle::is_given": "0 says it",
    "shadow_light": "the host's own arithmetic",
    "seconds_between_frames": "the host's own arithmetic",
    "KernelStatistics::value": "the host's own search in a list",
    "Plan::rounds": "one more than the largest round of the plan as JSON",
    "values_without_effect": "warnings of programs that take values from people",
    "find_entry": "a look is opaque in C: darkroom_look_override changes what it holds",
}

SCOPE = re.compile(r"^(?:template\s*<.*>\s*)?(namespace|class|struct|union|enum)\b(?:\s+class)?\s*([A-Za-z_:]*)")
FUNCTION = re.compile(r"([A-Za-z_]\w*)\s*\(")


def statements(text):
    """(scopes, statement) of what stands in namespaces and in classes. A scope is [kind, name, is_public]."""
    text = re.sub(r"//[^\n]*", "", text)
    text = re.sub(r"(?m)^\s*#.*$", "", text)
    text = re.sub(r'"(?:\\.|[^"\\])*"', '""', text)
    text = re.sub(r"\b(public|private|protected)\s*:(?!:)", r";@\1;", text)
    scopes, skipped, begun = [], 0, ""
    for word in re.findall(r"[{};]|[^{};]+", text):
        access = re.match(r"@(public|private|protected)", word)
        if skipped:
            skipped += {"{": 1, "}": -1}.get(word, 0)
            if skipped == 0 and not re.search(r"=\s*$|[\w>]\s*$", begun):
                begun = ""
        elif access and scopes:
            scopes[-1][2] = access[1] == "public"
        elif word == "{":
            head = SCOPE.match(begun.strip())
            if head and head[1] != "enum" and "(" not in begun.replace("alignas(", ""):
                scopes.append([head[1], head[2], head[1] != "class"])
                begun = ""
            else:
                if "(" in begun:
                    yield scopes, begun.strip()
                    begun = ""
                skipped = 1
        elif word == "}":
            if scopes:
                scopes.pop()
            begun = ""
        elif word == ";":
            yield scopes, begun.strip()
            begun = ""
        else:
            begun += word


def functions(text):
    """Names of public functions, "Class::name" or "name"."""
    for scopes, statement in statements(text):
        named = [name for kind, name, _ in scopes if kind != "namespace" and name]
        if any(kind == "namespace" and name == "detail" for kind, name, _ in scopes) or not statement:
            continue
        if not all(is_public for *_, is_public in scopes):
            continue
        if re.match(r"(friend|using|static_assert|typedef|template\s*<>|extern)\b", statement):
            continue
        if "operator" in statement or statement.startswith("~") or "= delete" in statement:
            continue
        # Neither attributes nor arguments of templates, nor values behind "=", which are no functions.
        plain = re.sub(r"\[\[.*?\]\]", "", statement)
        while (less := re.sub(r"<[^<>]*>", "", plain)) != plain:
            plain = less
        found = FUNCTION.search(plain.split("=")[0])
        # Pointers to functions, and what is declared in its class and defined behind it.
        if not found or re.search(r"\(\s*\*", plain) or plain[: found.start()].endswith("::"):
            continue
        # A move is no function of C's.
        if named and found[1] == named[-1] and re.search(r"&&\)", plain):
            continue
        yield "::".join([*named, found[1]])


def snake(name):
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


def main():
    have = {function.name for function in Api.read(sys.argv[2]).functions}
    faults, used, called, count = [], set(), set(), 0
    for header in sorted(os.listdir(sys.argv[3])):
        if not header.endswith(".hpp"):
            continue
        if header in HEADERS:
            used.add(header)
            continue
        with open(os.path.join(sys.argv[3], header), encoding="utf-8") as file:
            names = set(functions(file.read()))
        for name in sorted(names):
            count += 1
            if name in NONE:
                used.add(name)
                continue
            used.add(name)
            wanted = OTHERS.get(name, ["darkroom_" + "_".join(snake(part) for part in name.split("::"))])
            called |= set(wanted)
            faults += [f"{header}: {name} has no {one}" for one in wanted if one not in have]
    faults += [f"counterparts.py: there is no {name} any more" for name in {*HEADERS, *OTHERS, *NONE} - used]
    # What C has more, other than what C++ has by its types: nothing stays unseen here.
    if "list" in sys.argv:
        print("\n".join(sorted(have - called)))
    if count < 90:
        faults.append(f"counterparts.py: only {count} functions were found")
    print("\n".join(faults) or f"{count} functions of C++ have their counterparts among {len(have)} of C")
    return 1 if faults else 0


sys.exit(main())
