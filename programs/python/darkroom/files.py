# SPDX-License-Identifier: MIT
"""Scenes, picture files, and tables of other formats: what needs more than the engine.

These run the installed program `darkroom`, which reads files of strangers in confined processes of its own, and needs the
system's libraries for that. It is the one in DARKROOM_PROGRAM, else in PATH. OpenEXR frames (uncompressed or ZIP) and PNG
pictures are written, and such frames are read, without it.
"""

import json
import os
import shutil
import struct
import subprocess
import tempfile
import zlib

import numpy

from . import _exr
from ._error import Error, of_file, store
from ._frame import Camera, Light, as_array, as_frame
from ._stack import Stack
from ._table import Table

# An entry that changes nothing: a look with none at all is refused.
_UNCHANGED = '[[stack]]\neffect = "exposure"\nexposure = 1.0\n'


def program() -> str:
    """The program that is run. Raises Error where there is none."""
    named = os.environ.get("DARKROOM_PROGRAM")
    found = shutil.which(named or "darkroom")
    if found:
        return found
    where = f"DARKROOM_PROGRAM = {named}" if named else "PATH"
    raise Error(f"darkroom.files: {where}: no program 'darkroom' there: docs/install.md installs it", "machine")


def run(*arguments) -> bytes:
    """Runs the program with these arguments and gives what it prints. Its error is raised as Error."""
    words = [program(), *(os.fspath(word) if isinstance(word, os.PathLike) else str(word) for word in arguments)]
    done = subprocess.run(words, capture_output=True, stdin=subprocess.DEVNULL)
    if done.returncode in (0, 3):  # 3: compare found a difference
        return done.stdout
    lines = done.stderr.decode("utf-8", "backslashreplace").strip().splitlines() or [f"exit code {done.returncode}"]
    raise Error(lines[-1].removeprefix("darkroom: "), "user" if done.returncode == 1 else "machine")


def _stack(planes, names):
    return numpy.stack([planes[name] for name in names], axis=-1) if all(name in planes for name in names) else None


def _matrix(attributes, name):
    kind, data = attributes.get(name, (None, b""))
    return numpy.frombuffer(data, "<f4").reshape(4, 4).T.copy() if kind == "m44f" and len(data) == 64 else None


def _number(attributes, name):
    kind, data = attributes.get(name, (None, b""))
    return struct.unpack("<d", data)[0] if kind == "double" else None


def _pair(attributes, name):
    kind, data = attributes.get(name, (None, b""))
    return struct.unpack("<2f", data) if kind == "v2f" else (0.0, 0.0)


def _camera(attributes):
    near, far = _number(attributes, "darkroom:near"), _number(attributes, "darkroom:far")
    return Camera(
        view=_matrix(attributes, "worldToCamera"),
        projection=_matrix(attributes, "darkroom:projection"),
        previous_view=_matrix(attributes, "darkroom:previousWorldToCamera"),
        previous_projection=_matrix(attributes, "darkroom:previousProjection"),
        near=0.1 if near is None else near,
        far=1000.0 if far is None else far,
        jitter=_pair(attributes, "darkroom:jitter"),
        previous_jitter=_pair(attributes, "darkroom:previousJitter"),
    )


