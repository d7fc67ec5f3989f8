#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: OpenImageIO reads the numbers of a FITS file without its BSCALE and BZERO, so half of unsigned 16 bits is black.
# Versions: PyPI openimageio 3.2.2.0, numpy 2.4.6
# Behaviour: FITS has no unsigned integers of 16 bits: cameras store value - 32768 and say BZERO = 32768. OpenImageIO
#   takes what is stored, so all below the middle is negative, and 0 in integers. Floats with a scale come without it.
# Seen: 0, 16384, 32768, 65535 are 0, 0, 0, 65535 as integers of 16 bits; a float 3 of BSCALE 2, BZERO 1 is 3, not 7
# Date: 2026-11-29
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check openimageio==3.2.2.0 numpy==2.4.6 || exit 77
venv/bin/python -W ignore - <<'END'
import sys

import numpy as np
import OpenImageIO as oiio


def write(name, bits, scale, zero, values):
    cards = {"SIMPLE": "T", "BITPIX": bits, "NAXIS": 2, "NAXIS1": 4, "NAXIS2": 4, "BSCALE": scale, "BZERO": zero}
    head = "".join(f"{key:8}= {value:>20}".ljust(80) for key, value in cards.items()) + "END".ljust(80)
    with open(name, "wb") as file:
        file.write(head.ljust(2880).encode() + np.tile(values, (4, 1)).tobytes().ljust(2880, b"\0"))


codes = np.array([0, 16384, 32768, 65535])
write("codes.fits", 16, "1.0", "32768.0", (codes - 32768).astype(">i2"))
write("light.fits", -32, "2.0", "1.0", np.full(4, 3, ">f4"))
seen = [
    oiio.ImageBuf("codes.fits").get_pixels("uint16")[0, :, 0].tolist(),
    float(oiio.ImageBuf("light.fits").get_pixels("float")[0, 0, 0]),
]
print(f"OpenImageIO {oiio.VERSION_STRING}")
print("seen:", *seen)
sys.exit(seen != [[0, 0, 0, 65535], 3.0])
END
