# SPDX-License-Identifier: MIT
"""What `darkroom_lab api --json` says, for the modules that write it in a language."""

import json

C_TYPES = {"void", "char", "float", "double", "int32_t", "uint32_t", "uint64_t", "size_t"}


class Type:
    """pointers: of each, from the name outwards, "const" or "mutable": what it points to. length: of an array, and of
    a parameter how many it points to; 0: it is none."""

    def __init__(self, row):
        self.name = row["type"]
        self.pointers = row.get("pointers", [])
        self.length = row.get("length", 0)

    def is_text(self):
        return self.name == "char" and self.pointers == ["const"]

    def is_void(self):
        return self.name == "void" and not self.pointers


class Variable:
    def __init__(self, row):
        self.name = row["name"]
        self.type = Type(row)
        self.doc = row.get("doc", "")


class Function:
    """One of the library, or the type of one of the host's that it calls."""

    def __init__(self, row):
        self.name = row["name"]
        self.doc = row["doc"]
        self.result = Type(row["result"])
        self.parameters = [Variable(parameter) for parameter in row["parameters"]]
        self.can_fail = self.result.name == "DarkroomResult"

    def short_name(self):
        return self.name.removeprefix("darkroom_")

    def camel_name(self):
        return "".join(word.capitalize() for word in self.short_name().split("_"))


class Struct:
    def __init__(self, row):
        self.name = row["name"]
        self.doc = row.get("doc", "")
        self.members = [Variable(member) for member in row["members"]]


class Api:
    def __init__(self, document):
        self.version = document["version"]
        self.constants = document["constants"]
        self.handles = document["handles"]
        self.aliases = document["aliases"]
        self.enums = document["enums"]
        self.structs = [Struct(row) for row in document["structs"]]
        self.callbacks = [Function(row) for row in document["callbacks"]]
        self.functions = [Function(row) for row in document["functions"]]
        self.vulkan = document["vulkan"]
        self.vulkan_structs = [Struct(row) for row in self.vulkan if row["kind"] == "struct"]
        # What a name stands for: "c", "handle", "alias", "enum", "struct", "callback", and of Vulkan's "object",
        # "integer", "function" and "opaque" (proof/lab/api/c_header.hpp).
        self.kinds = {name: "c" for name in C_TYPES}
        self.kinds.update({row["name"]: row["kind"] for row in self.vulkan})
        for kind, rows in (("handle", self.handles), ("alias", self.aliases), ("enum", self.enums)):
            self.kinds.update({row["name"]: kind for row in rows})
        self.kinds.update({struct.name: "struct" for struct in self.structs})
        self.kinds.update({callback.name: "callback" for callback in self.callbacks})
        self.sizes = {row["name"]: row["size"] for row in self.vulkan}
        self.alias_types = {row["name"]: row["type"] for row in self.aliases}
        self.soname = ".".join(self.version.split(".")[:2])

    @classmethod
    def read(cls, source):
        """Of api.json."""
        with open(source, encoding="utf-8") as file:
            return cls(json.load(file))

    def integer_bits(self, name):
        """Of one of Vulkan's kind "integer"."""
        return self.sizes[name] * 8

    def head(self, language, comment):
        """How each file begins."""
        lines = [f"Darkroom {self.version} for {language}. "
                 f"Made by programs/bindings/make_bindings.py of `darkroom_lab api --json`:",
                 "docs/bindings.md. A change here is lost; what is said of a name is said in darkroom.h."]
        return "".join(f"{comment} {line}\n" for line in lines)


def type_in_bits(api, name, c_types, pointer):
    """A type without its pointers, for languages that name integers by their bits: u32, i32."""
    kind = api.kinds[name]
    if kind == "c":
        return c_types[name]
    if kind == "integer":
        return f"u{api.integer_bits(name)}"
    if kind == "object":
        return "u64"
    if kind == "function" or (kind == "handle" and name.startswith("Vk")):
        return pointer
    return "i32" if kind == "enum" and name.startswith("Vk") else name


def safe_name(name, keywords, form):
    """A name that is a word of the language itself, in the form that the language has for it."""
    return form.format(name) if name in keywords else name
