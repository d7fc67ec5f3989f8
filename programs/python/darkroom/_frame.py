# SPDX-License-Identifier: MIT
"""Frames and their cameras, and how arrays of others become numpy's."""

import dataclasses
import math
import os
import sys
import warnings

import numpy

from ._error import Error, nearest

_CPU = 1  # DLPack's DLDeviceType kDLCPU
_FOLDER = os.path.dirname(__file__)
_said = set()


def say_once(text):
    """A warning where the package was called, the first time."""
    if text in _said:
        return
    _said.add(text)
    level, caller = 1, sys._getframe()
    while caller and caller.f_code.co_filename.startswith(_FOLDER):
        level, caller = level + 1, caller.f_back
    warnings.warn(text, stacklevel=level)


def as_array(given, name):
    """A numpy array over the memory of an array of another library, floats of 64 bits and more as those of 32."""
    array = _as_numpy(given, name)
    if isinstance(array, numpy.ndarray) and array.dtype.kind == "f" and array.dtype.itemsize > 4:
        say_once(f"{name}: dtype {array.dtype}: it is converted to float32, here and from now on")
        array = array.astype(numpy.float32)
    return array


def is_codes16(array):
    """Code values of sRGB in 16 bits."""
    return isinstance(array, numpy.ndarray) and array.dtype == numpy.uint16


def from_codes16(array):
    """The same from 0 to 1, as the engine has them of bytes."""
    return array.astype(numpy.float32) / numpy.float32(65535) if is_codes16(array) else array


def _linear_of_codes16():
    # IEC 61966-2-1:1999, 5.2.
    codes = numpy.arange(65536, dtype=numpy.float64) / 65535
    return numpy.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4).astype(numpy.float32)


_linear16 = None


def as_color(given):
    """The colour of a frame: uint16 as the light that its code values stand for, alpha as it is."""
    global _linear16
    array = as_array(given, "color")
    if not is_codes16(array) or array.ndim != 3:
        return array
    if _linear16 is None:
        _linear16 = _linear_of_codes16()
    out = from_codes16(array)
    out[..., :3] = _linear16[array[..., :3]]
    return out


def _as_numpy(given, name):
    """By DLPack, else by numpy's own protocols."""
    if isinstance(given, numpy.ndarray):
        return given if given.dtype.isnative else given.astype(given.dtype.newbyteorder("="))
    if hasattr(given, "__dlpack__") and hasattr(given, "__dlpack_device__"):
        kind = int(given.__dlpack_device__()[0])
        if kind != _CPU:
            raise Error(f"{name}: on DLPack's device {kind}: allowed is {_CPU}, main memory")
        return numpy.from_dlpack(given)
    if hasattr(given, "__array__") or hasattr(given, "__array_interface__"):
        return numpy.asarray(given)
    return given  # refused, with its type, where it is read


def _matrix(value, name):
    matrix = numpy.asarray(value, dtype=numpy.float32)
    if matrix.shape != (4, 4) or not numpy.isfinite(matrix).all():
        raise Error(f"camera.{name}: shape {matrix.shape}: allowed is (4, 4), all finite")
    return matrix


def _three(value, name):
    numbers = tuple(float(x) for x in value)
    if len(numbers) != 3 or not all(map(math.isfinite, numbers)):
        raise Error(f"{name} = {numbers}: allowed are three finite numbers")
    return numbers


