#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: FFmpeg reads a TIFF of halves as one of 16-bit integers, so that light 0.18 and 4 lie close together.
# Versions: PyPI av 18.1.0 (FFmpeg 8.1), tifffile 2026.3.3, numpy 2.4.6
# Behaviour: the decoder counts the bits of a sample and asks for their format only where they are 32. The bits of a half are
#   taken for a code; no error, no warning. Negative numbers are the brightest.
# Seen: 0.18, 1, 4, -0.5 are rgb48le of 12739, 15360, 17408, 47104; floats of 32 bits are right (rgbf32le)
# Date: 2026-11-28
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check av==18.1.0 tifffile==2026.3.3 numpy==2.4.6 || exit 77
venv/bin/python - <<'END'
import sys

import av
import numpy as np
import tifffile

light = np.empty((16, 32, 3), np.float32)
light[:] = np.repeat(np.float32([0.18, 1, 4, -0.5]), 8)[:, None]


def read(kind):
    tifffile.imwrite("light.tif", light.astype(kind), photometric="rgb")
    with av.open("light.tif") as file:
        frame = next(file.decode(video=0))
    return frame.format.name, frame.to_ndarray()[4, ::8, 0].tolist() if kind == np.float16 else None


halves, floats = read(np.float16), read(np.float32)
print(f"av {av.__version__}, libavcodec {'.'.join(map(str, av.library_versions['libavcodec']))}")
print(f"seen: {halves[0]} {halves[1]} of halves, {floats[0]} of floats")
sys.exit(not (halves == ("rgb48le", [12739, 15360, 17408, 47104]) and floats[0] == "rgbf32le"))
END
