#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes docs/pictures/effects/: every effect off and on, for docs/effects.md: docs/make_effect_pictures.sh [DARKROOM].
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
darkroom=${1:-./darkroom}
out=docs/pictures/effects
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# pair NAME SCENE OFF-FLAGS -- ON-FLAGS: by flags of the flat table.
pair() {
    local name=$1 scene=scenes/$2.scene.toml off=() on=()
    shift 2
    while [[ $1 != -- ]]; do off+=("$1") && shift; done
    shift
    on=("$@")
    "$darkroom" render "$scene" --size 320x180 --msaa 4 "${off[@]}" -o "$out/${name}_off.jpg" >/dev/null
    "$darkroom" render "$scene" --size 320x180 --msaa 4 "${on[@]}" -o "$out/${name}_on.jpg" >/dev/null
}
# stack NAME SCENE TOML: an entry before exposure, tone mapping and encoding, against these alone.
tail_of_stack='[[stack]]
effect = "exposure"
[[stack]]
effect = "tonemap"
[[stack]]
effect = "encode"'
stack() {
    local name=$1 scene=scenes/$2.scene.toml
    printf '%s\n' "$tail_of_stack" >"$work/off.toml"
    printf '%s\n%s\n' "$3" "$tail_of_stack" >"$work/on.toml"
    for state in off on; do
        "$darkroom" render "$scene" --size 320x180 --msaa 4 --look "$work/$state.toml" -o "$out/${name}_$state.jpg" >/dev/null
    done
}

pair ssao courtyard --ssao-enabled off --volumetric-enabled off --fog-enabled off -- --ssao-radius 1 --ssao-intensity 2 --volumetric-enabled off --fog-enabled off
pair volumetric dungeon --volumetric-enabled off -- --volumetric-density 30
pair fog courtyard --fog-enabled off -- --fog-density 0.05
pair bloom forge --bloom-enabled off -- --bloom-intensity 0.12
pair exposure courtyard --exposure 0.4 -- --exposure 1.2
pair tonemap showcase --tonemap-curve linear -- --tonemap-curve aces_narkowicz
pair vignette showcase --vignette-enabled off -- --vignette-intensity 0.7
pair radial_blur forge --radial-blur 0 -- --radial-blur 0.8
pair chromatic_aberration forge --chromatic-aberration 0 -- --chromatic-aberration 3
pair dither dungeon --dither-enabled off -- --dither-intensity 0.05
stack god_rays showcase '[[stack]]
effect = "god_rays"
follows_light = false
position = [0.497, 0.235]
intensity = 1.5'
stack high_pass showcase '[[stack]]
effect = "high_pass"
threshold = 0.8'
stack gaussian_blur showcase '[[stack]]
effect = "gaussian_blur"
radius = 6'
stack negative showcase '[[stack]]
effect = "negative"'
stack grayscale showcase '[[stack]]
effect = "grayscale"'
