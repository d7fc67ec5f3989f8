# SPDX-License-Identifier: MIT
"""Darkroom for Zig. Its text is tested; it was never compiled, because Debian has no Zig."""

from api import safe_name, type_in_bits

C_TYPES = {"char": "u8", "float": "f32", "double": "f64", "int32_t": "i32", "uint32_t": "u32", "uint64_t": "u64",
           "size_t": "usize"}
KEYWORDS = set("""addrspace align allowzero and anyframe anytype asm async await break callconv catch comptime
    const continue defer else enum errdefer error export extern fn for if inline linksection noalias noinline
    nosuspend opaque or orelse packed pub resume return struct suspend switch test threadlocal try type undefined
    union unreachable usingnamespace var volatile while""".split())


def name_of(name):
    return safe_name(name, KEYWORDS, '@"{}"')


def base_type(api, name):
    return type_in_bits(api, name, C_TYPES, "?*anyopaque")


def type_of(api, type):
    pointers = list(type.pointers)
    if type.name == "void" and not pointers:
        return "void"
    if type.name == "void" or api.kinds[type.name] == "opaque":
        out = "?*const anyopaque" if pointers.pop(0) == "const" else "?*anyopaque"
    else:
        out = base_type(api, type.name)
    for pointer in pointers:
        out = f"[*c]{'const ' if pointer == 'const' else ''}{out}"
    return f"[{type.length}]{out}" if type.length and not type.pointers else out


def default_of(api, struct, member):
    kind = api.kinds[member.type.name]
    if member.name == "struct_size":
        return f"@sizeOf({struct.name})"
    if member.type.pointers or kind in ("handle", "function", "callback"):
        return "null"
    if kind == "struct":
        return ".{}"
    return f"[_]{base_type(api, member.type.name)}{{0}} ** {member.type.length}" if member.type.length else "0"


def docs(doc, indent=""):
    return f"{indent}/// {doc}\n" if doc else ""


def parameters_of(api, function):
    return ", ".join(f"{name_of(parameter.name)}: {type_of(api, parameter.type)}" for parameter in function.parameters)


def write(api):
    out = [api.head("Zig", "//"), "// Untested: it was never compiled.\n\n"]
    out += [f"{docs(row['doc'])}pub const {row['name']}: {C_TYPES[row['type']]} = {row['value']};\n" for row in api.constants]
    out += [f"{docs(row['doc'])}pub const {row['name']} = {C_TYPES[row['type']]};\n" for row in api.aliases]
    for row in api.handles:
        out.append(f"{docs(row['doc'])}pub const {row['name']} = ?*opaque {{}};\n")
    for row in api.enums:
        out.append(f"\n{docs(row['doc'])}pub const {row['name']} = i32;\n")
        out += [f"{docs(value['doc'])}pub const {value['name']}: {row['name']} = {value['value']};\n"
                for value in row["values"]]
    for callback in api.callbacks:
        out.append(f"\n{docs(callback.doc)}pub const {callback.name} = ?*const fn ({parameters_of(api, callback)}) "
                   f"callconv(.C) {type_of(api, callback.result)};\n")
    for struct in api.vulkan_structs + api.structs:
        members = "".join(f"{docs(member.doc, '    ')}    {name_of(member.name)}: {type_of(api, member.type)} = "
                          f"{default_of(api, struct, member)},\n" for member in struct.members)
        out.append(f"\n{docs(struct.doc)}pub const {struct.name} = extern struct {{\n{members}}};\n")
    out.append("\n")
    for function in api.functions:
        out.append(f"{docs(function.doc)}pub extern fn {function.name}({parameters_of(api, function)}) "
                   f"{type_of(api, function.result)};\n")
    return "".join(out)
