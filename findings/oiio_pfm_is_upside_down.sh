#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: OpenImageIO reads .pfm upside down, also those that it wrote itself.
# Versions: PyPI openimageio 3.2.2.0, av 18.1.0 (FFmpeg 8.1), numpy 2.4.6
# Behaviour: The rows of a .pfm go from the bottom to the top. OpenImageIO writes them so, and FFmpeg reads that right;
#   but it reads rows in the order of the file, so a picture turns over on each way through it.
# Seen: rows 1 2 3 4, written by OpenImageIO, are 1 2 3 4 by FFmpeg and 4 3 2 1 by OpenImageIO
# Date: 2026-11-29
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check openimageio==3.2.2.0 av==18.1.0 numpy==2.4.6 || exit 77
venv/bin/python -W ignore - <<'END'
import sys

import av
import numpy as np
import OpenImageIO as oiio

av.logging.set_level(None)
rows = np.repeat(np.float32([1, 2, 3, 4]), 24).reshape(4, 8, 3)
oiio.ImageBuf(rows).write("rows.pfm", "float")
with av.open("rows.pfm") as file:
    by_av = next(file.decode(video=0)).to_ndarray()[:, 0, 0].tolist()
by_oiio = oiio.ImageBuf("rows.pfm").get_pixels("float")[:, 0, 0].tolist()
print(f"OpenImageIO {oiio.VERSION_STRING}")
print("seen:", by_av, by_oiio)
sys.exit((by_av, by_oiio) != ([1, 2, 3, 4], [4, 3, 2, 1]))
END
