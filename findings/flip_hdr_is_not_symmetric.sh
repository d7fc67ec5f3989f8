#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: HDR-FLIP of A against B is another number than of B against A, while LDR-FLIP is the same both ways.
# Versions: PyPI flip-evaluator 1.7, numpy 2.4.6
# Behaviour: the exposures that HDR-FLIP looks at are chosen by the reference alone, the first of the two arguments. Who
#   swaps reference and test, or compares numbers of two tools with another order, gets others.
# Seen: LDR 0.3001 both ways; HDR 0.2377 and 0.2363
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

a = np.random.default_rng(1).random((32, 32, 3), dtype=np.float32)
b = np.clip(a + np.float32(0.1), 0, 1)


def both_ways(first, second, kind):
    return flip_evaluator.evaluate(first, second, kind)[1], flip_evaluator.evaluate(second, first, kind)[1]


screen = both_ways(a, b, "LDR")
light = both_ways(a * 4, b * 4, "HDR")
print(f"flip-evaluator {version('flip-evaluator')}, means, reference first")
print("seen: LDR %.4f and %.4f, HDR %.4f and %.4f" % (screen + light))
sys.exit(not (screen[0] == screen[1] and 0.0005 < abs(light[0] - light[1]) < 0.01))
END
