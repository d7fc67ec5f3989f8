#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""make_layouts.py BINDINGS API.json c|rust|csharp: a program, or a part of one, that prints the size of every struct,
and of every member where it begins and its size, as that language has them. Python prints them by itself (host.py)."""

import sys


def c(structs):
    out = "#include <darkroom/darkroom.h>\n#include <stddef.h>\n#include <stdio.h>\nint main(void) {\n"
    for struct in structs:
        out += f'    printf("{struct.name} %zu\\n", sizeof({struct.name}));\n'
        for member in struct.members:
            path = f"{struct.name}.{member.name}"
            out += (f'    printf("{path} %zu %zu\\n", offsetof({struct.name}, {member.name}), '
                    f"sizeof((({struct.name}*)0)->{member.name}));\n")
    return out + "    return 0;\n}\n"


def rust(structs):
    from rust import name_of

    out = "use crate::darkroom::*;\nuse std::mem::{size_of, zeroed};\n"
    out += "fn size<T>(_: &T) -> usize {\n    size_of::<T>()\n}\n"
    out += "#[rustfmt::skip]\npub fn print() {\n"
    for struct in structs:
        out += f"    let s: {struct.name} = unsafe {{ zeroed() }};\n"
        out += f'    println!("{struct.name} {{}}", size_of::<{struct.name}>());\n'
        for member in struct.members:
            place = f"s.{name_of(member.name)}"
            out += (f'    println!("{struct.name}.{member.name} {{}} {{}}", &{place} as *const _ as usize - '
                    f"&s as *const _ as usize, size(&{place}));\n")
    return out + "}\n"


def csharp(structs):
    from csharp import name_of, type_of

    out = "using System;\nusing Darkroom;\npublic static unsafe class Layout {\n"
    main = ""
    for struct in structs:
        out += f"    static void {struct.name}() {{\n        {struct.name} s = default({struct.name});\n"
        out += f'        Console.WriteLine("{struct.name} {{0}}", sizeof({struct.name}));\n'
        for member in struct.members:
            name, base = name_of(member.name), type_of(API, member.type)
            is_array = member.type.length and not member.type.pointers
            address = f"s.{name}" if is_array else f"&s.{name}"
            size = f"sizeof({base})" + (f" * {member.type.length}" if is_array else "")
            out += (f'        Console.WriteLine("{struct.name}.{member.name} {{0}} {{1}}", '
                    f"(byte*){address} - (byte*)&s, {size});\n")
        out += "    }\n"
        main += f"        {struct.name}();\n"
    aliases = "".join(f"using {row['name']} = System.IntPtr;\n" for row in API.handles)
    aliases += "".join(f"using {row['name']} = System.UInt64;\n" for row in API.aliases)
    return aliases + out + "    public static void Print() {\n" + main + "    }\n}\n"


if __name__ == "__main__":
    sys.path.insert(0, sys.argv[1])
    from api import Api

    API = Api.read(sys.argv[2])
    print({"c": c, "rust": rust, "csharp": csharp}[sys.argv[3]](API.vulkan_structs + API.structs), end="")
