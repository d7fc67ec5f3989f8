# SPDX-License-Identifier: MIT
"""make_pages.py [--check] DARKROOM: writes what pages say of the effects and of the sources, from the program and the
tree: docs/effects.md, docs/parameters.md, docs/errors.md and the table of the README. With --check nothing is written:
it names what would change, and what points nowhere in any page."""

import json
import re
import subprocess
import sys
from pathlib import Path

import make_pictures

tree = Path(__file__).resolve().parents[2]

# What a user wants, as the pages of effects say it behind "Purpose:".
purposes = {
    "light": "glow, exposure, occlusion and streaks",
    "air": "fog and haze",
    "lens": "what a camera's lens and film do",
    "colour": "from the scene's light to a display, and grading",
    "motion": "several frames in one",
    "style": "edges, blurs, grain and signal",
    "interface": "a chain of its own for a game's interface",
}


# What has no pictures, and why.
without_pictures = {"encode": "a picture of integers is encoded with this entry or without it"}


def effects_of(darkroom):
    run = subprocess.run([darkroom, "effects", "--json"], check=True, capture_output=True, text=True)
    effects = json.loads(run.stdout)
    for effect in effects:
        page = (tree / "effects" / effect["name"] / f"{effect['name']}.md").read_text()
        effect["purpose"] = re.search(r"^Purpose: (\w+)\.$", page, re.M)[1]
    return effects


def by_purpose(effects):
    return [(name, text, [effect for effect in effects if effect["purpose"] == name])
            for name, text in purposes.items()]


def link(effect, root):
    name = effect["name"]
    return f"[`{name}`]({root}effects/{name}/{name}.md)"


def readme_table(effects):
    lines = ["| For | Effects |", "|---|---|"]
    for name, text, members in by_purpose(effects):
        lines.append(f"| **{name}**: {text} | " + ", ".join(link(effect, "") for effect in members) + " |")
    return "\n".join(lines) + "\n"


def settings_of(pair):
    """What the two pictures of an effect were made with, where it is not the scene's look alone."""
    said = [f"{word} `{re.sub(' *--(ui|game) [^ ]+', '', flags).strip()}`" for word, flags in (("off", pair.off), ("on", pair.on))
            if "{" not in flags and re.sub(" *--(ui|game) [^ ]+", "", flags)]
    if pair.part:
        said.append(f"a part, each pixel {pair.part.scale} times as wide" if pair.part.scale > 1 else "a part, pixel by pixel")
    if pair.part and pair.part.contrast != 1:
        said.append(f"with {pair.part.contrast} times the contrast")
    return f" *{', '.join(said)}*" if said else ""


def effects_page(effects):
    out = ["# Effects, off and on\n",
           "What each effect does, grouped by what you want. `./darkroom effects NAME` prints an effect's page;",
           "[Parameters](parameters.md) lists the keys of all. The pictures are of the scenes that ship, by their own looks, with",
           "the flags that stand beside them. `docs/make/make_pictures.py` makes them, `docs/make/make_pages.py` this page.\n"]
    for name, text, members in by_purpose(effects):
        out += [f"## {name.capitalize()}: {text}\n", "| Effect | Off | On |", "|---|---|---|"]
        for effect in members:
            name, doc = effect["name"], effect["doc"]
            reason = without_pictures.get(name)
            if not reason and name not in make_pictures.effects:
                sys.exit(f"docs/make/make_pictures.py: has no pictures of {name}")
            pictures = [reason, ""] if reason else [f"![{name} {state}](pictures/{path})"
                                                    for state, path in zip(("off", "on"), make_pictures.pictures_of(name))]
            settings = "" if reason else settings_of(make_pictures.effects[name])
            out.append(f"| {link(effect, '../')}: {doc}{settings} | " + " | ".join(pictures) + " |")
        out.append("")
    return "\n".join(out)


def allowed(row):
    if row["type"] == "choice":
        return " ".join(f"`{choice}`" for choice in row["choices"])
    if row["type"] == "bool":
        return "`true` `false`"
    if row["type"] == "resource":
        return "a file"
    number = lambda value: f"{value:g}" if abs(value) < 1e6 or value % 1e6 else f"{value:.0e}".replace("e+0", "e")
    text = f"[{number(row['min'])}, {number(row['max'])}] {row['unit']}".strip()
    counts = {"vec2": "2 numbers in ", "vec3": "3 numbers in ", "vec4": "4 numbers in ", "rgb": "3 numbers in ",
              "int": "whole, ", "curve": "points, y in "}
    return counts.get(row["type"], "") + text


