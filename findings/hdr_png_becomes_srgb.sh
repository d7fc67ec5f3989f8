#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: a PNG whose cICP says PQ becomes an AVIF, and a JPEG XL, that say sRGB, with PQ's codes in them.
# Versions: Debian 12, libavif-bin 0.11.1, libjxl-tools 0.7.0
# Behaviour: both programs are older than the chunk and pass it over. Without a profile they say sRGB for certain, so all that
#   follow show the picture grey and dull; djxl writes a cICP of its own into the PNG that comes back, which says sRGB, too.
# Seen: primaries 1 and transfer 13 in AVIF, "sRGB transfer function" in JPEG XL, cICP 1 13 0 1 in the PNG of it
# Date: 2026-11-28
set -euo pipefail
for package in libavif-bin=0.11.1 libjxl-tools=0.7.0; do
    dpkg-query -W -f '${Package}=${Version}\n' "${package%=*}" | grep -F "$package" || { echo "needs $package"; exit 77; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 - <<'END'
import struct
import zlib


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


# Code 38055 of 65535 is 203 cd/m2 by PQ.
rows = (b"\0" + struct.pack(">H", 38055) * 3 * 16) * 16
with open("pq.png", "wb") as file:
    file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 16, 16, 16, 2, 0, 0, 0)))
    file.write(chunk(b"cICP", bytes((9, 16, 0, 1))) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
END
avifenc -l pq.png pq.avif > /dev/null
avifdec --info pq.avif | grep -E 'Color Primaries|Transfer Char' > avif.txt
cjxl -d 0 pq.png pq.jxl 2> /dev/null
jxlinfo pq.jxl | grep 'Color space' > jxl.txt
djxl pq.jxl back.png 2> /dev/null
python3 - <<'END'
import sys

avif, jxl, png = open("avif.txt").read(), open("jxl.txt").read(), open("back.png", "rb").read()
at = png.find(b"cICP")
back = list(png[at + 4 : at + 8]) if at >= 0 else None
print(f"seen: {' '.join(avif.split())}; {jxl.strip()}; cICP {back} in the PNG of it")
sys.exit(not (": 1\n" in avif and ": 13\n" in avif and "sRGB transfer function" in jxl and back == [1, 13, 0, 1]))
END
