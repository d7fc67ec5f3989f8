#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: OpenEXR's Python refuses to read a file that it wrote itself, with half R, G, B and a float A.
# Versions: PyPI openexr 3.5.3, numpy 2.4.6
# Behaviour: reading puts R, G, B and A into one array by default, and an array has one type. Where the types differ it raises
#   ValueError for the whole file, at the first look at its channels. separate_channels=True reads it.
# Seen: ValueError; with separate_channels=True A is float32 and R is float16
# Date: 2026-11-28
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check openexr==3.5.3 numpy==2.4.6 || exit 77
venv/bin/python - <<'END'
import sys
from importlib.metadata import version

import numpy as np
import OpenEXR

channels = {name: np.full((4, 8), 0.5, np.float32 if name == "A" else np.float16) for name in "RGBA"}
with OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels) as file:
    file.write("mixed.exr")
try:
    together = list(OpenEXR.File("mixed.exr").channels())
except ValueError as error:
    together = "ValueError"
    print(error)
apart = OpenEXR.File("mixed.exr", separate_channels=True).channels()
types = {name: channel.pixels.dtype.name for name, channel in sorted(apart.items())}
print(f"openexr {version('openexr')}\nseen: {together}; apart {types}")
sys.exit(not (together == "ValueError" and types == dict(A="float32", B="float16", G="float16", R="float16")))
END
