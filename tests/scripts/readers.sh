#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# readers.sh TREE DARKROOM: brings the programs of readers.py, by version, into a folder that goes again, and runs it. Those of
# Debian are looked for: ffmpeg, imagemagick, chromium, nodejs with npm. 77: something is missing.
set -euo pipefail
for program in ffmpeg /usr/bin/convert chromium npm; do
    command -v "$program" >/dev/null || { echo "left out: no $program (packages ffmpeg, imagemagick, chromium, npm)" && exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PIP_DISABLE_PIP_VERSION_CHECK=1 PYTHONDONTWRITEBYTECODE=1
# Blender's package asks for an older numpy than the others.
python3 -m venv "$work/python" && python3 -m venv "$work/blender" &&
    "$work/python/bin/pip" install -q OpenImageIO==3.2.2.0 opencolorio==2.6.0 pyvips==3.2.0 pyvips-binary==8.18.7 \
        imagecodecs==2026.3.6 numpy==2.4.6 pillow==13.0.0 &&
    "$work/blender/bin/pip" install -q bpy==5.0.1 'numpy<2' &&
    npm install --silent --no-fund --no-audit --prefix "$work" three@0.187.0 @monogrid/gainmap-js@3.7.3 \
        @babylonjs/core@9.35.0 playcanvas@2.23.3 >/dev/null ||
    { echo "left out: the packages are not to be had here" && exit 77; }
DARKROOM_NODE_MODULES=$work/node_modules DARKROOM_BLENDER_PYTHON=$work/blender/bin/python \
    "$work/python/bin/python" -B "$1/tests/scripts/readers.py" "$1" "$2"
