#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# names.sh TREE: no code outside effects/ names an effect, so that a folder can come and go; and none of the core names
# what a frame brings, but for its table (engine/plan/frame_inputs.hpp). Comments and tests may.
set -euo pipefail
cd "$1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for folder in effects/*/; do
    name=$(basename "$folder")
    [[ -f $folder$name.hpp ]] || continue
    type=$(sed -E 's/(^|_)([a-z])/\U\2/g' <<<"$name")
    printf '%s\n' "effects/$name" "[=!]= *\"$name\"" "effect\\(\"$name\"" "\\b$type ?\\{" "<$type>" "darkroom::$type\\b"
done >"$work/patterns"
folders=(engine files run scenes edit proof/graph_check proof/verify proof/verifier programs/darkroom include)
find "${folders[@]}" -name '*.[ch]pp' ! -name '*_test.cpp' ! -name "test_*" ! -path "*/test_*/*" -print0 |
    tar --null --files-from=- -c | tar -x -C "$work"
find "$work" -name '*.[ch]pp' -exec sed -i 's@//.*@@' {} +
cd "$work"
if grep -rnE -f patterns "${folders[@]}"; then
    echo "these name an effect"
    exit 1
fi
# Light and the interface have places of their own in the plan, and a camera says what depth and velocity are.
inputs=$(sed -nE 's/^enum class FrameImage .*\{ (.*) \};/\1/p' include/darkroom/frame.hpp | tr -d ,)
[[ $inputs ]] || { echo "include/darkroom/frame.hpp: no list of FrameImage"; exit 1; }
for name in $inputs; do
    lower=$(tr '[:upper:]' '[:lower:]' <<<"$name")
    printf '%s\n' "\"$lower\"" "\b(Frame|CompileDesc|ReferenceInput)::$lower\b" "\b(desc_?|frame|input)\.$lower\b"
    [[ $name == Ui || $name == Shadows ]] || printf '%s\n' "FrameImage::$name\b"
done >"$work/inputs"
if grep -rnE -f inputs --exclude=frame_inputs.hpp engine/plan engine/compose engine/custom; then
    echo "these name an image of the frame"
    exit 1
fi
