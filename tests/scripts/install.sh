#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# install.sh TREE BUILD COMPILER plain|sanitize: what is installed can be moved, found by CMake and by pkg-config, compiled
# against, run and removed; in other folders than the usual ones, too, and where the program alone was built.
set -euo pipefail
tree=$1 build=$2 compiler=$3 kind=$4
work=$(mktemp -d)
# What was installed from here before stays known to the target uninstall.
mkdir "$work/lists"
cp "$build"/install_manifest*.txt "$work/lists/" 2>/dev/null || true
trap 'rm -f "$build"/install_manifest*.txt; cp "$work/lists/"* "$build/" 2>/dev/null || true; rm -rf "$work"' EXIT
flags=(-O0)
kept=""
if [[ $kind == sanitize ]]; then
    flags+=(-fsanitize=address,undefined)
    # Leaks are traced back to the driver, which must still be loaded then, as in our own programs.
    kept=$work/keep_libraries.o
    "$compiler" -c "${flags[@]}" "$tree/tests/keep_libraries.cpp" -o "$kept"
fi

DESTDIR=$work/stage cmake --install "$build" --prefix /opt/darkroom >"$work/install.log" || { cat "$work/install.log" && exit 1; }
mv "$work/stage/opt/darkroom" "$work/moved here"
prefix=$work/moved\ here
for file in bin/darkroom include/darkroom/darkroom.hpp include/darkroom/effects.hpp include/darkroom/darkroom_load.h share/doc/darkroom/LICENSE \
    share/bash-completion/completions/darkroom share/zsh/site-functions/_darkroom \
    share/fish/vendor_completions.d/darkroom.fish share/man/man1/darkroom.1 share/man/man1/darkroom-develop.1 \
    share/darkroom/bindings/{api.json,darkroom_ctypes.py,darkroom.rs,Darkroom.cs,Darkroom.java,darkroom.zig,darkroom.odin}; do
    [[ -f $prefix/$file ]] || { echo "$file was not installed" && exit 1; }
done
if grep -rlF -e "$tree" -e "$build" "$prefix/include" $(find "$prefix" -name '*.cmake' -o -name '*.pc' | tr ' ' '?'); then
    echo "these name the folder they were built in" && exit 1
fi

library=$(dirname "$(find "$prefix" -name libdarkroom.so)")
export LD_LIBRARY_PATH=$library${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
CXXFLAGS=${flags[*]} LDFLAGS=$kept cmake -S "$tree/tests/package" -B "$work/cmake" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_PREFIX_PATH="$prefix" >"$work/log" || { cat "$work/log" && exit 1; }
cmake --build "$work/cmake" >"$work/log" || { cat "$work/log" && exit 1; }
"$work/cmake/package"
"$work/cmake/package_c"
# By themselves: no library of ours beside them.
if [[ -x $work/cmake/package_c_static ]]; then
    LD_LIBRARY_PATH="" "$work/cmake/package_c_static"
    ! readelf -d "$work/cmake/package_c_static" | grep 'NEEDED.*darkroom' || exit 1
fi
[[ -s $work/cmake/package_c.dkb ]] || { echo "darkroom_bake made nothing" && exit 1; }
[[ ! -x $work/cmake/script ]] || "$work/cmake/script"
[[ ! -x $work/cmake/hud ]] || "$work/cmake/hud"

export PKG_CONFIG_PATH=$library/pkgconfig
# pkg-config escapes the blank of the path, and eval reads it so.
eval "'$compiler' -std=c++20 ${flags[*]} '$tree/tests/package/main.cpp' $kept $(pkg-config --cflags --libs darkroom-looks) -o '$work/pkg'"
"$work/pkg"
eval "'${CC:-cc}' -std=c99 ${flags[*]} '$tree/tests/package/main.c' $(pkg-config --cflags --libs darkroom) -o '$work/pkg_c'"
"$work/pkg_c"
"$prefix/bin/darkroom" --version
# The module for other files than OpenEXR is found beside the program, wherever that was moved.
"$prefix/bin/darkroom" info "$tree/proof/goldens/forge.png" >/dev/null

# The tool alone.
cmake --install "$build" --component tool --prefix "$work/tool" >"$work/log" || { cat "$work/log" && exit 1; }
[[ -x $work/tool/bin/darkroom && ! -e $work/tool/include ]] || { echo "the component tool: $(ls "$work/tool")" && exit 1; }

# What was installed can be removed, and nothing else is.
DESTDIR=$work/stage cmake --install "$build" --component tool --prefix /opt/tool >"$work/log"
DESTDIR=$work/stage cmake --install "$build" --prefix /opt/darkroom >"$work/log"
touch "$work/stage/opt/darkroom/share/darkroom/looks/mine.toml"
DESTDIR=$work/stage cmake --build "$build" --target uninstall >"$work/log" || { cat "$work/log" && exit 1; }
[[ -x $work/stage/opt/tool/bin/darkroom ]] || { echo "removing took an earlier installation along" && exit 1; }
left=$(cd "$work/stage/opt/darkroom" && find . -type f -o -path '*[dD]arkroom*' -type d -empty)
[[ $left == ./share/darkroom/looks/mine.toml ]] || { echo "removing left: $left" && exit 1; }

# Another build folder, of which the program alone was built, with folders of its own. The program is linked again, and
# only what knows these folders is compiled.
option=$([[ $kind == sanitize ]] && echo ON || echo OFF)
cmake -S "$tree" -B "$work/second" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER="$compiler" \
    -DDARKROOM_SANITIZE="$option" -DDARKROOM_TESTS=OFF -DCMAKE_INSTALL_LIBDIR=lib64/x -DCMAKE_INSTALL_BINDIR=sbin \
    >"$work/log" 2>&1 || { cat "$work/log" && exit 1; }
object=engine/core/CMakeFiles/darkroom_core.dir/program_module.cpp.o
cmake --build "$work/second" --target "$object" >"$work/log" || { cat "$work/log" && exit 1; }
mkdir -p "$work/second/bin"
link=$(ninja -C "$build" -t commands bin/darkroom | tail -n 1)
(cd "$build" && eval "${link/ -o bin\/darkroom / -o '$work/second/bin/darkroom' '$work/second/$object' }")
cp -r "$build/lib" "$work/second/"
cp -r "$build/programs/darkroom/help" "$work/second/programs/darkroom/"
cmake --install "$work/second" --prefix "$work/there" >"$work/log" || { cat "$work/log" && exit 1; }
mv "$work/there" "$work/moved again"
rm -rf "$work/second"
"$work/moved again/sbin/darkroom" info "$tree/proof/goldens/forge.png" >/dev/null
[[ -x $work/moved\ again/lib64/x/darkroom/darkroom_svg && ! -e $work/moved\ again/include ]] ||
    { echo "a program alone is installed otherwise" && exit 1; }
