#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# page_machine.sh: the pages' lines that install and build, on a machine that has nothing else: scripts/on_release RELEASE
# tests/scripts/page_machine.sh. Run in the tree, by root; packages come by the pages' own lines alone.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive
# line PAGE BEGIN: the page's line that begins so, without a remark; root needs no sudo, and nobody is asked.
line() {
    grep -m 1 "^$2" "docs/$1.md" | sed -E 's/  +#.*//; s/^sudo //; s/^apt-get install /&-y --no-install-recommends /' ||
        { echo "page_machine: docs/$1.md has no line $2" >&2 && exit 1; }
}
run() {
    printf 'page_machine: %s\n' "$1"
    bash -ec "$1"
}
run "$(line install './darkroom --yes --version')"
run "$(line install 'cmake --preset release')"
tests/scripts/page_builds.sh "$PWD" "$PWD/build"
run "$(line python 'sudo apt-get install python3-venv')"
tests/scripts/pip_install.sh "$PWD" || [[ $? == 77 ]]   # 77: it says that pip brings nothing here
