#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: Pillow opens JPEG XL of floats as 8 bits of linear light, cut off at 1 and not rounded.
# Versions: PyPI pillow 13.0.0, pillow-jxl-plugin 1.3.8, imagecodecs 2026.3.6, openimageio 3.2.2.0, numpy 2.4.6
# Behaviour: imagecodecs writes floats as linear light, and says so in the file. The plugin makes bytes of them without
#   encoding; a linear profile goes with the picture, which looks far too dark where the profile is not applied.
# Seen: mode RGB; light 0.18, 2, 0.5 is 45 255 127, with a profile; OpenImageIO reads 0.18, 2, 0.5 as lin_rec709_scene
# Date: 2026-11-29
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check \
    pillow==13.0.0 pillow-jxl-plugin==1.3.8 imagecodecs==2026.3.6 openimageio==3.2.2.0 numpy==2.4.6 || exit 77
venv/bin/python -W ignore - <<'END'
import sys
from importlib.metadata import version

import imagecodecs
import numpy as np
import OpenImageIO as oiio
import pillow_jxl  # noqa: F401, it registers itself with Pillow
from PIL import Image

light = np.empty((64, 64, 3), np.float32)
light[:] = (0.18, 2, 0.5)
light[32:] += np.random.default_rng(1).random((32, 64, 3))
with open("light.jxl", "wb") as file:
    file.write(imagecodecs.jpegxl_encode(light, lossless=True))
image = Image.open("light.jxl")
buffer = oiio.ImageBuf("light.jxl")
seen = [
    (image.mode, image.getpixel((0, 0)), "icc_profile" in image.info),
    (np.array_equal(buffer.get_pixels("float"), light), buffer.spec().get_string_attribute("oiio:ColorSpace")),
]
print("pillow-jxl-plugin", version("pillow-jxl-plugin"))
print("seen:", *seen)
sys.exit(seen != [("RGB", (45, 255, 127), True), (True, "lin_rec709_scene")])
END
