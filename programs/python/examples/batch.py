# SPDX-License-Identifier: MIT
"""A folder of frames, in threads: one reads while another develops. batch.py [FRAME.exr ...]"""

import concurrent.futures
import pathlib
import sys
import tempfile

import darkroom

tree = pathlib.Path(__file__).resolve().parents[3]
names = [pathlib.Path(name) for name in sys.argv[1:]]
if not names:
    # Four frames of a size each, from the sample.
    folder = pathlib.Path(tempfile.mkdtemp(prefix="frames-"))
    frame = darkroom.files.read_frame(tree / "samples" / "window.exr")
    for step in (3, 4, 5, 6):
        names.append(folder / f"every_{step}.exr")
        darkroom.files.write_frame(names[-1], {"color": frame["color"][::step, ::step], "depth": frame["depth"][::step, ::step]})

look = darkroom.Stack(tree / "looks" / "film.toml")


def develop(name):
    picture = look.develop(darkroom.files.read_frame(name))
    out = pathlib.Path(name).with_suffix(".png").name
    darkroom.files.write(out, picture)
    return f"{out}: {picture.shape[1]}x{picture.shape[0]}"


with concurrent.futures.ThreadPoolExecutor(2) as threads:
    for line in threads.map(develop, names):
        print(line)
