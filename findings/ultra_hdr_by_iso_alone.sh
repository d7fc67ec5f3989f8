#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: An Ultra HDR picture of libultrahdr holds its gain map's numbers as ISO 21496-1 alone, and hdrify finds none in
#   it.
# Versions: PyPI imagecodecs 2026.3.6 (libultrahdr), numpy 2.4.6; npm hdrify 1.2.1
# Behaviour: The older place for the numbers is XMP (hdrgm:), which imagecodecs' libultrahdr leaves out. hdrify, which
#   wants XMP, refuses the file.
# Seen: no hdrgm in the file; hdrify: missing gain map metadata
# Date: 2026-11-29
set -euo pipefail
command -v npm > /dev/null || { echo "needs Node.js with npm"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check imagecodecs==2026.3.6 numpy==2.4.6 || exit 77
npm install --silent --no-fund --no-audit hdrify@1.2.1 > /dev/null || exit 77
venv/bin/python -W ignore - <<'END'
import sys

import imagecodecs
import numpy as np

light = np.ones((32, 32, 4), np.float16)
light[..., :3] = np.linspace(0, 4, 32)[None, :, None]
data = imagecodecs.ultrahdr_encode(light)
with open("light.jpg", "wb") as file:
    file.write(data)
seen = data.count(b"hdrgm"), data.count(b"urn:iso:std:iso:ts:21496:-1")
print(f"imagecodecs {imagecodecs.__version__}")
print("seen:", *seen)
sys.exit(seen != (0, 2))
END
cat > read.mjs <<'END'
import fs from "fs";
import { readJpegGainMap } from "hdrify";

let seen = "read";
try {
    await readJpegGainMap(new Uint8Array(fs.readFileSync("light.jpg")));
} catch (error) {
    seen = error.message.replace(/^.*: /, "");
}
console.log("seen:", seen);
process.exit(seen === "missing gain map metadata" ? 0 : 1);
END
node read.mjs
