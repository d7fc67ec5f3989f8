#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# debs.sh FOLDER: the Debian packages in FOLDER, which `scripts/release FOLDER debian` made on this release, are installed
# as a user would, run, compiled against, and removed without a trace. For a bare system, as root:
#     DARKROOM_TEST_DATA=FOLDER scripts/on_release bookworm tests/scripts/debs.sh /mnt/data
set -euo pipefail
folder=$1
tree=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
    printf 'debs: %s\n' "$*"
    exit 1
}
quietly() { "$@" >"$work/log" 2>&1 || { tail -n 40 "$work/log" && fail "$* fails"; }; }
export DEBIAN_FRONTEND=noninteractive
apt() { quietly apt-get -q -o Dpkg::Use-Pty=0 -y --no-install-recommends "$@"; }

ls "$folder"/*.deb >/dev/null || fail "$folder has no packages"
quietly apt-get -q update
# What a host is compiled with, and a driver.
apt install g++ cmake ninja-build pkg-config mesa-vulkan-drivers python3
files() { find / -xdev \( -path /root -o -path /tmp -o -path /proc -o -path /mnt -o -path /var/cache -o -path /var/log \
    -o -path /var/lib/apt -o -path /var/lib/dpkg -o -path "$tree" \) -prune -o ! -name '*.pyc' ! -name __pycache__ -print | sort; }
files >"$work/before"

apt install "$folder"/*.deb
cd "$work"
darkroom --version
darkroom devices
quietly darkroom develop /usr/share/darkroom/samples/window.exr --look /usr/share/darkroom/looks/film.toml -o picture.png
[[ -s picture.png ]] || fail "darkroom makes no picture"
# The parts that are loaded or started on first use: other files than OpenEXR, and what draws documents.
quietly darkroom info "$tree/proof/goldens/forge.png"
man -w darkroom >/dev/null 2>&1 || [[ -e /usr/share/man/man1/darkroom.1.gz ]] || fail "no manual page"
quietly cmake -S "$tree/tests/package" -B hosts -G Ninja -DCMAKE_CXX_FLAGS=-O0
quietly cmake --build hosts
for host in package package_c package_c_static script hud; do
    [[ -x hosts/$host ]] || fail "the host $host was not built"
    quietly "hosts/$host"
done
c++ -std=c++20 -O0 "$tree/tests/package/main.cpp" $(pkg-config --cflags --libs darkroom-looks) -o looks_by_pkg_config
cc -std=c99 "$tree/tests/package/main.c" $(pkg-config --cflags --libs darkroom) -o c_by_pkg_config
for host in ./*_by_pkg_config; do quietly "$host"; done
python3 -c '
import numpy, darkroom
frame = numpy.full((9, 16, 3), 0.18, numpy.float32)
picture = darkroom.develop(frame)
assert picture.shape[:2] == (9, 16) and picture.max() > 0'
echo "debs: $(ls "$folder"/*.deb | wc -l) packages are installed, the program runs, $(ls "$work"/hosts/*.dkb | wc -l) kernels are baked, 7 hosts run"

apt purge $(for deb in "$folder"/*.deb; do dpkg-deb -f "$deb" Package; done)
apt autoremove --purge
files >"$work/after"
# Caches of other packages' own that came by what these depend on are theirs.
diff "$work/before" "$work/after" | grep -i darkroom && fail "these are left"
echo "debs: and removed; of what they depend on $(diff "$work/before" "$work/after" | grep -c '^>') files are left"
