# SPDX-License-Identifier: MIT
"""Arrays in and out, and what is done to them."""

import pickle
import sys
import threading
import time
import unittest
import warnings

import numpy

import darkroom
from darkroom import _device, _frame, _stack
from support import Case, light


class Tensor:
    """An array of another library: it has DLPack's two functions and nothing else."""

    def __init__(self, array, device=1):
        self.array, self.device = array, device

    def __dlpack__(self, stream=None):
        return self.array.__dlpack__()

    def __dlpack_device__(self):
        return self.device, 0


class Arrays(Case):
    def test_every_kind_of_sample_is_the_same_picture(self):
        floats = darkroom.develop(light())
        self.assertEqual((floats.shape, floats.dtype), ((27, 48, 3), numpy.uint8))
        self.assertGreater(floats.std(), 20)
        self.assertSame(darkroom.develop(light(dtype=numpy.float16)), floats)
        four = darkroom.develop(light(channels=4))
        self.assertSame(four[..., :3], floats)
        self.assertSame(four[..., 3], numpy.full((27, 48), 255, numpy.uint8))

    def test_bytes_are_codes_of_srgb(self):
        codes = numpy.arange(256, dtype=numpy.uint8).repeat(3).reshape(1, 256, 3)
        unchanged = darkroom.Stack().exposure(exposure=1.0)
        self.assertSame(unchanged.develop(codes), codes)
        linear = unchanged.develop(codes, output="linear")[0, :, 0]
        values = numpy.arange(256) / 255
        expected = numpy.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
        # Between kernels pictures are half floats.
        numpy.testing.assert_allclose(linear, expected, rtol=2**-10)

    def test_rows_that_do_not_lie_one_after_the_other_are_copied(self):
        wide = light(96, 27)
        self.assertSame(darkroom.develop(wide[:, ::2]), darkroom.develop(wide[:, ::2].copy()))

    def test_outputs(self):
        stack = darkroom.Stack().exposure(exposure=2.0)
        linear = stack.develop(light(), output="linear")
        self.assertSame(linear, light() * 2)
        encoded = stack.develop(light(), output="encoded")
        self.assertEqual(encoded.dtype, numpy.float32)
        codes = stack.develop(light())
        # Half a code, and what a device may do to the last bit.
        self.assertLess(numpy.abs(encoded.clip(0, 1) * 255 - codes).max(), 0.51)
        self.assertEqual(stack.develop(light(), size=(24, 20)).shape, (20, 24, 3))
        self.assertRaisesText(
            "output = 'jpeg': allowed is 'encoded8', 'encoded', 'linear'", stack.develop, light(), output="jpeg"
        )
        self.assertRaisesText(
            "size = (0, 4): allowed is (width, height) in pixels, each at least 1", stack.develop, light(), size=(0, 4)
        )

    def test_functions_give_what_they_are_given(self):
        for dtype in (numpy.float16, numpy.float32):
            self.assertSame(darkroom.exposure(light(dtype=dtype), exposure=2), light(dtype=dtype) * dtype(2))
        codes = darkroom.develop(light())
        self.assertSame(darkroom.exposure(codes, exposure=1.0), codes)
        self.assertSame(darkroom.bloom(light(), intensity=0.0), light())
        stack = darkroom.Stack().bloom(intensity=0.5)
        self.assertSame(darkroom.bloom(light(), intensity=0.5), stack.develop(light(), output="linear"))

    def test_what_cannot_be_read_is_refused(self):
        allowed = "allowed is uint8, uint16, float16, float64 or float32"
        wrong = [
            (light().astype(numpy.int32), f"color: dtype int32: {allowed}"),
            (light().astype(numpy.complex64), f"color: dtype complex64: {allowed}"),
            (light()[..., 0], "color: shape (27, 48): allowed is (height, width, 3 or 4), none of them 0"),
            (light()[:0], "color: shape (0, 48, 3): allowed is (height, width, 3 or 4), none of them 0"),
            ([[1.0]], "color: a list: allowed is a numpy array, or what exports one (__dlpack__, __array__)"),
        ]
        for array, text in wrong:
            self.assertEqual(self.assertRaisesText(text, darkroom.develop, array).fault, "user")
        shape = "depth: 47x27 pixels: allowed is 48x27"
        self.assertRaisesText(shape, darkroom.develop, light(), depth=numpy.ones((27, 47), numpy.float32))
        text = "normals: shape (27, 48, 2): allowed is (height, width, 3), none of them 0"
        self.assertRaisesText(text, darkroom.develop, light(), normals=numpy.ones((27, 48, 2), numpy.float32))
        with self.assertRaisesRegex(darkroom.Error, "^frame: no layer 'deepth', did you mean 'depth'. allowed is camera"):
            darkroom.develop(light(), deepth=1)

    def test_longer_floats_are_converted_and_that_is_said_once(self):
        _frame._said.clear()
        stack, expected = darkroom.Stack.default(), darkroom.develop(light())
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            for array in (light().astype(numpy.float64), light().astype(numpy.float64), light().astype(">f8")):
                self.assertSame(stack.develop(array), expected)
        texts = [(str(one.message), one.filename) for one in caught]
        self.assertEqual(texts, [("color: dtype float64: it is converted to float32, here and from now on", __file__)])
        self.assertSame(darkroom.exposure(light().astype(numpy.float64), exposure=2), light() * numpy.float32(2))
        self.assertSame(darkroom.develop(light().astype(">f4")), expected)

    def test_what_changes_nothing_or_stands_in_a_wrong_place_is_told(self):
        wrong = darkroom.Stack().tonemap().color_grade().encode()
        idle = darkroom.Stack.default().set("vignette", smoothness=0.4)
        meant = darkroom.Stack.default().set("vignette", smoothness=0.4).set("vignette", enabled=True)
        texts = []
        for stack in (wrong, idle, meant):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                stack.develop(light())
                list(stack.sequence([light()]))
            texts.append([str(one.message) for one in caught])
        place = "color_grade expects a picture that is scene_linear; this one is display_linear."
        nothing = "vignette.smoothness changes nothing: vignette is off; vignette_enabled = true switches it on"
        self.assertEqual(texts, [[place] * 2, [nothing] * 2, []])

    def test_16_bits_are_code_values(self):
        codes = darkroom.develop(light())
        wide = codes.astype(numpy.uint16) * numpy.uint16(257)
        # The same picture in either: what the device decodes bytes by is within a code of the standard's curve.
        apart = darkroom.develop(wide).astype(int) - darkroom.develop(codes).astype(int)
        self.assertLessEqual(numpy.abs(apart).max(), 1)
        # Given back as they came, finer than bytes are, with alpha.
        fine = numpy.dstack([numpy.arange(0, 65536, 19, dtype=numpy.uint16)[:3200].reshape(40, 80)] * 4)
        back = darkroom.exposure(fine, exposure=1.0)
        self.assertEqual((back.dtype, back.shape), (numpy.uint16, fine.shape))
        self.assertLessEqual(numpy.abs(back.astype(int) - fine.astype(int)).max(), 24)  # halves on the way
        self.assertEqual(darkroom.compare(wide, codes).max_error, 0)

    def test_layers_are_read(self):
        depth = numpy.full((27, 48), 50.0, numpy.float32)
        dark = light() * numpy.float32(0.125)
        fogged = darkroom.fog(dark, depth=depth, density=0.05, start=0.0, end=100.0, color=(0, 0, 1))
        self.assertGreater(fogged[..., 2].mean(), dark[..., 2].mean() + 0.5)
        half = darkroom.fog(dark, depth=depth.astype(numpy.float16)[..., None], density=0.05, start=0.0, end=100.0,
                            color=(0, 0, 1))  # fmt: skip
        self.assertSame(half, fogged)
        self.assertRaisesText("fog: needs depth, which the frame does not have", darkroom.fog, light())
        with self.assertWarnsRegex(UserWarning, "fog: needs depth, which the frame does not have"):
            darkroom.Stack().fog().develop(light())

    def test_dlpack(self):
        picture = darkroom.develop(Tensor(light()))
        self.assertSame(picture, darkroom.develop(light()))
        again = numpy.from_dlpack(picture)
        self.assertTrue(numpy.shares_memory(again, picture))
        self.assertRaisesText("color: on DLPack's device 2: allowed is 1, main memory", darkroom.develop,
                              Tensor(light(), 2))  # fmt: skip


