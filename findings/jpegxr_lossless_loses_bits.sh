#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: floats that went through JPEG XR at its lossless level are not what they were; through JPEG XL they are.
# Versions: PyPI imagecodecs 2026.3.6, numpy 2.4.6
# Behaviour: JPEG XR codes 32-bit floats with a mantissa that it shortens first, so that level 1.0 is lossless only for
#   numbers of few bits. 1 and 4 come back, which is what tests try.
# Seen: 0.18 is 0.17999268 by JPEG XR, and itself by JPEG XL
# Date: 2026-11-28
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check imagecodecs==2026.3.6 numpy==2.4.6 || exit 77
venv/bin/python - <<'END'
import sys

import imagecodecs
import numpy as np

light = np.empty((16, 32, 3), np.float32)
light[:] = np.repeat(np.float32([0.18, 1, 4, -0.5]), 8)[:, None]
by_xr = imagecodecs.jpegxr_decode(imagecodecs.jpegxr_encode(light, level=1.0))
by_xl = imagecodecs.jpegxl_decode(imagecodecs.jpegxl_encode(light, lossless=True))
seen = [round(float(value), 8) for value in by_xr[4, ::8, 0]]
print(f"imagecodecs {imagecodecs.__version__}, light 0.18, 1, 4, -0.5")
print(f"seen: {seen} by JPEG XR, equal by JPEG XL: {np.array_equal(by_xl, light)}")
sys.exit(not (seen == [0.17999268, 1, 4, -0.5] and np.array_equal(by_xl, light)))
END
