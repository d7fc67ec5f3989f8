#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# pip_install.sh TREE: the lines of docs/python.md that install the package, in a plain virtual environment, with what pip
# brings from the net: they say how far they are, a second time they compile nothing, and the wheel works beside numpy 1
# and 2. 77: pip brings nothing here.
set -euo pipefail
tree=$1
fail() {
    printf 'pip_install: %s\n' "$*"
    exit 1
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PIP_DISABLE_PIP_VERSION_CHECK=1 PYTHONDONTWRITEBYTECODE=1
unset DARKROOM_PYTHON_PACKAGE PYTHONPATH VIRTUAL_ENV
python3 -m venv "$work/probe" && "$work/probe/bin/pip" download -q --no-deps -d "$work" pybind11 >/dev/null 2>&1 ||
    { echo "left out: pip brings nothing here" && exit 77; }
export HOME=$work DARKROOM_PYTHON_BUILD=$work/build

# The first block of shell of the page, without what is for the whole system.
awk '/^```/ { if (inside) exit; inside = $0 == "```sh"; next } inside' "$tree/docs/python.md" |
    grep -vE '^(sudo|\./darkroom) ' >"$work/lines"
[[ $(grep -c '^pip install \.$' "$work/lines") == 1 ]] || fail "docs/python.md has no line 'pip install .'"
install() { (cd "$tree" && script -qefc "bash -e $work/lines" "$work/said" >/dev/null) || { tail -n 40 "$work/said" && fail "they fail"; }; }
install
grep -qE 'darkroom: building: [0-9]+ %, about [0-9]+ s left' "$work/said" || fail "nothing says how far it is"
grep -q ' Building CXX object ' "$work/build/build.log" || fail "nothing was compiled, so this tells nothing"
start=$SECONDS
install
! grep ' Building CXX object ' "$work/build/build.log" || fail "the second time compiles"
echo "pip_install: the second time takes $((SECONDS - start)) s"

# What another interpreter left in that folder is no part of the wheel.
touch "$work/build/python/darkroom/_engine.cpython-30-other.so"
venv=$work/darkroom-python
(cd "$tree" && "$venv/bin/pip" wheel -q --no-deps -w "$work" .)
[[ $("$venv/bin/python" -m zipfile -l "$work"/darkroom-*.whl | grep -c _engine) == 1 ]] || fail "the wheel holds more than one module"
for numpy in 'numpy<2' 'numpy>=2'; do
    "$venv/bin/pip" install -q "$numpy" || { echo "left out: $numpy is not there for $("$venv/bin/python" --version)" && continue; }
    "$venv/bin/pip" install -q --no-deps --force-reinstall "$work"/darkroom-*.whl
    (cd "$tree/programs/python/tests" && DARKROOM_SOURCE=$tree "$venv/bin/python" -m unittest -q test_pictures test_stacks) ||
        fail "the package fails beside $numpy"
done
echo "pip_install: all as it should be"
