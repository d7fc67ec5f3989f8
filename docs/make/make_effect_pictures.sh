#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes docs/pictures/effects/: every effect off and on, for docs/effects.md: docs/make/make_effect_pictures.sh [DARKROOM
# [EFFECT ...]]. Without names all are made.
# docs/pictures/ssao_truth.jpg is of rays that a test traces: DARKROOM_PICTURES=docs/pictures
# build/bin/darkroom_tests --gtest_filter=SoakGpuSsaoTruth.Strip
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
darkroom=${1:-./darkroom}
names=" ${*:2} "
out=docs/pictures/effects
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

is_wanted() { [[ $names == "  " || $names == *" $1 "* ]]; }
# picture SCENE FILE FLAGS
picture() { "$darkroom" render "scenes/$1.scene.toml" --size 320x180 --msaa "${samples:-4}" "${@:3}" -o "$out/$2" >/dev/null; }

# pair NAME SCENE OFF-FLAGS -- ON-FLAGS: by flags of the flat table.
pair() {
    local name=$1 scene=$2 off=() on=()
    is_wanted "$name" || return 0
    shift 2
    while [[ $1 != -- ]]; do off+=("$1") && shift; done
    shift
    on=("$@")
    picture "$scene" "${name}_off.jpg" "${off[@]}"
    picture "$scene" "${name}_on.jpg" "${on[@]}"
}
# stack NAME SCENE BEFORE [BEHIND]: entries before exposure, tone mapping and encoding, or behind, against these alone.
tail_of_stack='[[stack]]
effect = "exposure"
[[stack]]
effect = "tonemap"
[[stack]]
effect = "encode"'
stack() {
    is_wanted "$1" || return 0
    printf '%s\n' "$tail_of_stack" >"$work/off.toml"
    printf '%s\n' "$3" "$tail_of_stack" "${4:-}" >"$work/on.toml"
    for state in off on; do picture "$2" "${1}_$state.jpg" --look "$work/$state.toml"; done
}

pair ssao dungeon --exposure 6 --ssao-enabled off --volumetric-enabled off -- --exposure 6 --ssao-radius 1.5 --volumetric-enabled off
pair volumetric dungeon --volumetric-enabled off -- --volumetric-density 30
pair fog courtyard --fog-enabled off -- --fog-density 0.05
pair bloom forge --bloom-enabled off -- --bloom-intensity 0.12
pair auto_exposure dungeon --exposure 1 --auto-exposure-enabled off -- --exposure 1 --auto-exposure-enabled on
pair exposure courtyard --exposure 0.4 -- --exposure 1.2
pair tonemap showcase --tonemap-curve linear -- --tonemap-curve aces_narkowicz
saturated=(--tonemap-curve linear --color-grade-saturation 2.5)
pair gamut_compression showcase "${saturated[@]}" -- "${saturated[@]}" --gamut-compression-enabled on
pair vignette showcase --vignette-enabled off -- --vignette-intensity 0.7
pair radial_blur forge --radial-blur 0 -- --radial-blur 0.8
pair chromatic_aberration forge --chromatic-aberration 0 -- --chromatic-aberration 3
pair film_grain street -- --film-grain-amount 0.06 --film-grain-size 6
pair lens_flare street --bloom-enabled off -- --bloom-enabled off --lens-flare-intensity 0.15
pair halation street --bloom-enabled off -- --bloom-enabled off --halation-intensity 0.6
pair anamorphic_streaks street --bloom-enabled off -- --bloom-enabled off --anamorphic-streaks-intensity 1.0
pair lens_dirt street --bloom-enabled off -- --bloom-enabled off --lens-dirt-intensity 6.0
pair dither dungeon --dither-enabled off -- --dither-intensity 0.05
stack god_rays dungeon '[[stack]]
effect = "god_rays"
follows_light = false
position = [0.47, 0.5]
threshold = 0.05
radius = 0.4
intensity = 8.0'
stack color_grade showcase '[[stack]]
effect = "color_grade"
temperature = 12000.0
shadows = [0.7, 0.9, 1.3]
highlights = [1.2, 1.05, 0.8]
contrast = 1.25
curve_red = [[-6.0, -6.5], [0.0, 0.2], [4.0, 4.0]]
vibrance = 0.4'
stack hsv_adjust showcase '' '[[stack]]
effect = "hsv_adjust"
hue = 110.0
saturation = 1.3'
stack posterize showcase '' '[[stack]]
effect = "posterize"
levels = 5'
samples=1 stack fxaa courtyard '' '[[stack]]
effect = "fxaa"'
samples=1 stack smaa courtyard '' '[[stack]]
effect = "smaa"'
is_wanted upscale && for state in off on; do
    [[ $state == on ]] && enlarge='[[stack]]
