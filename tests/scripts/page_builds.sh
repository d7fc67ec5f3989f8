#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# page_builds.sh TREE BUILD: the pages on installing and embedding, as they are written. The lines of docs/install.md that
# install are run, below a folder of the test; the CMake blocks of all pages then find what lies there, and build a program
# each; the lines with pkg-config build two more. Of lines that build Darkroom itself or install packages, presets, targets,
# options and packages are looked up.
set -euo pipefail
tree=$1 build=$2
fail() {
    printf 'page_builds: %s\n' "$*"
    exit 1
}
work=$(mktemp -d)
# What was installed from here before stays known to the target uninstall.
mkdir "$work/lists"
cp "$build"/install_manifest*.txt "$work/lists/" 2>/dev/null || true
trap 'rm -f "$build"/install_manifest*.txt; cp "$work/lists/"* "$build/" 2>/dev/null || true; rm -rf "$work"' EXIT
quietly() { "$@" >"$work/log" 2>&1 || { tail -n 40 "$work/log" && fail "$* fails"; }; }

# lines_of KIND PAGE...: what the blocks of this kind hold, a line that ends in a backslash joined to the next
lines_of() {
    local kind=$1
    shift
    (cd "$tree" && awk -v kind="$kind" '/^```/ { inside = $0 == "```" kind; next } inside' "$@") | sed -e :a -e '/\\$/N; s/\\\n//; ta'
}