class Errors(Case):
    def test_text_fault_and_code(self):
        error = self.assertRaisesText("bloom.intensity = 99: allowed is [0, 16]", darkroom.bloom, light(), intensity=99)
        self.assertEqual((error.fault, error.code), ("user", "other"))
        copy = pickle.loads(pickle.dumps(error))
        self.assertEqual((copy.text, copy.fault, copy.code), (error.text, error.fault, error.code))
        with self.assertRaisesRegex(darkroom.Error, "^bloom.intensty: .* did you mean 'intensity'"):
            darkroom.bloom(light(), intensty=1)
        with self.assertRaisesRegex(darkroom.Error, r"^no effect 'blom', did you mean 'bloom'\?"):
            darkroom.Stack().add("blom")
        with self.assertRaisesRegex(darkroom.Error, "^camera.fov = 180"):
            darkroom.develop(light(), camera=darkroom.Camera(fov=180))
        with self.assertRaisesRegex(darkroom.Error, "nosuch.toml"):
            darkroom.develop(light(), "nosuch.toml")

    def test_they_are_also_what_python_calls_such_errors(self):
        with self.assertRaises(ValueError):
            darkroom.bloom(light(), intensity=99)
        for call in (darkroom.Stack, darkroom.Table.read, darkroom.files.read_frame):
            with self.assertRaises(FileNotFoundError) as caught:
                call("nosuch.file")
            self.assertIsInstance(caught.exception, darkroom.Error)
        with self.assertRaises(OSError) as caught:
            darkroom.Stack().bloom().save("no such folder/look.toml")
        self.assertEqual(caught.exception.fault, "machine")
        for kind in (ValueError, OSError):
            self.assertNotIsInstance(darkroom.Error("text", "machine" if kind is ValueError else "user"), kind)
        lost = pickle.loads(pickle.dumps(darkroom.Error("lost", "machine", "device_lost")))
        self.assertEqual((str(lost), lost.fault, lost.code, lost.errno), ("lost", "machine", "device_lost", None))

    def test_unknown_names_tell_the_nearest(self):
        with self.assertRaisesRegex(darkroom.Error, "^no effect 'blom', did you mean 'bloom'. there are "):
            darkroom.info("blom")
        with self.assertRaisesRegex(AttributeError, "did you mean 'vignette'"):
            darkroom.Stack().vignete()
        with self.assertRaisesRegex(AttributeError, "did you mean 'develop'"):
            darkroom.develope
        self.assertFalse(hasattr(darkroom.Stack(), "qqq"))


