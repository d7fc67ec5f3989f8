# SPDX-License-Identifier: MIT
"""A function and a method of stacks for every effect of this build, made from the effects' own descriptions."""

import inspect

import numpy

from . import _device, _engine
from ._error import Error
from ._frame import as_array, from_codes16, is_codes16
from ._stack import Stack, develop_one, value_texts, with_layers

TYPES = {
    "float": "float | str",
    "int": "int",
    "bool": "bool",
    "vec2": "tuple[float, float]",
    "vec3": "tuple[float, float, float]",
    "vec4": "tuple[float, float, float, float]",
    "rgb": "tuple[float, float, float]",
    "curve": "Sequence[tuple[float, float]]",
}
# What every entry may have beside its effect's parameters.
WIRES = ("input", "source", "second", "mask")
ENTRY = tuple(row["name"] for row in _engine.entry_parameters())


class Written(str):
    """An annotation that help() shows without quotes."""

    __repr__ = str.__str__


def annotation(row) -> str:
    """The type of a parameter, as stubs have it."""
    return Written(_type_of(row))


def _type_of(row):
    if row["type"] == "choice":
        return f"Literal[{', '.join(repr(choice) for choice in row['choices'])}]"
    if row["type"] == "resource":
        return "ndarray | str | PathLike[str] | None" if row["is_picture"] else "Table | str | PathLike[str] | None"
    return TYPES[row["type"]]


def parameters_text(effect) -> str:
    lines = ["Parameters", "----------"]
    for row in effect["parameters"]:
        interval = "" if row["type"] in ("choice", "bool", "resource") else f", allowed is {row['interval']}"
        lines += [f"{row['name']} : {annotation(row)}, default {row['default']!r}{interval}", f"    {row['doc']}"]
    return "\n".join(lines)


def page(effect) -> str:
    """What help() shows: the sentence, the parameters, and the effect's page."""
    needs = f"It needs {', '.join(effect['needs'])}.\n\n" if effect["needs"] else ""
    return f"{effect['doc']}\n\n{needs}{parameters_text(effect)}\n\n{effect['page']}".strip() + "\n"


# Of layers that are no arrays.
LAYER_TYPES = {"camera": "Camera", "lights": "Sequence[Light]", "exposure": "float", "time": "float", "delta_time": "float", "frame_index": "int"}


def layers_of(effect):
    """The layers that a function of the effect takes, beside its parameters."""
    taken = {row["name"] for row in effect["parameters"]}
    needs = ["lights" if name == "shadows" else name for name in effect["needs"]]
    wanted = [*needs, "velocity", "camera", "time", "delta_time", "frame_index"]
    known = [name for name in wanted if name not in taken]
    return list(dict.fromkeys(known))


def _keyword(name, default, kind):
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=Written(kind))


def _signature(first, effect, others, returned):
    rows = [_keyword(row["name"], row["default"], annotation(row)) for row in effect["parameters"]]
    return inspect.Signature([first, *rows, *others], return_annotation=Written(returned))


def output_of(image, is_last_step):
    """What a function makes of such an array: bytes of bytes, light of light; but codes where the effect makes them."""
    if getattr(image, "dtype", None) == "uint8":
        return "encoded8"
    return "encoded" if is_last_step or is_codes16(image) else "linear"


def as_given(picture, image):
    """A picture in the samples of the array that it was made of, as far as output_of has not seen to it."""
    if is_codes16(image):
        return numpy.rint(numpy.clip(picture, 0, 1) * numpy.float32(65535)).astype(numpy.uint16)
    return picture.astype("float16") if getattr(image, "dtype", None) == "float16" else picture


def make_function(effect):
    name, layers = effect["name"], layers_of(effect)

    def function(image, /, **values):
        given = {key: values.pop(key) for key in layers if key in values}
        if "second" in values:
            values["second"] = from_codes16(as_array(values["second"], f"{name}.second"))
        look = _engine.Look()
        entry = look.add(name, "", "", value_texts(values, name))
        # An amount of 0 switches an entry off; here it was asked for.
        if values.get("enabled", True):
            look.set(entry, [("enabled", "on")])
        frame = with_layers(image, given)
        color = as_array(frame.color, "color")
        runner = _device.runner(name, output_of(color, effect["is_last_step"]))
        picture = develop_one(runner, look, frame)
        for text in runner.left_out():
            raise Error(text)
        return as_given(picture, color)

    others = [_keyword("opacity", 1.0, "float"), _keyword("blend", "mix", "str")]
    if effect["has_second"]:
        others.append(_keyword("second", None, "ndarray | str | PathLike[str] | None"))
    others += [_keyword(layer, None, LAYER_TYPES.get(layer, "ndarray") + " | None") for layer in layers]
    first = inspect.Parameter("image", inspect.Parameter.POSITIONAL_ONLY, annotation=Written("ndarray | Frame"))
    function.__name__ = function.__qualname__ = name
    function.__module__ = "darkroom"
    function.__doc__ = page(effect)
    function.__signature__ = _signature(first, effect, others, "ndarray")
    return function


def make_method(effect):
    name = effect["name"]

    def method(self, /, **values):
        return self.add(name, **values)

    others = [_keyword("name", "", "str"), _keyword("output", "", "str")]
    others += [_keyword(row["name"], row["default"], annotation(row)) for row in _engine.entry_parameters()]
    others += [_keyword(wire, "", "str | PathLike[str] | ndarray") for wire in WIRES]
    first = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    method.__name__ = name
    method.__qualname__ = f"Stack.{name}"
    method.__module__ = "darkroom"
    method.__doc__ = f"Appends {name}: {effect['doc']}\n\n{parameters_text(effect)}\n"
    method.__signature__ = _signature(first, effect, others, "Stack")
    return method


EFFECTS = {effect["name"]: effect for effect in _engine.effects()}
FUNCTIONS = {name: make_function(effect) for name, effect in EFFECTS.items()}
for _name, _effect in EFFECTS.items():
    setattr(Stack, _name, make_method(_effect))
