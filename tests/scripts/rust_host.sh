#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# rust_host.sh TREE BINDINGS LIBRARY FOLDER HOST DEPENDENCY...: a host in Rust (examples/HOST.rs), compiled in FOLDER with
# the crate `darkroom` and lines of Cargo.toml, makes the picture that the other hosts of docs/hosts.md make, in silence of the
# validation layer. 77: a dependency, or a cargo of 1.82 and newer, is not here; nothing is fetched from the net.
set -euo pipefail
tree=$1 bindings=$2 library=$3 folder=$4 host=$5
shift 5
version=$(cargo --version 2>/dev/null | cut -d' ' -f2) || true
printf '1.82\n%s\n' "${version:-0}" | sort -VC || { echo "left out: cargo ${version:-none} is here, 1.82 is needed" && exit 77; }
export CARGO_NET_OFFLINE=true DARKROOM_LIB_DIR=${library%/*}
export LD_LIBRARY_PATH=${library%/*}${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
mkdir -p "$folder/src"
cp "$tree/examples/$host.rs" "$folder/src/main.rs"
{
    printf '[package]\nname = "%s_host"\nversion = "0.1.0"\nedition = "2021"\n[dependencies]\n' "$host"
    printf '%s\n' "$@" "darkroom = { path = \"$bindings/rust/darkroom\" }"
    printf '[workspace]\n[profile.dev]\ndebug = 0\n[lints.rust]\nwarnings = "deny"\n'
} >"$folder/Cargo.toml"
cd "$folder"
cargo fetch >log 2>&1 || { echo "left out: not all is in cargo's folder (cargo fetch) of: $*" && exit 77; }
cargo build >log 2>&1 || { cat log && exit 1; }
"target/debug/${host}_host" >out
diff <(printf '%s\n' '170 170 170' '223 223 223' '250 250 250') out || { echo "the host (>) makes another picture" && exit 1; }