class Threads(Case):
    def test_the_lock_is_released_while_the_library_works(self):
        # No thread is made to give the lock back, so the other one runs where it is given back alone.
        ticks, is_over, interval = [0], threading.Event(), sys.getswitchinterval()

        def count():
            while not is_over.is_set():
                ticks[0] += 1
                time.sleep(0.0005)

        stack, frame = darkroom.Stack().bloom(intensity=0.1).tonemap(), darkroom.Frame(light(480, 270, channels=4))
        runner = _device.new_runner("encoded8", 1)
        _stack.develop_one(runner, stack._look, frame)
        other = threading.Thread(target=count)
        sys.setswitchinterval(1000)
        try:
            other.start()
            for _ in range(500):
                before = ticks[0]
                _stack.develop_one(runner, stack._look, frame)  # its picture has four channels: nothing is packed
                if ticks[0] > before:
                    break
            self.assertGreater(ticks[0], before)
        finally:
            is_over.set()
            sys.setswitchinterval(interval)
            other.join()

    def test_one_stack_from_several_threads(self):
        stack = darkroom.Stack().exposure(exposure=1.0)
        found = {}

        def develop(number):
            picture = numpy.full((9, 11, 3), number / 4, numpy.float32)
            found[number] = [stack.develop(picture, output="linear") for _ in range(5)]

        threads = [threading.Thread(target=develop, args=(number,)) for number in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for number, pictures in found.items():
            for picture in pictures:
                self.assertSame(picture, numpy.full((9, 11, 3), number / 4, numpy.float32))


class Comparisons(Case):
    def test_equal_pictures_and_known_errors(self):
        picture = darkroom.develop(light())
        same = darkroom.compare(picture, picture)
        self.assertEqual((same.flip_mean, same.max_error, same.psnr), (0, 0, float("inf")))
        other = picture.copy()
        other[3, 5] = 255 - other[3, 5]
        found = darkroom.compare(picture, other)
        self.assertEqual(found.worst, (5, 3))
        error = numpy.abs(picture[3, 5].astype(float) - other[3, 5]) / 255
        self.assertAlmostEqual(found.max_error, error.max(), places=6)
        self.assertAlmostEqual(found.psnr, 10 * numpy.log10(picture.size / (error**2).sum()), places=4)
        self.assertEqual(found.flip_map.shape, picture.shape)
        self.assertRaisesText("test: 48x26 pixels: allowed is 48x27, the reference's", darkroom.compare, picture,
                              picture[1:])  # fmt: skip
        self.assertRaisesText("compare: uint8 and float32: is_linear says what the floats are", darkroom.compare,
                              picture, light())  # fmt: skip


if __name__ == "__main__":
    unittest.main()
