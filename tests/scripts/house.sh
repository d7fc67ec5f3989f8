#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# house.sh PICTURE.svg FACTS: the picture of the house shows the targets, rooms and dependences that CMake knows today
# (cmake/DarkroomHouse.cmake). It holds what it was drawn from as its description.
set -euo pipefail
picture=$1 facts=$2
if ! diff -u --label "$picture" --label CMake <(sed -n '/^<desc>$/,/^<\/desc>$/p' "$picture" | sed '1d;$d') "$facts"; then
    echo "the house was rebuilt: run docs/make/make_pictures.py house"
    exit 1
fi
