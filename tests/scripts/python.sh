#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# python.sh TREE BUILD PYTHON PROGRAM: the wheel, made of what BUILD holds and installed by pip into an empty folder, is at
# most 15 MB and passes the package's tests there, under the validation layer.
set -euo pipefail
tree=$1 build=$2 python=$3 program=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_INDEX=1 PYTHONDONTWRITEBYTECODE=1
DARKROOM_PYTHON_PACKAGE=$build/python/darkroom DARKROOM_PYTHON_BUILD=$work/build \
    "$python" -m pip wheel -q --no-build-isolation --no-deps -w "$work" "$tree"
wheel=$(echo "$work"/darkroom-*.whl)
bytes=$(stat -c %s "$wheel")
[[ $bytes -le 15000000 ]] || { echo "$(basename "$wheel") has $bytes bytes, at most 15000000 are allowed" && exit 1; }
"$python" -m pip install -q --no-deps --root-user-action=ignore --target "$work/installed" "$wheel"
# One symbol leaves the module: an interpreter may load another shaderc or fmt.
symbols=$(nm -D --defined-only "$work"/installed/darkroom/_engine*.so | awk '{ print $3 }')
[[ $symbols == PyInit__engine ]] || { echo "_engine exports $symbols" && exit 1; }
# Beside a numpy that it was not compiled for it says so.
mkdir -p "$work/other/numpy"
echo '__version__ = "2.4"' >"$work/other/numpy/__init__.py"
if "$python" -c 'import sys, pybind11; sys.exit(pybind11.version_info >= (2, 12))'; then
    said=$(PYTHONPATH=$work/other:$work/installed "$python" -c 'import darkroom' 2>&1 | tail -n 1) || true
    [[ $said == *"for numpy 1, and numpy 2.4 is here: pip install 'numpy<2'"* ]] || { echo "numpy 2: $said" && exit 1; }
fi
cd "$tree/programs/python/tests"
PYTHONPATH=$work/installed DARKROOM_SOURCE=$tree DARKROOM_PROGRAM=$program "$python" -m unittest
