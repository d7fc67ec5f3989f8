#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# cgo.sh TREE LIBRARY LINKED: a host in Go (examples/cgo.go), with Go's checks of pointers at their strictest, makes the
# picture of a host in C (LINKED). 77: Go of 1.21 and newer, which has runtime.Pinner, is not here.
set -euo pipefail
tree=$1 library=$2 linked=$3
version=$(go env GOVERSION 2>/dev/null) || true
printf '1.21\n%s\n' "${version#go}" | sort -VC || { echo "left out: Go ${version:-none} is here, 1.21 is needed" && exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export GOFLAGS=-mod=mod GOTOOLCHAIN=local GOEXPERIMENT=cgocheck2 CGO_CFLAGS="-O1 -I$tree/include"
export CGO_LDFLAGS="-L${library%/*} -Wl,-rpath,${library%/*}"
unformatted=$(gofmt -l "$tree/examples/cgo.go")
[[ -z $unformatted ]] || { echo "gofmt would change $unformatted" && exit 1; }
go build -o "$work/cgo" "$tree/examples/cgo.go"
"$work/cgo" "$work/cgo.ppm"
"$linked" "$work/linked.ppm"
cmp "$work/linked.ppm" "$work/cgo.ppm"
