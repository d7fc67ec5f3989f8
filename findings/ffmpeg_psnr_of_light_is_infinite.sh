#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: FFmpeg's psnr and ssim say that light 2 and light 4 are the same picture.
# Versions: PyPI av 18.1.0 (FFmpeg 8.1), numpy 2.4.6
# Behaviour: Both filters know integers only. A scaler comes in between of itself, which clips floats to 0..1 and takes
#   them for codes, so what is above 1 does not count, and shadows count for little.
# Seen: psnr inf and ssim 1.000000 of light 2 against 4; psnr 12.041951 of 0.25 against 0.5
# Date: 2026-11-29
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check av==18.1.0 numpy==2.4.6 || exit 77
venv/bin/python -W ignore - <<'END'
import sys

import av
import numpy as np

av.logging.set_level(None)


def compared(name, *lights):
    graph = av.filter.Graph()
    frames = [av.VideoFrame.from_ndarray(np.full((16, 16, 3), light, np.float32), format="gbrpf32le") for light in lights]
    inputs = [graph.add_buffer(width=16, height=16, format=frame.format, time_base="1/25") for frame in frames]
    measure, sink = graph.add(name), graph.add("buffersink")
    for place, each in enumerate(inputs):
        each.link_to(measure, 0, place)
    measure.link_to(sink)
    graph.configure()
    for each, frame in zip(inputs, frames):
        frame.pts = 0
        each.push(frame)
        each.push(None)
    return dict(graph.pull().metadata)


seen = [
    compared("psnr", 2, 4)["lavfi.psnr.psnr_avg"],
    compared("ssim", 2, 4)["lavfi.ssim.All"],
    compared("psnr", 0.25, 0.5)["lavfi.psnr.psnr_avg"],
]
print("FFmpeg of av", av.__version__)
print("seen:", *seen)
sys.exit(seen != ["inf", "1.000000", "12.041951"])
END
