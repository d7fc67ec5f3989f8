# SPDX-License-Identifier: MIT
"""What the tests of renderers' frames share: DARKROOM's run, an effect that shows layers, and what was expected."""
import os
import shutil
import subprocess
import sys


def need(package, environment):
    """Starts the script anew by the Python that the environment names where this one lacks the package; else skips."""
    try:
        return __import__(package)
    except ImportError:
        wanted = shutil.which(os.environ.get(environment, ""))
        if wanted and f"{environment}_TRIED" not in os.environ:
            os.environ[f"{environment}_TRIED"] = "1"
            os.execv(wanted, [wanted, "-B", *sys.argv])
        print(f"skipped: no {package} here; {environment} names a Python that has it")
        sys.exit(77)


def fail(why):
    print(why)
    sys.exit(1)


def darkroom(*arguments):
    done = subprocess.run([sys.argv[2], *map(str, arguments)], capture_output=True, text=True)
    if done.returncode:
        fail(f"darkroom {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout + done.stderr


def expect(what, found, right, most):
    if max(abs(a - b) for a, b in zip(found, right)) > most:
        fail(f"{what} is {list(found)}, {list(right)} is right")


def write_effect(folder, has_motion):
    """show.glsl: what a frame's layers are, as colours."""
    motion = "return vec4(load(frame_velocity, pixel.texel).xy, 0.0, 1.0);" if has_motion else "return vec4(0.0);"
    (folder / "show.glsl").write_text(f"""// SPDX-License-Identifier: MIT
// @effect show: Shows a frame's layers as colours.
// @accepts scene_linear
// @needs depth
// @needs normals
// {"@needs velocity" if has_motion else ""}
// @param choice what = normals | place | motion: What is shown.

#include "shared/camera.glsl"

vec4 show(vec4 color, Pixel pixel, Show parameters) {{
    float planar = load(frame_depth, pixel.texel).r;
    if (parameters.what == Show_what_normals) return vec4(load(frame_normals, pixel.texel).xyz, 1.0);
    if (parameters.what == Show_what_place) return vec4(world_position(pixel.uv, planar), 1.0);
    {motion}
}}
""")


def show(frame, camera, what):
    """The effect's picture, beside it, of a frame that nothing is left out of."""
    folder = frame.parent
    (folder / "show.toml").write_text(f'format = 1\n[[stack]]\neffect = "show.glsl"\nwhat = "{what}"\n')
    told = darkroom("develop", frame, "--camera", folder / camera, "--look", folder / "show.toml", "--bits", "float", "-q",
                    "-o", folder / "shown.exr")
    if told:
        fail(told)
    return str(folder / "shown.exr")
