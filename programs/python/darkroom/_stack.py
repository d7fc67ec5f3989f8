# SPDX-License-Identifier: MIT
"""Stacks of effects, and pictures and sequences that go through them."""

import itertools
import os
import pathlib

import numpy

from . import _device, _engine
from ._error import Error, MissingFileError, nearest, of_file, store
from ._frame import Camera, Frame, as_array, as_frame, from_codes16, say_once, size_of, warn
from ._table import Table

_numbers = itertools.count()
_shipped = pathlib.Path(__file__).parent / "looks"


def value_text(value, name):
    """A value as the engine takes it: text, as at a command line, but tables and pictures as they are."""
    if isinstance(value, (bool, numpy.bool_)):
        return "on" if value else "off"
    if value is None:
        return ""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, Table):
        return value._engine
    if isinstance(value, (int, numpy.integer)):
        return str(int(value))
    if isinstance(value, (float, numpy.floating)):
        return repr(float(value))
    if hasattr(value, "ndim") and getattr(value, "ndim") == 3:
        return from_codes16(as_array(value, name))
    try:
        items = list(value)
        if items and all(hasattr(item, "__len__") and len(item) == 2 for item in items):
            return ",".join(f"{float(x)!r}:{float(y)!r}" for x, y in items)
        return ",".join(repr(float(item)) for item in items)
    except TypeError:
        raise Error(f"{name}: a {type(value).__name__} is no value of a parameter") from None


def value_texts(values, name):
    return [(key, value_text(value, f"{name}.{key}")) for key, value in values.items()]


def look_file(look):
    """The file of a look: "night" is the one that ships, where no file has this name."""
    path = os.fspath(look)
    if not path or any(mark in path for mark in "/\\.") or os.path.exists(path):
        return path
    names = [file.stem for file in _shipped.glob("*.toml")]
    if path not in names:
        raise MissingFileError(f"{path}: no such file, and no look that ships has this name{nearest(path, names)}")
    return os.fspath(_shipped / f"{path}.toml")


