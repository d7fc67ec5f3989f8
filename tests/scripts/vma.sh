#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# vma.sh TREE GENERATED LIBRARY COMPILER: examples/vma.cpp makes the picture that the other hosts of docs/hosts.md make, and
# leaves nothing in the allocator, which is compiled with its assertions. 77: volk or the allocator is not here.
set -euo pipefail
tree=$1 generated=$2 library=$3 compiler=$4
for header in volk.h vk_mem_alloc.h; do
    "$compiler" -x c++ -E - <<<"#include <$header>" >/dev/null 2>&1 ||
        { echo "left out: $header is not here (libvulkan-volk-dev; of Debian 13, libvulkan-memory-allocator-dev)" && exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# volk's and the allocator's own code has warnings.
"$compiler" -std=c++20 -w -DVK_NO_PROTOTYPES -UNDEBUG "-I$tree/include" "-I$generated/include" "$tree/examples/vma.cpp" \
    -o "$work/vma" -L "${library%/*}" -Wl,-rpath,"${library%/*}" -ldarkroom_cpp -ldl -lpthread
if readelf -d "$work/vma" | grep 'NEEDED.*libvulkan'; then echo "it is linked with the loader" && exit 1; fi
"$work/vma" >"$work/out"
diff <(printf '%s\n' '170 170 170' '223 223 223' '250 250 250') "$work/out" ||
    { echo "the host (>) makes another picture" && exit 1; }
