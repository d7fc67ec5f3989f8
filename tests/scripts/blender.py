#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""blender.py TREE DARKROOM: frames that Blender itself renders (PyPI's bpy), beside the camera that
examples/blender_camera.py writes of them. Right is what follows from the scene: a floor at height 0 looks up, so its
normal is (0, 1, 0) and its depth that of a plane; nothing is left out. Ends with 77 where there is no bpy."""
import os
import pathlib
import sys
import tempfile

import rendered
from rendered import darkroom, expect, fail

tree, sys.argv[2] = pathlib.Path(sys.argv[1]).resolve(), os.path.abspath(sys.argv[2])
bpy = rendered.need("bpy", "DARKROOM_BLENDER_PYTHON")
import mathutils
from bpy_extras.object_utils import world_to_camera_view


def make_scene(folder, kind):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_plane_add(size=400, location=(0, 0, 0))
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 3, 0.5))
    cube = bpy.context.object
    for frame, x in ((1, -0.5), (3, 0.5)):  # one moves by half a metre a frame
        cube.location.x = x
        cube.keyframe_insert("location", frame=frame)
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.ortho_scale, camera.shift_x = kind, 8, 0.1
    seen_by = bpy.data.objects.new("camera", camera)
    seen_by.location, seen_by.rotation_euler = (0.5, -5, 2.5), (1.2, 0, 0.1)
    scene.collection.objects.link(seen_by)
    scene.camera = seen_by
    scene.frame_start, scene.frame_end = 1, 3
    render, layer = scene.render, scene.view_layers[0]
    render.engine, render.resolution_x, render.resolution_y = "CYCLES", 96, 64
    scene.cycles.samples, scene.cycles.device = 1, "CPU"
    layer.use_pass_z = layer.use_pass_normal = layer.use_pass_vector = True
    settings = render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
    render.filepath = str(folder / "blender.")
    os.chdir(folder)
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        render.filepath = str(folder / f"blender.{frame:04}.exr")
        bpy.ops.render.render(write_still=True)
    exec(compile((tree / "examples/blender_camera.py").read_text(), "blender_camera.py", "exec"), {})


def shown(folder, what):
    """Three numbers a pixel, by row from the top and column."""
    image = bpy.data.images.load(rendered.show(folder / "blender.0002.exr", "camera.####.toml", what), check_existing=False)
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = list(image.pixels)
    return lambda x, y: pixels[4 * ((height - 1 - y) * width + x):][:3]


def pixel_of(point):
    """Where the camera sees a point of the world, y down."""
    x, y, _ = world_to_camera_view(bpy.context.scene, bpy.context.scene.camera, mathutils.Vector(point))
    return x * 96, (1 - y) * 64


for kind in ("PERSP", "ORTHO"):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_scene(folder, kind)
        rendered.write_effect(folder, has_motion=True)
        alone = darkroom("develop", folder / "blender.0002.exr", "--ssao", "--fov", "40", "-q", "-o", folder / "a.png")
        if "normals are left out" not in alone:
            fail(f"{kind}: normals of a world without a camera were used: {alone}")
        told = darkroom("develop", folder / "blender.####.exr", "--camera", folder / "camera.####.toml", "--fps", "24",
                        "--ssao", "--fog-density", "0.03", "--motion-blur", "-q", "-o", folder / "b.####.png")
        if told:
            fail(f"{kind}: {told}")
        bpy.context.scene.frame_set(2)
        to_camera = bpy.context.scene.camera.matrix_world.to_3x3().inverted()
        x, y = map(int, pixel_of((-1.5, 0, 0)))
        expect(f"{kind}: the floor's normal", shown(folder, "normals")(x, y), to_camera @ mathutils.Vector((0, 0, 1)), 2e-3)
        place = shown(folder, "place")(x, y)
        expect(f"{kind}: the floor's height", place[1:2], [0], 5e-3)
        seen = pixel_of((place[0], -place[2], 0))
        expect(f"{kind}: the place under a pixel", seen, [x + 0.5, y + 0.5], 0.05)
        now, before = pixel_of((0, 2.5, 0.5)), pixel_of((-0.5, 2.5, 0.5))
        expect(f"{kind}: the cube's motion", shown(folder, "motion")(int(now[0]), int(now[1]))[:2],
               [before[0] - now[0], before[1] - now[1]], 0.1)
        print(f"{kind}: right")
