#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""mitsuba_frames.py TREE DARKROOM: frames that Mitsuba 3 itself renders (PyPI's mitsuba), beside the camera that
examples/mitsuba_camera.py writes of them. Right is the closed form: where the ray of a pixel meets a plane that is tilted
in two directions, and that plane's normal. Ends with 77 where there is no Mitsuba."""
import os
import pathlib
import subprocess
import sys
import tempfile

import rendered
from rendered import darkroom, fail

tree, sys.argv[2] = pathlib.Path(sys.argv[1]).resolve(), os.path.abspath(sys.argv[2])
mitsuba = rendered.need("mitsuba", "DARKROOM_MITSUBA_PYTHON")
np = rendered.need("numpy", "DARKROOM_MITSUBA_PYTHON")
mitsuba.set_variant("scalar_rgb")

WIDTH, HEIGHT = 96, 64
NORMAL = np.array([np.sin(0.2), np.cos(0.2) * np.cos(0.1), np.cos(0.2) * np.sin(0.1)])  # of a plane through the origin
EYE, TARGET = np.array([0.5, 2.5, 5.0]), np.array([0.2, 1.9, 0.0])
SCENE = """<scene version="3.0.0">
  <integrator type="aov"><string name="aovs" value="{aovs}"/><integrator type="path"/></integrator>
  <sensor type="{kind}">
    <transform name="to_world">
      {stretch}<lookat origin="0.5, 2.5, 5" target="0.2, 1.9, 0" up="0, 1, 0"/>
    </transform>
    {more}
    <film type="hdrfilm">
      <integer name="width" value="96"/><integer name="height" value="64"/><rfilter type="box"/>
      <string name="component_format" value="float32"/><string name="pixel_format" value="rgba"/>
    </film>
    <sampler type="stratified"><integer name="sample_count" value="1"/><boolean name="jitter" value="false"/></sampler>
  </sensor>
  <shape type="rectangle">
    <transform name="to_world">
      <scale value="60"/><lookat origin="0, 0, 0" target="{normal}" up="0, 0, 1"/>
    </transform>
  </shape>
  <emitter type="constant"/>
</scene>
"""
KINDS = {
    "perspective": '<float name="fov" value="50"/><float name="near_clip" value="1"/>',
    "thinlens": '<float name="fov" value="50"/><float name="near_clip" value="0.5"/><float name="focus_distance" '
                'value="5"/><float name="aperture_radius" value="1e-6"/>',
    "shifted": '<float name="fov" value="50"/><float name="principal_point_offset_x" value="0.1"/>'
               '<float name="principal_point_offset_y" value="-0.07"/>',
    "orthographic": '<float name="near_clip" value="0.25"/>',
}


AHEAD = (TARGET - EYE) / np.linalg.norm(TARGET - EYE)
RIGHT = np.cross(AHEAD, [0, 1, 0]) / np.linalg.norm(np.cross(AHEAD, [0, 1, 0]))
UP = np.cross(RIGHT, AHEAD)


def rays_of(kind):
    """Where the rays of pixels' middles begin, and their directions, by the numbers above alone."""
    shift = (0.1, -0.07) if kind == "shifted" else (0, 0)  # of a width, and of a height downward
    x, y = np.meshgrid((np.arange(WIDTH) + 0.5) / WIDTH + shift[0], (np.arange(HEIGHT) + 0.5) / HEIGHT + shift[1])
    across = (2 * x - 1)[..., None] * RIGHT + (1 - 2 * y)[..., None] * HEIGHT / WIDTH * UP
    if kind == "orthographic":
        return EYE + 4 * across, AHEAD + 0 * across
    return EYE + 0 * across, AHEAD + np.tan(np.radians(25)) * across


def render(folder, kind, aovs):
    stretch = '<scale x="4" y="4"/>' if kind == "orthographic" else ""
    (folder / "scene.xml").write_text(SCENE.format(
        kind=kind.replace("shifted", "perspective"), more=KINDS[kind], stretch=stretch, aovs=aovs,
        normal=", ".join(f"{value:.9f}" for value in NORMAL)))
    scene = mitsuba.load_file(str(folder / "scene.xml"))
    mitsuba.render(scene)
    scene.sensors()[0].film().bitmap().write(str(folder / "frame.exr"))
    subprocess.run([sys.executable, "-B", tree / "examples/mitsuba_camera.py", "scene.xml"], cwd=folder, check=True)


def layer(folder, what):
    return np.array(mitsuba.Bitmap(rendered.show(folder / "frame.exr", "camera.toml", what)))[..., :3]


def check(folder, kind, aovs):
    render(folder, kind, aovs)
    rendered.write_effect(folder, has_motion=False)
    alone = darkroom("develop", folder / "frame.exr", "--ssao", "-q", "-o", folder / "a.png")
    if "is the length of a ray" not in alone or "ssao: needs depth" not in alone:
        fail(f"{kind}: lengths of rays without a camera were used: {alone}")
    start, ray = rays_of(kind)
    distance = -(start @ NORMAL) / (ray @ NORMAL)
    is_plane = (distance > 2) & (distance < 40)  # behind near clips, and smaller than it is; behind its horizon is sky
    is_sky = (distance < 0) | (distance > 400)
    if is_plane.mean() < 0.2 or not is_sky.any():
        fail(f"{kind}: the scene shows {is_plane.mean():.2f} of a plane, and {is_sky.mean():.2f} of sky")
    place = layer(folder, "place")
    off = np.abs(place - start - distance[..., None] * ray).max(axis=-1)[is_plane].max()
    if off > 1e-3:
        fail(f"{kind}, {aovs}: places on the plane are {off:.4g} off")
    if np.linalg.norm(place[is_sky], axis=-1).min() < 1e9:
        fail(f"{kind}, {aovs}: the sky is near")
    off = np.abs(layer(folder, "normals")[is_plane] - np.array([RIGHT, UP, -AHEAD]) @ NORMAL).max()
    if off > 1e-3:  # half floats
        fail(f"{kind}, {aovs}: normals are {off:.4g} off")
    print(f"{kind}, {aovs}: right")


for kind in KINDS:
    for aovs in ("dd.y:depth,nn:sh_normal", "depth:depth,sh_normal:sh_normal"):
        with tempfile.TemporaryDirectory() as name:
            check(pathlib.Path(name), kind, aovs)