class Stack:
    """An ordered list of effects. Each has a method of its name, which appends it and gives the stack back:

        stack = darkroom.Stack().bloom(intensity=0.1).tonemap()
        picture = stack.develop(frame)

    `look` is the file of a look (TOML), the name of one that ships ("night"), another stack to copy, or None for an
    empty one. A stack is a look: `text` and `save` write it as one. Effects of files run as code on the GPU:
    allows_custom_effects=False refuses looks that name some.
    """

    def __init__(self, look=None, *, allows_custom_effects: bool = True):
        self._key = ("stack", next(_numbers))
        warnings = []
        if look is None:
            self._look = _engine.Look()
        elif isinstance(look, Stack):
            self._look = look._look.copy()
        elif isinstance(look, (str, os.PathLike)):
            file = look_file(look)
            with of_file(file):
                self._look, warnings = _engine.Look.read(file, allows_custom_effects)
        else:
            raise Error(f"look: a {type(look).__name__}: allowed is the path or name of a look, or a Stack")
        warn(warnings)

    @classmethod
    def parse(cls, text: str, name: str = "look", *, allows_custom_effects: bool = True) -> "Stack":
        """The look that this TOML says. `name` is what errors call it."""
        out = cls()
        out._look, warnings = _engine.Look.parse(text, name, allows_custom_effects)
        warn(warnings)
        return out

    @classmethod
    def default(cls) -> "Stack":
        """What `darkroom develop` does to a picture without a look: exposure, bloom, tone mapping, and the like."""
        out = cls()
        out._look = _engine.Look.default()
        return out

    def add(self, effect: str, /, *, name: str = "", output: str = "", **values) -> "Stack":
        """Appends an effect, or one of a file (`"duotone.glsl"`), with values of its parameters.

        Every entry also takes enabled, opacity (0 to 1), blend, scale and format, and as wires input, source, second and
        mask: the `output` of an entry before it, "scene", a name with ".previous" for the frame before, or a picture.
        """
        self._look.add(os.fspath(effect), name, output, value_texts(values, name or os.fspath(effect)))
        return self

    def set(self, entry: str, /, **values) -> "Stack":
        """Sets values of an entry, which is found by its name, or by "bloom" or "bloom#2"."""
        self._look.set(entry, value_texts(values, entry))
        return self

    def remove(self, entry: str, /) -> "Stack":
        """Takes an entry out."""
        self._look.remove(entry)
        return self

    def values(self, entry: str, /) -> dict:
        """All values of an entry by name."""
        return {
            name: Table._of(value) if isinstance(value, _engine.Table) else value
            for name, value in self._look.values(entry).items()
        }

    @property
    def names(self) -> list:
        """The entries in order."""
        return self._look.names

    def __len__(self) -> int:
        return len(self._look.names)

    def __contains__(self, entry) -> bool:
        return entry in self._look.names

    def __getattr__(self, name):
        from ._effects import EFFECTS

        raise AttributeError(f"a stack has no effect '{name}'{nearest(name, EFFECTS)}", name=name, obj=self)

    def __repr__(self) -> str:
        return f"<darkroom.Stack: {', '.join(self.names) or 'empty'}>"

    def copy(self) -> "Stack":
        """Another stack with the same entries."""
        return Stack(self)

    @property
    def text(self) -> str:
        """The look as TOML."""
        return self._look.text()

    def save(self, path) -> None:
        """Writes the look to a file."""
        store(path, self.text.encode())

    def develop(self, frame, *, output: str = "encoded8", size=None, **layers):
        """Develops one frame: an array, a Frame, or a dictionary of layers; `layers` are those of Frame.

        output: "encoded8", bytes for the screen (sRGB, uint8); "encoded", the same before it is rounded (float32);
        "linear", scene-linear light (float32), without encode and dither. size: (width, height) of the picture where it
        is another than the frame's. The array has as many channels as the frame. Histories are empty: a frame by itself.
        """
        frame = with_layers(frame, layers)
        runner = _device.runner(self._key, output, size)
        picture = develop_one(runner, self._look, frame)
        warn(runner.misplaced() + self._look.values_without_effect())
        if not self._look.is_flat:
            warn(runner.left_out())
        return picture

    def sequence(self, frames, *, fps: float = 60.0, output: str = "encoded8", size=None):
        """Develops frames one after the other, with histories: yields a picture for each.

        Frame n is at n / fps seconds, unless it says its time, and its camera moved from that of the frame before. The
        device works at a frame while the next one is made, so picture n comes when frame n + 2 has been taken.
        Values of the stack may be set meanwhile; they count for frames that are taken after that.
        """
        if not fps > 0:
            raise Error(f"fps = {fps}: allowed is above 0")
        _device.target_of(output), _device.sized(size)
        return self._pictures(frames, fps, output, size)

    def _pictures(self, frames, fps, output, size):
        runner = _device.new_runner(output, 2, size)
        under_way, before = 0, None
        for index, given in enumerate(frames):
            frame = as_frame(given)
            camera = frame.camera or Camera()
            width, height = size_of(frame.color)
            described = camera._described(width, height, before)
            described["is_cut"] = camera.is_cut or index == 0
            if under_way == 2:
                yield runner.finish()
                under_way -= 1
            runner.submit(self._look, frame._described(described, index / fps, 1 / fps, index))
            under_way += 1
            if index == 0:
                warn(runner.misplaced() + self._look.values_without_effect())
            before = camera._matrices(width, height)
        for _ in range(under_way):
            yield runner.finish()

    def plan(self) -> str:
        """What the planner made of the stack for the last picture of `develop`: passes, and what each reads and writes."""
        found = [runner for key, runner in _device._runners.items() if key[0] == self._key]
        return found[-1].plan_text() if found else ""


def with_layers(frame, layers):
    if not layers:
        return as_frame(frame)
    if isinstance(frame, (Frame, dict)):
        raise Error(f"{next(iter(layers))}: the frame says its layers itself")
    if set(layers) == {"exposure"}:
        say_once(
            "exposure: what the frame's light is multiplied by, which few effects read; the effect of this name is set by "
            'Stack.default().set("exposure", exposure=...), or by a look'
        )
    return as_frame({"color": frame, **layers})


def develop_one(runner, look, frame):
    if frame.fire:
        raise Error(f"fire = {frame.fire!r}: a picture by itself has no time in which a pulse dies down: use sequence")
    camera = frame.camera or Camera()
    described = camera._described(*size_of(frame.color), None)
    described["is_cut"] = True
    return runner.develop(look, frame._described(described, 0.0, 1 / 60, 0))


def develop(image, look=None, *, output: str = "encoded8", size=None, **layers):
    """Develops a picture, as `darkroom develop` does.

    image: an array of height x width x 3 or 4, or a Frame, or a dictionary of layers. float16 and float32 are
    scene-linear light in Rec. 709; uint8 and uint16 are code values of sRGB. look: the file of a look (TOML), the name
    of one that ships, a Stack, or None for the default. layers: depth, normals, velocity, camera and so on, as
    darkroom.Frame has them. output: "encoded8", bytes for the screen (sRGB, uint8); "encoded", the same before it is
    rounded (float32); "linear", scene-linear light (float32). size: (width, height) of the picture where it is another
    than the frame's.
    """
    if isinstance(look, Stack):
        return look.develop(image, output=output, size=size, **layers)
    stack = Stack.default() if look is None else Stack(look)
    frame = with_layers(image, layers)
    return develop_one(_device.runner(("look", str(look)), output, size), stack._look, frame)
