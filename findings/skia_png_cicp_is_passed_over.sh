#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: Skia for Python reads a PNG that says PQ by cICP as sRGB of 8 bits.
# Versions: PyPI skia-python 144.1, numpy 2.4.6
# Behaviour: The chunk is passed over, so the image says sRGB, and white of PQ becomes a grey. 16 bits become 8, too.
# Seen: a code of 38055 in Rec. 2100 PQ is 148 of 255, colour space sRGB, colour type BGRA 8888
# Date: 2026-11-29
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check skia-python==144.1 numpy==2.4.6 || exit 77
venv/bin/python -W ignore - <<'END'
import struct
import sys
import zlib

import skia


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


rows = (b"\0" + struct.pack(">6H", *[38055] * 6)) * 2
with open("pq.png", "wb") as file:
    file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 16, 2, 0, 0, 0)))
    file.write(chunk(b"cICP", bytes((9, 16, 0, 1))) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
image = skia.Image.open("pq.png")
seen = image.colorType().name, image.colorSpace().isSRGB(), image.toarray()[0, 0].tolist()
print("skia-python", skia.__version__)
print("seen:", *seen)
sys.exit(seen != ("kBGRA_8888_ColorType", True, [148, 148, 148, 255]))
END
