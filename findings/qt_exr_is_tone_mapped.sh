#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: a Qt program shows an EXR tone mapped and without its alpha, and the same light from a .hdr as linear codes.
# Versions: Debian 12, kimageformat-plugins 5.103.0, python3-pyqt5 5.15.9; PyPI openexr 3.5.3, numpy 2.4.6
# Behaviour: the two readers come from different hands. That of EXR applies a curve which takes light of 4 to 236 and never
#   says so; a white page of 1.0 is a mid grey. That of Radiance multiplies by 255, encodes nothing and clips.
# Seen: 0.18, 1, 4 are 84, 164, 236 from EXR, with alpha 255 where the file has 0.5; 46, 255, 255 from .hdr
# Date: 2026-11-28
set -euo pipefail
for package in kimageformat-plugins=5.103 python3-pyqt5=5.15.9; do
    dpkg-query -W -f '${Package}=${Version}\n' "${package%=*}" | grep -F "$package" || { echo "needs $package"; exit 77; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check openexr==3.5.3 numpy==2.4.6 || exit 77
venv/bin/python - <<'END'
import numpy as np
import OpenEXR

light = np.empty((4, 6, 3), np.float32)
light[:] = np.repeat(np.float32([0.18, 1, 4]), 2)[:, None]
for name, channels in (("rgb", {"RGB": light}), ("rgba", {"RGBA": np.dstack([light / 2, np.full((4, 6), 0.5, "f4")])})):
    with OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels) as file:
        file.write(name + ".exr")
# Six pixels to the line are too few for runs: four bytes each, mantissas of 0.18 (184/1024), 1 and 4.
line = bytes((184, 184, 184, 126)) * 2 + bytes((128, 128, 128, 129)) * 2 + bytes((128, 128, 128, 131)) * 2
with open("light.hdr", "wb") as file:
    file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 6\n" + line * 4)
END
QT_QPA_PLATFORM=offscreen /usr/bin/python3 - <<'END'
import sys

from PyQt5.QtGui import QImage


def seen(name):
    picture = QImage(name)
    return [picture.pixelColor(x, 2).green() for x in (0, 2, 4)], picture.pixelColor(0, 2).alpha()


exr, alpha, hdr = seen("rgb.exr"), seen("rgba.exr"), seen("light.hdr")
print(f"seen: EXR {exr}, with alpha of a half {alpha}, .hdr {hdr}")
sys.exit(not (exr[0] == [84, 164, 236] and alpha[1] == 255 and hdr[0] == [46, 255, 255]))
END
