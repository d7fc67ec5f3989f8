#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures that CliRenderGolden compares with, by the software driver: tests/scripts/make_goldens.sh [DARKROOM [FOLDER]].
# Every scene as it is rendered, and finished by its look; every look on the sample frame. Look at what changed before you
# commit it.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
darkroom=${1:-./darkroom}
folder=${2:-proof/goldens}
render() { "$darkroom" render "$@" --device llvmpipe; }
for scene in scenes/*.scene.toml; do
    name=$(basename "$scene" .scene.toml)
    render "$scene" --no-postprocess --msaa 4 --size 192x108 -o "$folder/$name.png"
    render "$scene" --size 320x180 -o "$folder/$name.finished.png"
done
for look in looks/*.toml; do
    "$darkroom" develop samples/window.exr --look "$look" --device llvmpipe --size 192x108 \
        -o "$folder/$(basename "$look" .toml).look.png"
done
