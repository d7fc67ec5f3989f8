#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# embed.sh TREE BUILD COMPILER SHADERC...: what is installed serves hosts unlike our own programs (tests/embed). SHADERC
# are the archives of the host's own GLSL compiler; where there are none, the library as an archive is not tried.
set -euo pipefail
tree=$1 build=$2 compiler=$3
shift 3
# Of glslang 15 most archives hold one stub each, of one name, so that build files with their names go on.
archives=()
for archive in "$@"; do [[ $(ar t "$archive") == stub.cpp.o ]] || archives+=("$archive"); done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log" && exit 1; }; }

quietly cmake --install "$build" --prefix "$work/prefix"
quietly cmake -S "$tree/tests/embed" -B "$work/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_PREFIX_PATH="$work/prefix" -DEXAMPLE="$tree/examples/embed.cpp" \
    -DSECOND_COMPILER="$(IFS=';' && echo "${archives[*]}")"
quietly cmake --build "$work/build"

hosts=(plain volk)
[[ $# == 0 ]] || hosts+=(static)
for host in "${hosts[@]}"; do
    echo "$host:"
    "$work/build/$host" "$work/$host.ppm"
    cmp "$work/plain.ppm" "$work/$host.ppm"
done
if readelf -d "$work/build/volk" | grep -q 'NEEDED.*libvulkan'; then echo "volk: linked with the loader" && exit 1; fi
if [[ -x $work/build/static ]] && readelf -d "$work/build/static" | grep 'NEEDED.*darkroom'; then
    echo "static: linked with the shared library" && exit 1
fi
