#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# c_header.sh TREE CC CXX [BINDINGS]: the header of the C interface, and the one that loads it, of BINDINGS, compile alone as
# every C and C++ that hosts are written in, without a warning; by clang and for Windows by mingw-w64, too, where they are there.
set -euo pipefail
tree=$1 cc=$2 cxx=$3 bindings=${4:-}
strict=(-pedantic -Wall -Wextra -Wshadow -Wconversion -Werror -fsyntax-only "-I$tree/include")
include='#include <darkroom/darkroom.h>'
if [[ -n $bindings ]]; then
    strict+=("-I$bindings/include")
    include='#include <darkroom/darkroom_load.h>'
fi
compilers=("$cc" "$cxx")
! command -v clang++ >/dev/null || compilers+=(clang clang++)
if command -v x86_64-w64-mingw32-g++ >/dev/null; then
    compilers+=(x86_64-w64-mingw32-gcc x86_64-w64-mingw32-g++)
    # Of the system's headers it may see Vulkan's alone.
    borrowed=$(mktemp -d)
    trap 'rm -rf "$borrowed"' EXIT
    vulkan=$("$cc" -x c -M - <<<'#include <vulkan/vulkan.h>' | grep -o '/[^ ]*/vulkan/vulkan\.h')
    ln -s "${vulkan%/*}" "${vulkan%/*/*}/vk_video" "$borrowed"
    strict+=("-idirafter$borrowed")
fi
for ((i = 0; i < ${#compilers[@]}; i += 2)); do
    for standard in c99 c11 c17; do "${compilers[i]}" -x c "-std=$standard" "${strict[@]}" - <<<"$include"; done
    for standard in c++11 c++14 c++17 c++20; do
        "${compilers[i + 1]}" -x c++ "-std=$standard" "${strict[@]}" - <<<"$include"
    done
done
echo "compiled by ${compilers[*]}"
