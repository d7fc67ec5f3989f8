#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# c_header.sh TREE CC CXX [BINDINGS]: the header of the C interface, and the one that loads it, of BINDINGS, compile alone as
# every C and C++ that hosts are written in, without a warning; by clang, too, where it is there.
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
for ((i = 0; i < ${#compilers[@]}; i += 2)); do
    for standard in c99 c11 c17; do "${compilers[i]}" -x c "-std=$standard" "${strict[@]}" - <<<"$include"; done
    for standard in c++11 c++14 c++17 c++20; do
        "${compilers[i + 1]}" -x c++ "-std=$standard" "${strict[@]}" - <<<"$include"
    done
done
echo "compiled by ${compilers[*]}"
