# SPDX-License-Identifier: MIT
"""A colour table made of a function, written as .cube, read again and applied. lut.py [OUT.cube]"""

import pathlib
import sys

import numpy

import darkroom

tree = pathlib.Path(__file__).resolve().parents[3]
out = sys.argv[1] if len(sys.argv) > 1 else "teal.cube"

# cube[red, green, blue] for code values from 0 to 1: shadows go to teal, the rest keeps its colour.
colors = darkroom.Table.identity(33).cube
luma = colors @ numpy.float32([0.2126, 0.7152, 0.0722])
shadow = (1 - luma[..., None]) ** 2
table = darkroom.Table(colors * (1 - 0.4 * shadow) + shadow * numpy.float32([0.0, 0.06, 0.08]), title="teal")
table.write(out)

frame = darkroom.files.read_frame(tree / "samples" / "window.exr")
color = frame["color"][::4, ::4, :3]
stack = darkroom.Stack().tonemap().lut(lut=out)
graded, plain = stack.develop(color, output="encoded"), darkroom.Stack().tonemap().develop(color, output="encoded")
expected = darkroom.Table.read(out)(plain)
error = float(numpy.abs(graded - expected).max())
print(f"{out}: GPU and table differ by at most {error * 255:.2f} codes")
assert error < 0.5 / 255
