#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# windows.sh TREE BUILD DARKROOM EMBED EMBED_C: the engine's libraries, built for Windows by mingw-w64, run under wine: the
# tests that need no GPU pass, and examples/embed.cpp and embed.c, whose kernels DARKROOM bakes, make the pictures that
# EMBED and EMBED_C make here, without a word of the validation layer's. Builds in BUILD/windows. Ends with 77, which CTest takes for skipped, where a
# package is missing.
set -euo pipefail
tree=$1 build=$2 darkroom=$3 embed=$4 embed_c=$5
fail() {
    printf 'windows: %s\n' "$*"
    exit 1
}
# Program and package.
for needed in x86_64-w64-mingw32-g++-posix=g++-mingw-w64-x86-64-posix wine=wine wineserver=wine64 Xvfb=xvfb; do
    command -v "${needed%%=*}" >/dev/null ||
        { echo "windows: skipped, there is no ${needed%%=*}: it is in Debian's package ${needed##*=}" && exit 77; }
done

work=$(mktemp -d)
export WINEPREFIX=$work/prefix WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml=' WINEARCH=win64
xvfb=""
finish() {
    wineserver -k 2>/dev/null || true
    [[ -z $xvfb ]] || { kill "$xvfb" && wait "$xvfb"; } 2>/dev/null || true
    rm -rf "$work"
}
trap finish EXIT
quietly() { "$@" >"$work/log" 2>&1 || { tail -n 40 "$work/log" && fail "$1 failed"; }; }

# The prefix is made while the compiler runs.
exec 3<>"$work/display_number"
Xvfb -displayfd 3 -screen 0 640x480x24 -nolisten tcp >"$work/xvfb.log" 2>&1 &
xvfb=$!
for ((wait = 0; wait < 100; ++wait)); do [[ ! -s $work/display_number ]] && sleep 0.1 || break; done
[[ -s $work/display_number ]] || { cat "$work/xvfb.log" && fail "no display"; }
exec 3>&-
export DISPLAY=:$(<"$work/display_number")
timeout 120 wine wineboot -i >"$work/boot.log" 2>&1 &
boot=$!
quietly cmake -S "$tree" --preset windows -B "$build/windows" -DCMAKE_COMPILE_WARNING_AS_ERROR=ON
quietly cmake --build "$build/windows" --target darkroom_tests darkroom_shared darkroom_c_shared example_embed example_embed_c
wait "$boot" || { cat "$work/boot.log" && fail "wine does not start"; }

# The C++ runtime of mingw-w64 is three DLLs, which a host brings along.
folder_of() { dirname "$(x86_64-w64-mingw32-g++-posix -print-file-name="$1")"; }
WINEPATH="Z:$build/windows/bin;Z:$(folder_of libstdc++-6.dll);Z:$(folder_of libwinpthread-1.dll)"
export WINEPATH=${WINEPATH//\//\\}

cd "$build/windows"
# Those of the label `fast` (tests/CMakeLists.txt).
timeout 120 wine bin/darkroom_tests.exe --gtest_brief=1 \
    --gtest_filter='-Compose*:Effect*:Chain*:Cli*:GraphPhysical*:*Gpu*:Truth*:Soak*' >"$work/tests.log" 2>&1 ||
    { tail -n 40 "$work/tests.log" && fail "tests fail"; }
grep -a 'ran\.' "$work/tests.log"

# look_of "EFFECT" or "EFFECT PARAMETER VALUE"...: a look
look_of() {
    echo 'format = 1'
    printf '[[stack]]\neffect = "%s"\n' "$@" |
        sed 's/^effect = "\([a-z_]*\) \([a-z_]*\) \(.*\)"$/effect = "\1"\n\2 = \3/'
}
look_of 'bloom intensity 0.08' 'exposure exposure 1.5' tonemap 'vignette intensity 0.4' encode dither >"$work/embed.toml"
look_of 'bloom intensity 0.08' 'exposure exposure 1.5' tonemap encode >"$work/embed_c.toml"
enabled=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION
# of_host NAME LINUX_PROGRAM
of_host() {
    local name=$1 here=$2
    quietly "$darkroom" bake "$work/$name.toml" -o "$work/embed.dkb" --profile software --size 640x360
    quietly "$here" "$work/linux.ppm"
    VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation VK_LAYER_ENABLES=${enabled}_EXT:${enabled}_QUEUE_SUBMIT \
        timeout 60 wine "examples/$name.exe" "$work/windows.ppm" "$work/embed.dkb" >"$work/embed.log" 2>&1 ||
        { cat "$work/embed.log" && fail "the example $name fails"; }
    grep -aE 'Validation (Error|Warning)|SYNC-HAZARD|UNASSIGNED-|VUID-' "$work/embed.log" &&
        fail "the validation layer speaks of $name"
    # cmp says which bytes differ, in octal digits.
    cmp -l "$work/linux.ppm" "$work/windows.ppm" >"$work/differing" || true
    [[ $(stat -c %s "$work/windows.ppm") == $(stat -c %s "$work/linux.ppm") ]] || fail "the pictures have not one size"
    awk -v name="$name" 'function value(octal) { return int(octal / 100) * 64 + int(octal % 100 / 10) * 8 + octal % 10 }
        { by = value($2) - value($3); if (by < 0) by = -by; if (by > most) most = by }
        END { printf "windows: %s: %d bytes of the picture differ, by %d at most\n", name, NR, most; exit most > 1 }' \
        "$work/differing" || fail "the picture is another one"
    # Without the file the error says what is missing.
    if timeout 60 wine "examples/$name.exe" "$work/none.ppm" >"$work/embed.log" 2>&1; then fail "kernels of nowhere"; fi
    grep -aq 'no compiler of GLSL' "$work/embed.log" || { cat "$work/embed.log" && fail "it does not say why"; }
    rm "$work/windows.ppm"
}
of_host embed "$embed"
of_host embed_c "$embed_c"
