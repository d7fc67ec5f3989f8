#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# symbols.sh LIBRARY...: a shared object exports C++ symbols of this project and no others, and needs the C++ runtime and
# our other libraries alone.
set -euo pipefail
for library in "$@"; do
    exported=$(nm -D --defined-only --demangle "$library" | cut -d ' ' -f 3-)
    foreign=$(grep -vE '^((vtable|VTT|typeinfo|typeinfo name|guard variable) for )?darkroom::' <<<"$exported" || true)
    if [[ -n $foreign ]]; then
        printf '%s exports what is not ours:\n%s\n' "$library" "$foreign"
        exit 1
    fi
    grep -q '^darkroom::' <<<"$exported" || { echo "$library exports nothing of ours" && exit 1; }

    needed=$(readelf -d --wide "$library" | sed -nE 's/.*\(NEEDED\).*\[(.*)\]/\1/p')
    foreign=$(grep -vE '^(libstdc\+\+|libm|libgcc_s|libc|libpthread|libdl|ld-linux[-a-z0-9_]*|libdarkroom)\.so\.[0-9.]+$' \
        <<<"$needed" || true)
    if [[ -n $foreign ]]; then
        printf '%s needs more than the C++ runtime:\n%s\n' "$library" "$foreign"
        exit 1
    fi
    printf '%s: %s symbols, needs %s\n' "$library" "$(wc -l <<<"$exported")" "$(xargs <<<"$needed")"
done
