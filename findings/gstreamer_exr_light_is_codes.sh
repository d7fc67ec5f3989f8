#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: GStreamer makes codes of an EXR's light without a curve, so that a movie of it is dark and cut at white.
# Versions: Debian 12, gstreamer1.0-plugins-bad 1.22.0, gstreamer1.0-tools; PyPI openexr 3.5.3, numpy 2.4.6
# Behaviour: openexrdec hands out ARGB64 of the light itself, clipped to 0..1, and its caps say nothing of linear light, so
#   videoconvert takes it for sRGB like any other RGB.
# Seen: 0.18, 1, 4 are 46, 255, 255 of 255 where sRGB has 118 for the first
# Date: 2026-11-28
set -euo pipefail
for package in gstreamer1.0-plugins-bad=1.22 gstreamer1.0-plugins-base=1.22 gstreamer1.0-tools=1.22; do
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

light = np.empty((16, 48, 3), np.float32)
light[:] = np.repeat(np.float32([0.18, 1, 4]), 16)[:, None]
with OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, {"RGB": light}) as file:
    file.write("light.exr")
END
GST_REGISTRY="$folder/registry" gst-launch-1.0 -q filesrc location=light.exr ! openexrdec ! videoconvert dither=none ! \
    video/x-raw,format=RGBA ! filesink location=light.raw
venv/bin/python - <<'END'
import sys

line = open("light.raw", "rb").read()[-48 * 4 :]
codes = [line[x * 4 + 1] for x in (8, 24, 40)]
print(f"seen: {codes}")
sys.exit(codes != [46, 255, 255])
END
