#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: three readers pass over EXPOSURE in the head of a .hdr; one shows bottom-up files upside down, two take XYZ for RGB.
# Versions: PyPI av 18.1.0 (FFmpeg 8.1), imagecodecs 2026.3.6, opencv-python-headless 5.0.0.93, numpy 2.4.6
# Behaviour: Radiance's format says to divide by EXPOSURE for the light, gives the order of lines by +Y or -Y, and has
#   32-bit_rle_xyze beside rgbe. FFmpeg reads all as -Y rgbe; imagecodecs refuses +Y and takes xyze; OpenCV refuses both.
# Seen: 1.0 under EXPOSURE=2 is 1.0 by all; lines 1, 2 of +Y are 1, 2; XYZ of white is 0.953 1 1.086 as RGB
# Date: 2026-11-28
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check \
    av==18.1.0 imagecodecs==2026.3.6 opencv-python-headless==5.0.0.93 numpy==2.4.6 || exit 77
OPENCV_LOG_LEVEL=OFF venv/bin/python - <<'END'
import sys

import av
import cv2
import imagecodecs

av.logging.set_level(None)


def by_av(name):
    with av.open(name) as file:
        return next(file.decode(video=0)).to_ndarray()


readers = {
    "FFmpeg": by_av,
    "imagecodecs": lambda name: imagecodecs.rgbe_decode(open(name, "rb").read()),
    "OpenCV": lambda name: cv2.cvtColor(cv2.imread(name, cv2.IMREAD_UNCHANGED), cv2.COLOR_BGR2RGB),
}
one, two, white = bytes((128, 128, 128, 129)), bytes((128, 128, 128, 130)), bytes((122, 128, 139, 129))
files = {
    "exposure": (b"rgbe\nEXPOSURE=2.0\n\n-Y 2 +X 4\n" + one * 8, lambda light: light[0, 0].tolist()),
    "bottom_up": (b"rgbe\n\n+Y 2 +X 4\n" + one * 4 + two * 4, lambda light: light[:, 0, 0].tolist()),
    "xyz": (b"xyze\n\n-Y 2 +X 4\n" + white * 8, lambda light: [round(value, 3) for value in light[0, 0].tolist()]),
}
seen = {}
for name, (rest, look) in files.items():
    with open(name + ".hdr", "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_" + rest)
    for reader, read in readers.items():
        try:
            seen[name, reader] = look(read(name + ".hdr"))
        except (cv2.error, imagecodecs.RgbeError):
            seen[name, reader] = "refused"
    print(f"seen: {name}", {reader: seen[name, reader] for reader in readers})
xyz = [0.953, 1, 1.086]
expected = [[1, 1, 1]] * 3 + [[1, 2], "refused", "refused"] + [xyz, xyz, "refused"]
sys.exit(list(seen.values()) != expected)
END
