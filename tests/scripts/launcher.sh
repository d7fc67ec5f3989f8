#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# launcher.sh TREE: when ./darkroom builds, when it does not, and what it says, in a small tree with a CMake that only
# pretends. Nothing is compiled or installed.
set -euo pipefail
unset DARKROOM_BUILD DARKROOM_CMAKE_OPTIONS DARKROOM_OPTIONAL_PACKAGES DARKROOM_YES XDG_RUNTIME_DIR XDG_STATE_HOME
work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
tree="$work/a tree"
mkdir -p "$tree" "$work/bin" "$work/elsewhere"
cp -rL "$1/.ci" "$1/darkroom" "$1/test" "$1/scripts" "$1/packages.txt" "$tree/"
cp -L "$1/CMakePresets.json" "$work/presets"
mkdir -p "$tree"/{cmake,include,engine,files,run,edit,proof,programs,effects,samples,scenes/models,looks}
touch "$tree"/{CMakeLists.txt,CMakePresets.json} "$tree/engine/one.cpp" "$tree/samples/a.exr" "$tree/scenes/models/a.glb"

# A build that counts itself, and a machine that has every package.
cat >"$work/bin/cmake" <<'STUB'
#!/usr/bin/env bash
echo "$*" >>"$STUB_LOG"
[[ -n ${STUB_FAILS:-} ]] && { echo "one.cpp:1: error: it is broken" && exit 1; }
if [[ $1 == --build ]]; then
    mkdir -p "$2/bin"
    printf '#!/usr/bin/env bash\nprintf "<%%s>" "$PWD" "$@"\n' >"$2/bin/darkroom"
    cp "$2/bin/darkroom" "$2/bin/darkroom_tests"
    chmod +x "$2/bin/"*
