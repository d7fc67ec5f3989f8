#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: colour-science cuts off where it writes 8 bits, so pictures are a code darker than where one rounds.
# Versions: PyPI colour-science 0.4.7, openimageio 3.2.2.0, numpy 2.4.6
# Behaviour: write_image() multiplies by 255 and drops what is behind the point before OpenImageIO sees the numbers; given
#   the floats, OpenImageIO rounds. Where two pictures are compared code by code, that is a difference of one.
# Seen: 0.5, 0.999 are 127, 254 by colour-science and 128, 255 by OpenImageIO
# Date: 2026-11-28
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check colour-science==0.4.7 openimageio==3.2.2.0 numpy==2.4.6 || exit 77
venv/bin/python -W ignore - <<'END'
import sys

import colour
import numpy as np
import OpenImageIO as oiio

picture = np.full((2, 2, 3), 0.5, np.float32)
picture[:, 1] = 0.999
colour.write_image(picture, "colour.png", bit_depth="uint8")
buffer = oiio.ImageBuf(picture)
buffer.write("oiio.png", "uint8")


def codes(name):
    pixels = oiio.ImageBuf(name).get_pixels("uint8")
    return pixels[0, :, 0].tolist()


seen = codes("colour.png"), codes("oiio.png")
print(f"colour-science {colour.__version__}, OpenImageIO {oiio.VERSION_STRING}")
print("seen:", *seen)
sys.exit(seen != ([127, 254], [128, 255]))
END
