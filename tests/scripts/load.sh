#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# load.sh TREE BINDINGS LIBRARY COMPILER LINKED: a host that opens the library (examples/load.c) draws what one that is
# linked with it (LINKED) draws. Where the library is missing, of another version or something else, the host goes on, is
# told why in one line, and shows its scene as it is.
set -euo pipefail
tree=$1 bindings=$2 library=$3 compiler=$4 linked=$5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
strict=(-pedantic -Wall -Wextra -Wshadow -Werror "-I$tree/include" "-I$bindings/include")
"$compiler" -std=c99 "${strict[@]}" "$tree/examples/load.c" -o "$work/load" -lvulkan -ldl
if readelf -d "$work/load" | grep 'NEEDED.*darkroom'; then echo "it is linked with the library" && exit 1; fi

# picture NAME [LIBRARY]: what the host says of the library is left in $work/said.
picture() {
    "$work/load" "$work/$1.ppm" "${@:2}" 2>"$work/said" || { cat "$work/said" && exit 1; }
}
LD_LIBRARY_PATH=${library%/*} picture by_name
picture by_path "$library"
[[ ! -s $work/said ]] || { cat "$work/said" && exit 1; }
"$linked" "$work/linked.ppm"
cmp "$work/linked.ppm" "$work/by_name.ppm"
cmp "$work/linked.ppm" "$work/by_path.ppm"

# says LIBRARY TEXT: the host goes on without it, and is told so once.
says() {
    picture without "$1"
    [[ $(cat "$work/said") == "darkroom_load: $1: $2" ]] || { echo "expected '$2', it says:" && cat "$work/said" && exit 1; }
    # Its scene: 0.01, 0.012, 0.02 around the lamps, and 8, 5 and 8 of the last one, at (588, 178).
    [[ $(tail -c $((640 * 360 * 3)) "$work/without.ppm" | od -An -tu1 -N3 | xargs) == "3 3 5" ]] ||
        { echo "its background is another" && exit 1; }
    [[ $(tail -c $((640 * 360 * 3 - 3 * (640 * 178 + 588))) "$work/without.ppm" | od -An -tu1 -N3 | xargs) == "255 255 255" ]] ||
        { echo "its brightest lamp is another" && exit 1; }
}
# fake NAME VERSION FUNCTION...: a library that has these alone.
fake() {
    {
        echo '#include <stdint.h>'
        echo "uint32_t darkroom_version(void) { return $2; }"
        printf 'void darkroom_%s(void) {}\n' "${@:3}"
    } >"$work/fake.c"
    "$compiler" -shared -fPIC "$work/fake.c" -o "$work/$1.so"
}
version=$(sed -nE 's/^#define DARKROOM_VERSION ([0-9]+)$/\1/p' "$tree/include/darkroom/darkroom.h")
own=$((version / 1000000)).$((version / 1000 % 1000))
says "$work/nowhere.so" "cannot open shared object file: No such file or directory"
fake newer $((version + 1000)) error
says "$work/newer.so" "it is version $(((version + 1000) / 1000000)).$(((version + 1000) / 1000 % 1000)).0, and this program takes $own"
fake older $((version - version % 1000)) error
says "$work/older.so" "it has no darkroom_device_list"
printf 'no library' >"$work/text.so"
says "$work/text.so" "file too short"
