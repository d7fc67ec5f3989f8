#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: gltf-transform's quantize() clips vertex colours at 1 and leaves dark ones 8 bits of linear light.
# Versions: npm @gltf-transform/core and @gltf-transform/functions 4.5.1
# Behaviour: COLOR_0 of floats becomes normalized bytes, by default as all else that has no setting of its own. Vertex colours
#   of glTF are linear, so bytes have steps of 1/255 of light: baked light below 0.002 is black, and above 1 it is gone.
# Seen: 4, 0.18, 0.001 become 1, 0.18039, 0
# Date: 2026-11-28
set -euo pipefail
command -v npm > /dev/null || { echo "needs Node.js with npm"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-fund --no-audit @gltf-transform/core@4.5.1 @gltf-transform/functions@4.5.1 > /dev/null || exit 77
cat > quantize.mjs <<'END'
import { Document, Logger } from "@gltf-transform/core";
import { quantize } from "@gltf-transform/functions";

const document = new Document().setLogger(new Logger(Logger.Verbosity.SILENT));
const buffer = document.createBuffer();
const attribute = (type, numbers) =>
    document.createAccessor().setType(type).setArray(new Float32Array(numbers)).setBuffer(buffer);
const triangle = document
    .createPrimitive()
    .setAttribute("POSITION", attribute("VEC3", [0, 0, 0, 1, 0, 0, 0, 1, 0]))
    .setAttribute("COLOR_0", attribute("VEC3", [4, 0.18, 0.001, 1, 1, 1, 0, 0.5, 0]));
document.createScene().addChild(document.createNode().setMesh(document.createMesh().addPrimitive(triangle)));
await document.transform(quantize());

const colour = triangle.getAttribute("COLOR_0");
const seen = colour.getElement(0, []).map((value) => Number(value.toFixed(5)));
console.log("seen:", colour.getArray().constructor.name, JSON.stringify(seen));
process.exit(JSON.stringify(seen) === "[1,0.18039,0]" ? 0 : 1);
END
node quantize.mjs
