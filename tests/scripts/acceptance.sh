#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# acceptance.sh ACCEPTANCE.md TEST_PROGRAM BUILD PAGE...: every test that the table and the pages' tables of promises
# name exists, every row of the table (number, capability, how, tests) says how, and each names a test or says "open". A
# test is written `Suite.Test`, or `ctest:Name` where it is a program of its own.
set -euo pipefail
table=$1 program=$2 build=$3
shift 3
promises=$(for page; do sed -n '/^| Promise | Held by |$/,/^$/p' "$page" | sed 1,2d; done)
[[ -f $table && ($# == 0 || -n $promises) ]] || { echo "$table is not there, or a page's promises" && exit 1; }

# "All/Suite." and "  Test/0  # ..." become Suite.Test.
tests=$("$program" --gtest_list_tests | sed 's/ *#.*//' | awk '
    /^[^ ]/ { suite = $1; sub(/\.$/, "", suite); sub(/\/[0-9]+$/, "", suite); sub(/^.*\//, "", suite); next }
    { test = $1; sub(/\/.*$/, "", test); print suite "." test }')
programs=$(ctest --test-dir "$build" -N | sed -nE 's/^ *Test +#[0-9]+: //p')
missing=0
while read -r name; do
    grep -qxF -- "$name" <<<"$tests" || { echo "$name does not exist" && missing=1; }
done < <(grep -oE '`[A-Z][A-Za-z0-9_]*\.[A-Z][A-Za-z0-9_]*`' <(cat "$table" && echo "$promises") | tr -d '`' | sort -u)
while read -r name; do
    grep -qxF -- "$name" <<<"$programs" || { echo "ctest:$name does not exist" && missing=1; }
done < <(grep -oE '`ctest:[^`]+`' <(cat "$table" && echo "$promises") | tr -d '`' | sed 's/^ctest://' | sort -u)

while IFS='|' read -r _ number _ how named rest; do
    [[ -z $rest && $how =~ [a-z] ]] || { echo "row$number does not say how" && missing=1; }
    grep -qE '`([A-Z][A-Za-z0-9_]*\.[A-Z]|ctest:)|\bopen\b' <<<"$named" ||
        { echo "row$number names no test and is not open" && missing=1; }
    [[ $how != " not yet"* || $named != *'`'* ]] || { echo "row$number has tests and says not yet" && missing=1; }
done < <(grep -E '^\| *[0-9]+ *\|' "$table")
while IFS='|' read -r _ promise named _; do
    [[ -z $promise || $named =~ \`([A-Z]|ctest:) ]] || { echo "$promise: no test is named" && missing=1; }
done <<<"$promises"
rows=$(grep -cE '^\| *[0-9]+ *\|' "$table" || true)
[[ $rows -ge 104 ]] || { echo "$table has $rows rows of 104" && missing=1; }
exit $missing
