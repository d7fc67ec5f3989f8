#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""abi.py BINDINGS API.json LAYOUT: what compiled programs hold of libdarkroom.so, a line each: values of enums, the
place, size and type of members (LAYOUT has them of C, make_layouts.py), and the functions that are called."""

import sys

sys.path.insert(0, sys.argv[1])
from api import Api  # noqa: E402


def type_text(type):
    out = type.name
    for pointer in type.pointers:
        out = f"const {out}*" if pointer == "const" else f"{out}*"
    return out + (f"[{type.length}]" if type.length else "")


def signature(function):
    return f"{type_text(function.result)} ({', '.join(type_text(one.type) for one in function.parameters)})"


def main():
    api = Api.read(sys.argv[2])
    with open(sys.argv[3], encoding="utf-8") as file:
        layout = dict(line.rstrip("\n").split(" ", 1) for line in file)
    for row in api.constants:
        # That of the version is another with each.
        if row["name"] != "DARKROOM_VERSION":
            print(f"{row['name']} = {row['value']}")
    for row in api.aliases:
        print(f"{row['name']}: {row['type']}")
    for row in api.enums:
        for value in row["values"]:
            print(f"{row['name']} {value['name']} = {value['value']}")
    for struct in api.structs:
        for member in struct.members:
            place, size = layout[f"{struct.name}.{member.name}"].split()
            print(f"{struct.name}.{member.name}: {size} bytes at {place}, {type_text(member.type)}")
        print(f"{struct.name}: {layout[struct.name]} bytes")
    for callback in api.callbacks:
        print(f"{callback.name}: {signature(callback)}")
    for function in api.functions:
        print(f"{function.name}: {signature(function)}")


main()
