#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""make_bindings.py API.json FOLDER [LANGUAGE...]: writes what languages call Darkroom by into a folder, of what
`darkroom_lab api --json` says (docs/bindings.md). Another language is a module beside this one with a function write(api)
that returns the text, or texts by their places in a folder."""

import importlib
import os
import sys

from api import Api

FILES = {"c_loader": "include/darkroom/darkroom_load.h", "python": "darkroom_ctypes.py", "rust": "darkroom.rs",
         "rust_crates": "rust", "csharp": "Darkroom.cs", "java": "Darkroom.java", "zig": "darkroom.zig", "odin": "darkroom.odin"}


def write(path, text):
    """Whole or not at all."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(path + ".part", path)


def main(arguments):
    languages = arguments[2:] or list(FILES)
    if len(arguments) < 2 or not set(languages) <= set(FILES):
        print(f"usage: make_bindings.py API.json FOLDER [{'|'.join(FILES)}...]", file=sys.stderr)
        return 1
    api = Api.read(arguments[0])
    for language in languages:
        written = importlib.import_module(language).write(api)
        path = os.path.join(arguments[1], FILES[language])
        for file, text in ({"": written} if isinstance(written, str) else written).items():
            write(os.path.join(path, file) if file else path, text)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
