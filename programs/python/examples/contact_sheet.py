# SPDX-License-Identifier: MIT
"""A contact sheet: one frame through several looks, side by side. contact_sheet.py [OUT.png] [LOOK.toml ...]"""

import pathlib
import sys

import numpy

import darkroom

tree = pathlib.Path(__file__).resolve().parents[3]
out = sys.argv[1] if len(sys.argv) > 1 else "sheet.png"
looks = [pathlib.Path(name) for name in sys.argv[2:]]
looks = looks or [tree / "looks" / f"{name}.toml" for name in ("clean", "film", "noir", "night")]

frame = darkroom.files.read_frame(tree / "samples" / "window.exr")
color = frame["color"][::4, ::4, :3]
cells = [darkroom.develop(color, look) for look in looks]
columns, gap = 2, 4
height, width = cells[0].shape[:2]
rows = -(-len(cells) // columns)
sheet = numpy.full((rows * (height + gap) + gap, columns * (width + gap) + gap, 3), 24, numpy.uint8)
for index, cell in enumerate(cells):
    y, x = (gap + place * (side + gap) for place, side in zip(divmod(index, columns), (height, width)))
    sheet[y : y + height, x : x + width] = cell
darkroom.files.write(out, sheet)
print(f"{out}: {', '.join(look.stem for look in looks)}")
