#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""page_blocks.py TREE: every block of code of every page is named below with the test that runs it, and every such test
is there. What no machine can run is said to be so, with the reason."""

import re
import sys
from pathlib import Path

# Page, kinds of its blocks, test. A block without a kind is what a program prints.
TAKEN = """
README.md               sh        CliPages.Readme
README.md               cpp       PageCode
README.md               toml      CliPages.TomlAndGlslAreRead
docs/architecture.md    shown     CliDocuments.ThePlanIsTheOneThatIsPrinted
docs/bindings.md        python    BindingsPython
docs/bindings.md        rust      BindingsRust
docs/bindings.md        csharp    BindingsCSharp
docs/bindings.md        zig,odin  BindingsTexts
docs/bindings.md        sh        CliPages.Bindings
docs/c.md               c         PageCode
docs/c.md               sh,cmake  PageBuilds
docs/command_line.md    sh        CliPages.CommandLine
docs/console.md         cpp       PageCode
docs/console.md         shown     Console.OutOfRangeIsSetToTheBoundAndSaid
docs/controllers.md     cpp       PageCode
docs/controllers.md     lua       CliPages.DocumentsControllersAndCameras
docs/conventions.md     toml      CliPages.DocumentsControllersAndCameras
docs/custom_effects.md  sh        CliPages.CustomEffects
docs/custom_effects.md  toml,glsl CliPages.TomlAndGlslAreRead
docs/embedding.md       cpp       PageCode
docs/embedding.md       glsl      CliPages.TomlAndGlslAreRead
docs/embedding.md       sh,cmake  PageBuilds
docs/errors.md          text      CliPages.WhatTheySayIsPrinted
docs/farm.md            sh        CliPages.Farm
docs/farm.md            yaml      CliPages.FarmsWithoutSlurm
docs/hosts.md           c         ExampleSwapchain
docs/hosts.md           cpp       ExampleVma
docs/hosts.md           go        ExampleCgo
docs/hosts.md           java      ExampleLwjgl
docs/hosts.md           rust      ExampleAsh
docs/hosts.md           sh,toml   PageBuilds
docs/hud.md             xml       CliPages.DocumentsControllersAndCameras
docs/install.md         sh,cmake  PageBuilds
docs/interface.md       shown     a picture of wires
docs/interface.md       sh        CliPages.Interface
docs/interface.md       toml      CliPages.TomlAndGlslAreRead
docs/interface.md       cpp       PageCode
docs/jobs.md            sh        CliPages.Jobs
docs/kernel_costs.md    shown     a table of one chip
docs/looks.md           toml      CliPages.TomlAndGlslAreRead
docs/looks.md           sh        CliPages.LooksScenesAndProbing
docs/looks.md           cpp       PageCode
docs/looks.md           shown     CliPages.WhatTheySayIsPrinted
docs/packaging.md       sh        PageBuilds
docs/probe.md           sh        CliPages.LooksScenesAndProbing
docs/probe.md           shown     CliProbe
docs/python.md          python    Python
docs/python.md          sh        PageBuilds
docs/recipes.md         sh,text   CliRecipes
docs/recipes.md         yaml      CliRecipes.PicturesThatAreWatchedByCi
docs/scenes.md          sh        CliPages.LooksScenesAndProbing
docs/scenes.md          toml      CliPages.TomlAndGlslAreRead
docs/temporal.md        cpp       PageCode
docs/temporal_lab.md    sh        CliPages.TemporalLab
docs/troubleshooting.md text      CliPages.WhatTheySayIsPrinted
docs/tutorial.md        sh        CliPages.Tutorial
docs/tutorial.md        toml      CliPages.TomlAndGlslAreRead
docs/tutorial.md        cpp,glsl  PageCode
docs/verify.md          sh        CliPages.Verify
docs/verify.md          shown     what a wrong driver gives
docs/viewer.md          sh        CliPages.Windows
docs/windows.md         sh        PageBuilds
effects                 sh        CliPages.Effects
effects                 toml      CliPages.TomlAndGlslAreRead
"""


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    tree = Path(sys.argv[1])
    taken, tests = set(), set()
    for line in TAKEN.split("\n"):
        if words := line.split(maxsplit=2):
            taken |= {(words[0], kind) for kind in words[1].split(",")}
            tests |= {words[2]} if re.fullmatch(r"\w+(\.\w+)?", words[2]) else set()
    found = set()
    for page in [tree / "README.md", *sorted(tree.glob("docs/*.md")), *sorted(tree.glob("effects/*/*.md"))]:
        name = page.relative_to(tree).as_posix()
        for kind in re.findall(r"^```(\w*)\n.*?^```", page.read_text(), re.M | re.S):
            found.add((re.sub("^effects/.*", "effects", name), kind or "shown"))
    wrong = [f"{page}: no test is named that takes its blocks of {kind}" for page, kind in sorted(found - taken)]
    wrong += [f"{page}: has no block of {kind}" for page, kind in sorted(taken - found)]
    folders = ("tests", "engine", "files", "run", "scenes", "edit", "proof")
    sources = "".join(path.read_text() for path in [*(test for folder in folders for test in tree.glob(f"{folder}/**/*_test.cpp")),
                                                    tree / "tests/CMakeLists.txt", tree / "examples/CMakeLists.txt"])
    for test in sorted(tests):
        suite, _, name = test.partition(".")
        form = rf"TEST(_F|_P)?\({suite}, {name}" if name else rf"TEST(_F|_P)?\({suite},|add_test\((NAME )?{suite} "
        language = suite.removeprefix("Bindings") in ("Python", "Rust", "CSharp")
        if not re.search(form, sources) and not (language and "darkroom_add_test(Bindings${language}" in sources):
            wrong.append(f"there is no test {test}")
    print("\n".join(wrong or [f"page_blocks: {len(found)} kinds of blocks, each with its test"]))
    return 1 if wrong else 0


sys.exit(main())
