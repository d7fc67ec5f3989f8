#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes docs/pictures/interface_*.jpg, the visor's states, for docs/interface.md: docs/make/make_interface_pictures.sh [DARKROOM].
# What happens to it is said by events, and done by the controller that ships.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
darkroom=${1:-./darkroom}
work=$(mktemp -d looks/visor.XXXX)
trap 'rm -rf "$work"' EXIT

sed 's|"../hud|"../../hud|; s|^game = .*|&\ncontrollers = ["../../controllers/combat.lua"]|' looks/visor.toml >"$work/visor.toml"
# picture STATE GAME FLAGS: what the game says at the time of the frame.
picture() {
    printf '[[event]]\ntime = 1.0\ngame = { %s }\n' "$2" >"$work/events.toml"
    "$darkroom" render scenes/showcase.scene.toml --look "$work/visor.toml" --events "$work/events.toml" --time 1 --msaa 4 \
        --size 480x270 "${@:3}" -o "docs/pictures/interface_$1.jpg" >/dev/null
}
picture rest 'health = 82'
picture hit 'health = 61, face_pain = true'
picture echo 'health = 82' --ui-echo-strength 0.5 --ui-echo-size 1.06
picture additive 'health = 82' --ui-composite-additive 1
picture low_health 'health = 4'
