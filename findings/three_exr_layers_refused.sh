#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: three.js refuses an EXR whose only colours have a layer's name, and one whose first part is depth.
# Versions: npm three 0.187.0; PyPI openexr 3.5.3, numpy 2.4.6
# Behaviour: EXRLoader looks at the first part alone and wants channels that are called R, G, B, A or Y exactly. What renderers
#   write (ViewLayer.Combined.R), and files with a part for each pass, end in an error. The order of
#   parts decides: with the colours first, all is well.
# Seen: refused, refused, and 0.18 where the colours come first
# Date: 2026-11-28
set -euo pipefail
command -v npm > /dev/null || { echo "needs Node.js with npm"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check openexr==3.5.3 numpy==2.4.6 || exit 77
npm install --silent --no-fund --no-audit three@0.187.0 > /dev/null || exit 77
venv/bin/python - <<'END'
import numpy as np
import OpenEXR

head = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
plane = np.full((4, 8), 0.18, np.float32)
with OpenEXR.File(dict(head), {f"ViewLayer.Combined.{name}": plane for name in "RGB"}) as file:
    file.write("layer.exr")
for name, order in (("depth_first", "ZC"), ("colour_first", "CZ")):
    channels = {"Z": ("depth", {"Z": plane}), "C": ("colour", {"RGB": np.dstack([plane] * 3)})}
    parts = [OpenEXR.Part(dict(head), channels[key][1], name=channels[key][0]) for key in order]
    with OpenEXR.File(parts) as file:
        file.write(name + ".exr")
END
cat > read.mjs <<'END'
import fs from "fs";
import { FloatType } from "three";
import { EXRLoader } from "three/examples/jsm/loaders/EXRLoader.js";

console.warn = () => {};
const seen = ["layer", "depth_first", "colour_first"].map((name) => {
    const loader = new EXRLoader();
    loader.setDataType(FloatType);
    try {
        return loader.parse(new Uint8Array(fs.readFileSync(name + ".exr")).buffer).data[0].toFixed(2);
    } catch (error) {
        return "refused";
    }
});
console.log("seen:", seen.join(", "));
process.exit(seen.join() === "refused,refused,0.18" ? 0 : 1);
END
node read.mjs
