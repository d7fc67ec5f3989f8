#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# One picture of all models (.glb, .gltf) below a folder, row by row in the order of the list that it prints:
# docs/make/make_contact_sheet.sh FOLDER OUT.png [DARKROOM]. A model that cannot be rendered is told and left out.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
folder=${1:?a folder of models} out=${2:?the picture to write} darkroom=${3:-$root/darkroom}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

count=0
while IFS= read -r -d '' model; do
    tile=$work/$(printf '%04d' "$count").png
    if "$darkroom" render "$model" --size 320x240 --no-grid --exposure "${EXPOSURE:-1}" -o "$tile" >/dev/null; then
        count=$((count + 1))
        echo "$count ${model#"$folder"/}"
    fi
done < <(find "$folder" \( -name '*.glb' -o -name '*.gltf' \) -print0 | sort -z)
((count > 0)) || { echo "no model below $folder could be rendered" >&2 && exit 1; }
columns=$((count < 4 ? count : 4))
oiiotool "$work"/*.png --mosaic:pad=4 "${columns}x$(((count + columns - 1) / columns))" -o "$out"
echo "$count models -> $out"
