# SPDX-License-Identifier: MIT
"""Tensors of another library in and out, by DLPack: of PyTorch where it is installed, else of a stand-in."""

import numpy

import darkroom

try:
    import torch

    tensor = torch.rand(48, 64, 3)
    back = torch.from_dlpack
except ImportError:

    class Tensor:
        """What every library of tensors exports."""

        def __init__(self, array):
            self.array = array

        def __dlpack__(self, **arguments):
            return self.array.__dlpack__()

        def __dlpack_device__(self):
            return self.array.__dlpack_device__()

    tensor = Tensor(numpy.random.default_rng(1).random((48, 64, 3), dtype=numpy.float32))
    back = numpy.from_dlpack

glowing = back(darkroom.bloom(tensor, intensity=0.5, threshold=0.5))  # both ways over the same memory
print(f"{type(tensor).__module__}.{type(tensor).__name__} -> {type(glowing).__module__}, mean {float(glowing.mean()):.3f}")
