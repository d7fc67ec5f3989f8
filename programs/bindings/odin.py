# SPDX-License-Identifier: MIT
"""Darkroom for Odin. Its text is tested; it was never compiled, because Debian has no Odin."""

from api import safe_name, type_in_bits

C_TYPES = {"char": "u8", "float": "f32", "double": "f64", "int32_t": "i32", "uint32_t": "u32", "uint64_t": "u64",
           "size_t": "uint"}
KEYWORDS = set("""asm auto_cast bit_set break case cast context continue defer distinct do dynamic else enum
    fallthrough for foreign if import in map matrix not_in or_else or_return package proc return struct switch
    transmute typeid union using when where""".split())


def name_of(name):
    return safe_name(name, KEYWORDS, "{}_")


def base_type(api, name):
    return type_in_bits(api, name, C_TYPES, "rawptr")


def type_of(api, type):
    pointers = len(type.pointers)
    if type.name == "void" or api.kinds[type.name] == "opaque":
        out, pointers = "rawptr", pointers - 1
    elif type.name == "char" and pointers:
        out, pointers = "cstring", pointers - 1
    else:
        out = base_type(api, type.name)
    out = "[^]" * pointers + out
    return f"[{type.length}]{out}" if type.length and not type.pointers else out


def docs(doc, indent=""):
    return f"{indent}// {doc}\n" if doc else ""


def procedure(api, function):
    parameters = ", ".join(f"{name_of(parameter.name)}: {type_of(api, parameter.type)}"
                           for parameter in function.parameters)
    return f"({parameters})" + ("" if function.result.is_void() else f" -> {type_of(api, function.result)}")


def write(api):
    out = [api.head("Odin", "//"), "// Untested: it was never compiled.\n\npackage darkroom\n\n"
           'foreign import lib "system:darkroom"\n\n']
    out += [f"{docs(row['doc'])}{row['name']} :: {C_TYPES[row['type']]}({row['value']})\n" for row in api.constants]
    out += [f"{docs(row['doc'])}{row['name']} :: {C_TYPES[row['type']]}\n" for row in api.aliases]
    out += [f"{docs(row['doc'])}{row['name']} :: distinct rawptr\n" for row in api.handles]
    for row in api.enums:
        values = "".join(f"{docs(value['doc'], '    ')}    {value['name']} = {value['value']},\n"
                         for value in row["values"])
        out.append(f"\n{docs(row['doc'])}{row['name']} :: enum i32 {{\n{values}}}\n")
    for callback in api.callbacks:
        out.append(f'\n{docs(callback.doc)}{callback.name} :: proc "c" {procedure(api, callback)}\n')
    for struct in api.vulkan_structs + api.structs:
        members = "".join(f"{docs(member.doc, '    ')}    {name_of(member.name)}: {type_of(api, member.type)},\n"
                          for member in struct.members)
        out.append(f"\n{docs(struct.doc)}{struct.name} :: struct {{\n{members}}}\n")
    out.append('\n@(default_calling_convention = "c")\nforeign lib {\n')
    for function in api.functions:
        out.append(f"{docs(function.doc, '    ')}    {function.name} :: proc{procedure(api, function)} ---\n")
    return "".join(out) + "}\n"
