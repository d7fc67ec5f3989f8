#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: three.js' LUTCubeLoader wraps table numbers outside of 0..1 round: 1.004 is black.
# Versions: npm three 0.187.0
# Behaviour: By default the table becomes bytes, and value * 255 is stored in a Uint8Array, which drops what is above 255.
#   Looks that reach a little over white, and those for HDR, show black or rainbow spots. setType(FloatType) keeps the
#   numbers.
# Seen: 0, 1, 1.004, 1.5, 2, -0.01 are 0, 255, 0, 126, 254, 254
# Date: 2026-11-29
set -euo pipefail
command -v npm > /dev/null || { echo "needs Node.js with npm"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-fund --no-audit three@0.187.0 > /dev/null || exit 77
cat > read.mjs <<'END'
import { FloatType } from "three";
import { LUTCubeLoader } from "three/examples/jsm/loaders/LUTCubeLoader.js";

const numbers = [0, 1, 1.004, 1.5, 2, -0.01, 0, 0];
const text = "LUT_3D_SIZE 2\n" + numbers.map((value) => `${value} 0 0.5\n`).join("");
const red = (loader) => Array.from(loader.parse(text).texture3D.image.data).filter((value, index) => index % 4 === 0);
const [bytes, floats] = [red(new LUTCubeLoader()), red(new LUTCubeLoader().setType(FloatType))];
console.log("seen:", bytes.join(" "), "and as floats", floats.map((value) => value.toFixed(3)).join(" "));
const kept = floats.every((value, index) => Math.abs(value - numbers[index]) < 1e-6);
process.exit(bytes.join() === "0,255,0,126,254,254,0,0" && kept ? 0 : 1);
END
node read.mjs
