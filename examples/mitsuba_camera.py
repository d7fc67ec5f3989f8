# SPDX-License-Identifier: MIT
"""Writes the camera of a scene of Mitsuba 3 as a file for --camera camera.toml: python mitsuba_camera.py scene.xml"""
import sys
import mitsuba
import numpy

mitsuba.variant() or mitsuba.set_variant("scalar_rgb")
sensor = mitsuba.load_file(sys.argv[1]).sensors()[0]
world, lens = (numpy.array(each.matrix) for each in (sensor.world_transform(), sensor.projection_transform()))
turn = numpy.diag([-1, 1, -1, 1.0])  # it looks along z, and x goes to the left
turn[:3] /= numpy.linalg.norm(world[:3, :3], axis=0)[:, None]  # how much a parallel camera sees
x, y = (mitsuba.traverse(sensor).get(f"principal_point_offset_{axis}", 0) for axis in "xy")
window = [[2, 0, 0, -1 - 2 * x], [0, 2, 0, -1 - 2 * y], [0, 0, 1, 0], [0, 0, 0, 1]]  # its pictures are from 0 to 1
with open("camera.toml", "w") as file:
    for name, matrix in {"camera_to_world": world @ turn, "projection": window @ lens @ turn}.items():
        file.write(f"{name} = [{', '.join(f'{value:.9g}' for value in matrix.flat)}]\n")
