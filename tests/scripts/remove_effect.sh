#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# remove_effect.sh TREE: for each effect, a tree without its folder configures, builds, and passes its tests. It takes
# long, so it is of `./test --all` alone. Programs that show effects (examples), documents and whole-chain tests name
# some, and stay out; so do these scripts.
set -euo pipefail
tree=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/tree"
tar -C "$tree" --exclude='./build*' --exclude=./.git -cf - . | tar -C "$work/tree" -xf -
cd "$work/tree"
# One build folder for all: only what saw the effect is compiled again.
for folder in effects/*/; do
    name=$(basename "$folder")
    [[ -f $folder$name.hpp ]] || continue
    mv "$folder" "$work/removed"
    cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release >"$work/log" 2>&1 &&
        cmake --build build >>"$work/log" 2>&1 || { tail -n 40 "$work/log" && echo "without $name it does not build" && exit 1; }
    ctest --test-dir build -L '^fast$' -E '^(Acceptance|Launcher|Documents)$' --output-on-failure >"$work/log" 2>&1 ||
        { tail -n 40 "$work/log" && echo "without $name its tests fail" && exit 1; }
    mv "$work/removed" "$folder"
    echo "without $name: builds and passes"
done
