#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# acceptance.sh ACCEPTANCE.md TEST_PROGRAM BUILD: every test that the table names exists, and every row (number,
# capability, how, tests) says how, and names a test or says "open". A test is written `Suite.Test`, or `ctest:Name`
# where it is a program of its own.
set -euo pipefail
table=$1 program=$2 build=$3
[[ -f $table ]] || { echo "$table is not there" && exit 1; }

# "All/Suite." and "  Test/0  # ..." become Suite.Test.
tests=$("$program" --gtest_list_tests | sed 's/ *#.*//' | awk '
    /^[^ ]/ { suite = $1; sub(/\.$/, "", suite); sub(/\/[0-9]+$/, "", suite); sub(/^.*\//, "", suite); next }
    { test = $1; sub(/\/.*$/, "", test); print suite "." test }')
programs=$(ctest --test-dir "$build" -N | sed -nE 's/^ *Test +#[0-9]+: //p')
missing=0
while read -r name; do
    grep -qxF -- "$name" <<<"$tests" || { echo "$table names $name, which does not exist" && missing=1; }
done < <(grep -oE '`[A-Z][A-Za-z0-9_]*\.[A-Z][A-Za-z0-9_]*`' "$table" | tr -d '`' | sort -u)
while read -r name; do
    grep -qxF -- "$name" <<<"$programs" || { echo "$table names ctest:$name, which does not exist" && missing=1; }
done < <(grep -oE '`ctest:[^`]+`' "$table" | tr -d '`' | sed 's/^ctest://' | sort -u)

while IFS='|' read -r _ number _ how named rest; do
    [[ -z $rest && $how =~ [a-z] ]] || { echo "row$number does not say how" && missing=1; }
    grep -qE '`([A-Z][A-Za-z0-9_]*\.[A-Z]|ctest:)|\bopen\b' <<<"$named" ||
        { echo "row$number names no test and is not open" && missing=1; }
    [[ $how != " not yet"* || $named != *'`'* ]] || { echo "row$number has tests and says not yet" && missing=1; }
done < <(grep -E '^\| *[0-9]+ *\|' "$table")
rows=$(grep -cE '^\| *[0-9]+ *\|' "$table" || true)
[[ $rows -ge 104 ]] || { echo "$table has $rows rows of 104" && missing=1; }
exit $missing
