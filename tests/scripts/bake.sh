#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# bake.sh TREE DARKROOM HOST HOST_WITHOUT LIBRARY: kernels that `darkroom bake` wrote give the same bits as the compiler's,
# in a host that is linked without it (tests/baked), whatever is switched; and what is without it is as small as promised.
set -euo pipefail
tree=$1 darkroom=$2 host=$3 host_without=$4 library=$5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
    printf 'bake: %s\n' "$*"
    exit 1
}
# at_most WHAT BYTES LIMIT
at_most() {
    printf '%s: %d bytes, at most %d\n' "$1" "$2" "$3"
    (($2 <= $3)) || fail "$1 is too large"
}
# The images of tests/baked/baked_host.cpp.
images=(--color-format R16G16B16A16_SFLOAT:storage --depth-format R32_SFLOAT:storage --planar-depth --plain-velocity
    --target-format R8G8B8A8_UNORM:storage)

compiler='shaderc_|glslang::|spvtools::'
[[ $(nm -C "$host_without" | grep -cE "$compiler") == 0 ]] || fail "the host without the compiler has it"
[[ $(nm -C "$host" | grep -cE "$compiler") != 0 ]] || fail "the host with the compiler has none"
profile=$("$host" profile)
mkdir "$work/here" "$work/elsewhere"
cp "$tree/examples/histogram.glsl" "$work/here"
cp "$tree"/looks/{documented,default}.toml "$work/here"
printf '[[stack]]\neffect = "%s"\n' bloom tonemap encode histogram.glsl >"$work/here/of_a_user.toml"
sed -i '1i format = 1' "$work/here/of_a_user.toml"
for look in documented default of_a_user; do
    "$darkroom" bake "$work/here/$look.toml" -o "$work/$look.dkb" --profile "$profile" --size 256x144 "${images[@]}"
    "$host" "$work/here/$look.toml" "$work/$look.compiled"
done
mv "$work/here"/* "$work/elsewhere" # an effect of a user's is the same wherever it lies
for look in documented default of_a_user; do
    "$host_without" "$work/elsewhere/$look.toml" "$work/$look.baked" "$work/$look.dkb"
    cmp "$work/$look.compiled" "$work/$look.baked" || fail "$look: the pictures differ"
done
told=$("$host_without" "$tree/looks/documented.toml" "$work/none" 2>&1) && fail "there are kernels of nowhere"
[[ $told == *"no compiler of GLSL"* ]] || fail "without kernels it says: $told"
told=$("$host_without" "$tree/looks/visor.toml" "$work/none" "$work/default.dkb" 2>&1) && fail "another look is served"
[[ $told == *"not among the"* ]] || fail "of another look it says: $told"

for profile in gpu software; do
    "$darkroom" bake "$tree/looks/documented.toml" -o "$work/$profile.dkb" --profile $profile --depth-format D32_SFLOAT
    at_most "kernels of the documented look ($profile)" "$(stat -c %s "$work/$profile.dkb")" 300000
done
strip -o "$work/library" "$library"
at_most "the library without the compiler" "$(stat -c %s "$work/library")" 3000000
