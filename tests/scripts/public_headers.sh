#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# public_headers.sh TREE GENERATED COMPILER: what a host's file pays for the public headers: characters and templates that
# are ours, beside Vulkan and the standard library, which it would pay anyway. Seconds are a row of darkroom_bench.
set -euo pipefail
tree=$1 generated=$2 compiler=$3

# characters HEADER: of ours, behind the preprocessor. Its line markers tell whose a line is.
characters() {
    printf '#include <%s>\n' "$1" |
        "$compiler" -std=c++20 -E -x c++ -I "$tree/include" -I "$generated" - |
        awk '/^# [0-9]+ "/ { ours = $3 ~ /\/darkroom\// || $3 ~ /\/effects\//; next } ours { n += length($0) } END { print n }'
}
# A limit leaves room for a third more.
within() {
    local count
    count=$(characters "$1")
    [[ $count -gt 1000 && $count -le $2 ]] || { echo "$1: $count characters of ours, allowed are 1000 to $2" && exit 1; }
}
within darkroom/composer.hpp 26000
# Every effect's struct comes to that.
effects=$(find "$tree/effects" -mindepth 2 -name '*.hpp' | awk -F/ '$NF == $(NF-1) ".hpp"' | wc -l)
within darkroom/darkroom.hpp $((26000 + 740 * effects))

# The machinery that describes parameters, and what is heaviest of the standard library, stay out.
for header in darkroom/composer.hpp darkroom/darkroom.hpp; do
    for unwanted in darkroom/describe.hpp /filesystem /regex /iostream; do
        if printf '#include <%s>\n' "$header" |
            "$compiler" -std=c++20 -M -x c++ -I "$tree/include" -I "$generated" - | grep -qE "$unwanted( |\$)"; then
            echo "$header includes $unwanted" && exit 1
        fi
    done
done
