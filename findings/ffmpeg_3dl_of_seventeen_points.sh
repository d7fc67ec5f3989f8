#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: FFmpeg takes each .3dl for one of 17 points and 12 bits, whatever its head and its numbers say.
# Versions: PyPI av 18.1.0 (FFmpeg 8.1), opencolorio 2.6.0, numpy 2.4.6
# Behaviour: The first line of a .3dl gives the number of points, and tables hold 10, 12 or 16 bits. lut3d divides by 4096
#   always, so a table of 10 bits is a quarter as bright, one of 16 bits 16 times as bright, and white of 12 bits is no
#   longer 1. Of 33 points it reads the first 17 * 17 * 17 rows as a whole table, so all colours are wrong, without a
#   word.
# Seen: identity tables make of 1 0.5 0.25: 0.9998 0.5 0.25 (17 points, 12 bits), 0.2498 0.125 0.0625 (10 bits), 15.9998 8
#   4 (16 bits), 0.125 0.375 0.375 (33 points); OpenColorIO 1 0.5 0.25 of each
# Date: 2026-11-29
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check av==18.1.0 opencolorio==2.6.0 numpy==2.4.6 || exit 77
venv/bin/python -W ignore - <<'END'
import sys

import av
import numpy as np
import PyOpenColorIO as ocio

av.logging.set_level(None)
colour = [1, 0.5, 0.25]


def filtered(light, *filters):
    graph = av.filter.Graph()
    frame = av.VideoFrame.from_ndarray(np.full((4, 8, 3), light, np.float32), format="gbrpf32le")
    last = graph.add_buffer(width=8, height=4, format=frame.format, time_base="1/25")
    for name, options in (*filters, ("buffersink", None)):
        following = graph.add(name, options)
        last.link_to(following)
        last = following
    graph.configure()
    graph.push(frame)
    return [round(float(value), 4) for value in graph.pull().to_ndarray()[0, 0]]


def by_ocio(name):
    table = ocio.FileTransform(name, interpolation=ocio.INTERP_LINEAR)
    return ocio.Config.CreateRaw().getProcessor(table).getDefaultCPUProcessor().applyRGB(colour)


seen, right = [], True
for points, white in ((17, 4095), (17, 1023), (17, 65535), (33, 4095)):
    name = f"{points}_{white}.3dl"
    steps = range(points)
    with open(name, "w") as file:
        print(*(round(step * 1023 / (points - 1)) for step in steps), file=file)
        for row in ((red, green, blue) for red in steps for green in steps for blue in steps):
            print(*(round(value * white / (points - 1)) for value in row), file=file)
    seen.append(filtered(colour, ("lut3d", "file=" + name)))
    right = right and np.allclose(by_ocio(name), colour, atol=0.001)
    print(f"seen: {points} points, white {white}: {seen[-1]}, OpenColorIO {by_ocio(name)}")
expected = [[0.9998, 0.5, 0.25], [0.2498, 0.125, 0.0625], [15.9998, 8, 4], [0.125, 0.375, 0.375]]
sys.exit(not (seen == expected and right))
END
