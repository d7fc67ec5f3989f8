#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# symbols.sh LIBRARY...: a shared object or an archive exports C++ symbols of this project's interface and no others,
# libdarkroom.so those of the C interface and no others, and a shared object needs the C++ runtime and our other libraries
# alone; that of scripts needs Lua, too.
set -euo pipefail
for library in "$@"; do
    # What is dynamic of an archive is what is global in it.
    kind=--dynamic
    [[ $library == *.a ]] && kind=--extern-only
    exported=$(nm $kind --defined-only "$library" | sed -nE 's/^[0-9a-f]+ . //p')
    # Functions, variables, tables, types, guards, what is local in functions, and what DarkroomStatic.cmake renames.
    ours='_Z(T[VTIS]|GV)?Z*NK?8darkroom|darkroom_static\.' one=_ZN8darkroom
    [[ $library == */libdarkroom_c.a ]] && ours='darkroom_[a-z0-9_]+$|darkroom_c_static\.' one=darkroom_
    [[ $library == */libdarkroom.so* ]] && ours=darkroom_ one=darkroom_
    foreign=$(grep -vE "^($ours)" <<<"$exported" | c++filt || true)
    if [[ -n $foreign ]]; then
        printf '%s exports what is not ours:\n%s\n' "$library" "$foreign"
        exit 1
    fi
    inner=$(grep -E '^_Z(T[VTIS]|GV)?Z*NK?8darkroom(3gpu|4plan|5graph|6custom|7compose)' <<<"$exported" | c++filt || true)
    if [[ -n $inner ]]; then
        printf '%s exports what no public header asks for:\n%s\n' "$library" "$inner"
        exit 1
    fi
    grep -q "^$one" <<<"$exported" || { echo "$library exports nothing of ours" && exit 1; }
    if nm $kind --undefined-only "$library" | grep -w 'vk[A-Z][A-Za-z0-9]*'; then
        echo "$library calls Vulkan's prototypes, which a host may not have" && exit 1
    fi

    needed=$(readelf -d --wide "$library" | sed -nE 's/.*\(NEEDED\).*\[(.*)\]/\1/p')
    runtime='libstdc\+\+|libm|libgcc_s|libc|libpthread|libdl|ld-linux[-a-z0-9_]*'
    others=libdarkroom_cpp
    [[ $library == *darkroom_script* ]] && others+='|liblua5\.4'
    foreign=$(grep -vE "^(($runtime|$others)\.so\.[0-9.]+)?\$" <<<"$needed" || true)
    if [[ -n $foreign ]]; then
        printf '%s needs more than the C++ runtime:\n%s\n' "$library" "$foreign"
        exit 1
    fi
    printf '%s: %s symbols, needs %s\n' "$library" "$(wc -l <<<"$exported")" "$(xargs <<<"$needed")"
done
