#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: three.js' LUT3dlLoader refuses a .3dl of 17 points whose first line ends at 1023.
# Versions: npm three 0.187.0
# Behaviour: The first line gives the places of the points, in 10 bits 0 64 128 ... 1023 for 17 points, whose steps are
#   not all of one size as 1023 / 16 is no whole number. The loader wants equal steps, and takes a line that ends at 1024
#   only.
# Seen: 0 64 ... 959 1023: Inconsistent grid size; 0 64 ... 960 1024: read
# Date: 2026-11-29
set -euo pipefail
command -v npm > /dev/null || { echo "needs Node.js with npm"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-fund --no-audit three@0.187.0 > /dev/null || exit 77
cat > read.mjs <<'END'
import { LUT3dlLoader } from "three/examples/jsm/loaders/LUT3dlLoader.js";

const steps = Array.from({ length: 17 }, (_, step) => step);
const rows = steps.flatMap((red) => steps.flatMap((green) => steps.map((blue) => [red, green, blue])));
const table = rows.map((row) => row.map((value) => Math.round((value * 4095) / 16)).join(" ")).join("\n");
const seen = [1023, 1024].map((last) => {
    const head = steps.map((step) => Math.round((step * last) / 16)).join(" ");
    try {
        return new LUT3dlLoader().parse(head + "\n" + table + "\n").size;
    } catch (error) {
        return error.message.replace(/^.*: /, "");
    }
});
console.log("seen:", seen.join(", "));
process.exit(seen.join() === "Inconsistent grid size,17" ? 0 : 1);
END
node read.mjs
