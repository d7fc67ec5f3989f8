#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# rust_crates.sh TREE BINDINGS LIBRARY: the crates darkroom-sys and darkroom compile without a warning, are packed as they
# would be published, their page's example compiles, and a host in Rust (examples/ash.rs) makes the picture that the page
# says, in silence of the validation layer. 77: ash, or a cargo of 1.77 and newer, is not here; nothing is fetched from the
# net.
set -euo pipefail
tree=$1 bindings=$2 library=$3
version=$(cargo --version 2>/dev/null | cut -d' ' -f2) || true
printf '1.77\n%s\n' "${version:-0}" | sort -VC || { echo "left out: cargo ${version:-none} is here, 1.77 is needed" && exit 77; }
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
if cargo package --help | grep -q -e '--workspace'; then
    quietly cargo package --workspace
    (cd "$work/target/package" && sha256sum -- *.crate)
fi

mkdir -p "$work/host/src"
cp "$tree/examples/ash.rs" "$work/host/src/main.rs"
cat >"$work/host/Cargo.toml" <<'END'
[package]
name = "host"
version = "0.1.0"
edition = "2021"
[dependencies]
ash = { version = "0.38", default-features = false, features = ["loaded"] }
darkroom = { path = "../rust/darkroom" }
[workspace]
END
cd "$work/host"
cargo fetch >"$work/log" 2>&1 || { echo "left out: ash 0.38 is not in cargo's folder (cargo fetch)" && exit 77; }
quietly cargo build
"$work/target/debug/host" >"$work/out"
diff <(printf '%s\n' '170 170 170' '223 223 223' '250 250 250') "$work/out" ||
    { echo "the host (>) makes another picture" && exit 1; }
