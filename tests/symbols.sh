#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# symbols.sh LIBRARY...: a shared object exports C++ symbols of this project, and no others.
set -euo pipefail
for library in "$@"; do
    exported=$(nm -D --defined-only --demangle "$library" | cut -d ' ' -f 3-)
    foreign=$(grep -vE '^((vtable|VTT|typeinfo|typeinfo name|guard variable) for )?darkroom::' <<<"$exported" || true)
    if [[ -n $foreign ]]; then
        printf '%s exports what is not ours:\n%s\n' "$library" "$foreign"
        exit 1
    fi
    grep -q '^darkroom::' <<<"$exported" || { echo "$library exports nothing of ours" && exit 1; }
    printf '%s: %s symbols\n' "$library" "$(wc -l <<<"$exported")"
done
