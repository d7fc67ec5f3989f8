# SPDX-License-Identifier: MIT
"""A movie through ffmpeg: frames that a program makes, developed with histories and encoded. movie.py [OUT.mp4]"""

import shutil
import subprocess
import sys

import numpy

import darkroom

if not shutil.which("ffmpeg"):
    sys.exit("skipped: ffmpeg is not here")
out = sys.argv[1] if len(sys.argv) > 1 else "movie.mp4"
width, height, fps = 160, 96, 24


def frames(count):
    """A lamp that swings over a grey wall."""
    y, x = numpy.mgrid[0:height, 0:width].astype(numpy.float32)
    for number in range(count):
        at = width / 2 + width / 3 * numpy.sin(number / fps * 3)
        lamp = numpy.exp(-((x - at) ** 2 + (y - height / 3) ** 2) / 60)
        yield (0.05 + 6 * lamp[..., None] * [1.0, 0.7, 0.3]).astype(numpy.float32)


stack = darkroom.Stack().recursive_blend(weight=0.8).bloom(intensity=0.2).tonemap(curve="agx").dither()
ffmpeg = subprocess.Popen(
    ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}",
     "-r", str(fps), "-i", "-", "-pix_fmt", "yuv420p", out],
    stdin=subprocess.PIPE,
)  # fmt: skip
count = 0
for picture in stack.sequence(frames(24), fps=fps):
    ffmpeg.stdin.write(picture)
    count += 1
ffmpeg.stdin.close()
if ffmpeg.wait() != 0:
    sys.exit(f"{out}: ffmpeg failed")
print(f"{out}: {count} frames")
