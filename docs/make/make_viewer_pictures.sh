#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes docs/pictures/viewer_*.jpg for docs/viewer.md: docs/make/make_viewer_pictures.sh [DARKROOM [SIZE [FOLDER]]]. The
# windows open in a display of its own (Xvfb, openbox), whose mouse and keys are moved by xdotool.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
darkroom=$(realpath -- "${1:-./darkroom}") size=${2:-1280x720} scenes=$PWD/scenes
out=$(realpath -- "${3:-docs/pictures}")
for tool in Xvfb openbox xdotool oiiotool; do
    command -v "$tool" >/dev/null || { echo "$tool is not installed: no pictures are made" && exit 0; }
done
work=$(mktemp -d)
processes=()
# Panels as they lie at first, whatever who calls this has made of them.
export XDG_CONFIG_HOME=$work/config
trap 'kill "${processes[@]}" 2>/dev/null || true; wait; rm -rf "$work"' EXIT

mkfifo "$work/number" "$work/commands"
exec 4<>"$work/commands"
# With room for the window's frame.
Xvfb -displayfd 3 -screen 0 "$((${size%x*} + 100))x$((${size#*x} + 100))x24" -nolisten tcp -noreset 3>"$work/number" 2>/dev/null &
processes+=($!)
read -r number <"$work/number"
export DISPLAY=:$number
openbox --sm-disable >/dev/null 2>&1 &
processes+=($!)

count() { grep -c -- "$1" "$work/said" || true; }
# wait_for LINE COUNT: until the viewer has said it more than so many times.
wait_for() {
    for ((i = 0; i < 1200; ++i)); do
        [[ $(count "$1") -le $2 ]] || return 0
        sleep 0.1
    done
    echo "the viewer does not say '$1':" >&2
    cat "$work/said" >&2
    exit 1
}
start() {
    (cd "$work" && exec "$darkroom" "$@" --commands >"$work/said" <"$work/commands") &
    viewer=$!
    processes+=("$viewer")
    until [[ -s $work/said ]] || ! kill -0 "$viewer" 2>/dev/null; do sleep 0.1; done
    wait_for ready 0
    window=$(xdotool search --onlyvisible --name Darkroom | tail -n 1)
    xdotool windowactivate --sync "$window"
}
leave() {
    xdotool key Escape
    wait "$viewer"
    rm "$work/said"
}
# say KEY LINE: presses a key, and waits for what it says.
say() {
    local before
    before=$(count "$2")
    xdotool key "$1"
    wait_for "$2" "$before"
}
# A frame has seen what the mouse did: nothing is ever undone here.
frame() { say ctrl+shift+z 'nothing to redo' && say ctrl+shift+z 'nothing to redo'; }
# Prints where a widget lies: the console knows.
corners() {
    local before
    before=$(count "^place $1 ")
    for ((i = 0; i < 600; ++i)); do
        echo "places $1" >&4
        sleep 0.1
        [[ $(count "^place $1 ") -le $before ]] || break
    done
    grep "^place $1 " "$work/said" | tail -n 1 | cut -d ' ' -f 3-
}
point() { xdotool mousemove --window "$window" "$1" "$2" && frame; }
press() {
    xdotool mousedown 1
    frame
    xdotool mouseup 1
    frame
}
click() {
    local left top right bottom
    read -r left top right bottom < <(corners "$1")
    point $(((left + right) / 2)) $(((top + bottom) / 2))
    press
}
# picture NAME: of the window, when nothing is told any more.
picture() {
    local begin=$SECONDS
    frame
    sleep $((3 + 5 * (SECONDS - begin)))
    say shift+F12 'stored darkroom-window-'
    oiiotool "$work/$(grep -o 'darkroom-window-.*' "$work/said" | tail -n 1)" --compression jpeg:85 -o "$out/viewer_$1.jpg"
}
# In parts of the window's width and height.
part() { echo $((${size%x*} * $1 / 100)) $((${size#*x} * $2 / 100)); }

# Whatever is told at the start is gone after two seconds.
"$darkroom" play "$scenes/dungeon.scene.toml" --size "$size" --fps 1 --frames 4 --window-screenshot "$out/viewer_play.jpg" >/dev/null

start edit "$scenes/showcase.scene.toml" --size "$size" --time 2.5
say p 'P pause: on'
click stack/bloom
point $(part 50 40)
picture edit
click stack/add
# Each effect's picture is made when it is seen.
sleep 20
picture add
xdotool key Escape
click tab/Scopes
click view/false_colors
point $(part 50 40)
picture scopes
click view/false_colors
click view/compare
point $(part 40 40)
picture compare
click view/compare
click tab/Images
click image/normals/0
point $(part 50 40)
picture images
click tab/Pixel
point $(part 50 25)
press
picture pixel
leave
