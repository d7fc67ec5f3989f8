#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# fetch.sh TREE BUILD COMPILER [DARKROOM]: a host in another folder (tests/embed) fetches the tree by CMake, as
# docs/embedding.md says. It gets the engine alone, compiles no more files than the tree by itself does for the engine, and its own settings stay. With
# DARKROOM, the program, it is built in BUILD/fetched and draws, with the compiler of GLSL and then without, from kernels
# that its build bakes: the same picture.
set -euo pipefail
tree=$1 build=$2 compiler=$3 darkroom=${4:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
    printf 'fetch: %s\n' "$*"
    exit 1
}
quietly() { "$@" >"$work/log" 2>&1 || { tail -n 40 "$work/log" && fail "$* fails"; }; }
folder=$work/host
[[ -z $darkroom ]] || folder=$build/fetched
mkdir -p "$folder"
awk '/^```/ { if (block ~ /FetchContent_Declare/) printf "%s", block; block = ""; next } { block = block $0 "\n" }' \
    "$tree/docs/embedding.md" | grep -vE '^(cmake_minimum_required|project|find_package|add_executable)' |
    sed "s|\${CMAKE_SOURCE_DIR}/external/darkroom|$tree|; s/\bengine\b/plain/" >"$folder/fetch.cmake"
grep -q "SOURCE_DIR $tree)" "$folder/fetch.cmake" || fail "docs/embedding.md does not say how the tree is fetched"
# configure OPTION...
configure() {
    quietly cmake -S "$tree/tests/embed" -B "$folder" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release \
        -DFETCH="$folder/fetch.cmake" -DEXAMPLE="$tree/examples/embed.cpp" "$@"
}
configure -DDARKROOM_COMPILER=AUTO -DLOOKS=

files() { ninja -C "$1" -t commands "$2" | grep -c -- ' -c '; }
quietly cmake -S "$tree" -B "$work/alone" --preset engine-only -DCMAKE_CXX_COMPILER="$compiler"
alone=$(files "$work/alone" darkroom_shared)
fetched=$(($(files "$folder" plain) - 1)) # one is the host's
echo "fetch: a host compiles $fetched files of the library, the tree alone $alone"
((fetched <= alone && fetched <= 83)) || fail "these are too many"
# Of the rest nothing is looked for, and nothing is built that the host does not link.
grep -E '^(OpenImageIO|OpenEXR|EXPAT|glfw3|tomlplusplus|TinyGLTF|CLI11|GTest|DARKROOM_(IMGUI|LUA))_' "$folder/CMakeCache.txt" &&
    fail "a host needs more than the engine does"
[[ $(ninja -C "$folder" -t commands all | grep -- ' -c ' | grep -vcE 'CMakeFiles/(plain|volk|vma)\.dir/') == "$fetched" ]] ||
    fail "a host's build makes more than the host and what it links"
grep -E '^CMAKE_UNITY_BUILD|Unity/.*embed\.cpp' "$folder/CMakeCache.txt" "$folder/build.ninja" &&
    fail "the host is compiled in another way than it says"
DESTDIR=$work/stage quietly cmake --install "$folder"
[[ ! -e $work/stage ]] || fail "a host installs $(find "$work/stage" -type f | head -n 3 | xargs)"
[[ -n $darkroom ]] || exit 0

quietly cmake --build "$folder"
"$folder/plain" "$work/compiled.ppm"
"$folder/volk" "$work/volk.ppm"
if [[ -x $folder/vma ]]; then
    "$folder/vma" >"$work/out"
    diff <(printf '%s\n' '170 170 170' '223 223 223' '250 250 250') "$work/out" || fail "the host (>) with volk and an allocator differs"
else
    echo "fetch: left out the host with an allocator: there is no vk_mem_alloc.h (libvulkan-memory-allocator-dev of Debian 13)"
fi
cmp "$work/compiled.ppm" "$work/volk.ppm"
configure -DDARKROOM_COMPILER=OFF -DLOOKS="$tree/tests/embed/looks" -DDARKROOM_PROGRAM="$darkroom"
quietly cmake --build "$folder"
if "$folder/plain" "$work/none.ppm" >"$work/log" 2>&1; then fail "kernels of nowhere"; fi
grep -q 'no compiler of GLSL' "$work/log" || { cat "$work/log" && fail "it does not say why"; }
"$folder/plain" "$work/baked.ppm" "$folder/plain.dkb"
cmp "$work/compiled.ppm" "$work/baked.ppm"
