#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: FLIP of two pictures in 8 bits is a fraction of what it is of the same pictures as floats.
# Versions: PyPI flip-evaluator 1.7, numpy 2.4.6
# Behaviour: evaluate() takes arrays of uint8 without a word, and as the numbers that they hold: all above code 0 is white.
#   Scaling to 0..1 is the caller's business, and a threshold that was set for floats passes nearly everything.
# Seen: floats 0.300, the same pictures as uint8 0.012; code 1 against code 255 is 0
# Date: 2026-11-28
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check flip-evaluator==1.7 numpy==2.4.6 || exit 77
venv/bin/python - <<'END'
import sys
from importlib.metadata import version

import flip_evaluator
import numpy as np

reference = np.random.default_rng(1).random((32, 32, 3), dtype=np.float32)
test = np.clip(reference + np.float32(0.1), 0, 1)
as_bytes = [np.round(picture * 255).astype(np.uint8) for picture in (reference, test)]

floats = flip_evaluator.evaluate(reference, test, "LDR")[1]
scaled = flip_evaluator.evaluate(*[picture / np.float32(255) for picture in as_bytes], "LDR")[1]
codes = flip_evaluator.evaluate(*as_bytes, "LDR")[1]
ends = flip_evaluator.evaluate(*[np.full((32, 32, 3), code, np.uint8) for code in (1, 255)], "LDR")[1]
print(f"flip-evaluator {version('flip-evaluator')}, mean of LDR")
print(f"seen: floats {floats:.3f}, bytes divided by 255 {scaled:.3f}, bytes as they are {codes:.3f}, 1 against 255 {ends:.3f}")
sys.exit(not (abs(floats - 0.300) < 0.002 and abs(scaled - 0.300) < 0.002 and abs(codes - 0.012) < 0.002 and ends == 0))
END
