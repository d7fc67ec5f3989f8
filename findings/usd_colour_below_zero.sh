#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: USD makes -6.5 of linear -0.5 where it encodes for sRGB, and -0.5 where for gamma 2.2.
# Versions: PyPI usd-core 26.11
# Behaviour: Gf.Color goes on along the straight part of sRGB's curve below zero, while gamma 2.2 passes a negative number
#   through unencoded. Neither mirrors the curve, as OpenColorIO's mirrored styles do; and light above 1 does not clip.
# Seen: linear -0.5 is -6.4616 in srgb_rec709_scene and -0.5 in g22_rec709_scene; 4 is 1.8248 and 1.8779
# Date: 2026-11-28
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check usd-core==26.11 || exit 77
venv/bin/python - <<'END'
import sys
from importlib.metadata import version

from pxr import Gf

names = Gf.ColorSpaceNames


def encoded(light, space):
    linear = Gf.Color(Gf.Vec3f(light, light, light), Gf.ColorSpace(names.LinearRec709))
    return round(float(Gf.Color(linear, Gf.ColorSpace(space)).GetRGB()[1]), 4)


seen = {space: [encoded(light, space) for light in (-0.5, 0.18, 4)] for space in (names.SRGBRec709, names.G22Rec709)}
print(f"usd-core {version('usd-core')}, linear -0.5, 0.18, 4")
print("seen:", seen)
srgb, power = seen.values()
sys.exit(not (srgb == [-6.4616, 0.4614, 1.8248] and power == [-0.5, 0.4587, 1.8779]))
END
