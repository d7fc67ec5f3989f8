#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# names.sh TREE: no code outside effects/ names an effect, so that a folder can come and go. Comments and tests may.
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
find src apps include -name '*.[ch]pp' ! -name '*_test.cpp' ! -name "test_*" ! -path "*/test_*/*" -print0 |
    tar --null --files-from=- -c | tar -x -C "$work"
find "$work" -name '*.[ch]pp' -exec sed -i 's@//.*@@' {} +
cd "$work"
if grep -rnE -f patterns src apps include; then
    echo "these name an effect"
    exit 1
fi
