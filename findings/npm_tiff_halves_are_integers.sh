#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: Three readers of TIFF on npm hand out halves as integers of 16 bits: mid grey is 12739, and white is darker than
#   2.
# Versions: npm tiff 7.1.3, image-js 1.7.0, jimp 1.6.1; PyPI tifffile 2026.3.3, numpy 2.4.6
# Behaviour: SampleFormat says floats, and it is passed over for 16 bits. image-js refuses floats of 32 bits, but not
#   these. Jimp (by utif2) shows the upper byte of each half.
# Seen: light 0.18, 2, 0.5: 12739 16384 14336 by tiff and image-js, 49 64 56 by Jimp
# Date: 2026-11-29
set -euo pipefail
command -v npm > /dev/null || { echo "needs Node.js with npm"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check tifffile==2026.3.3 numpy==2.4.6 || exit 77
npm install --silent --no-fund --no-audit tiff@7.1.3 image-js@1.7.0 jimp@1.6.1 > /dev/null || exit 77
venv/bin/python -W ignore - <<'END'
import numpy as np
import tifffile

light = np.empty((16, 16, 3), np.float16)
light[:] = (0.18, 2, 0.5)
tifffile.imwrite("half.tif", light)
END
cat > read.mjs <<'END'
import fs from "fs";
import { decode as decodeImage } from "image-js";
import { Jimp } from "jimp";
import { decode as decodeTiff } from "tiff";

const file = fs.readFileSync("half.tif");
const seen = [
    decodeTiff(file)[0].data.slice(0, 3),
    decodeImage(file).getRawImage().data.slice(0, 3),
    (await Jimp.fromBuffer(file)).bitmap.data.subarray(0, 3),
].map((numbers) => Array.from(numbers).join(" "));
console.log("seen:", seen.join(", "));
process.exit(seen.join() === "12739 16384 14336,12739 16384 14336,49 64 56" ? 0 : 1);
END
node read.mjs
