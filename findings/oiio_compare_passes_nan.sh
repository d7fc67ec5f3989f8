#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: OpenImageIO's comparison calls a picture of NaN the same as one of zeros.
# Versions: PyPI openimageio 3.2.2.0, numpy 2.4.6
# Behaviour: compare() counts pixels whose difference is greater than the threshold; a difference of NaN is not. So a test
#   that a broken render must fail by is green, which the greatest error, NaN itself, does not change. color_range_check()
#   counts NaN as in range, too; computePixelStats() alone tells.
# Seen: NaN against 0: 0 fails, 0 warnings, greatest error NaN, no error; 64 of 64 pixels in range; nancount 64
# Date: 2026-11-29
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check openimageio==3.2.2.0 numpy==2.4.6 || exit 77
venv/bin/python -W ignore - <<'END'
import sys

import numpy as np
import OpenImageIO as oiio

zeros = oiio.ImageBuf(np.zeros((8, 8, 3), np.float32))
nothing = oiio.ImageBuf(np.full((8, 8, 3), np.nan, np.float32))
result = oiio.ImageBufAlgo.compare(zeros, nothing, 1e-6, 1e-6)
seen = [
    (result.nfail, result.nwarn, str(result.maxerror), bool(result.error)),
    tuple(oiio.ImageBufAlgo.color_range_check(nothing, (0, 0, 0), (1, 1, 1))),
    oiio.ImageBufAlgo.computePixelStats(nothing).nancount[0],
]
print(f"OpenImageIO {oiio.VERSION_STRING}")
print("seen:", *seen)
sys.exit(seen != [(0, 0, "nan", False), (0, 0, 64), 64])
END
