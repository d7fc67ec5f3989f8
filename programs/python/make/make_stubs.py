# SPDX-License-Identifier: MIT
"""make_stubs.py OUT.pyi: writes the types of the package in OUT's folder, for editors and type checkers. Run while the
package is built; what is written here by hand is checked against the package by its tests."""

import inspect
import pathlib
import sys

# Before what the environment says, which is where numpy is.
sys.path.insert(0, str(pathlib.Path(sys.argv[1]).resolve().parents[1]))

import darkroom  # noqa: E402
from darkroom import _effects  # noqa: E402

HEAD = '''# Made by make_stubs.py from the effects of this build.
from os import PathLike
from typing import Any, Iterable, Iterator, Literal, Sequence

from numpy import ndarray

from . import files as files

'''


def text_of(parameter):
    out = parameter.name
    if parameter.annotation is not inspect.Parameter.empty:
        out += f": {parameter.annotation}"
    if parameter.default is not inspect.Parameter.empty:
        out += f" = {parameter.default!r}" if parameter.annotation is not inspect.Parameter.empty else "=..."
    return out


def line_of(name, signature, indent, first_line):
    """A function as a stub; `signature` has one parameter before the star, or none."""
    parameters = list(signature.parameters.values())
    words = []
    for number, parameter in enumerate(parameters):
        is_keyword = parameter.kind is inspect.Parameter.KEYWORD_ONLY
        before = parameters[number - 1].kind if number else None
        if before is inspect.Parameter.POSITIONAL_ONLY:
            words.append("/")
        if is_keyword and before is not inspect.Parameter.KEYWORD_ONLY:
            words.append("*")
        words.append(text_of(parameter))
    doc = f'{indent}    """{first_line}"""\n'
    return f"{indent}def {name}({', '.join(words)}) -> {signature.return_annotation}:\n{doc}{indent}    ...\n"


