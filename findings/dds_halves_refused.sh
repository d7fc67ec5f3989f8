#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: A DDS of uncompressed halves, with the head of DirectX 10, is refused by four readers and misread by one.
# Versions: PyPI openimageio 3.2.2.0, pillow 13.0.0, imagecodecs 2026.3.6, av 18.1.0 (FFmpeg 8.1), numpy 2.4.6; npm three
#   0.187.0
# Behaviour: R16G16B16A16_FLOAT is format 10 of the DX10 head. FFmpeg takes it for integers of 16 bits and blue for red.
#   HDR as BC6H, more involved, is read by OpenImageIO and imagecodecs as halves, by Pillow as 8 bits clipped.
# Seen: refused by OpenImageIO, Pillow, imagecodecs and three.js; bgra64le, 16384 for light 2, by FFmpeg
# Date: 2026-11-29
set -euo pipefail
command -v npm > /dev/null || { echo "needs Node.js with npm"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check \
    openimageio==3.2.2.0 pillow==13.0.0 imagecodecs==2026.3.6 av==18.1.0 numpy==2.4.6 || exit 77
npm install --silent --no-fund --no-audit three@0.187.0 > /dev/null || exit 77
venv/bin/python -W ignore - <<'END'
import struct
import sys

import av
import imagecodecs
import numpy as np
import OpenImageIO as oiio
from PIL import Image

av.logging.set_level(None)
light = np.full((4, 4, 4), 2, np.float16).tobytes()
with open("light.dds", "wb") as file:
    file.write(struct.pack("<4s7I44x", b"DDS ", 124, 0x100F, 4, 4, 32, 1, 1))
    file.write(struct.pack("<2I4s5I", 32, 4, b"DX10", 0, 0, 0, 0, 0))
    file.write(struct.pack("<5I", 0x1000, 0, 0, 0, 0) + struct.pack("<5I", 10, 3, 0, 1, 0) + light)


def refused(read):
    try:
        read()
    except (NotImplementedError, imagecodecs.DdsError):
        return True
    return False


with av.open("light.dds") as file:
    frame = next(file.decode(video=0))
seen = [
    oiio.ImageInput.open("light.dds") is None and "Unsupported DXGI format" in oiio.geterror(),
    refused(lambda: Image.open("light.dds")),
    refused(lambda: imagecodecs.dds_decode(open("light.dds", "rb").read())),
    frame.format.name,
    int(np.asarray(frame.planes[0]).view(np.uint16)[0]),
]
print(f"OpenImageIO {oiio.VERSION_STRING}, imagecodecs {imagecodecs.__version__}")
print("seen:", *seen)
sys.exit(seen != [True, True, True, "bgra64le", 16384])
END
cat > read.mjs <<'END'
import fs from "fs";
import { DDSLoader } from "three/examples/jsm/loaders/DDSLoader.js";

console.error = console.warn = () => {};
const seen = new DDSLoader().parse(new Uint8Array(fs.readFileSync("light.dds")).buffer, true);
console.log("seen: three.js", seen.format, seen.mipmaps.length);
process.exit(seen.format === null && seen.mipmaps.length === 0 ? 0 : 1);
END
node read.mjs