def _floats(attributes, name, count=None):
    """The floats of an attribute; None: there is none of this many."""
    kind, data = attributes.get(name, (None, b""))
    if kind not in ("float", "v3f", "floatvector") or count is not None and len(data) != 4 * count:
        return None
    return tuple(float(number) for number in numpy.frombuffer(data[: len(data) // 4 * 4], "<f4"))


def _lights(attributes, parts):
    """The lights of a frame, with the depths of their cascades, which are parts of their own."""
    out = []
    while direction := _floats(attributes, f"darkroom:light{len(out)}.direction", 3):
        name = f"darkroom:light{len(out)}."
        light = Light(
            direction,
            _floats(attributes, name + "color", 3) or (1.0, 1.0, 1.0),
            (_floats(attributes, name + "volumetricIntensity", 1) or (0.0,))[0],
            _floats(attributes, name + "volumetricColor", 3) or (1.0, 1.0, 1.0),
        )
        kind, data = attributes.get(name + "shadow", (None, b""))
        part = parts.get(f"shadow{struct.unpack('<i', data)[0]}") if kind == "int" and len(data) == 4 else None
        if part is not None:
            light.splits = _floats(attributes, name + "splits") or ()
            numbers = range(len(light.splits))
            light.cascades = [part.planes[key] for key in (f"cascade{i}" for i in numbers) if key in part.planes]
            matrices = [_matrix(attributes, f"{name}worldToCascade{i}") for i in numbers]
            light.world_to_cascade = [matrix for matrix in matrices if matrix is not None]
        out.append(light)
    return out


def read_frame(path) -> dict:
    """The layers of a frame in an OpenEXR file: what darkroom.Frame takes, by name.

    Colour has alpha where the file has it.
    """
    with of_file(path):
        part, parts = _exr.read(path)
    planes = part.planes
    out = {"color": _stack(planes, "RGBA") if "A" in planes else _stack(planes, "RGB")}
    if out["color"] is None:
        raise Error(f"{os.fspath(path)}: channels {', '.join(planes)}: R, G and B are needed")
    for name, channels in (
        ("normals", ("N.X", "N.Y", "N.Z")),
        ("velocity", ("velocity.X", "velocity.Y")),
        ("transparency", ("transparency.R", "transparency.G", "transparency.B")),
    ):
        out[name] = _stack(planes, channels)
    out["depth"] = planes.get("Z")
    if "worldToCamera" in part.attributes:
        out["camera"] = _camera(part.attributes)
    for name, attribute in (("time", "darkroom:time"), ("delta_time", "darkroom:deltaTime")):
        out[name] = _number(part.attributes, attribute)
    out["lights"] = _lights(part.attributes, parts) or None
    index = _number(part.attributes, "darkroom:frameIndex")
    out["frame_index"] = None if index is None else int(index)
    return {name: layer for name, layer in out.items() if layer is not None}


def write_frame(path, frame) -> None:
    """Writes a frame (darkroom.Frame, or a dictionary of layers) as an OpenEXR file, for `darkroom develop`.

    Lights are not written, nor reactive, ui and exposure.
    """
    frame = as_frame(frame)
    channels = {}

    def add(layer, names):
        if layer is None:
            return
        layer = as_array(layer, names[0])
        if layer.dtype not in (numpy.float16, numpy.float32):
            raise Error(f"{os.fspath(path)}: {names[0]} of {layer.dtype}: allowed is float16 or float32")
        planes = layer.reshape(layer.shape[0], layer.shape[1], -1)
        channels.update({name: planes[..., i] for i, name in enumerate(names[: planes.shape[2]])})

    add(frame.color, "RGBA")
    add(frame.depth, ("Z",))
    add(frame.normals, ("N.X", "N.Y", "N.Z"))
    add(frame.velocity, ("velocity.X", "velocity.Y"))
    add(frame.transparency, ("transparency.R", "transparency.G", "transparency.B"))
    attributes = []
    if frame.camera is not None:
        height, width = channels["R"].shape
        described = frame.camera._described(width, height, None)
        for name, matrix in (
            ("worldToCamera", "view"),
            ("darkroom:projection", "projection"),
            ("darkroom:previousWorldToCamera", "previous_view"),
            ("darkroom:previousProjection", "previous_projection"),
        ):
            attributes.append((name, "m44f", described[matrix].T.astype("<f4").tobytes()))
        for name, number in (("darkroom:near", frame.camera.near), ("darkroom:far", frame.camera.far)):
            attributes.append((name, "double", struct.pack("<d", number)))
    if frame.time is not None:
        attributes.append(("darkroom:time", "double", struct.pack("<d", frame.time)))
    _exr.write(path, channels, attributes)


def render(scene, *, size=(1920, 1080), look=None, time: float | None = None, flags=()) -> dict:
    """Renders a scene or a model (.toml, .glb, .gltf): the layers of its frame by name, and "picture", developed.

    look: the file of a look, or a Stack, in place of the scene's own. time: seconds. flags: more of `darkroom render`.
    """
    width, height = size
    words = ["render", scene, "--size", f"{width}x{height}", "-o", "-", "--format", "rgb24", "--quiet"]
    with tempfile.TemporaryDirectory(prefix="darkroom-") as folder:
        if isinstance(look, Stack):
            look.save(os.path.join(folder, "look.toml"))
            look = os.path.join(folder, "look.toml")
        if look is not None:
            words += ["--look", look]
        if time is not None:
            words += ["--time", repr(float(time))]
        stored = os.path.join(folder, "frame.exr")
        picture = run(*words, "--save-frame", stored, *flags)
        layers = read_frame(stored)
    layers["picture"] = numpy.frombuffer(picture, numpy.uint8).reshape(height, width, 3)
    return layers


def read(path):
    """The picture in a file that `darkroom develop` reads (EXR, PNG, JPEG, TIFF, WebP, HDR): scene-linear float32."""
    with of_file(path), tempfile.TemporaryDirectory(prefix="darkroom-") as folder:
        look, out = os.path.join(folder, "unchanged.toml"), os.path.join(folder, "out.exr")
        with open(look, "w", encoding="utf-8") as file:
            file.write(_UNCHANGED)
        run("develop", path, "--look", look, "-o", out, "--bits", "float", "--compression", "zip", "--quiet")
        return read_frame(out)["color"]


def write(path, picture) -> None:
    """Writes a picture: uint8 and uint16 as .png, floats as .exr. Other formats: `run("develop", "picture.exr", ...)`."""
    path, picture = os.fspath(path), as_array(picture, "picture")
    if path.endswith(".exr"):
        return write_frame(path, picture)
    if not path.endswith(".png"):
        raise Error(f"{path}: allowed are .png and .exr; `darkroom develop` writes other formats")
    is_picture = picture.ndim == 3 and picture.shape[2] in (3, 4) and picture.dtype in (numpy.uint8, numpy.uint16)
    if not is_picture:
        raise Error(f"{path}: {picture.dtype}, shape {picture.shape}: allowed are .png of uint8 or uint16 and .exr of floats")
    height, width, channels = picture.shape
    bits = 8 * picture.dtype.itemsize
    samples = picture.astype(picture.dtype.newbyteorder(">")).reshape(height, -1).view(numpy.uint8)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, bits, 2 if channels == 3 else 6, 0, 0, 0)
    rows = numpy.concatenate([numpy.zeros((height, 1), numpy.uint8), samples], axis=1)
    parts = [chunk(b"IHDR", head), chunk(b"sRGB", b"\0"), chunk(b"IDAT", zlib.compress(rows.tobytes(), 6))]
    store(path, b"\x89PNG\r\n\x1a\n" + b"".join(parts) + chunk(b"IEND", b""))


def info(path) -> dict:
    """What `darkroom info` tells of a file: a picture, a frame, a look, a scene, a table."""
    with of_file(path):
        return json.loads(run("info", path, "--json"))


def compare(reference, test) -> dict:
    """How far two files, folders or sequences of pictures are apart: what `darkroom compare --json` tells."""
    return json.loads(run("compare", reference, test, "--json"))


def table(path) -> Table:
    """A colour table in any format that `darkroom lut convert` reads (.cube, .3dl, .clf and others), a HaldCLUT."""
    with of_file(path), tempfile.TemporaryDirectory(prefix="darkroom-") as folder:
        out = os.path.join(folder, "table.cube")
        run("lut", "convert", path, "-o", out)
        return Table.read(out)


def load_resource(path, is_table):
    """What the engine asks for when a stack names a file that it does not read itself: a table or a picture."""
    return table(path)._engine if is_table else read(path)
