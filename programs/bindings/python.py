# SPDX-License-Identifier: MIT
"""Darkroom for Python, by ctypes."""

import keyword

from api import safe_name

C_TYPES = {"char": "c_char", "float": "c_float", "double": "c_double", "int32_t": "c_int32", "uint32_t": "c_uint32",
           "uint64_t": "c_uint64", "size_t": "c_size_t"}

HEAD = '''"""{version}: the C interface of Darkroom. `Library().composer_add(...)` calls darkroom_composer_add; what can
fail raises DarkroomError. Structs know their size, texts are str or bytes, and a pointer is given as the thing itself or
`ctypes.byref(thing)`. A struct that is passed keeps nothing alive: hold on to what it points to."""

import ctypes
import enum
import sys

DarkroomVersion = "{version}"


class DarkroomError(Exception):
    """result: a DarkroomResult. The text is one line: place, thing, value, what is allowed."""

    def __init__(self, result, text):
        super().__init__(text)
        self.result = result


class _Struct(ctypes.Structure):
    def __init__(self, *values, **members):
        super().__init__(*values, **members)
        self.struct_size = ctypes.sizeof(self)


class _Text(ctypes.c_char_p):
    @classmethod
    def from_param(cls, value):
        return ctypes.c_char_p.from_param(value.encode() if isinstance(value, str) else value)


def _decoded(text):
    return None if text is None else text.decode()

'''

LIBRARY = '''
_FUNCTIONS = {{
{functions}}}


class Library:
    """The functions of the library. `c` has them as they are in C."""

    def __init__(self, path="libdarkroom.dll" if sys.platform == "win32" else "libdarkroom.so.{soname}"):
        self.c = ctypes.CDLL(path)
        for name, (result, parameters) in _FUNCTIONS.items():
            function = getattr(self.c, name)
            function.restype = result
            function.argtypes = parameters

    def _check(self, result):
        if result != DarkroomResult.DARKROOM_OK:
            raise DarkroomError(DarkroomResult(result), self.error())
'''


def name_of(name):
    return safe_name(name, keyword.kwlist, "{}_")


def base_type(api, name):
    kind = api.kinds[name]
    if kind == "c":
        return "ctypes." + C_TYPES[name]
    if kind == "alias":
        return "ctypes." + C_TYPES[api.alias_types[name]]
    if kind == "enum":
        return "ctypes.c_int32"
    if kind == "integer":
        return f"ctypes.c_uint{api.integer_bits(name)}"
    if kind == "object":
        return "ctypes.c_uint64"
    if kind == "function" or (kind == "handle" and name.startswith("Vk")):
        return "ctypes.c_void_p"
    return name


def type_of(api, type, is_parameter=False):
    pointers = len(type.pointers)
    if type.name == "void" and not pointers:
        return "None"
    if type.name == "void" or api.kinds[type.name] == "opaque":
        out, pointers = "ctypes.c_void_p", pointers - 1
    elif type.name == "char" and pointers:
        out, pointers = "_Text" if is_parameter and pointers == 1 else "ctypes.c_char_p", pointers - 1
    else:
        out = base_type(api, type.name)
    for _ in range(pointers):
        out = f"ctypes.POINTER({out})"
    return f"{out} * {type.length}" if type.length and not type.pointers else out


def signature(api, function, is_callback):
    parameters = ", ".join(type_of(api, parameter.type, not is_callback) for parameter in function.parameters)
    return type_of(api, function.result), parameters


def docstring(doc, indent):
    """A backslash or a quote would end it otherwise than meant."""
    text = doc.replace("\\", "\\\\").replace('"""', "'''")
    if text.endswith('"'):
        text += " "
    return f'{indent}"""{text}"""\n' if doc else ""


def struct_text(api, struct):
    rows = "".join(f'    ("{member.name}", {type_of(api, member.type)}),\n' for member in struct.members)
    return f"\n{struct.name}._fields_ = [\n{rows}]\n"


def method_text(function):
    parameters = [name_of(parameter.name) for parameter in function.parameters]
    call = f"self.c.{function.name}({', '.join(parameters)})"
    if function.can_fail:
        body = f"self._check({call})"
    elif function.result.is_text():
        body = f"return _decoded({call})"
    else:
        body = f"return {call}" if not function.result.is_void() else call
    return (f"\n    def {name_of(function.short_name())}({', '.join(['self', *parameters])}):\n"
            f"{docstring(function.doc, '        ')}        {body}\n")


def write(api):
    out = [api.head("Python", "#"), HEAD.format(version=api.version)]
    out += [f"{row['name']} = {row['value']}\n" for row in api.constants]
    for row in api.enums:
        values = "".join(f"    {value['name']} = {value['value']}\n" for value in row["values"])
        out.append(f"\n\nclass {row['name']}(enum.IntEnum):\n{docstring(row['doc'], '    ')}{values}")
    for row in api.handles:
        out.append(f"\n\nclass {row['name']}(ctypes.c_void_p):\n{docstring(row['doc'] or 'A handle.', '    ')}")
    # The types first, because callbacks and structs point to each other.
    for struct in api.vulkan_structs:
        out.append(f"\n\nclass {struct.name}(ctypes.Structure):\n    pass\n")
    for struct in api.structs:
        members = "\n".join(f"    {member.name}: {member.doc}" for member in struct.members if member.doc)
        doc = f"{struct.doc}\n\n{members}\n    " if members else struct.doc
        out.append(f"\n\nclass {struct.name}(_Struct):\n{docstring(doc, '    ') or '    pass' + chr(10)}")
    out.append("\n")
    for callback in api.callbacks:
        result, parameters = signature(api, callback, True)
        out.append(f"\n{callback.name} = ctypes.CFUNCTYPE({result}{', ' + parameters if parameters else ''})\n")
    out += [struct_text(api, struct) for struct in api.vulkan_structs + api.structs]
    rows = []
    for function in api.functions:
        result, parameters = signature(api, function, False)
        rows.append(f'    "{function.name}": ({result}, [{parameters}]),\n')
    out.append(LIBRARY.format(functions="".join(rows), soname=api.soname))
    out += [method_text(function) for function in api.functions]
    return "".join(out)
