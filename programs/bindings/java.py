# SPDX-License-Identifier: MIT
"""Darkroom for Java, by JNA."""

from api import safe_name

C_TYPES = {"void": "void", "char": "byte", "float": "float", "double": "double", "int32_t": "int", "uint32_t": "int",
           "uint64_t": "long", "size_t": "long"}
KEYWORDS = set("""abstract assert boolean break byte case catch char class const continue default do double else enum
    extends final finally float for goto if implements import instanceof int interface long native new package private
    protected public return short static strictfp super switch synchronized this throw throws transient try void
    volatile while true false null""".split())

HEAD = '''//
// The functions are those of `Darkroom.Functions`; check() throws what failed. A struct knows its size; one that another points
// to is a ByReference. Numbers that a call gives come in an array of one, objects in a PointerByReference. Handles of Vulkan
// are the pointers and numbers that LWJGL has: new Pointer(device.address()). For systems of 64 bits.

import com.sun.jna.Callback;
import com.sun.jna.Library;
import com.sun.jna.Native;
import com.sun.jna.Pointer;
import com.sun.jna.Structure;
import com.sun.jna.ptr.PointerByReference;
import java.util.Map;

public final class Darkroom {
    private Darkroom() {}

    /** Its message is one line: place, thing, value, what is allowed. */
    public static final class Failure extends RuntimeException {
        private static final long serialVersionUID = 1;
        public final int result;
        Failure(int result, String text) {
            super(text);
            this.result = result;
        }
    }

    /** The library, by its path, or by its name where the system finds it. */
    public static Functions load(String library) {
        return Native.load(library, Functions.class, Map.of(Library.OPTION_STRING_ENCODING, "UTF-8"));
    }
    /** Of a call on this thread. */
    public static void check(Functions functions, int result) {
        if (result != DARKROOM_OK) throw new Failure(result, functions.darkroom_error());
    }
'''


def name_of(name):
    return safe_name(name, KEYWORDS, "{}_")


def docs(doc, indent="    "):
    text = doc.replace("&", "&amp;").replace("<", "&lt;").replace("*/", "*&#47;").replace("@", "&#64;")
    return f"{indent}/** {text} */\n" if doc else ""


def base_type(api, name):
    kind = api.kinds[name]
    if kind == "c":
        return C_TYPES[name]
    if kind == "alias":
        return C_TYPES[api.alias_types[name]]
    if kind == "integer":
        return {32: "int", 64: "long"}[api.integer_bits(name)]
    if kind in ("handle", "function", "opaque"):
        return "Pointer"
    return {"object": "long", "enum": "int"}.get(kind, name)


def is_number(api, type):
    return base_type(api, type.name) in ("int", "long", "float", "double")


def member_type(api, type):
    if type.is_text():
        return "String"
    if len(type.pointers) == 1 and api.kinds[type.name] == "struct":
        return f"{type.name}.ByReference"
    if type.pointers:
        return "Pointer"
    return base_type(api, type.name) + ("[]" if type.length else "")


def parameter_type(api, type):
    if type.is_text():
        return "String"
    if not type.pointers:
        return f"{type.name}.ByValue" if api.kinds[type.name] == "struct" else base_type(api, type.name)
    if len(type.pointers) > 1:
        return "PointerByReference"
    if api.kinds[type.name] == "struct":
        return type.name
    if is_number(api, type):
        return base_type(api, type.name) + "[]"
    is_given = type.pointers == ["mutable"] and api.kinds[type.name] == "handle"
    return "PointerByReference" if is_given else "Pointer"


def parameters_of(api, function):
    return ", ".join(f"{parameter_type(api, one.type)} {name_of(one.name)}" for one in function.parameters)


def result_of(api, function):
    return "String" if function.result.is_text() else base_type(api, function.result.name)


def struct_text(api, struct):
    members = ""
    for member in struct.members:
        made = ""
        if member.type.length and not member.type.pointers:
            made = f" = new {base_type(api, member.type.name)}[{member.type.length}]"
        elif not member.type.pointers and api.kinds[member.type.name] == "struct":
            made = f" = new {member.type.name}()"
        members += (f"{docs(member.doc, '        ')}        public {member_type(api, member.type)} "
                    f"{name_of(member.name)}{made};\n")
    order = ", ".join(f'"{name_of(member.name)}"' for member in struct.members)
    sized = "" if struct.name.startswith("Vk") else "            struct_size = size();\n"
    return (f"\n{docs(struct.doc)}    @Structure.FieldOrder({{{order}}})\n"
            f"    public static class {struct.name} extends Structure {{\n{members}"
            f"        public {struct.name}() {{\n{sized}        }}\n"
            f"        public static final class ByReference extends {struct.name} implements Structure.ByReference {{}}\n"
            f"        public static final class ByValue extends {struct.name} implements Structure.ByValue {{}}\n    }}\n")


def write(api):
    out = [api.head("Java", "//"), HEAD, "\n"]
    out += [f"{docs(row['doc'])}    public static final long {row['name']} = {row['value']}L;\n" for row in api.constants]
    for row in api.enums:
        out.append(f"\n    // {row['name']}{': ' + row['doc'] if row['doc'] else ''}\n")
        out += [f"{docs(value['doc'])}    public static final int {value['name']} = {value['value']};\n"
                for value in row["values"]]
    for callback in api.callbacks:
        out.append(f"\n{docs(callback.doc)}    public interface {callback.name} extends Callback {{\n"
                   f"        {result_of(api, callback)} invoke({parameters_of(api, callback)});\n    }}\n")
    out += [struct_text(api, struct) for struct in api.vulkan_structs + api.structs]
    out.append("\n    /** As they are in C. */\n    public interface Functions extends Library {\n")
    out += [f"{docs(function.doc, '        ')}        {result_of(api, function)} {function.name}"
            f"({parameters_of(api, function)});\n" for function in api.functions]
    return "".join(out) + "    }\n}\n"
