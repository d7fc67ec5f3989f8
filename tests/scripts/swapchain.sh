#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# swapchain.sh TREE LIBRARY COMPILER LINKED: examples/swapchain.c shows in a window what a host that saves its picture
# (LINKED) makes, by the memory of a display of its own. 77: GLFW or Xvfb is not here.
set -euo pipefail
tree=$1 library=$2 compiler=$3 linked=$4
pkg-config --exists glfw3 && command -v Xvfb >/dev/null || { echo "left out: libglfw3-dev or xvfb is not here" && exit 77; }
work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; wait; rm -rf "$work"' EXIT
"$compiler" -std=c99 -Wall -Wextra -Werror -I "$tree/include" "$tree/examples/swapchain.c" -o "$work/swapchain" \
    -L "${library%/*}" -Wl,-rpath,"${library%/*}" -ldarkroom $(pkg-config --cflags --libs glfw3) -lvulkan
"$linked" "$work/linked.ppm"
mkfifo "$work/number"
Xvfb -displayfd 3 -screen 0 640x360x24 -nolisten tcp -fbdir "$work" 3>"$work/number" >"$work/xvfb.log" 2>&1 &
read -r number <"$work/number"
export DISPLAY=:$number
unset WAYLAND_DISPLAY

timeout 60 "$work/swapchain" >"$work/said" 2>&1 &
host=$!
shown() {
    # An XWD file: its length, its colours of 12 bytes, then four bytes a pixel: blue, green, red.
    python3 - "$work/Xvfb_screen0" "$work/linked.ppm" <<'END'
import struct, sys
data = open(sys.argv[1], "rb").read()
head = struct.unpack(">25I", data[:100])
pixels = data[head[0] + 12 * head[19]:][:640 * 360 * 4]
red_green_blue = bytearray(640 * 360 * 3)
for channel in range(3):
    red_green_blue[channel::3] = pixels[2 - channel::4]
sys.exit(red_green_blue != open(sys.argv[2], "rb").read()[-640 * 360 * 3:])
END
}
until shown; do
    kill -0 $host 2>/dev/null || { echo "its window never had the picture:" && cat "$work/said" && exit 1; }
done
kill $host
cat "$work/said"
# It ends by itself, too.
timeout 60 "$work/swapchain" 5
