#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What: two exposures that are dynamic are one: the second picture is made with the first one's value.
# Versions: PyPI opencolorio 2.6.0
# Behaviour: a configuration keeps processors and finds them again by what they do, where a dynamic value does not count. So
#   the processor of a second ExposureContrastTransform is the first one's, value and all (the flag
#   PROCESSOR_CACHE_SHARE_DYN_PROPERTIES, on by default). Two viewers that share a configuration move each other's slider.
# Seen: 0.18 by exposures 0 and 1 is 0.18 twice; 0.18 and 0.36 with PROCESSOR_CACHE_OFF
# Date: 2026-11-28
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check opencolorio==2.6.0 || exit 77
venv/bin/python - <<'END'
import sys

import PyOpenColorIO as ocio


def exposure(stops):
    transform = ocio.ExposureContrastTransform()
    transform.makeExposureDynamic()
    transform.setExposure(stops)
    return transform


def two_viewers(flags):
    config = ocio.Config.CreateRaw()
    if flags is not None:
        config.setProcessorCacheFlags(flags)
    first, second = [config.getProcessor(exposure(stops)) for stops in (0, 1)]
    return [round(viewer.getDefaultCPUProcessor().applyRGB([0.18] * 3)[0], 4) for viewer in (first, second)]


by_default = two_viewers(None)
apart = two_viewers(ocio.PROCESSOR_CACHE_OFF)
print(f"OpenColorIO {ocio.__version__}, 0.18 by exposures 0 and 1")
print(f"seen: {by_default} by default, {apart} without the cache")
sys.exit(not (by_default == [0.18, 0.18] and apart == [0.18, 0.36]))
END
