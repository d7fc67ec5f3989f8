#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# rooms.sh TREE: no folder of code holds more than one can take in at a glance: 24 files of C++, and 24 of GLSL.
set -euo pipefail
cd "$1"
limit=24
crowded=$(for files in '*.[ch]pp' '*.glsl'; do
    find src apps bench python tests effects -name "$files" -printf '%h\n' | sort | uniq -c |
        awk -v limit=$limit -v files="$files" '$1 > limit { print $2 " holds " $1 " files " files }'
done)
[[ -n $crowded ]] || exit 0
printf '%s\nmore than %d are several rooms: move what belongs together into a folder below\n' "$crowded" $limit
exit 1
