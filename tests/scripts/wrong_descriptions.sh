#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# wrong_descriptions.sh TREE COMPILER: a parameter that is described wrongly does not compile, and the compiler shows
# the sentence that says why, without exceptions as with them. The right description compiles.
set -euo pipefail
tree=$1 compiler=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# compiles FLAG ROWS
compiles() {
    printf '%s\n' '#include <darkroom/describe.hpp>' 'using namespace darkroom;' \
        'struct Wrong { float amount = 0.5f; std::int32_t steps = 4; };' \
        "constexpr auto rows = describe($2);" >"$work/wrong.cpp"
    "$compiler" -std=c++20 "$1" -fsyntax-only -I "$tree/include" "$work/wrong.cpp" >"$work/log" 2>&1
}
amount='field<&Wrong::amount>("An amount.", {0, 1})'
steps='field<&Wrong::steps>("Steps.", {1, 8})'
for flag in -fexceptions -fno-exceptions; do
    compiles $flag "$amount, $steps.as_loop_count()" || { cat "$work/log" && exit 1; }
    while IFS='#' read -r why rows; do
        if compiles $flag "$rows"; then echo "compiles, although: $why" && exit 1; fi
        grep -qF -- "$why" "$work/log" || { cat "$work/log" && echo "the compiler does not say: $why" && exit 1; }
    done <<ROWS
the doc of a parameter is a sentence#field<&Wrong::amount>("An amount", {0, 1}), $steps
the range is empty#field<&Wrong::amount>("An amount."), $steps
a log range starts above zero#field<&Wrong::amount>("An amount.", {0, 1, Scale::Log}), $steps
the default lies outside the range#field<&Wrong::amount>("An amount.", {0, 0.25}), $steps
a loop count lies in [0, 255]#$amount, field<&Wrong::steps>("Steps.", {1, 300}).as_loop_count()
a member is missing from the description#$amount
describe the members in the order#$steps, $amount
ROWS
done