@dataclasses.dataclass
class Camera:
    """Where a frame was seen from: matrices as on paper, clip = projection @ view @ world.

    The camera looks along -z, y up; clip space has y down and depth 0 to 1, as Vulkan's. Without `projection` one is
    made of `fov`, the vertical angle in degrees, and of near and far. Without previous matrices the camera stood still;
    in a sequence they are those of the frame before. Jitter is in pixels, y down. `is_cut`: nothing of the frame before
    is related to this one.
    """

    view: object = None
    projection: object = None
    previous_view: object = None
    previous_projection: object = None
    fov: float = 45.0
    near: float = 0.1
    far: float = 1000.0
    jitter: tuple = (0.0, 0.0)
    previous_jitter: tuple = (0.0, 0.0)
    is_cut: bool = False

    def perspective(self, width, height):
        """The projection of `fov` for a picture of this size: a numpy array (4, 4) of float32."""
        if not 0 < self.fov < 180:
            raise Error(f"camera.fov = {self.fov}: allowed is (0, 180) deg")
        if not 0 < self.near < self.far:
            raise Error(f"camera.near = {self.near}: allowed is (0, far = {self.far})")
        scale = 1 / math.tan(math.radians(self.fov) / 2)
        depth = -1.0 if math.isinf(self.far) else self.far / (self.near - self.far)
        out = numpy.zeros((4, 4), numpy.float32)
        out[0, 0] = scale * height / width
        out[1, 1] = -scale
        out[2, 2] = depth
        out[2, 3] = depth * self.near
        out[3, 2] = -1
        return out

    def _matrices(self, width, height):
        view = numpy.eye(4, dtype=numpy.float32) if self.view is None else _matrix(self.view, "view")
        if self.projection is None:
            projection = self.perspective(width, height)
        else:
            projection = _matrix(self.projection, "projection")
        return view, projection

    def _described(self, width, height, before):
        """What the engine takes. `before`: view and projection of the frame before, or None."""
        view, projection = self._matrices(width, height)
        previous_view, previous_projection = before or (view, projection)
        if self.previous_view is not None:
            previous_view = _matrix(self.previous_view, "previous_view")
        if self.previous_projection is not None:
            previous_projection = _matrix(self.previous_projection, "previous_projection")
        return {
            "view": view,
            "projection": projection,
            "previous_view": previous_view,
            "previous_projection": previous_projection,
            "near": self.near,
            "far": self.far,
            "jitter": tuple(float(x) for x in self.jitter),
            "previous_jitter": tuple(float(x) for x in self.previous_jitter),
            "is_cut": self.is_cut,
        }


_MOST_CASCADES = 4


@dataclasses.dataclass
class Light:
    """A directional light, and where its light reaches: what effects of light in the air read.

    direction: toward the light, in world space. color: linear Rec. 709, times intensity. cascades: up to four square
    depth maps of one size, float32, 0 near the light to 1; world_to_cascade: their matrices (4, 4), as on paper, to x
    and y in -1 to 1, y down, and depth in 0 to 1; splits: how far from the eye each ends. Without cascades it casts no
    shadow.
    """

    direction: tuple
    color: tuple = (1.0, 1.0, 1.0)
    volumetric_intensity: float = 0.0
    volumetric_color: tuple = (1.0, 1.0, 1.0)
    cascades: tuple = ()
    world_to_cascade: tuple = ()
    splits: tuple = ()

    def _described(self, name):
        counts = {len(self.cascades), len(self.world_to_cascade), len(self.splits)}
        if len(counts) > 1 or max(counts) > _MOST_CASCADES:
            raise Error(
                f"{name}: {len(self.cascades)} cascades, {len(self.world_to_cascade)} matrices, {len(self.splits)} "
                f"splits: allowed are equal numbers, up to {_MOST_CASCADES}"
            )
        cascades = [as_array(cascade, f"{name}.cascades") for cascade in self.cascades]
        shapes = [numpy.shape(cascade) for cascade in cascades]
        if any(len(shape) != 2 or shape[0] != shape[1] or shape != shapes[0] for shape in shapes):
            raise Error(f"{name}.cascades: shapes {shapes}: allowed are squares of one size")
        return {
            "direction": _three(self.direction, f"{name}.direction"),
            "color": _three(self.color, f"{name}.color"),
            "volumetric_intensity": float(self.volumetric_intensity),
            "volumetric_color": _three(self.volumetric_color, f"{name}.volumetric_color"),
            "cascades": cascades,
            "world_to_cascade": [_matrix(matrix, "world_to_cascade") for matrix in self.world_to_cascade],
            "splits": [float(split) for split in self.splits],
        }


