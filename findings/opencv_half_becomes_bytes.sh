#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: OpenCV writes an array of halves as a TIFF of 8-bit codes, and by default reads none of floats.
# Versions: PyPI opencv-python-headless 5.0.0.93, tifffile 2026.3.3, numpy 2.4.6
# Behaviour: imwrite() of float32 makes a TIFF of floats; of float16 it makes bytes, by cutting off at 0 and 255 with no scale
#   (a line in the log, and True), so light of 0.18 is 0. imread() gives None for the TIFF of floats unless it is told
#   IMREAD_UNCHANGED or IMREAD_ANYDEPTH.
# Seen: float16 0.18, 1, 4 are uint8 0, 1, 4; float32 as written; imread None
# Date: 2026-11-28
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check opencv-python-headless==5.0.0.93 tifffile==2026.3.3 numpy==2.4.6 || exit 77
OPENCV_LOG_LEVEL=OFF venv/bin/python - <<'END'
import sys

import cv2
import numpy as np
import tifffile

light = np.empty((4, 12, 3), np.float32)
light[:] = np.repeat(np.float32([0.18, 1, 4]), 4)[:, None]


def written(kind):
    said = cv2.imwrite(kind + ".tif", light.astype(kind), [cv2.IMWRITE_TIFF_COMPRESSION, cv2.IMWRITE_TIFF_COMPRESSION_NONE])
    file = tifffile.imread(kind + ".tif")
    return said, file.dtype.name, [round(float(value), 4) for value in file[2, 2::4, 0]]


halves, floats = written("float16"), written("float32")
by_default = cv2.imread("float32.tif")
print(f"OpenCV {cv2.__version__}")
print(f"seen: {halves}, {floats}, imread {by_default}")
sys.exit(not (halves == (True, "uint8", [0, 1, 4]) and floats == (True, "float32", [0.18, 1, 4]) and by_default is None))
END
