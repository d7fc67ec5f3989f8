#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# release.sh TREE: scripts/release makes the same bytes of the sources in two folders, whose sums are right and which can be
# configured; what lies there it leaves alone, and what it does not know it refuses before it makes anything. Ends with 77, which CTest takes for skipped, where
# the tree is no clone.
set -euo pipefail
tree=$1
git -C "$tree" rev-parse HEAD >/dev/null 2>&1 || { echo "release: skipped, $tree is no clone" && exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
    printf 'release: %s\n' "$*"
    exit 1
}
told=$("$tree/scripts/release" "$work/none" sources 2>&1) && fail "it takes a part that is not there"
[[ $told == *"'sources': allowed are source, linux"* && -z $(ls -A "$work/none") ]] || fail "of a wrong part it says: $told"
mkdir -p "$work/first/work"
echo precious | tee "$work/first/work/notes" >"$work/first/notes"
for folder in first another/folder; do
    "$tree/scripts/release" "$work/$folder" source >"$work/log" 2>&1 || { cat "$work/log" && fail "scripts/release fails"; }
done
[[ $(cd "$work/first" && find . -type f | sort | paste -sd ' ') == "./SHA256SUMS ./"darkroom-*".tar.gz ./notes ./work/notes" ]] ||
    fail "files of others do not stay alone: $(ls -AR "$work/first")"
cmp "$work/first/SHA256SUMS" "$work/another/folder/SHA256SUMS" || fail "another folder has other bytes"
cd "$work/first"
sha256sum --quiet -c SHA256SUMS
mkdir "$work/there"
tar -xzf darkroom-*.tar.gz -C "$work/there" --strip-components=1
[[ -z $(find "$work/there" -newermt "@$(git -C "$tree" log -1 --format=%ct)" -type f) ]] || fail "files are younger than the commit"
cmake -S "$work/there" -B "$work/build" --preset engine-only >"$work/log" 2>&1 || { cat "$work/log" && fail "the archive cannot be configured"; }