fi
STUB
cat >"$work/bin/dpkg-query" <<'STUB'
#!/usr/bin/env bash
shift 2
for name in "$@"; do [[ $name == "${STUB_LACKS:-}" ]] || echo "$name installed"; done
STUB
cat >"$work/bin/apt-cache" <<'STUB'
#!/usr/bin/env bash
shift
for name in "$@"; do
    found=999:1
    [[ $name != "${STUB_OLD%% *}" ]] || found=${STUB_OLD#* }
    [[ $name != "${STUB_LACKS:-}" ]] && printf '%s:\n  Installed: %s\n  Candidate: 999:2\n' "$name" "$found" ||
        printf '%s:\n  Installed: (none)\n  Candidate: %s\n' "$name" "$found"
done
STUB
cat >"$work/bin/apt-get" <<'STUB'
#!/usr/bin/env bash
echo "apt-get $*" >>"$STUB_LOG"
echo 'what a package prints'
[[ $* != *Status-Fd=3* ]] || printf '%s\n' dlstatus:1:45.5:Retrieving dlstatus:2:59:Retrieving pmstatus:libfmt-dev:61.1:Unpacking >&3
STUB
cat >"$work/bin/sudo" <<'STUB'
#!/usr/bin/env bash
echo "sudo" >>"$STUB_LOG"
exec "$@"
STUB
printf '#!/usr/bin/env bash\necho "${STUB_USER:-0}"\n' >"$work/bin/id"
printf '#!/usr/bin/env bash\necho "ctest $*"\n' >"$work/bin/ctest"
chmod +x "$work/bin/"*
real_path=$PATH
export PATH="$work/bin:$PATH" STUB_LOG="$work/calls"

fail() {
    printf 'launcher: %s\n' "$*"
    cat "$STUB_LOG"
    exit 1
}
calls() { wc -l <"$STUB_LOG"; }
cd "$work/elsewhere"
: >"$STUB_LOG"

# The first run configures, builds, and hands the arguments on as they are, in the folder it was called from.
out=$("$tree/darkroom" develop "a b.exr" '*' 2>"$work/said")
[[ $out == "<$work/elsewhere><develop><a b.exr><*>" ]] || fail "arguments: $out"
[[ $(calls) == 2 ]] || fail "the first run calls CMake twice"
grep -q '^darkroom: building in ' "$work/said" || fail "the first run says what it does"

# The second starts at once and says nothing; so does one through a link.
"$tree/darkroom" >"$work/out" 2>"$work/said"
ln -s "$tree/darkroom" "$work/link"
"$work/link" >"$work/out" 2>>"$work/said"
[[ $(calls) == 2 && ! -s $work/said ]] || fail "the second run builds again"

# What changed, came or went is built; pictures that the build made are not sources.
rebuilds() {
    local before
    before=$(calls)
    "$tree/darkroom" >"$work/out" 2>"$work/said"
    [[ $(calls) -gt $before ]] || fail "no build after: $1"
    before=$(calls)
    "$tree/darkroom" >"$work/out" 2>"$work/said"
    [[ $(calls) == "$before" ]] || fail "two builds after: $1"
}
echo "int x;" >"$tree/engine/one.cpp" && rebuilds "a source changed"
touch "$tree/effects/two.glsl" && rebuilds "a source came"
rm "$tree/engine/one.cpp" && rebuilds "a source went"
rm "$tree/samples/a.exr" && before=$(calls) && "$tree/darkroom" >"$work/out" 2>"$work/said"
[[ $(calls) -gt $before ]] || fail "no build where the samples are gone"
touch "$tree/samples/a.exr" && before=$(calls) && "$tree/darkroom" >"$work/out" 2>"$work/said"
[[ $(calls) == "$before" ]] || fail "a build because of a sample"

# What one command alone needs is built when that is first asked for, and again when sources changed since.
builds_viewer() {
    : >"$STUB_LOG"
    DISPLAY=:0 "$tree/darkroom" "$1" >"$work/out" 2>"$work/said"
    [[ $(grep -c -- '--target darkroom_program darkroom_viewer$' "$STUB_LOG") == "$2" ]] || fail "$3"
}
builds_viewer play 1 "the viewer is not built when it is first asked for"
grep -q 'building darkroom_viewer, a part' "$work/said" || fail "the first window does not say what it waits for"
builds_viewer edit 0 "the viewer is built twice"
builds_viewer render 0 "render builds the viewer"
: >"$STUB_LOG"
! env -u DISPLAY -u WAYLAND_DISPLAY -u WAYLAND_SOCKET "$tree/darkroom" edit >"$work/out" 2>"$work/said" ||
    fail "a window without a display"
[[ ! -s $STUB_LOG ]] && grep -q 'no window can be opened: neither DISPLAY nor WAYLAND_DISPLAY is set' "$work/said" ||
    fail "the viewer is built where no window can be opened"
env -u DISPLAY -u WAYLAND_DISPLAY "$tree/darkroom" edit --help >"$work/out" 2>"$work/said" || fail "no help without a display"
touch "$tree/effects/two.glsl" && builds_viewer render 0 "render builds the viewer after a source changed"
builds_viewer play 1 "the viewer is not built again after a source changed"
: >"$STUB_LOG"
"$tree/darkroom" verify >"$work/out" 2>"$work/said"
grep -q -- '--target darkroom_program darkroom_verifier$' "$STUB_LOG" || fail "verify does not build its program"

# A tree that moved is built anew.
mv "$tree" "$work/moved" && tree=$work/moved && rebuilds "the tree moved"

# A build that fails shows the end of its log, ends with 2, and is tried again.
echo "int y;" >"$tree/engine/three.cpp"
status=0
STUB_FAILS=1 "$tree/darkroom" >"$work/out" 2>"$work/said" || status=$?
[[ $status == 2 && ! -s $work/out ]] && grep -q 'it is broken' "$work/said" || fail "a failing build"
rebuilds "a build that failed"

# What is missing is installed, and nothing else is; not unasked. lacking USER ANSWER COMMAND...: COMMAND where one package
# is missing, for user number USER (0 is root), with ANSWER typed on a terminal, or without a terminal where it is "none".
lacking() {
    local user=$1 answer=$2
    shift 2
    status=0
    : >"$STUB_LOG"
    touch "$tree/engine/three.cpp"
    if [[ $answer == none ]]; then
        STUB_LACKS=libfmt-dev STUB_USER=$user "$@" </dev/null >"$work/out" 2>"$work/said" || status=$?
    else
        STUB_LACKS=libfmt-dev STUB_USER=$user script -qec "$(printf '%q ' "$@")" /dev/null <<<"$answer" >"$work/said" || status=$?
    fi
}
command='apt-get install -y --no-install-recommends libfmt-dev'
installed() {
    [[ $status == 0 ]] && grep -qE '^apt-get .*install -y --no-install-recommends libfmt-dev$' "$STUB_LOG" || fail "not installed: $1"
}
refused() {
    [[ $status == 2 ]] && ! grep -q '^apt-get' "$STUB_LOG" && grep -q "they are by: $command" <(tr -d '\r' <"$work/said") ||
        fail "not refused: $1"
}
lacking 0 none "$tree/darkroom" && installed "root without a terminal"
! grep -q '^sudo' "$STUB_LOG" || fail "root needs no sudo"
lacking 0 n "$tree/darkroom" && refused "root says no on a terminal"
lacking 0 y "$tree/darkroom" && installed "root says yes on a terminal"
grep -q 'missing packages: libfmt-dev' "$work/said" && grep -q 'install them?' "$work/said" || fail "root is not asked"
command="sudo $command"
lacking 1 none "$tree/darkroom" && refused "a user without a terminal"
lacking 1 n "$tree/darkroom" && refused "a user says no"
lacking 1 "" "$tree/test" && installed "a user presses return"
grep -q 'install them by sudo?' "$work/said" && grep -q '^sudo' "$STUB_LOG" || fail "a user is not asked"
lacking 1 none env DARKROOM_YES=1 "$tree/darkroom" && installed "DARKROOM_YES=1"
lacking 1 none env DARKROOM_YES=0 "$tree/darkroom" && refused "DARKROOM_YES=0"
lacking 1 n "$tree/darkroom" --yes a --yes && installed "--yes"
! grep -q 'install them' "$work/said" || fail "--yes is asked all the same"
grep -qF "elsewhere><a><--yes>" "$work/said" || fail "the first --yes is handed on, or the second is not"
lacking 1 none "$tree/darkroom" a --yes && refused "--yes behind another argument"
lacking 1 none "$tree/test" --yes -R Bloom && installed "./test --yes"
[[ $(<"$work/out") == *"-LE ^soak$ -R Bloom" ]] || fail "./test hands --yes on"

# A release whose packages are too old is named in one line, before anything is installed or compiled: by the version that
# is installed, or the one that would be.
too_old() {
    status=0
    : >"$STUB_LOG"
    touch "$tree/engine/three.cpp"
    STUB_OLD=$1 STUB_LACKS=${3:-} "$tree/darkroom" --yes >"$work/out" 2>"$work/said" || status=$?
    [[ $status == 2 && ! -s $STUB_LOG && $(<"$work/said") == "darkroom: too old here: $2" ]] ||
        fail "too old: $1: $(<"$work/said")"
}
# The packages alone.
: >"$STUB_LOG"
STUB_LACKS=libfmt-dev "$tree/darkroom" --yes --packages >"$work/out" 2>"$work/said" || fail "--packages: $(<"$work/said")"
grep -qE '^apt-get .*install -y --no-install-recommends libfmt-dev$' "$STUB_LOG" && ! grep -q -- --build "$STUB_LOG" ||
    fail "--packages installs and builds nothing"
diff <(printf 'darkroom: packages: %s %%\n' 'downloading, 40' 'unpacking, 60') <(grep % "$work/said") || fail "how far apt is"
too_old 'cmake 3.18.4-2' 'cmake 3.18.4-2 (3.25 is needed)'
too_old 'g++ 4:11.2.0-1' 'g++ 4:11.2.0-1 (4:12 is needed)'
too_old 'libfmt-dev 8.1.1+ds1-2' 'libfmt-dev 8.1.1+ds1-2 (9 is needed)' libfmt-dev
touch "$tree/engine/three.cpp"
STUB_OLD='cmake 3.25.1-1' "$tree/darkroom" >"$work/out" 2>"$work/said" || fail "the oldest version that does: $(<"$work/said")"

# A folder that cannot be written is named, and so is the way out. Root can write everywhere.
if [[ $EUID != 0 ]]; then
    status=0
    chmod u-w "$work/elsewhere"
    DARKROOM_BUILD=$work/elsewhere/build "$tree/darkroom" 2>"$work/said" || status=$?
    [[ $status == 2 ]] && grep -q DARKROOM_BUILD "$work/said" || fail "a folder that cannot be written"
    chmod u+w "$work/elsewhere"
fi
DARKROOM_BUILD=$work/other "$tree/darkroom" >"$work/out" 2>"$work/said"
[[ -x $work/other/bin/darkroom ]] || fail "DARKROOM_BUILD"

# ./test chooses labels, and hands the rest to CTest.
[[ $("$tree/test" -R Bloom 2>/dev/null) == "ctest --test-dir $tree/build "*" -LE ^soak$ -R Bloom" ]] || fail "./test -R"
[[ $("$tree/test" --all 2>/dev/null) != *"-LE"* ]] || fail "./test --all"
[[ $("$tree/test" --sanitize 2>/dev/null) == "ctest --test-dir $tree/build-sanitize "*" -L ^(fast|gpu)$" ]] || fail "./test --sanitize"
grep -q -- '--preset sanitize' "$STUB_LOG" || fail "./test --sanitize configures without sanitizers"
out=$("$tree/test" --thread 2>/dev/null)
[[ $out == "ctest --test-dir $tree/build-thread "*" -L ^(fast|gpu)$" ]] || fail "./test --thread: $out"
grep -q -- '--preset thread' "$STUB_LOG" || fail "./test --thread: no sanitizer"
grep -qF -- "--build $tree/build-thread --target darkroom_tests" "$STUB_LOG" || fail "./test --thread: what is built"
status=0
"$tree/test" --thread --all 2>"$work/said" || status=$?
[[ $status == 2 ]] && grep -q 'one of them' "$work/said" || fail "./test --thread --all"

# A build says how far it is, here as far as five of ten equal steps, and goes on when that was said.
cat >"$work/bin/ninja" <<'STUB'
#!/usr/bin/env bash
[[ -z ${STUB_STEPS:-} ]] || printf '[%d/10] Building x.o%s\n' {1,1,2,2,3,3,4,4,5,5,6,6,7,7,8,8,9,9,10,10}
STUB
cat >>"$work/bin/cmake" <<'STUB'
[[ -z ${STUB_STEPS:-} || $1 != --build ]] || {
    printf '[%d/10] Building x.o%s\n' {1,1,2,2,3,3,4,4,5,5}
    for _ in {1..100}; do grep -q "$STUB_STEPS" "$STUB_SAID" && break || sleep 0.1; done
    # Time to say it twice, which would be wrong.
    sleep 0.6
}
STUB
chmod +x "$work/bin/ninja"
export STUB_SAID=$work/said
touch "$tree/engine/three.cpp"
STUB_STEPS='50 %' "$tree/darkroom" >"$work/out" 2>"$work/said"
[[ $(grep -cE '^darkroom: building: 50 %, about [0-9]+ s left$' "$work/said") == 1 ]] || fail "progress without a terminal"
touch "$tree/engine/three.cpp"
STUB_STEPS='50 %.*50 %' script -qefc "$(printf '%q' "$tree/darkroom")" "$work/said" </dev/null >"$work/out"
grep -qE $'\r\033\\[Kdarkroom: building: 50 %, about [0-9]+ s left\r' "$work/said" || fail "progress on a terminal"

# So it does with CMake and ninja as they are, which look for new files before they build: three of five steps are done.
real="$work/a real tree"
mkdir "$real" "$work/packages"
cp -r "$tree/darkroom" "$tree/scripts" "$tree/packages.txt" "$real/"
cp "$work/presets" "$real/CMakePresets.json"
cp "$work/bin/"{dpkg-query,apt-cache,apt-get,id} "$work/packages/"
cat >"$real/CMakeLists.txt" <<'LISTS'
cmake_minimum_required(VERSION 3.25)
project(small NONE)
file(GLOB sources CONFIGURE_DEPENDS *.txt)
foreach(step RANGE 1 3)
  add_custom_command(OUTPUT ${step} COMMAND true)
endforeach()
set(wait "for i in $(seq 100)\; do grep -q 'building: 60 %' \"$STUB_SAID\" && break || sleep 0.1\; done")
add_custom_command(OUTPUT 4 DEPENDS 1 2 3 COMMAND sh -c ${wait} VERBATIM)
add_custom_command(OUTPUT bin/darkroom DEPENDS 4 COMMAND mkdir -p bin COMMAND ln -sf /bin/true bin/darkroom)
add_custom_target(darkroom_program DEPENDS bin/darkroom)
LISTS
PATH="$work/packages:$real_path" "$real/darkroom" >"$work/out" 2>"$work/said" || fail "a build by CMake: $(<"$work/said")"
grep -qE '^darkroom: building: 60 %, about [0-9]+ s left$' "$work/said" || fail "progress by ninja: $(<"$work/said")"

# How much came from the compiler's cache is said in one line, where something was compiled.
cat >>"$work/bin/cmake" <<'STUB'
[[ -z ${STUB_HITS:-} || $1 != --build ]] ||
    printf '%s\n' '# a.cpp' direct_cache_hit '# b.cpp' cache_miss >"$CCACHE_STATSLOG"
STUB
STUB_HITS=1 "$tree/test" -R Bloom >"$work/out" 2>"$work/said"
grep -qxF 'darkroom: 1 of 2 compiled files from the cache' "$work/said" || fail "the cache's hits are not said"
"$tree/test" -R Bloom >"$work/out" 2>"$work/said"
! grep -q 'cache' "$work/said" || fail "hits of a build that compiled nothing"

# CI: a warning is an error in its three builds, and what it leaves out stands before the closing lines of CTest.
cat >"$work/bin/ctest" <<'STUB'
#!/usr/bin/env bash
printf '%s\n' "100% tests passed" "Total Test time"
[[ $* != *${STUB_RED:-none}* ]]
STUB
cat >"$tree/scripts/on_release" <<'STUB'
#!/usr/bin/env bash
echo "on_release $1 ${2} ${3//[[:space:]]*/}" >>"$STUB_LOG"
[[ $2 != bash || -t 1 ]] || tar -cT /dev/null
[[ $1 != "${STUB_OLD:-}" ]]
STUB
export HOME=$work/home
: >"$STUB_LOG"
"$tree/.ci/run" >"$work/out" 2>"$work/said" || fail ".ci/run"
[[ $(grep -c 'preset release .*-DCMAKE_COMPILE_WARNING_AS_ERROR=ON' "$STUB_LOG") == 1 ]] || fail ".ci/run: warnings"
! grep -qE -- "-B .*/build --preset" "$STUB_LOG" || fail ".ci/run leaves its flags in build/"
[[ $(tail -n 3 "$work/out" | xargs) == *"(.ci/more): clang never on this machine; "*"; testing never on this machine 100% tests passed Total Test time" ]] ||
    fail ".ci/run: closing lines: $(<"$work/out")"
: >"$STUB_LOG"
"$tree/.ci/more" >"$work/out" 2>"$work/said" || fail ".ci/more"
[[ $(grep -oE 'preset (clang|plain|without-compiler|sanitize|release)' "$STUB_LOG" | cut -d' ' -f2 | xargs) == \
    "clang plain without-compiler sanitize release release release" ]] ||
    fail ".ci/more: builds"
[[ $(grep '^on_release' "$STUB_LOG" | sed 's/ *$//') == "on_release bookworm tests/scripts/page_machine.sh
on_release trixie bash -c
on_release bookworm bash -euc
on_release bookworm tests/scripts/debs.sh /mnt/data
on_release trixie bash -euc
on_release trixie tests/scripts/debs.sh /mnt/data
on_release testing ./test --yes" ]] || fail ".ci/more: releases"
! STUB_RED=build-ci-thread "$tree/.ci/run" >"$work/out" 2>"$work/said" || fail ".ci/run passes where a test fails"
last=$("$tree/.ci/more" --last)
[[ $(grep -oE '[a-z-]+ passed [0-9-]+ [0-9:]+ UTC at ' <<<"$last" | wc -l) == 11 ]] || fail ".ci/more --last: $last"
"$tree/.ci/run" >"$work/out" 2>"$work/said" || fail ".ci/run again"
grep -qF "(.ci/more): $last" "$work/out" || fail ".ci/run says when .ci/more ran"
STUB_LACKS=clang "$tree/.ci/more" >"$work/out" 2>"$work/said" </dev/null || fail ".ci/more without clang"
grep -qE '^apt-get .*install .* clang$' "$STUB_LOG" || fail ".ci/more installs no clang"
status=0
STUB_FAILS=1 "$tree/.ci/more" >"$work/out" 2>"$work/said" || status=$?
[[ $status != 0 ]] || fail ".ci/more that failed"
is_last() {
    [[ $("$tree/.ci/more" --last | grep -oE '[a-z-]+ (passed|failed|never)' | xargs) == "$1" ]] || fail "$2: $("$tree/.ci/more" --last)"
}
failed="clang failed plain failed without-compiler failed sanitize failed soak failed languages failed readers failed"
is_last "$failed pages passed trixie passed debs passed testing passed" ".ci/more that failed"
# One part alone leaves what is known of the others.
! STUB_OLD=testing "$tree/.ci/more" testing >"$work/out" 2>"$work/said" || fail ".ci/more testing"
is_last "$failed pages passed trixie passed debs passed testing failed" ".ci/more testing"
! "$tree/.ci/more" woody 2>"$work/said" || fail ".ci/more woody"
grep -q '^darkroom: woody: no part, which are: clang ' "$work/said" || fail ".ci/more names no parts"
echo "launcher: all as it should be"
