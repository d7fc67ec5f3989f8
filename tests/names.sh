#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# names.sh TREE: no code outside effects/ names an effect, so that a folder can come and go. Comments and tests may.
set -euo pipefail
cd "$1"
found=0
for folder in effects/*/; do
    name=$(basename "$folder")
    [[ -f $folder$name.hpp ]] || continue
    type=$(sed -E 's/(^|_)([a-z])/\U\2/g' <<<"$name")
    while read -r file; do
        if sed 's@//.*@@' "$file" | grep -nE "effects/$name|[=!]= *\"$name\"|effect\(\"$name\"|\\b$type ?\\{|<$type>|darkroom::$type\\b"; then
            printf '%s names the effect %s\n' "$file" "$name"
            found=1
        fi
    done < <(find src apps include -name '*.[ch]pp' ! -name '*_test.cpp' ! -name 'test_*')
done
exit $found
