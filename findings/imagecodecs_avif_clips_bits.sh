#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: imagecodecs makes AVIF of 10 bits white where 16-bit codes are above 1023.
# Versions: PyPI imagecodecs 2026.3.6, numpy 2.4.6
# Behaviour: avif_encode() wants to be told 10 or 12 bits for 16-bit arrays, and cuts off at the greatest code instead of
#   scaling or refusing. Shift the codes by hand: codes >> 6 for 10 bits.
# Seen: 100, 1000, 5000, 65535 are 100, 1000, 1023, 1023 with 10 bits and 100, 1000, 4095, 4095 with 12
# Date: 2026-11-29
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check imagecodecs==2026.3.6 numpy==2.4.6 || exit 77
venv/bin/python -W ignore - <<'END'
import sys

import imagecodecs
import numpy as np

codes = np.repeat(np.uint16([100, 1000, 5000, 65535]), 48).reshape(4, 16, 3)
seen = [imagecodecs.avif_decode(imagecodecs.avif_encode(codes, bitspersample=bits))[:, 0, 0].tolist() for bits in (10, 12)]
print(f"imagecodecs {imagecodecs.__version__}")
print("seen:", *seen)
sys.exit(seen != [[100, 1000, 1023, 1023], [100, 1000, 4095, 4095]])
END
