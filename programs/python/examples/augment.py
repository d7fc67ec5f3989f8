# SPDX-License-Identifier: MIT
"""A data-set augmented: one frame as many cameras would have taken it. augment.py [FRAME.exr] [OUT.npz]"""

import pathlib
import sys

import numpy

import darkroom

tree = pathlib.Path(__file__).resolve().parents[3]
frame = darkroom.files.read_frame(sys.argv[1] if len(sys.argv) > 1 else tree / "samples" / "window.exr")
out = sys.argv[2] if len(sys.argv) > 2 else "augmented.npz"
color = frame["color"][::4, ::4, :3]  # small, for speed

random = numpy.random.default_rng(7)
stack = darkroom.Stack().exposure().color_grade().bloom().tonemap().film_grain().vignette()
pictures, labels = [], []
for index in range(12):
    stops = random.uniform(-2, 2)
    stack.set("exposure", exposure=2.0**stops)
    stack.set("color_grade", temperature=random.uniform(4500, 9000))
    stack.set("bloom", intensity=random.uniform(0.0, 0.2))
    stack.set("film_grain", amount=random.uniform(0.0, 0.15))
    stack.set("vignette", intensity=random.uniform(0.0, 0.6))
    pictures.append(stack.develop(darkroom.Frame(color, frame_index=index)))  # grain of its own
    labels.append(stops)
numpy.savez_compressed(out, pictures=numpy.stack(pictures), stops=labels)
print(f"{out}: {len(pictures)} pictures of {pictures[0].shape}")
assert len({picture.tobytes() for picture in pictures}) == len(pictures)