def parameters_page(effects):
    out = ["# Parameters\n",
           "Every parameter of every effect. `bloom_intensity = 0.1` in a look, `--bloom-intensity 0.1` on the command line",
           "and `bloom.intensity` in the console set the same value. The key is that of the flat table; in a `[[stack]]`",
           "entry it stands without the effect's name (`intensity = 0.1`). A key in **bold** switches the effect: above 0 on,",
           "at 0 off. [Looks](looks.md) has the keys of entries and files, [Effects](effects.md) the pictures.",
           "`docs/make/make_pages.py` makes this page from the effects' own descriptions.\n"]
    for name, text, members in by_purpose(effects):
        out.append(f"## {name.capitalize()}: {text}\n")
        for effect in members:
            out += [f"### {effect['name']}\n", f"{effect['doc']} {link(effect, '../')}\n"]
            if not effect["parameters"]:
                continue
            out += ["| Key | Allowed | Default | What it is |", "|---|---|---|---|"]
            for row in effect["parameters"]:
                key = f"**`{row['key']}`**" if row["switches_effect"] else f"`{row['key']}`"
                default = row["default"]
                default = json.dumps(default) if not isinstance(default, str) else default
                default = f"`{default}`" if default else ""
                doc = row["doc"] + (" A change compiles the stack anew." if row["at_compile"] else "")
                out.append(f"| {key} | {allowed(row)} | {default} | {doc} |")
            out.append("")
    return "\n".join(out)


# Functions whose argument is the text of an error or a warning.
tellers = re.compile(r"\b(\w*_error|error|refused?|fail\w*|malformed|wrong\w*|complain|warn\w*)\(")
literal = r'"((?:[^"\\\n]|\\.)*)"'
areas = {
    "programs/darkroom": "The command line",
    "edit/viewer": "Play and edit",
    "proof/verifier": "Verifying",
    "proof/verify": "Verifying: the kernels",
    "effects": "Effects",
    "files/looks": "Looks",
    "files/toml": "TOML",
    "edit/edit": "Editing looks",
    "edit/panels": "The editor's panels",
    "edit/window": "Windows of the desktop",
    "engine/custom": "Custom effects",
    "run/script": "Console and controllers",
    "run/hud": "Documents of the interface",
    "scenes/scene": "Scenes and models",
    "scenes/draco": "Scenes and models: Draco",
    "scenes/render": "The renderer of scenes",
    "files/image": "Pictures and frames",
    "files/formats": "Formats of pictures",
    "files/decode": "The process that decodes",
    "files/oiio": "Pictures by OpenImageIO",
    "files/tables": "Colour tables",
    "files/ocio": "OpenColorIO",
    "engine/compose": "Composer",
    "engine/plan": "Planner",
    "engine/graph": "Graph",
    "run/develop": "Developing",
    "engine/gpu": "Vulkan",
    "engine/glsl": "The compiler of GLSL",
    "engine/c": "The C interface",
    "files/confined": "Confined processes",
    "engine/core": "Values and files",
}
houses = ("engine", "files", "run", "scenes", "edit", "proof", "programs")
left_out = ("test", "graph_check", "run/svg")


def argument_of(text, at):
    """From behind an opening bracket to the one that closes it."""
    depth, place = 1, at
    while depth and place < len(text):
        if text[place] == '"':
            place = re.compile(literal, re.S).match(text, place).end() if re.compile(literal).match(text, place) else place + 1
            continue
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        place += 1
    return text[at:place - 1]


def texts_of(source):
    text = re.sub(r'R"\((.*?)\)"', '""', source, flags=re.S)
    text = re.sub(r"^\s*//.*$", "", text, flags=re.M)
    found = []
    for teller in tellers.finditer(text):
        inner = argument_of(text, teller.end())
        # Literals side by side are one; the first with a word in it is the text, what follows are words of it.
        inner = re.sub(r'(?<!\\)"\s*"', "", inner)
        words = [word for word in re.findall(literal, inner) if re.search(r"[a-z]{2}", word)]
        if words and " " in words[0]:
            shown = words[0].replace('\\"', '"').replace("\\\\", "\\").replace("{{", "{").replace("}}", "}")
            if shown not in found:
                found.append(shown)
    return found


