#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""effect_folders.py TREE BUILD NINJA: any folder of effects/ can be removed, because nothing reads it but its own files,
tests that are left out without it (tests/CMakeLists.txt), and what takes all effects as they come. Says of every object
of a build what it has read, as the compilers told ninja; of shaders, what they include."""

import json
import re
import subprocess
import sys
from pathlib import Path

# What is made of all effects, whichever there are, and what shows some and is left out without them.
OF_ALL = re.compile(r"effect_registry|darkroom_tests\.dir|^examples/|^proof/bench/|darkroom_check_shaders|darkroom_headers_alone")
# As <darkroom/effects/NAME.hpp>, which is a link to it.
PUBLIC = re.compile(r"(?:^|/)effects/(\w+)(?:/\1)?\.hpp$")


def objects_of(build, ninja):
    """Each object of the build, and the files that it was made of."""
    told = subprocess.run([ninja, "-C", build, "-t", "deps"], capture_output=True, text=True, check=True).stdout
    commands = json.loads((Path(build) / "compile_commands.json").read_text())
    built = {re.search(r" -o (\S+)", command["command"]).group(1) for command in commands}
    for block in told.split("\n\n"):
        head, *files = block.strip().splitlines() or [""]
        name = head.split(": #deps")[0]
        if name in built and head.endswith("(VALID)"):
            yield name, [file.strip() for file in files]


def shows(files, build, effect):
    """Whether a file of tests includes the effect's header, so that it is left out without it."""
    line = f"#include <darkroom/effects/{effect}.hpp>"
    return any(line in (build / file).resolve().read_text() for file in files if file.endswith("_test.cpp"))


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    tree, build, ninja = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3]
    effects = {header.stem for header in tree.glob("effects/*/*.hpp") if header.stem == header.parent.name}
    inside = re.compile(r"(?:^|/)effects/(\w+)/")
    wrong, count = set(), 0
    for name, files in objects_of(str(build), ninja):
        count += 1
        homes = {found.group(1) for file in files if file.endswith(".cpp") and (found := inside.search(file))}
        takes_all = any(file.endswith("generated/include/darkroom/effects.hpp") for file in files)
        if takes_all and not OF_ALL.search(name):
            wrong.add(f"{name} reads <darkroom/effects.hpp>")
        for file in files:
            public = PUBLIC.search(file)
            found = public or inside.search(file)
            effect = found.group(1) if found else None
            if effect not in effects or effect in homes or (public and takes_all):
                continue
            if public and OF_ALL.search(name) and "darkroom_tests" not in name:
                continue
            if "darkroom_tests" not in name or not shows(files, build, effect):
                wrong.add(f"{name} reads {file}")
    for shader in tree.glob("effects/*/*.glsl"):
        for effect in re.findall(r'^#include "(\w+)/', shader.read_text(), re.M):
            if effect in effects and effect != shader.parent.name:
                wrong.add(f"{shader.relative_to(tree)} includes what is of {effect}")
    if len(effects) < 40 or count < 300:
        wrong.add(f"{len(effects)} effects and {count} objects were found, 40 and 300 and more are there")
    print("\n".join(sorted(wrong)) or f"{len(effects)} effects, of which {count} objects read none but what they show")
    return 1 if wrong else 0


sys.exit(main())
