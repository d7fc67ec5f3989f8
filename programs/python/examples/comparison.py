# SPDX-License-Identifier: MIT
"""What a viewer would notice of less work: bloom of fewer levels against the full one. comparison.py [OUT.png]"""

import pathlib
import sys

import darkroom

tree = pathlib.Path(__file__).resolve().parents[3]
out = sys.argv[1] if len(sys.argv) > 1 else "errors.png"
color = darkroom.files.read_frame(tree / "samples" / "window.exr")["color"][::2, ::2, :3]

stack = darkroom.Stack().bloom(intensity=0.2).tonemap()
full = stack.develop(color)
means = []
for levels in (4, 2, 1):
    stack.set("bloom", levels=levels)
    found = darkroom.compare(full, stack.develop(color))
    means.append(found.flip_mean)
    print(f"{levels} levels: FLIP {found.flip_mean:.4f}, {found.psnr:.1f} dB, worst at {found.worst}")
darkroom.files.write(out, (found.flip_map * 255 + 0.5).astype("uint8"))
assert means == sorted(means)
