#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: colour-science clips light at the domain of a 3D table, and lets it pass a 1D one or three 1D ones unclipped.
# Versions: PyPI colour-science 0.4.7, opencolorio 2.6.0, numpy 2.4.6
# Behaviour: LUT1D and LUT3x1D go on along their last slope, LUT3D holds its edge. OpenColorIO clips both, so highlights
#   of the same .cube of one dimension differ between the two.
# Seen: 2 and -0.5: 2, -0.5 by a table of one dimension and 1, 0 by one of three; OpenColorIO 1, 0
# Date: 2026-11-29
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check colour-science==0.4.7 opencolorio==2.6.0 numpy==2.4.6 || exit 77
venv/bin/python -W ignore - <<'END'
import sys

import colour
import numpy as np
import PyOpenColorIO as ocio

with open("line.cube", "w") as file:
    file.write("LUT_1D_SIZE 2\n0 0 0\n1 1 1\n")
light = [2, -0.5, 0.25]
processor = ocio.Config.CreateRaw().getProcessor(ocio.FileTransform("line.cube"))
seen = [
    colour.read_LUT("line.cube").apply(np.array([light]))[0].tolist(),
    colour.LUT3D(size=9).apply(np.array([light]))[0].tolist(),
    processor.getDefaultCPUProcessor().applyRGB(light),
]
print(f"colour-science {colour.__version__}, OpenColorIO {ocio.__version__}")
print("seen:", *seen)
sys.exit(seen != [[2, -0.5, 0.25], [1, 0, 0.25], [1, 0, 0.25]])
END
