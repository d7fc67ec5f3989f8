#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# install.sh TREE BUILD COMPILER plain|sanitize: what is installed can be moved, found by CMake and by pkg-config, compiled
# against and run.
set -euo pipefail
tree=$1 build=$2 compiler=$3 kind=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
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
for file in bin/darkroom include/darkroom/darkroom.hpp include/darkroom/effects.hpp share/doc/darkroom/LICENSE \
    share/bash-completion/completions/darkroom share/zsh/site-functions/_darkroom \
    share/fish/vendor_completions.d/darkroom.fish share/man/man1/darkroom.1 share/man/man1/darkroom-develop.1; do
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
[[ ! -x $work/cmake/script ]] || "$work/cmake/script"

export PKG_CONFIG_PATH=$library/pkgconfig
# pkg-config escapes the blank of the path, and eval reads it so.
eval "'$compiler' -std=c++20 ${flags[*]} '$tree/tests/package/main.cpp' $kept $(pkg-config --cflags --libs darkroom-looks) -o '$work/pkg'"
"$work/pkg"
"$prefix/bin/darkroom" --version
# The module for other files than OpenEXR is found beside the program, wherever that was moved.
"$prefix/bin/darkroom" info "$tree/tests/goldens/forge.png" >/dev/null
