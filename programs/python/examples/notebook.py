# SPDX-License-Identifier: MIT
# %% [markdown]
# # Tone curves
# How much of the display each curve gives to light of so many stops around a bright surface.

# %%
import sys

import numpy

import darkroom

try:
    import matplotlib
except ImportError:
    sys.exit("skipped: matplotlib is not here")
matplotlib.use("Agg")
from matplotlib import pyplot

# %% A ramp of light: one row, from 8 stops below 1.0 to 8 above.
stops = numpy.linspace(-8, 8, 257, dtype=numpy.float32)
ramp = numpy.repeat(2.0 ** stops[None, :, None], 3, axis=2).astype(numpy.float32)

# %% Every curve, as code values.
row = next(row for row in darkroom.info("tonemap")["parameters"] if row["name"] == "curve")
figure, axes = pyplot.subplots(figsize=(7, 4))
for curve in row["choices"]:
    codes = darkroom.Stack().tonemap(curve=curve).develop(ramp, output="encoded")
    axes.plot(stops, codes[0, :, 1], label=curve)
    assert (numpy.diff(codes[0, :, 1]) >= -1e-3).all(), curve

# %%
axes.set(xlabel="stops", ylabel="code value", title="tonemap")
axes.legend(fontsize=7)
figure.savefig("curves.png", dpi=80)
print(f"curves.png: {', '.join(row['choices'])}")
