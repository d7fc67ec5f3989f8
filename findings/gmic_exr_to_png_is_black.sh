#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: G'MIC makes a black PNG of an EXR whose light lies in 0..1, and floats of EXR lose their lower bits in it.
# Versions: Debian 12, gmic 2.9.4-4; PyPI openexr 3.5.3, numpy 2.4.6, pypng 0.20220715.0
# Behaviour: numbers of a file stay as they are, and PNG takes numbers for codes, 0..255: white is code 1. Nothing warns. 32-bit
#   floats of EXR are read as halves, so ids above 2048 and depth are rounded as well.
# Seen: light 0.18, 1, 4 are codes 0, 1, 4; 2049 and 2049.25 come in as 2048 and 2050
# Date: 2026-11-28
set -euo pipefail
dpkg-query -W -f '${Package} ${Version}\n' gmic | grep '2\.9\.4' || { echo "needs gmic 2.9.4 of Debian 12"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check openexr==3.5.3 numpy==2.4.6 pypng==0.20220715.0 || exit 77
venv/bin/python - <<'END'
import numpy as np
import OpenEXR

for name, numbers in (("light", [0.18, 1, 4, 0]), ("ids", [1, 2048, 2049, 2049.25])):
    picture = np.empty((8, 4, 3), np.float32)
    picture[:] = np.float32(numbers)[:, None]
    with OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, {"RGB": picture}) as file:
        file.write(name + ".exr")
END
gmic -v 0 light.exr -o out.png
gmic -v 0 ids.exr -o out.pfm
venv/bin/python - <<'END'
import sys

import numpy as np
import png

width, height, rows, info = png.Reader("out.png").read()
codes = [list(row) for row in rows][4][:: info["planes"]][:3]
data = open("out.pfm", "rb").read()
order = "<f4" if data.split(b"\n")[2].startswith(b"-") else ">f4"
floats = np.frombuffer(data[-8 * 4 * 3 * 4 :], order).reshape(8, 4, 3)[4, :, 0].tolist()
print(f"seen: codes {codes} of {info['planes']} channels in PNG, floats {floats} in PFM")
sys.exit(not (codes == [0, 1, 4] and floats == [1, 2048, 2048, 2050]))
END
