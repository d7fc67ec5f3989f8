# SPDX-License-Identifier: MIT
"""Writes the camera of every frame of a scene as files for --camera 'camera.####.toml':
blender scene.blend --background --python blender_camera.py"""
import bpy

scene, render = bpy.context.scene, bpy.context.scene.render
for frame in range(scene.frame_start, scene.frame_end + 1):
    scene.frame_set(frame)
    x, y, z, w = scene.camera.calc_matrix_camera(
        bpy.context.evaluated_depsgraph_get(), x=render.resolution_x, y=render.resolution_y,
        scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y)
    rows = {"camera_to_world": scene.camera.matrix_world.normalized(), "projection": [x, -y, (z + w) / 2, w]}
    with open(f"camera.{frame:04}.toml", "w") as file:
        file.write('up = "z"\n')
        for name, matrix in rows.items():
            file.write(f"{name} = [{', '.join(f'{value:.9g}' for row in matrix for value in row)}]\n")
