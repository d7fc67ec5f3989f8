# SPDX-License-Identifier: MIT
"""How far two pictures are apart."""

import dataclasses

import numpy

from . import _engine
from ._error import Error
from ._frame import as_array, from_codes16


@dataclasses.dataclass
class Comparison:
    """What a viewer would notice (FLIP, 0 to 1; Andersson et al., 2020 and 2021) and errors of the numbers.

    flip_map is a picture of the errors, encoded, in magma. psnr is in dB, infinite where nothing differs. worst is the
    place (x, y) of the largest error.
    """

    flip_mean: float
    flip_weighted_median: float
    flip_max: float
    psnr: float
    max_error: float
    mean_error: float
    worst: tuple
    non_finite_differences: int
    flip_map: numpy.ndarray = dataclasses.field(repr=False)


def compare(reference, test, *, is_linear: bool | None = None, pixels_per_degree: float = 67.02064327658226):
    """Compares two pictures of one size, as `darkroom compare` does.

    is_linear: scene-linear light, for which FLIP looks at many exposures; else code values of sRGB, bytes or floats of 0
    to 1. None: it is where both are floats. pixels_per_degree of visual angle: the default is a display 0.7 m and 3840
    pixels wide, seen from 0.7 m.
    """
    reference, test = as_array(reference, "reference"), as_array(test, "test")
    kinds = [getattr(getattr(array, "dtype", None), "kind", "f") for array in (reference, test)]
    if is_linear is None:
        if kinds[0] != kinds[1]:
            raise Error(f"compare: {reference.dtype} and {test.dtype}: is_linear says what the floats are")
        is_linear = kinds[0] == "f"
    pictures = from_codes16(reference), from_codes16(test)
    return Comparison(**_engine.compare(*pictures, is_linear, pixels_per_degree))