def errors_page():
    out = ["# Errors\n",
           "Every text of an error or a warning, by the part that says it; `{}` stands for a value. An error is one line:",
           "place, thing, value, what is allowed. Exit code 1: a file, a flag or a value is wrong; 2: Vulkan or the system",
           "failed. [Troubleshooting](troubleshooting.md) has what to do about the frequent ones. `docs/make/make_pages.py`",
           "makes this page from the sources.\n",
           "For example:\n",
           "```text",
           "darkroom: my.toml:4:19: bloom_intensity = -1: allowed is [0, 16]",
           "```\n"]
    files = [file for folder in (*houses, "effects") for file in sorted((tree / folder).rglob("*.[ch]pp"))]
    names = [(file.relative_to(tree).as_posix(), file) for file in files]
    for folder, title in areas.items():
        section = []
        for name, file in names:
            if not name.startswith(folder + "/") or any(part in name for part in left_out):
                continue
            section += [text for text in texts_of(file.read_text()) if text not in section]
        if section:
            out += [f"## {title}\n"] + [f"- `` {text} ``" if "`" in text else f"- `{text}`" for text in section] + [""]
    return "\n".join(out)


def with_readme_table(effects):
    page = (tree / "README.md").read_text()
    return re.sub(r"\| For \| Effects \|\n(?:\|.*\n)+", lambda _: readme_table(effects), page)


def anchors_of(page):
    """What a link into a page may name, as GitHub makes it of headings."""
    names = set()
    text = re.sub(r"^```.*?^```", "", page, flags=re.M | re.S)
    for heading in re.findall(r"^#+ (.*)$", text, re.M):
        plain = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        number = 1
        while (name if number == 1 else f"{name}-{number - 1}") in names:
            number += 1
        names.add(name if number == 1 else f"{name}-{number - 1}")
    return names


def dead_links():
    pages = [tree / "README.md", tree / "CHANGELOG.md", *sorted(tree.glob("docs/*.md")), *sorted(tree.glob("effects/*/*.md"))]
    dead, reached = [], set()
    for page in pages:
        text = re.sub(r"^ *```.*?^ *```", "", page.read_text(), flags=re.M | re.S)
        text = re.sub(r"`[^`\n]*`", lambda code: "`" if "](" in code[0] else code[0], text)
        for target in re.findall(r"\]\(([^)\s]+)\)", text):
            if re.match(r"https?:", target):
                continue
            path, _, anchor = target.partition("#")
            file = (page.parent / path).resolve() if path else page
            reached.add(file)
            if not file.exists():
                dead.append(f"{page.relative_to(tree)}: {target}: there is no such file")
            elif anchor and file.suffix == ".md" and anchor not in anchors_of(file.read_text()):
                dead.append(f"{page.relative_to(tree)}: {target}: there is no such heading")
    for page in [*pages[1:], *sorted(tree.glob("docs/pictures/**/*.*"))]:
        if page not in reached:
            dead.append(f"{page.relative_to(tree)}: no page links to it")
    return dead


def main():
    is_check = sys.argv[1:2] == ["--check"]
    if len(sys.argv) != 2 + is_check:
        sys.exit(__doc__)
    effects = effects_of(sys.argv[-1])
    made = {"docs/effects.md": effects_page(effects), "docs/parameters.md": parameters_page(effects),
            "docs/errors.md": errors_page(), "README.md": with_readme_table(effects)}
    stale = [name for name, text in made.items() if not (tree / name).exists() or (tree / name).read_text() != text]
    if not is_check:
        for name, text in made.items():
            (tree / name).write_text(text)
        return
    wrong = [f"{name}: is not what the tree says: run docs/make/make_pages.py" for name in stale] + dead_links()
    if readme_table(effects) not in made["README.md"]:
        wrong.append("README.md: has no table of effects")
    wrong += [f"{picture.relative_to(tree)}: names the command that made it, and its folders"
              for picture in tree.glob("docs/pictures/**/*.jpg") if b"oiiotool" in picture.read_bytes()]
    for line in wrong:
        print(line)
    sys.exit(1 if wrong else 0)


main()
