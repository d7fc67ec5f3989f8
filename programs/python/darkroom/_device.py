# SPDX-License-Identifier: MIT
"""The Vulkan device that everything runs on, made when it is first needed."""

import atexit
import collections
import os
import threading

from . import _engine
from ._error import Error

TARGETS = {
    "encoded8": _engine.Target.encoded8,
    "encoded": _engine.Target.encoded,
    "linear": _engine.Target.linear,
}
_MOST_RUNNERS = 8  # each keeps the images of its stack

_lock = threading.RLock()
_device = None
_select = os.environ.get("DARKROOM_DEVICE", "")
_runners = collections.OrderedDict()


def devices() -> list:
    """The Vulkan devices of this machine, best first: index, name, driver, is_software, is_usable and reason of each."""
    return _engine.devices()


def use_device(name: str | int = "") -> str:
    """From here on pictures are developed on this device: a part of its name, or its index. Gives its name.

    Without a name it is a GPU, if there is one. DARKROOM_DEVICE in the environment says which one is taken first.
    Stacks take theirs with their next picture, sequences keep the one they began on.
    """
    global _device, _select
    made = _engine.Device(str(name), False)
    with _lock:
        free()
        _device = made
        _select = str(name)
    return made.name


def device():
    """The device there is: its name, driver, is_software, validation_messages."""
    global _device
    with _lock:
        if _device is None:
            _device = _engine.Device(_select, False)
        return _device


def free() -> None:
    """Gives back the memory that finished pictures have left for the next ones, and the device."""
    global _device
    with _lock:
        _runners.clear()
        _device = None


def target_of(output):
    if output not in TARGETS:
        raise Error(f"output = {output!r}: allowed is {', '.join(map(repr, TARGETS))}")
    return TARGETS[output]


def sized(size):
    """The extent of pictures that have one of their own; (0, 0): they have not."""
    if size is None:
        return 0, 0
    try:
        width, height = (int(side) for side in size)
    except (TypeError, ValueError):
        width = height = 0
    if width < 1 or height < 1:
        raise Error(f"size = {size!r}: allowed is (width, height) in pixels, each at least 1")
    return width, height


def new_runner(output, frames_in_flight, size=None):
    return _engine.Runner(device(), target_of(output), frames_in_flight, sized(size))


def runner(key, output, size=None):
    """One for single pictures, shared by all that ask with this key; the least recently used goes first."""
    with _lock:
        key = (key, output, sized(size))
        found = _runners.pop(key, None) or new_runner(output, 1, size)
        _runners[key] = found
        while len(_runners) > _MOST_RUNNERS:
            _runners.popitem(last=False)
        return found


atexit.register(free)
