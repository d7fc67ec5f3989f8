# SPDX-License-Identifier: MIT
"""Colour tables."""

import os

import numpy

from . import _engine
from ._error import Error, of_file, store


class Table:
    """A table of colours: Table(cube) of an array (n, n, n, 3), cube[red, green, blue], for inputs from min to max.

    What its numbers mean (encoded, logarithmic, linear) is for its user to know; the effect `lut` has parameters for it.
    """

    def __init__(self, cube, min=(0.0, 0.0, 0.0), max=(1.0, 1.0, 1.0), title: str = ""):
        cube = numpy.asarray(cube, dtype=numpy.float32)
        if cube.ndim == 4:
            cube = cube.transpose(2, 1, 0, 3)
        self._engine = _engine.Table(cube, tuple(min), tuple(max), title)

    @classmethod
    def _of(cls, engine):
        out = cls.__new__(cls)
        out._engine = engine
        return out

    @classmethod
    def read(cls, path) -> "Table":
        """A .cube file (Adobe, "Cube LUT Specification", version 1.0, 2013). darkroom.files.table reads others."""
        with of_file(path):
            return cls._of(_engine.Table.read(os.fspath(path)))

    @classmethod
    def identity(cls, size: int = 33) -> "Table":
        """The table that changes nothing, for tools that paint over one."""
        axis = numpy.linspace(0, 1, size, dtype=numpy.float32)
        return cls(numpy.stack(numpy.meshgrid(axis, axis, axis, indexing="ij"), axis=-1))

    @property
    def cube(self):
        """The entries: cube[red, green, blue]; of no size where there is a shaper alone."""
        return self._engine.cube.transpose(2, 1, 0, 3)

    @property
    def shaper(self):
        """The curves before the cube, an array (n, 3); of no size where there are none."""
        return self._engine.shaper

    @property
    def title(self) -> str:
        return self._engine.title

    def __call__(self, colors, interpolation: str = "tetrahedral"):
        """What the table says of colours, an array (..., 3), worked out on the CPU in double precision."""
        if interpolation not in ("tetrahedral", "trilinear"):
            raise Error(f"interpolation = {interpolation!r}: allowed is 'tetrahedral' or 'trilinear'")
        return self._engine.colors(numpy.asarray(colors), interpolation == "trilinear")

    def write(self, path) -> None:
        """Writes a .cube file."""
        store(path, self._engine.text().encode())