effect = "upscale"
[[stack]]
effect = "sharpen"' || enlarge=
    printf '%s\n' "$tail_of_stack" "$enlarge" >"$work/$state.toml"
    picture showcase "upscale_$state.jpg" --look "$work/$state.toml" --render-scale 0.5
done
stack sharpen showcase '' '[[stack]]
effect = "sharpen"
stops = 0.0'
stack lens_distortion courtyard '' '[[stack]]
effect = "lens_distortion"
lens_distortion = 0.5
dispersion = 0.05'
stack perturb courtyard '' '[[stack]]
effect = "perturb"
strength = [5.0, 5.0, 3.0, 2.0]'
stack high_pass showcase '[[stack]]
effect = "high_pass"
threshold = 0.8'
stack gaussian_blur showcase '[[stack]]
effect = "gaussian_blur"
radius = 6'
stack blend showcase '[[stack]]
effect = "gaussian_blur"
radius = 10
output = "soft"
[[stack]]
effect = "blend"
input = "scene"
second = "soft"
mode = "screen"
amount = 0.6'
stack negative showcase '[[stack]]
effect = "negative"'
stack grayscale showcase '[[stack]]
effect = "grayscale"'
stack box_blur showcase '[[stack]]
effect = "box_blur"
radius = 6'
stack kawase_blur showcase '[[stack]]
effect = "kawase_blur"'
stack classic_bloom forge '[[stack]]
effect = "classic_bloom"'
stack arena_bloom forge '[[stack]]
effect = "arena_bloom"'
stack arena_grade showcase '[[stack]]
effect = "arena_grade"
preset = "sepia"
[[stack]]
effect = "exposure"
exposure = 0.5'
# A table of what another look does to colours.
printf '%s\n' '[[stack]]' 'effect = "color_grade"' 'temperature = 4500' 'saturation = 0.4' 'contrast = 1.4' "$tail_of_stack" >"$work/film.toml"
is_wanted lut && "$darkroom" lut export "$work/film.toml" -o "$work/film.cube" >/dev/null
pair lut showcase --bloom-enabled off -- --bloom-enabled off --lut "$work/film.cube" --lut-space scene_linear --lut-result display --tonemap-enabled off
# trail NAME SCENE FPS ENTRY: the eighth frame, with those before it.
trail() {
    is_wanted "$1" || return 0
    local frame=$work/frame.%04d.jpg
    printf '%s\n' "$tail_of_stack" >"$work/off.toml"
    printf '%s\n' "$4" "$tail_of_stack" >"$work/on.toml"
    for state in off on; do
        "$darkroom" render "scenes/$2.scene.toml" --size 320x180 --msaa 4 --distance 6 --fps "$3" --frames 8-8 --look "$work/$state.toml" -o "$frame" >/dev/null
        mv "$work/frame.0008.jpg" "$out/${1}_$state.jpg"
    done
}
trail frame_blend showcase 60 '[[stack]]
effect = "frame_blend"'
trail recursive_blend showcase 60 '[[stack]]
effect = "recursive_blend"
weight = 0.9'
is_wanted taa && for state in off on; do
    [[ $state == on ]] && gather='[[stack]]
effect = "taa"' || gather=
    printf '%s\n' "$gather" "$tail_of_stack" >"$work/$state.toml"
    samples=1 picture courtyard taa.%04d.jpg --fps 60 --frames 16-16 --look "$work/$state.toml"
    mv "$out/taa.0016.jpg" "$out/taa_$state.jpg"
done
stack depth_of_field street '[[stack]]
effect = "depth_of_field"
focus_distance = 4.0
f_stop = 1.0
sensor_height = 700.0
max_radius = 3.0'
trail motion_blur showcase 12 '[[stack]]
effect = "motion_blur"
shutter_angle = 360.0
max_radius = 3.0'
ui=(--ui hud/visor.svg --game health=82 --game ammunition=24 --game reserve=120 --game heading=40 --game weapon=RIFLE)
pair ui_warp showcase "${ui[@]}" -- "${ui[@]}" --ui-warp-strength -0.5
pair ui_chroma showcase "${ui[@]}" -- "${ui[@]}" --ui-chroma-strength 0.01
pair ui_echo showcase "${ui[@]}" -- "${ui[@]}" --ui-echo-strength 0.6 --ui-echo-size 1.08
pair ui_composite showcase -- "${ui[@]}"
pair contrast_gamma showcase "${ui[@]}" -- "${ui[@]}" --contrast-gamma-contrast 1.4 --contrast-gamma-gamma 0.9
