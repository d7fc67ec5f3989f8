#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/pictures/house.svg for docs/architecture.md from the CMake targets: docs/make/make_house_picture.sh [BUILD].
# Needs dot and tred (Debian: graphviz), which nothing else here does. What it drew is in the picture as its description,
# by which tests/scripts/house.sh sees that it has aged.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
for tool in dot tred; do
    command -v "$tool" >/dev/null || { echo "$tool is not installed: apt-get install graphviz" >&2 && exit 1; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
build=${1:-$work/build}
cmake -S . -B "$build" -DDARKROOM_TESTS=ON >/dev/null
facts=$build/generated/house.txt

# Targets first: what else is said of one, is said of one that is known.
{ grep '^target ' "$facts" && grep -v '^target ' "$facts"; } |
    awk -f docs/make/house.awk | tred | dot -Tsvg >"$work/house.svg"

# What was drawn goes behind the first tag. Names of nodes and edges go: a viewer shows them over the picture.
awk -v facts="$facts" '
    /^<svg/ { inside = 1 }
    !inside || /^<!--.*-->$/ || /^<title>/ { next }
    { print }
    />$/ && !told {
        told = 1
        print "<title>Folders, their targets and rooms, and what each builds on</title>\n<desc>"
        while ((getline line <facts) > 0) print line
        print "</desc>"
    }' "$work/house.svg" >docs/pictures/house.svg
