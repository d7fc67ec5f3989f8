#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# presets.sh TREE: CMake reads CMakePresets.json, lists every preset that the documents and ./test name, and takes each for
# another folder, with the variables that it is there for. Nothing is configured.
set -euo pipefail
tree=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$tree"
fail() {
    printf 'presets: %s\n' "$*"
    exit 1
}

list=$(cmake --list-presets) || fail "CMake does not read them"
# has PRESET VARIABLE=VALUE...
has() {
    local preset=$1 said
    grep -q "^ *\"$preset\"" <<<"$list" || fail "$preset is not listed"
    shift
    said=$(cmake -S . --preset "$preset" -N -B "$work/$preset" 2>&1) || fail "$preset is not accepted: $said"
    for variable in "$@"; do
        grep -qxF "  ${variable%%=*}=\"${variable#*=}\"" <<<"$said" || fail "$preset: no $variable in: $said"
    done
}
has release CMAKE_BUILD_TYPE=Release
has debug CMAKE_BUILD_TYPE=Debug
has sanitize CMAKE_BUILD_TYPE=Debug DARKROOM_SANITIZE=ON
has thread CMAKE_BUILD_TYPE=Debug DARKROOM_SANITIZE=thread DARKROOM_APPS=OFF
has fuzz CMAKE_CXX_COMPILER=clang++ DARKROOM_SANITIZE=ON DARKROOM_FUZZERS=ON DARKROOM_TESTS=OFF
has engine-only CMAKE_BUILD_TYPE=Release DARKROOM_APPS=OFF DARKROOM_LOOKS=OFF DARKROOM_SCRIPT=OFF DARKROOM_TESTS=OFF
has without-compiler DARKROOM_COMPILER=OFF DARKROOM_APPS=OFF DARKROOM_TESTS=ON
has windows CMAKE_BUILD_TYPE=Release DARKROOM_COMPILER=OFF DARKROOM_APPS=OFF DARKROOM_TESTS=ON DARKROOM_STATIC=OFF
has clang CMAKE_CXX_COMPILER=clang++
has plain CMAKE_UNITY_BUILD=OFF
for preset in $(grep -ohE -- '--preset [a-z][a-z-]*' test darkroom scripts/fuzz .ci/run .ci/more docs/*.md README.md | cut -d' ' -f2 | sort -u); do
    has "$preset"
done
echo "presets: all as they should be"
