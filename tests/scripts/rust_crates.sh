#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# rust_crates.sh BINDINGS LIBRARY: the crates darkroom-sys and darkroom compile without a warning, the example of their page
# compiles, and they are packed as they would be published. 77: a cargo of 1.82 and newer is not here.
set -euo pipefail
bindings=$1 library=$2
version=$(cargo --version 2>/dev/null | cut -d' ' -f2) || true
printf '1.82\n%s\n' "${version:-0}" | sort -VC || { echo "left out: cargo ${version:-none} is here, 1.82 is needed" && exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export CARGO_NET_OFFLINE=true RUSTFLAGS='-D warnings' RUSTDOCFLAGS='-D warnings' CARGO_TARGET_DIR=$work/target
export DARKROOM_LIB_DIR=${library%/*} LD_LIBRARY_PATH=${library%/*}${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log" && exit 1; }; }
cp -r "$bindings/rust" "$work/rust"
cd "$work/rust"
quietly cargo test
quietly cargo doc --no-deps
# With the form of 1.90 that knows the two of one another.
if cargo package --help | grep -q -e "--workspace"; then
    quietly cargo package --workspace
fi
