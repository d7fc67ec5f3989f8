#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures that CliRenderGolden compares with, by the software driver: tests/make_goldens.sh [DARKROOM]. Look at
# what changed before you commit it.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
for scene in dungeon forge courtyard showcase; do
    "${1:-./darkroom}" render "scenes/$scene.scene.toml" --no-postprocess --msaa 4 --size 192x108 -o "tests/goldens/$scene.png"
done
