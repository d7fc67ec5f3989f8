#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check_texts.py BINDINGS API.json FOLDER: every name that the header declares stands in the file of every language, each
begins with the version, and those that no test compiles say so. Names in the page's examples of these are declared, too."""

import os
import re
import sys

sys.path.insert(0, sys.argv[1])
from api import Api  # noqa: E402
from make_bindings import FILES  # noqa: E402

UNTESTED = {"zig", "odin"}


def names_of(api):
    names = {row["name"] for rows in (api.constants, api.aliases, api.enums, api.handles) for row in rows}
    names |= {value["name"] for row in api.enums for value in row["values"]}
    for struct in api.structs:
        names |= {struct.name} | {member.name for member in struct.members}
    for function in api.functions + api.callbacks:
        names.add(function.name)
    return names


def examples_of(language):
    """The page's blocks of a language."""
    with open(os.path.join(sys.argv[1], "..", "..", "docs", "bindings.md"), encoding="utf-8") as opened:
        return re.findall(rf"^```{language}\n(.*?)^```", opened.read(), re.M | re.S)


def main():
    api = Api.read(sys.argv[2])
    names = names_of(api)
    faults = [] if len(names) > 400 else [f"{sys.argv[2]} has {len(names)} names only"]
    for language, file in FILES.items():
        path = os.path.join(sys.argv[3], file)
        with open(path if os.path.isfile(path) else f"{path}/darkroom/src/lib.rs", encoding="utf-8") as opened:
            text = opened.read()
        if not re.match(rf"(//|#) Darkroom {re.escape(api.version)} for ", text):
            faults.append(f"{file} does not begin with the version")
        if ("Untested" in "".join(text.splitlines(True)[:6])) != (language in UNTESTED):
            faults.append(f"{file} says otherwise than is so whether it is tested")
        # What stands in a comment is not declared, nor what is called.
        code = re.sub(r"(?m)^\s*(//|#).*$", "", text)
        if language in UNTESTED:
            for left, right in ("()", "{}", "[]"):
                if code.count(left) != code.count(right):
                    faults.append(f"{file}: {code.count(left)} {left} and {code.count(right)} {right}")
        words = set(re.findall(r"[A-Za-z_][A-Za-z0-9_]*", code))
        # An alias is its own type in Python, a list of numbers knows it as one.
        left_out = {row["name"] for row in api.aliases} if language == "python" else set()
        if language == "java":
            # They are pointers and numbers there.
            left_out = {row["name"] for rows in (api.aliases, api.handles, api.enums) for row in rows}
        if language in ("c_loader", "rust_crates"):
            # The rest is declared by the header that the one includes, and by the crate that the other has.
            left_out = names - {function.name for function in api.functions}
        faults += [f"{file} has no {name}" for name in sorted(names - left_out - words)]
    for language in sorted(UNTESTED):
        used = set(re.findall(r"\b(?:darkroom_|DARKROOM_|Darkroom)\w+", "".join(examples_of(language))))
        if len(used) < 3:
            faults.append(f"docs/bindings.md has no example in {language}")
        faults += [f"docs/bindings.md: {name} of its {language} is not declared" for name in sorted(used - names)]
    print("\n".join(faults[:40]))
    return 1 if faults else 0


sys.exit(main())
