#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# mutants.sh TREE: proof/mutants draws the same faults by the same seed, others by another, and puts each into its copy
# and takes it out again: of one line that differs, and of a statement that is left out, alone. Nothing is built. Ends
# with 77, which CTest takes for skipped, where the tree is no checkout of git.
set -euo pipefail
tree=$1
git -C "$tree" rev-parse HEAD >/dev/null 2>&1 || { echo "mutants: skipped, $tree is no checkout of git" && exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
    printf 'mutants: %s\n' "$*"
    exit 1
}

mutants=("$tree/proof/mutants" --count 12)
first=$("${mutants[@]}" --list --seed 5)
[[ $(wc -l <<<"$first") == 12 ]] || fail "12 faults were asked for: $first"
[[ $first == "$("${mutants[@]}" --list --seed 5)" ]] || fail "--seed 5 draws other faults the second time"
[[ $first != "$("${mutants[@]}" --list --seed 6)" ]] || fail "--seed 6 draws the faults of --seed 5"
[[ $("${mutants[@]}" --list --seed 5 --only 3,7) == "$(sed -n '3p; 7p' <<<"$first")" ]] || fail "--only 3,7 draws others"
[[ $first == *.cpp:* && $first == *.glsl:* ]] || fail "of C++ and GLSL one is missing: $first"
grep -qE '_test\.cpp|/test_' <<<"$first" && fail "a test is among them: $first"

# Each is one line for another, in the file that the list names.
copy=$work/copy
changes=$("${mutants[@]}" --dry --seed 5 --folder "$copy")
[[ $(grep -cE '^-([^-]|$)' <<<"$changes") == 12 && $(grep -cE '^\+([^+]|$)' <<<"$changes") == 12 ]] ||
    fail "12 lines should have changed: $changes"
diff <(sed -nE 's/^ *[0-9]+ ([^:]*):([0-9]+): .*/\1 \2/p' <<<"$first") \
    <(awk '/^\+\+\+ b/ { file = substr($2, 3) } /^@@/ { print file, substr($2, 2) }' <<<"$changes") ||
    fail "other lines have changed than were listed"
[[ -z $(git -C "$copy" status --porcelain) ]] || fail "the copy is not as it was: $(git -C "$copy" status --porcelain)"
if said=$("${mutants[@]}" --list --in effects/none 2>&1); then fail "a folder without code was taken: $said"; fi
[[ $said == "mutants: --in effects/none: no code lies there; "* ]] || fail "of a folder without code it says: $said"
echo "mutants: as they should be"
