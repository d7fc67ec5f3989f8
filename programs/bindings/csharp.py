# SPDX-License-Identifier: MIT
"""Darkroom for C#, by DllImport."""

from api import safe_name

C_TYPES = {"void": "void", "char": "byte", "float": "float", "double": "double", "int32_t": "int", "uint32_t": "uint",
           "uint64_t": "ulong", "size_t": "UIntPtr"}
ALIASED = {"int32_t": "Int32", "uint32_t": "UInt32", "uint64_t": "UInt64"}
KEYWORDS = set("""abstract as base bool break byte case catch char checked class const continue decimal default
    delegate do double else enum event explicit extern false finally fixed float for foreach goto if implicit in
    int interface internal is lock long namespace new null object operator out override params private protected
    public readonly ref return sbyte sealed short sizeof stackalloc static string struct switch this throw true
    try typeof uint ulong unchecked unsafe ushort using virtual void volatile while""".split())

HEAD = '''//
// Compiled with -unsafe. `Native` has the functions as they are in C; those of `Api` take strings and throw
// DarkroomException. `Create()` of a struct sets its size. A callback is given by
// Marshal.GetFunctionPointerForDelegate, and its delegate is kept for as long as it may be called. Handles are IntPtr.

using System;
using System.Runtime.InteropServices;
using System.Text;
'''

API = '''
/// <summary>The functions with strings, and with exceptions of those that can fail.</summary>
public static unsafe class Api {
    static byte[] Utf8(string text) {
        return text == null ? null : Encoding.UTF8.GetBytes(text + "\\0");
    }
    /// <summary>A text of the library's; null where it is.</summary>
    public static string Text(byte* text) {
        if (text == null) return null;
        int length = 0;
        while (text[length] != 0) ++length;
        byte[] bytes = new byte[length];
        Marshal.Copy((IntPtr)text, bytes, 0, length);
        return Encoding.UTF8.GetString(bytes);
    }
    static void Check(DarkroomResult result) {
        if (result != DarkroomResult.DARKROOM_OK)
            throw new DarkroomException(result, Text(Native.darkroom_error()));
    }
'''

EXCEPTION = '''
/// <summary>Its message is one line: place, thing, value, what is allowed.</summary>
public class DarkroomException : Exception {
    public readonly DarkroomResult Result;
    public DarkroomException(DarkroomResult result, string text) : base(text) { Result = result; }
}
'''


def name_of(name):
    return safe_name(name, KEYWORDS, "@{}")


def base_type(api, name):
    kind = api.kinds[name]
    if kind == "c":
        return C_TYPES[name]
    if kind == "integer":
        return {32: "uint", 64: "ulong"}[api.integer_bits(name)]
    if kind == "object":
        return "ulong"
    if kind in ("function", "callback"):
        return "IntPtr"
    if kind == "handle" and name.startswith("Vk"):
        return "IntPtr"
    if kind == "opaque":
        return "void"
    return "int" if kind == "enum" and name.startswith("Vk") else name


def type_of(api, type):
    return base_type(api, type.name) + "*" * len(type.pointers)


def docs(doc, indent=""):
    text = doc.replace("&", "&amp;").replace("<", "&lt;")
    return f"{indent}/// <summary>{text}</summary>\n" if doc else ""


def parameters_of(api, function, with_strings=False):
    return ", ".join(f"{'string' if with_strings and parameter.type.is_text() else type_of(api, parameter.type)} "
                     f"{name_of(parameter.name)}" for parameter in function.parameters)


def member_text(api, member):
    length = member.type.length if not member.type.pointers else 0
    if length and api.kinds[member.type.name] != "c":
        raise ValueError(f"{member.name}: C# has arrays of plain numbers alone in a struct")
    declaration = (f"fixed {type_of(api, member.type)} {name_of(member.name)}[{length}]" if length else
                   f"{type_of(api, member.type)} {name_of(member.name)}")
    return f"{docs(member.doc, '    ')}    public {declaration};\n"


def struct_text(api, struct):
    members = "".join(member_text(api, member) for member in struct.members)
    create = ""
    if not struct.name.startswith("Vk"):
        create = (f"    public static {struct.name} Create() {{\n        return new {struct.name} "
                  f"{{ struct_size = (uint)sizeof({struct.name}) }};\n    }}\n")
    return (f"\n{docs(struct.doc)}[StructLayout(LayoutKind.Sequential)]\npublic unsafe struct {struct.name} {{\n"
            f"{members}{create}}}\n")


def method_text(api, function):
    texts = [parameter for parameter in function.parameters if parameter.type.is_text()]
    names = ", ".join(f"{parameter.name}_" if parameter in texts else name_of(parameter.name)
                      for parameter in function.parameters)
    call = f"Native.{function.name}({names})"
    if function.can_fail:
        body = f"Check({call});"
    elif function.result.is_text():
        body = f"return Text({call});"
    else:
        body = call + ";" if function.result.is_void() else f"return {call};"
    if texts:
        pinned = ", ".join(f"{parameter.name}_ = Utf8({name_of(parameter.name)})" for parameter in texts)
        body = f"fixed (byte* {pinned}) {body}"
    result = ("void" if function.can_fail else "string" if function.result.is_text() else
              type_of(api, function.result))
    return (f"{docs(function.doc, '    ')}    public static {result} {function.camel_name()}"
            f"({parameters_of(api, function, True)}) {{\n        {body}\n    }}\n")


def write(api):
    out = [api.head("C#", "//"), HEAD]
    out += [f"using {row['name']} = System.IntPtr;\n" for row in api.handles]
    out += [f"using {row['name']} = System.{ALIASED[row['type']]};\n" for row in api.aliases]
    out.append("\nnamespace Darkroom {\n" + EXCEPTION)
    for row in api.enums:
        values = "".join(f"{docs(value['doc'], '    ')}    {value['name']} = {value['value']},\n"
                         for value in row["values"])
        out.append(f"\n{docs(row['doc'])}public enum {row['name']} : int {{\n{values}}}\n")
    for callback in api.callbacks:
        out.append(f"\n{docs(callback.doc)}[UnmanagedFunctionPointer(CallingConvention.Cdecl)]\npublic unsafe delegate "
                   f"{type_of(api, callback.result)} {callback.name}({parameters_of(api, callback)});\n")
    out += [struct_text(api, struct) for struct in api.vulkan_structs + api.structs]
    out.append("\npublic static unsafe class Native {\n")
    out += [f"{docs(row['doc'], '    ')}    public const {C_TYPES[row['type']]} {row['name']} = {row['value']};\n"
            for row in api.constants]
    for function in api.functions:
        out.append('    [DllImport("darkroom", CallingConvention = CallingConvention.Cdecl)]\n'
                   f"    public static extern {type_of(api, function.result)} {function.name}"
                   f"({parameters_of(api, function)});\n")
    out.append("}\n" + API)
    out += [method_text(api, function) for function in api.functions]
    return "".join(out) + "}\n\n}\n"
