# SPDX-License-Identifier: MIT
"""Darkroom develops raw HDR frames into finished pictures, on any Vulkan device.

    import darkroom

    picture = darkroom.develop(frame)                         # what `darkroom develop` does
    glowing = darkroom.bloom(frame, intensity=0.1)            # one effect; help(darkroom.bloom) is its page
    stack = darkroom.Stack().bloom(intensity=0.1).tonemap()
    for picture in stack.sequence(frames, fps=24):            # histories live
        ...

Pictures are arrays of height x width x 3 or 4: float16 and float32 are scene-linear light, uint8 and
uint16 code values of sRGB.
Every effect is a function here and a method of Stack. Scenes, picture files and other tables are in darkroom.files.
"""

from . import _effects, _engine
from ._compare import Comparison, compare
from ._device import device, devices, free, use_device
from ._error import Error, nearest
from ._frame import Camera, Frame, Light
from ._stack import Stack, develop
from ._table import Table

__version__ = _engine.version

globals().update(_effects.FUNCTIONS)

__all__ = [
    "Camera", "Comparison", "Error", "Frame", "Light", "Stack", "Table", "compare", "develop", "device", "devices", "effect_names",
    "files", "free", "info", "use_device", *_effects.FUNCTIONS,
]  # fmt: skip


def effect_names() -> list:
    """The effects of this build."""
    return list(_effects.EFFECTS)


def info(effect: str | None = None) -> dict:
    """Of an effect its parameters, with default, type and what is allowed, and what it needs; else of this build."""
    if effect is None:
        found = device()
        return {
            "version": __version__,
            "device": found.name,
            "driver": found.driver,
            "is_software": found.is_software,
            "effects": effect_names(),
        }
    if effect not in _effects.EFFECTS:
        near = nearest(effect, effect_names()) or ":"
        raise Error(f"no effect '{effect}'{near} there are {', '.join(effect_names())}")
    return _effects.EFFECTS[effect]


def __getattr__(name):
    # Loaded when it is first used: it brings modules that few need.
    if name == "files":
        import importlib

        return importlib.import_module(".files", __name__)
    raise AttributeError(f"module 'darkroom' has no attribute '{name}'{nearest(name, __all__)}")
