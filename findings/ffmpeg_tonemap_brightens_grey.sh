#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: FFmpeg's tonemap makes bright greys brighter where it should take colour out of them, for RGB without a tag.
# Versions: PyPI av 18.1.0 (FFmpeg 8.1), numpy 2.4.6
# Behaviour: desat=2, the default, mixes what is bright with its luminance. For frames of RGB that luminance is red +
#   green + blue, three times too much. Even the curve none alters light, and no curve maps the peak to 1. With desat=0
#   each does.
# Seen: peak=4: light 4 is 10.6667 by none, 1.1429 by reinhard, 1.3866 by hable; with desat=0 4, 1, 1
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


seen = {}
for curve in ("none", "reinhard", "hable"):
    options = (f"tonemap={curve}:peak=4", f"tonemap={curve}:peak=4:desat=0")
    seen[curve] = [filtered([4, 4, 4], ("tonemap", option))[1] for option in options]
print("FFmpeg of av", av.__version__, "grey 4 by default, with desat=0")
print("seen:", seen)
sys.exit(seen != {"none": [10.6667, 4], "reinhard": [1.1429, 1], "hable": [1.3866, 1]})
END
