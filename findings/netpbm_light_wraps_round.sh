#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: light above 1 of a PFM wraps round in Netpbm instead of ending at white.
# Versions: Debian 12, netpbm 2:11.01.00
# Behaviour: pfmtopam multiplies by the largest code and keeps the lower bits of what does not fit: 4 times 255 is 1020, which
#   is 252 in a byte. Light of 1.01 is nearly black. Nothing warns.
# Seen: 0.18, 1, 1.01, 4 are 46, 255, 2, 252
# Date: 2026-11-28
set -euo pipefail
dpkg-query -W -f '${Package} ${Version}\n' netpbm | grep '11\.01' || { echo "needs netpbm 11.01 of Debian 12"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 - <<'END'
import struct

with open("light.pfm", "wb") as file:
    file.write(b"PF\n4 1\n-1.0\n" + b"".join(struct.pack("<3f", light, light, light) for light in (0.18, 1, 1.01, 4)))
END
pfmtopam -maxval 255 light.pfm | pamtopnm > light.ppm
python3 - <<'END'
import sys

codes = list(open("light.ppm", "rb").read()[-12::3])
print(f"seen: codes {codes} of light 0.18, 1, 1.01, 4")
sys.exit(codes != [46, 255, 2, 252])
END
