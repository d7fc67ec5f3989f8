#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# c_abi.sh TREE API.json LIBRARY COMPILER [renew]: libdarkroom.so keeps to what programs that were compiled before hold
# of it, which is stored in tests/bindings/libdarkroom.abi; `renew` stores what it is now. The library exports the
# functions of darkroom.h and no others. abidiff needs debug information for this, which a release has not; the header,
# which the library is compiled with, and the compiler tell as much, on machines without it, too.
set -euo pipefail
tree=$1 api=$2 library=$3 compiler=$4 renew=${5:-}
stored=$tree/tests/bindings/libdarkroom.abi
[[ $(uname -m) == x86_64 ]] || { echo "left out: $stored is of x86_64" && exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PYTHONDONTWRITEBYTECODE=1
python3 "$tree/tests/bindings/make_layouts.py" "$tree/programs/bindings" "$api" c >"$work/layout.c"
"$compiler" -I "$tree/include" "$work/layout.c" -o "$work/layout"
"$work/layout" >"$work/layout.txt"
python3 "$tree/tests/bindings/abi.py" "$tree/programs/bindings" "$api" "$work/layout.txt" >"$work/now"

sed -nE 's/^(darkroom_[a-z0-9_]+): .*/\1/p' "$work/now" | sort >"$work/declared"
nm --dynamic --defined-only "$library" | sed -nE 's/^[0-9a-f]+ T //p' | sort >"$work/exported"
diff "$work/declared" "$work/exported" || { echo "darkroom.h (<) and $library (>) have other functions" && exit 1; }

[[ $renew != renew ]] || cp "$work/now" "$stored"
diff "$stored" "$work/now" >"$work/difference" && exit 0
cat "$work/difference"
# A struct says its size, so one that has more behind its end is none that breaks.
if grep -E '^<' "$work/difference" | grep -qvE '^< Darkroom[A-Za-z]+: [0-9]+ bytes$'; then
    echo "programs that were compiled with the interface before (<) break with this one (>)"
else
    echo "the interface has more than before (>); programs that were compiled before go on"
fi
echo "if that is meant: $0 $tree $api $library $compiler renew"
exit 1