HAND = '''class Error(Exception):
    text: str
    fault: Literal["user", "machine"]
    code: Literal["device_lost", "out_of_memory", "unsupported", "other"]
    def __init__(self, text: str, fault: str = "user", code: str = "other") -> None: ...

class Camera:
    view: Any
    projection: Any
    previous_view: Any
    previous_projection: Any
    fov: float
    near: float
    far: float
    jitter: tuple[float, float]
    previous_jitter: tuple[float, float]
    is_cut: bool
    def __init__(self, view: Any = None, projection: Any = None, previous_view: Any = None,
                 previous_projection: Any = None, fov: float = 45.0, near: float = 0.1, far: float = 1000.0,
                 jitter: tuple[float, float] = (0.0, 0.0), previous_jitter: tuple[float, float] = (0.0, 0.0),
                 is_cut: bool = False) -> None: ...
    def perspective(self, width: int, height: int) -> ndarray: ...

class Light:
    direction: tuple[float, float, float]
    color: tuple[float, float, float]
    volumetric_intensity: float
    volumetric_color: tuple[float, float, float]
    cascades: Sequence[Any]
    world_to_cascade: Sequence[Any]
    splits: Sequence[float]
    def __init__(self, direction: tuple[float, float, float], color: tuple[float, float, float] = (1.0, 1.0, 1.0),
                 volumetric_intensity: float = 0.0, volumetric_color: tuple[float, float, float] = (1.0, 1.0, 1.0),
                 cascades: Sequence[Any] = (), world_to_cascade: Sequence[Any] = (),
                 splits: Sequence[float] = ()) -> None: ...

class Frame:
    color: Any
    depth: Any
    normals: Any
    velocity: Any
    reactive: Any
    transparency: Any
    ui: Any
    exposure: float | None
    camera: Camera | None
    lights: Sequence[Light]
    time: float | None
    delta_time: float | None
    frame_index: int | None
    fire: str | Sequence[str]
    layer_weights: dict[str, float]
    def __init__(self, color: Any, depth: Any = None, normals: Any = None, velocity: Any = None, reactive: Any = None,
                 transparency: Any = None, ui: Any = None, exposure: float | None = None,
                 camera: Camera | None = None, lights: Sequence[Light] = (), time: float | None = None, delta_time: float | None = None,
                 frame_index: int | None = None, fire: str | Sequence[str] = (),
                 layer_weights: dict[str, float] = ...) -> None: ...

class Comparison:
    flip_mean: float
    flip_weighted_median: float
    flip_max: float
    psnr: float
    max_error: float
    mean_error: float
    worst: tuple[int, int]
    non_finite_differences: int
    flip_map: ndarray

class Table:
    def __init__(self, cube: Any, min: tuple[float, float, float] = (0.0, 0.0, 0.0),
                 max: tuple[float, float, float] = (1.0, 1.0, 1.0), title: str = "") -> None: ...
    @classmethod
    def read(cls, path: str | PathLike[str]) -> Table: ...
    @classmethod
    def identity(cls, size: int = 33) -> Table: ...
    @property
    def cube(self) -> ndarray: ...
    @property
    def shaper(self) -> ndarray: ...
    @property
    def title(self) -> str: ...
    def __call__(self, colors: Any, interpolation: Literal["tetrahedral", "trilinear"] = "tetrahedral") -> ndarray: ...
    def write(self, path: str | PathLike[str]) -> None: ...

class Device:
    name: str
    driver: str
    is_software: bool
    validation_messages: int

Output = Literal["encoded8", "encoded", "linear"]
__version__: str

def develop(image: Any, look: str | PathLike[str] | Stack | None = None, *, output: Output = "encoded8",
            size: tuple[int, int] | None = None, **layers: Any) -> ndarray: ...
def compare(reference: Any, test: Any, *, is_linear: bool | None = None,
            pixels_per_degree: float = ...) -> Comparison: ...
def device() -> Device: ...
def devices() -> list[dict[str, Any]]: ...
def use_device(name: str | int = "") -> str: ...
def free() -> None: ...
def effect_names() -> list[str]: ...
def info(effect: str | None = None) -> dict[str, Any]: ...

class Stack:
    def __init__(self, look: str | PathLike[str] | Stack | None = None, *, allows_custom_effects: bool = True) -> None: ...
    @classmethod
    def parse(cls, text: str, name: str = "look", *, allows_custom_effects: bool = True) -> Stack: ...
    @classmethod
    def default(cls) -> Stack: ...
    def add(self, effect: str, /, *, name: str = "", output: str = "", **values: Any) -> Stack: ...
    def set(self, entry: str, /, **values: Any) -> Stack: ...
    def remove(self, entry: str, /) -> Stack: ...
    def values(self, entry: str, /) -> dict[str, Any]: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def text(self) -> str: ...
    def __len__(self) -> int: ...
    def __contains__(self, entry: str) -> bool: ...
    def copy(self) -> Stack: ...
    def save(self, path: str | PathLike[str]) -> None: ...
    def develop(self, frame: Any, *, output: Output = "encoded8", size: tuple[int, int] | None = None,
                **layers: Any) -> ndarray: ...
    def sequence(self, frames: Iterable[Any], *, fps: float = 60.0, output: Output = "encoded8",
                 size: tuple[int, int] | None = None) -> Iterator[ndarray]: ...
    def plan(self) -> str: ...
'''


def main(out):
    parts = [HEAD, HAND]
    for name, effect in _effects.EFFECTS.items():
        parts.append(line_of(name, inspect.signature(getattr(darkroom.Stack, name)), "    ", effect["doc"]))
    for name, effect in _effects.EFFECTS.items():
        parts.append(line_of(name, inspect.signature(getattr(darkroom, name)), "", effect["doc"]))
    with open(out, "w", encoding="utf-8") as file:
        file.write("".join(parts))


if __name__ == "__main__":
    main(sys.argv[1])
