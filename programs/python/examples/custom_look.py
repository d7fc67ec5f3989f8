# SPDX-License-Identifier: MIT
"""A look made in Python, with a mask, an effect of one's own and wires, saved as a file that `darkroom` develops with."""

import pathlib

import numpy

import darkroom

tree = pathlib.Path(__file__).resolve().parents[3]
color = darkroom.files.read_frame(tree / "samples" / "window.exr")["color"][::4, ::4, :3]

stack = darkroom.Stack()
stack.exposure(exposure="0.5ev")
stack.high_pass(output="bright", threshold=2.0)
stack.gaussian_blur(radius=12, output="soft")
stack.exposure(input="scene", exposure="0.5ev", name="again")
stack.blend(second="soft", amount=0.6)
stack.tonemap(curve="hable")
stack.add(tree / "examples" / "duotone.glsl", amount=0.35)
stack.vignette(intensity=0.4)
stack.save("own.toml")
print(stack)

picture = stack.develop(color)
numpy.testing.assert_array_equal(picture, darkroom.develop(color, "own.toml"))
darkroom.files.write("own.png", picture)
print("own.toml, own.png")
