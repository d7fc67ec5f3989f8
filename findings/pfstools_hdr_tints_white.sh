#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: white that goes through pfstools into a Radiance file comes back a little green, and float EXR goes out as half.
# Versions: Debian 12, pfstools 2.2.0-5; PyPI openexr 3.5.3, numpy 2.4.6
# Behaviour: between the programs of a pipe the picture is XYZ. The two matrices of the way there and back give red and blue
#   a hair below 1, which the shared exponent of Radiance then cuts off instead of rounding: a whole step, 1/128. Into EXR
#   the same pipe writes halves, whatever came in.
# Seen: 1,1,1 is 0.992 1 0.992 by way of .hdr; 0.18 is a float16 by way of .exr
# Date: 2026-11-28
set -euo pipefail
dpkg-query -W -f '${Package} ${Version}\n' pfstools | grep '2\.2\.0' || { echo "needs pfstools 2.2.0 of Debian 12"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check openexr==3.5.3 numpy==2.4.6 || exit 77
venv/bin/python - <<'END'
import numpy as np
import OpenEXR

light = np.ones((8, 4, 3), np.float32)
light[:, :2] = 0.18
with OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, {"RGB": light}) as file:
    file.write("in.exr")
END
pfsin in.exr | pfsout out.hdr
pfsin in.exr | pfsout out.exr
venv/bin/python - <<'END'
import sys

import numpy as np
import OpenEXR

# Of the Radiance file the bytes themselves are looked at: the last line has four bytes of head, and a count of 4 before
# the four bytes of each of red, green, blue and the exponent.
line = np.frombuffer(open("out.hdr", "rb").read()[-24:], np.uint8)
red, green, blue, exponent = line[4:].reshape(4, 5)[:, 4].astype(float)
white = [float(round(value / 256 * 2.0 ** (exponent - 128), 4)) for value in (red, green, blue)]
channels = OpenEXR.File("out.exr", separate_channels=True).channels()
kind = channels["R"].pixels.dtype.name
print(f"seen: white {white} in out.hdr, {kind} in out.exr")
sys.exit(not (white == [0.9922, 1.0, 0.9922] and kind == "float16"))
END
