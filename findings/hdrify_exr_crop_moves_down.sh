#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: hdrify moves an EXR whose data window is off the origin down, leaves black above, and makes 0 of light below zero.
# Versions: npm hdrify 1.2.1; PyPI openexr 3.5.3, numpy 2.4.6
# Behaviour: It counts rows from 0 instead of from the window's first, so the last rows of a render of a region are lost,
#   without a word. What wide-gamut colours become in Rec. 709 loses its negative channels.
# Seen: rows 1 2 3 4 of a window from 2, 2 are 0 0 1 2; -0.5, 0.18, 2 is 0, 0.18, 2
# Date: 2026-11-29
set -euo pipefail
command -v npm > /dev/null || { echo "needs Node.js with npm"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check openexr==3.5.3 numpy==2.4.6 || exit 77
npm install --silent --no-fund --no-audit hdrify@1.2.1 > /dev/null || exit 77
venv/bin/python -W ignore - <<'END'
import numpy as np
import OpenEXR

head = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
corner = np.int32([2, 2]), np.int32([9, 5])
whole = np.int32([0, 0]), np.int32([15, 15])
with OpenEXR.File(
    head | {"dataWindow": corner, "displayWindow": whole}, {"RGB": np.repeat(np.float32([1, 2, 3, 4]), 24).reshape(4, 8, 3)}
) as file:
    file.write("crop.exr")
light = np.empty((4, 8, 3), np.float32)
light[:] = (-0.5, 0.18, 2)
with OpenEXR.File(head, {"RGB": light}) as file:
    file.write("light.exr")
END
cat > read.mjs <<'END'
import fs from "fs";
import { readExr } from "hdrify";

const seen = ["crop", "light"].map((name) => {
    const { width, data } = readExr(new Uint8Array(fs.readFileSync(name + ".exr")));
    const numbers = name === "crop" ? data.filter((_, index) => index % (width * 4) === 0) : data.slice(0, 3);
    return Array.from(numbers, (value) => Number(value.toFixed(2))).join(" ");
});
console.log("seen:", seen.join(", "));
process.exit(seen.join() === "0 0 1 2,0 0.18 2" ? 0 : 1);
END
node read.mjs
