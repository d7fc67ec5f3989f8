#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of the documents from samples/window.exr: docs/make/make_pictures.sh [DARKROOM]. Dither is off, because a
# PNG of noise is large.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
darkroom=${1:-./darkroom}

develop() { "$darkroom" develop samples/window.exr "$@"; }
develop --look docs/pictures/before.toml -o docs/pictures/before.png
develop -o docs/pictures/after.png
develop --look docs/pictures/soft.toml -o docs/pictures/soft.png
for order in documented scene_linear; do
    develop --look "looks/$order.toml" --vignette-intensity 0.7 --dither-enabled off --size 336x189 -o "docs/pictures/$order.png"
done