LAYERS = ("depth", "normals", "velocity", "reactive", "transparency", "ui")


@dataclasses.dataclass
class Frame:
    """One frame: its colour, and what a renderer knows beside it. Arrays of height x width (x channels), top row first.

    color: red, green, blue, and alpha if there is one. Floats (float16, float32) are scene-linear light in Rec. 709;
    uint8 and uint16 are code values of sRGB. depth: distance along the view axis; 1e9 and more is sky. normals: x, y, z in world
    space. velocity: x, y, the previous position minus the present one, in pixels, y down. reactive: 0 to 1.
    transparency: the colour before anything transparent was drawn. exposure: a number, what light is multiplied by.
    ui: the interface, uint8 with alpha, sRGB-encoded, premultiplied after that. lights: darkroom.Light of each. time:
    seconds; None: that of the frame's place in its sequence. fire: an event, or several, that start pulses of the look
    with this frame of a sequence. layer_weights: 0 to 1 by name, of layers of the look in this frame; others have the
    weight that the look says.
    """

    color: object
    depth: object = None
    normals: object = None
    velocity: object = None
    reactive: object = None
    transparency: object = None
    ui: object = None
    exposure: float | None = None
    camera: Camera | None = None
    lights: list | tuple = ()
    time: float | None = None
    delta_time: float | None = None
    frame_index: int | None = None
    fire: str | list | tuple = ()
    layer_weights: dict = dataclasses.field(default_factory=dict)

    def _described(self, camera, time, delta_time, frame_index):
        """What the engine takes; `camera` as Camera._described has it."""
        out = {
            "color": as_color(self.color),
            "camera": camera,
            "lights": [light._described(f"lights[{number}]") for number, light in enumerate(self.lights)],
            "time": float(time if self.time is None else self.time),
            "delta_time": float(delta_time if self.delta_time is None else self.delta_time),
            "frame_index": int(frame_index if self.frame_index is None else self.frame_index),
            "fire": [self.fire] if isinstance(self.fire, str) else list(self.fire),
            "layer_weights": {name: float(weight) for name, weight in self.layer_weights.items()},
        }
        if self.exposure is not None:
            try:
                out["exposure"] = float(self.exposure)
            except (TypeError, ValueError):
                raise Error(f"exposure = {self.exposure!r}: allowed is a number, what light is multiplied by") from None
        for name in LAYERS:
            layer = getattr(self, name)
            if layer is None:
                continue
            layer = as_array(layer, name)
            is_float = isinstance(layer, numpy.ndarray) and layer.dtype.kind == "f"
            if is_float and not (name == "velocity" and layer.dtype == numpy.float16):
                layer = layer.astype(numpy.float32, copy=False)
            out[name] = layer
        return out


def as_frame(given):
    """A frame, the layers of one by name, or its colour alone."""
    if isinstance(given, Frame):
        return given
    if isinstance(given, dict):
        known = {field.name for field in dataclasses.fields(Frame)}
        unknown = sorted(set(given) - known - {"picture"})
        if unknown:
            near = nearest(unknown[0], known) or ":"
            raise Error(
                f"frame: no layer '{unknown[0]}'{near} allowed is {', '.join(sorted(known))}; values of effects are set "
                "by a look or a Stack"
            )
        return Frame(**{name: layer for name, layer in given.items() if name in known})
    return Frame(given)


def size_of(array, name="color"):
    """Width and height; (0, 0) of what is no picture, which is refused where it is read."""
    array = as_array(array, name)
    if isinstance(array, numpy.ndarray) and array.ndim == 3 and array.shape[0] and array.shape[1]:
        return array.shape[1], array.shape[0]
    return 1, 1


def warn(texts):
    """Of the caller of this package."""
    for text in texts:
        warnings.warn(text, stacklevel=4)
