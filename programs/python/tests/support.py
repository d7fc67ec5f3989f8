# SPDX-License-Identifier: MIT
"""What the tests of the package share. DARKROOM_SOURCE is the tree, DARKROOM_PROGRAM its program."""

import os
import pathlib
import unittest

import numpy

import darkroom

source = pathlib.Path(os.environ.get("DARKROOM_SOURCE", pathlib.Path(__file__).resolve().parents[3]))


def light(width=48, height=27, channels=3, dtype=numpy.float32):
    """A picture of light from 0 to 8, with a bright spot; all of it halves."""
    y, x = numpy.mgrid[0:height, 0:width]
    planes = [(x % 16) / 16, (y % 8) / 8, ((x + y) % 32) / 16, numpy.ones_like(x)]
    out = numpy.stack(planes[:channels], axis=-1).astype(dtype)
    out[height // 2, width // 2, :3] = 8
    return out


class Case(unittest.TestCase):
    """Whatever it runs, the validation layer has nothing to say."""

    def setUp(self):
        self.messages = darkroom.device().validation_messages

    def tearDown(self):
        self.assertEqual(darkroom.device().validation_messages, self.messages, "the validation layer complains")

    def assertRaisesText(self, text, call, *arguments, **named):
        with self.assertRaises(darkroom.Error) as caught:
            call(*arguments, **named)
        self.assertEqual(caught.exception.text, text)
        self.assertEqual(str(caught.exception), text)
        return caught.exception

    def assertSame(self, a, b):
        self.assertEqual(a.dtype, b.dtype)
        numpy.testing.assert_array_equal(a, b)
