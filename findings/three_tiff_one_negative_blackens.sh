#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: one channel below zero in a TIFF of floats, and three.js shows the whole picture black.
# Versions: npm three 0.187.0, utif2 4.1.0; PyPI tifffile 2026.3.3, numpy 2.4.6
# Behaviour: TIFFLoader has utif's code in it, which does not ask the file for the order of its bytes but looks for a number
#   below zero: with one, it turns all bytes round. Light of a wide gamut has such numbers. Without one the picture is right,
#   as 8 bits that clip at 1.
# Seen: 0.18, 1, 4 are 118, 255, 255 of 255; with -0.5 in another pixel all three are 0, by both
# Date: 2026-11-28
set -euo pipefail
command -v npm > /dev/null || { echo "needs Node.js with npm"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check tifffile==2026.3.3 numpy==2.4.6 || exit 77
npm install --silent --no-fund --no-audit three@0.187.0 utif2@4.1.0 > /dev/null || exit 77
venv/bin/python - <<'END'
import numpy as np
import tifffile

light = np.empty((4, 12, 3), np.float32)
light[:] = np.repeat(np.float32([0.18, 1, 4]), 4)[:, None]
tifffile.imwrite("light.tif", light, photometric="rgb")
light[0, 0, 0] = -0.5
tifffile.imwrite("negative.tif", light, photometric="rgb")
END
cat > read.mjs <<'END'
import fs from "fs";
import UTIF from "utif2";
import { TIFFLoader } from "three/examples/jsm/loaders/TIFFLoader.js";

function read(name) {
    const bytes = new Uint8Array(fs.readFileSync(name)).buffer;
    const [page] = UTIF.decode(bytes);
    UTIF.decodeImage(bytes, page);
    const both = [new TIFFLoader().parse(bytes).data, UTIF.toRGBA8(page)];
    return both.map((data) => [2, 6, 10].map((x) => data[(3 * 12 + x) * 4 + 1]).join(" "));
}
const light = read("light.tif");
const negative = read("negative.tif");
console.log("seen (three, utif2):", light, "without,", negative, "with a number below zero");
const right = light.every((codes) => codes === "118 255 255") && negative.every((codes) => codes === "0 0 0");
process.exit(right ? 0 : 1);
END
node read.mjs
