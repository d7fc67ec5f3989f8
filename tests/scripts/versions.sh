#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# versions.sh TREE: what packages and pages call Darkroom's version is the one of its CMake project.
set -euo pipefail
cd "$1"
whole=$(sed -nE 's/^project\(darkroom VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)
short=${whole%.*}
failed=0
# is VERSION PATTERN FILE...: each file has the pattern, whose group is the version wherever it stands.
is() {
    local version=$1 pattern=$2 file found
    shift 2
    for file; do
        found=$(grep -oE -- "$pattern" "$file" | sed -E "s/.*$pattern.*/\1/" | sort -u | paste -sd ' ')
        [[ $found == "$version" ]] && continue
        printf 'versions: %s: "%s" of /%s/, CMakeLists.txt has %s\n' "$file" "$found" "$pattern" "$version"
        failed=1
    done
}
number='([0-9]+[.][0-9.]*[0-9])'
is "$whole" "\"version\": \"$number\"" packaging/vcpkg/darkroom/vcpkg.json
is "$whole" "^darkroom [(]$number-" packaging/debian/changelog
is "$whole" "darkroom-$number" docs/packaging.md
is "$short" "libdarkroom[a-z-]*$number" packaging/debian/control docs/packaging.md <(ls packaging/debian)
is "$short" "find_package[(]Darkroom $number" packaging/conan/test_package/CMakeLists.txt docs/{c,embedding,install}.md
is "$short" "this is version $number" README.md
is "$short" "^## $number, unreleased" CHANGELOG.md
exit $failed