# Lines that install, in their order; the last one removes again, below.
ln -s "$build" "$work/build"
installed=0
while IFS= read -r line; do
    line=${line#sudo }
    [[ $line == 'cmake --install '* ]] || continue
    (cd "$work" && HOME=/home DESTDIR=$work/stage quietly bash -c "${line%% #*}")
    installed=$((installed + 1))
done < <(lines_of sh docs/install.md)
[[ $installed -ge 3 ]] || fail "docs/install.md has $installed lines that install"
for program in usr/local/bin home/.local/bin; do
    [[ -x $work/stage/$program/darkroom ]] || fail "docs/install.md installs nothing in /$program"
done
prefix=$work/stage/opt/darkroom

# A folder for each CMake block.
mkdir -p "$work/project/looks"
cp "$tree"/tests/package/looks/*.toml "$work/project/looks/"
printf '#include <darkroom/darkroom.hpp>\nint main() { return darkroom::all_effects().empty() ? 1 : 0; }\n' >"$work/project/main.cpp"
cp "$tree/tests/package/main.c" "$work/project/"
cd "$work/project"
{
    printf 'cmake_minimum_required(VERSION 3.25)\nproject(pages LANGUAGES C CXX)\n'
    for page in install embedding; do
        awk -v page="$page" '/^```/ { inside = $0 == "```cmake"; number += inside; next }
            inside { print > (page "_" number ".txt") }' "$tree/docs/$page.md"
    done
} >CMakeLists.txt
for block in install_*.txt embedding_*.txt; do
    name=${block%.txt}
    # Another test's: a host that fetches the tree (fetch.sh); and below: one that is whole.
    ! grep -qE 'FetchContent|^project' "$block" || continue
    mkdir "$name"
    ln -s ../looks "$name/looks"
    {
        printf 'add_executable(%s ../main.cpp)\n' "$name"
        sed "s|/opt/darkroom|$prefix|; s/\bengine\b/$name/" "$block"
        # What follows in the page presumes what its first block says.
        grep -q target_link_libraries "$block" || printf 'target_link_libraries(%s PRIVATE Darkroom::darkroom)\n' "$name"
    } >"$name/CMakeLists.txt"
    printf 'add_subdirectory(%s)\n' "$name" >>CMakeLists.txt
done
# darkroom_bake looks for the program in the library's folders, then in PATH.
quietly env CXXFLAGS=-O0 PATH="$work/stage/home/.local/bin:$PATH" cmake -S . -B out -G Ninja
quietly cmake --build out
for name in install_1 embedding_3; do
    quietly "out/$name/$name"
done
[[ -s out/embedding_3/embedding_3.dkb ]] || fail "docs/embedding.md: darkroom_bake made nothing"

# The hosts beside the tree, whole: their files are copied from it, and they make a picture.
# host PAGE FOLDER FILE KIND: the page's first block of this kind goes to the file, behind the lines that make the folder.
mkdir "$work/tree"
ln -s "$tree/examples" "$work/tree/"
cd "$work/tree"
host() {
    local page=$tree/docs/$1.md folder=$2
    lines_of sh "$page" | grep -E "\.\./$folder\b|^export " >"$work/lines"
    sed -i "s|/opt/darkroom|$prefix|g" "$work/lines"
    quietly bash -e <(grep -E '^(mkdir|cargo new)' "$work/lines")
    awk -v kind="$4" '/^```/ { inside = !done && $0 == "```" kind; done += inside; next } inside' "$page" |
        sed "s|/opt/darkroom|$prefix|; s/^\[dependencies\]//" >>"$work/$folder/$3"
    CXXFLAGS=-O0 CFLAGS=-O0 bash -e <(grep -vE '^(mkdir|cargo new)' "$work/lines") >"$work/log" 2>&1 ||
        { tail -n 40 "$work/log" && fail "docs/$1.md: the host does not build or run"; }
}
for page in embedding c; do
    host $page host$([[ $page == c ]] && echo _c) CMakeLists.txt cmake
    [[ -s picture.ppm ]] || fail "docs/$page.md: the host writes no picture"
    rm picture.ppm
done
# Where a cargo of 1.82 and newer is, and ash with it: nothing is fetched from the net.
version=$(cargo --version 2>/dev/null | cut -d' ' -f2) || true
if printf '1.82\n%s\n' "${version:-0}" | sort -VC && compgen -G "${CARGO_HOME:-$HOME/.cargo}/registry/cache/*/ash-0.38.*" >/dev/null; then
    export CARGO_NET_OFFLINE=true
    host hosts host_rust Cargo.toml toml
    [[ $(tail -n 3 "$work/log") == $'170 170 170\n223 223 223\n250 250 250' ]] || fail "docs/hosts.md: the host in Rust prints other pixels"
fi
cd "$work/project"

# And by pkg-config.
lines_of sh docs/install.md | grep -E '^(export PKG_CONFIG_PATH=|c\+\+ |cc )' >lines || fail "docs/install.md has no pkg-config"
[[ $(wc -l <lines) == 4 ]] || fail "docs/install.md: other lines of pkg-config than four"
[[ -f $prefix/lib/libdarkroom_c.a ]] || sed -i /darkroom-static/d lines
sed -i "s|/opt/darkroom|$prefix|; /^c/s/ *#.*//; s/^c++ /c++ -O0 -o by_cpp /; /static/s/^cc /cc -o by_archive /; s/^cc -std/cc -o by_c -std/" lines
quietly bash -e lines
# As they are: nothing but those lines says where the library is.
for program in by_cpp by_c by_archive; do
    [[ ! -e $program ]] || quietly env -u LD_LIBRARY_PATH ./$program
done
[[ ! -e by_archive ]] || ! readelf -d by_archive | grep -q 'NEEDED.*darkroom' || fail "by_archive loads the library"

# Removed again: what was installed last.
DESTDIR=$work/stage quietly bash -c "cd '$work' && $(lines_of sh docs/install.md | grep -- '--target uninstall')"
[[ ! -e $prefix/include ]] || fail "docs/install.md: uninstall leaves $prefix/include"

# What is not run.
all=$(cd "$tree" && cat README.md docs/*.md)
named=0
while IFS= read -r option; do
    named=$((named + 1))
    grep -rqE "\b$option\b" "$tree/CMakeLists.txt" "$tree/cmake" || fail "pages name the option $option, which CMake does not know"
done < <(grep -oE -- '-DDARKROOM_[A-Z_]+' <<<"$all" | cut -c3- | sort -u)
# The table of options and targets has them all.
while IFS= read -r name; do
    named=$((named + 1))
    grep -qE "^\|.*\`$name\`" "$tree/docs/embedding.md" || fail "docs/embedding.md has no row of $name"
done < <(cd "$tree" && grep -ohE '^(option|set)\(DARKROOM_[A-Z_]+' CMakeLists.txt | sed 's/.*(//' | sort -u &&
    cmake --build "$build" --target help | sed -nE 's/^darkroom_(looks|script|hud)_shared:.*/Darkroom::\1/p')
targets=$(cmake --build "$build" --target help | sed 's/:.*//')
while IFS= read -r target; do
    named=$((named + 1))
    grep -qxF -- "$target" <<<"$targets" || fail "pages name the target $target, which is not there"
done < <(lines_of sh $(cd "$tree" && echo README.md docs/*.md) | grep -oE -- '--target( [a-z][a-z_]+)+' | tr ' ' '\n' | grep '^[a-z]' | sort -u)
# Without lists of packages nothing is known of any.
if apt-cache show bash >/dev/null 2>&1; then
    while IFS= read -r package; do
        named=$((named + 1))
        apt-cache show "$package" >/dev/null 2>&1 || fail "pages name the package $package, which Debian does not have"
    done < <({
        lines_of sh $(cd "$tree" && echo README.md docs/*.md) | sed -nE 's/^sudo apt-get install //p'
        # And of the packages at run time the column of the release that this is.
        release=$(. /etc/os-release && echo "On Debian ${VERSION_ID:-}")
        awk -F ' *[|] *' -v release="$release" '$2 == "For" { for (i = 3; i < NF; ++i) if ($i == release) column = i; next }
            /^[|]/ && column { print $column } !/^[|]/ { column = 0 }' "$tree/docs/install.md" |
            grep -oE '`[^`]+`' | tr -d '`' | tr ' ' '\n' | grep -vE '[.:][a-z:]' || true
    } | tr ' ' '\n' | sort -u)
fi
lines_of sh docs/python.md | grep -q -- "$(grep -oE 'pip wheel( -q)? --no-build-isolation --no-deps' "$tree/tests/scripts/python.sh" | sed 's/ -q//')" ||
    fail "docs/python.md makes its wheel otherwise than tests/scripts/python.sh"
[[ $named -ge 10 ]] || fail "pages name $named options, targets and packages"
echo "page_builds: $installed lines install, $(ls -d install_?/ embedding_?/ ../host*/ | wc -l) blocks of CMake build, $named names are there"
