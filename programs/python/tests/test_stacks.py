# SPDX-License-Identifier: MIT
"""Stacks, sequences, tables, and that functions and stubs are those of the effects."""

import ast
import inspect
import os
import pathlib
import re
import tempfile
import unittest
import unittest.mock

import numpy

import darkroom
from darkroom import _device
from support import Case, light, source


class Stacks(Case):
    def test_a_stack_is_a_look(self):
        stack = darkroom.Stack().exposure(exposure=2.0).bloom(intensity=0.25, mode="energy_conserving").tonemap()
        self.assertEqual(stack.names, ["exposure", "bloom", "tonemap"])
        again = darkroom.Stack.parse(stack.text)
        self.assertEqual(again.values("bloom"), stack.values("bloom"))
        self.assertSame(again.develop(light()), stack.develop(light()))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "own.toml")
            stack.save(path)
            self.assertSame(darkroom.develop(light(), path), stack.develop(light()))

    def test_values_are_set_and_read(self):
        stack = darkroom.Stack().exposure(exposure=1.0).exposure(exposure="1ev", name="second")
        self.assertEqual(stack.values("second")["exposure"], 2.0)
        self.assertSame(stack.develop(light(), output="linear"), light() * 2)
        stack.set("second", exposure=numpy.float32(0.5), enabled=True)
        self.assertSame(stack.develop(light(), output="linear"), light() * numpy.float32(0.5))
        stack.set("second", enabled=False)
        self.assertSame(stack.develop(light(), output="linear"), light())
        self.assertEqual(stack.copy().remove("second").names, ["exposure"])
        self.assertEqual(len(stack), 2)
        before = stack.text
        for wrong in ({"exposure": -1}, {"exposure": 0.25, "opacity": 2}):
            with self.assertRaises(darkroom.Error):
                stack.set("second", **wrong)
        self.assertEqual(stack.text, before)

    def test_wires_and_masks(self):
        mask = numpy.zeros((27, 48, 3), numpy.float32)
        mask[:, 24:] = 1
        stack = darkroom.Stack().exposure(exposure=2.0, mask=mask)
        out = stack.develop(light(), output="linear")
        self.assertSame(out[:, :24], light()[:, :24])
        # A mask counts as its luminance, whose weights add up to nearly 1.
        numpy.testing.assert_allclose(out[:, 24:], light()[:, 24:] * 2, rtol=2**-11)
        with self.assertRaisesRegex(darkroom.Error, "^stack: exposure.mask is in memory"):
            stack.text
        wired = darkroom.Stack().exposure(exposure=4.0, output="bright").exposure(exposure=1.0, input="scene")
        self.assertSame(wired.develop(light(), output="linear"), light())
        with self.assertRaisesRegex(darkroom.Error, "nosuch"):
            wired.add("exposure", input="nosuch")
        self.assertEqual(wired.names, ["exposure", "exposure#2"])

    def test_shipped_looks(self):
        film = darkroom.Stack(source / "looks" / "film.toml")
        self.assertSame(film.develop(light()), darkroom.develop(light(), source / "looks" / "film.toml"))
        self.assertEqual(darkroom.Stack("film").text, film.text)
        with self.assertRaisesRegex(FileNotFoundError, "^flim: no such file, and .*, did you mean 'film'\\?$"):
            darkroom.Stack("flim")
        self.assertGreater(darkroom.compare(film.develop(light()), darkroom.develop(light())).flip_mean, 0.01)
        with self.assertWarnsRegex(UserWarning, "look:1:1: "):
            darkroom.Stack.parse("nosuch = 1\n[post_process]\nexposure = 2.0\n")

    def test_effects_of_files(self):
        file = source / "examples" / "duotone.glsl"
        stack = darkroom.Stack().tonemap().add(file, shadow=(0, 0, 1), highlight=(1, 1, 1))
        self.assertEqual(stack.names, ["tonemap", "duotone"])
        self.assertEqual(tuple(stack.develop(numpy.zeros((4, 4, 3), numpy.float32))[0, 0]), (0, 0, 255))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "look.toml")
            stack.save(path)
            with self.assertRaises(darkroom.Error):
                darkroom.Stack(path, allows_custom_effects=False)

    def test_the_plan_is_told(self):
        stack = darkroom.Stack().bloom().tonemap()
        self.assertEqual(stack.plan(), "")
        stack.develop(light())
        self.assertIn("48 x 27", stack.plan())
        self.assertIn("bloom", stack.plan())


class Sequences(Case):
    def frames(self, count):
        return [numpy.full((6, 8, 3), float(number % 2), numpy.float32) for number in range(count)]

    def test_histories_live(self):
        stack = darkroom.Stack().recursive_blend(weight=0.5)
        pictures = list(stack.sequence(self.frames(4), output="linear"))
        means = [float(picture.mean()) for picture in pictures]
        # out = weight * before + (1 - weight) * now, from the first frame on
        expected, last = [], 0.0
        for number in range(4):
            last = float(number % 2) if number == 0 else 0.5 * last + 0.5 * (number % 2)
            expected.append(last)
        numpy.testing.assert_allclose(means, expected, rtol=1e-3)
        # Single pictures have none, and the next sequence begins anew.
        self.assertSame(stack.develop(self.frames(2)[1], output="linear"), self.frames(2)[1])
        self.assertSame(numpy.stack(list(stack.sequence(self.frames(4), output="linear"))), numpy.stack(pictures))

    def test_a_stack_that_is_made_anew_keeps_the_plan_and_its_histories(self):
        runner = _device.new_runner("linear", 1)
        for number, expected in enumerate((0.0, 0.5)):
            stack = darkroom.Stack().recursive_blend(weight=0.5)
            frame = darkroom.Frame(self.frames(2)[number])._described(
                darkroom.Camera()._described(8, 6, None), number / 60, 1 / 60, number
            )
            numpy.testing.assert_allclose(runner.develop(stack._look, frame), expected, rtol=1e-3)

    def test_sequences_beside_each_other_do_not_meet(self):
        stack = darkroom.Stack().recursive_blend(weight=0.5)
        alone = list(stack.sequence(self.frames(5), output="linear"))
        pairs = zip(stack.sequence(self.frames(5), output="linear"), stack.sequence(self.frames(5), output="linear"))
        for expected, (one, other) in zip(alone, pairs):
            self.assertSame(one, expected)
            self.assertSame(other, expected)

    def test_values_may_be_set_meanwhile(self):
        stack = darkroom.Stack().exposure(exposure=1.0)
        ones = (numpy.ones((27, 48, 3), numpy.float32) for _ in range(6))
        seen = []
        for number, picture in enumerate(stack.sequence(ones, output="linear")):
            seen.append(float(picture.mean()))
            if number == 0:
                stack.set("exposure", exposure=3.0)
            if number == 1:
                stack.bloom(intensity=1.0, threshold=0.5)  # another plan: frames under way are not lost
        self.assertEqual(len(seen), 6)
        self.assertEqual(seen[:2], [1.0, 1.0])
        self.assertIn(3.0, seen)
        self.assertGreater(seen[-1], 3.0)

    def test_events_fire_pulses_and_layers_have_weights(self):
        stack = darkroom.Stack.parse(
            """
            format = 1
            [[stack]]
            effect = "exposure"
            exposure = 1.0
            [[pulse]]
            event = "hit"
            parameter = "exposure.exposure"
            amount = 1.0
            duration = 0.4
            [[layer]]
            name = "cave"
            values = { "exposure.exposure" = 4.0 }
            """
        )
        ones = numpy.ones((6, 8, 3), numpy.float32)

        def means(*frames):
            return [float(one.mean()) for one in stack.sequence([{"color": ones, **f} for f in frames], fps=10, output="linear")]

        # Linear: from 1 to 0 in 0.4 s.
        numpy.testing.assert_allclose(means({}, {"fire": "hit"}, {}, {}, {}, {}), [1, 2, 1.75, 1.5, 1.25, 1], rtol=1e-3)
        self.assertEqual(means({}, {}), [1, 1])
        numpy.testing.assert_allclose(means({}, {"layer_weights": {"cave": 1}}, {}), [1, 4, 1], rtol=1e-3)
        self.assertEqual(stack.develop(ones, output="linear", layer_weights={"cave": 1}).mean(), 4)
        self.assertEqual(stack.develop(ones, output="linear").mean(), 1)
        for wrong, text in (
            ({"fire": ["hit", "hti"]}, 'fire = "hti": no pulse of look has this event'),
            ({"layer_weights": {"cve": 1}}, "layer_weights: look has no layer 'cve'"),
            ({"layer_weights": {"cave": 2}}, "allowed is"),
        ):
            with self.assertRaisesRegex(darkroom.Error, re.escape(text)):
                means({}, wrong)
        with self.assertRaisesRegex(darkroom.Error, "^fire = 'hit': a picture by itself has no time"):
            stack.develop(ones, fire="hit")

    def test_time_and_camera_go_on(self):
        taken = []

        class Recorder:
            def submit(self, look, frame):
                taken.append(frame)

            def misplaced(self):
                return []

            def finish(self):
                return numpy.zeros((27, 48, 3), numpy.uint8)

        moved = numpy.eye(4, dtype=numpy.float32)
        moved[0, 3] = 2
        frames = [
            darkroom.Frame(light(), camera=darkroom.Camera(fov=50)),
            darkroom.Frame(light(), camera=darkroom.Camera(view=moved, fov=60)),
            darkroom.Frame(light(), camera=darkroom.Camera(previous_view=moved, is_cut=True), time=9.0, frame_index=70),
        ]
        with unittest.mock.patch.object(_device, "new_runner", lambda *arguments: Recorder()):
            self.assertEqual(len(list(darkroom.Stack().bloom().sequence(frames, fps=25))), 3)
        self.assertEqual([frame["time"] for frame in taken], [0, 0.04, 9.0])
        self.assertEqual([frame["delta_time"] for frame in taken], [0.04] * 3)
        self.assertEqual([frame["frame_index"] for frame in taken], [0, 1, 70])
        cameras = [frame["camera"] for frame in taken]
        self.assertEqual([camera["is_cut"] for camera in cameras], [True, False, True])
        self.assertSame(cameras[0]["previous_view"], cameras[0]["view"])
        self.assertSame(cameras[1]["view"], moved)
        self.assertSame(cameras[1]["previous_view"], cameras[0]["view"])
        self.assertSame(cameras[1]["previous_projection"], cameras[0]["projection"])
        self.assertSame(cameras[2]["previous_view"], moved)
        # y down, as tall as fov says: a point at half the angle lies on the upper edge.
        up = cameras[0]["projection"] @ numpy.float32([0, numpy.tan(numpy.radians(25)), -1, 1])
        numpy.testing.assert_allclose(up[1] / up[3], -1, rtol=1e-6)

    def test_frames_say_what_they_are(self):
        stack = darkroom.Stack().exposure(exposure=1.0)
        frames = [darkroom.Frame(light(), camera=darkroom.Camera(fov=50)), {"color": light()}, light()]
        self.assertEqual([picture.shape for picture in stack.sequence(frames, fps=24)], [(27, 48, 3)] * 3)
        self.assertRaisesText("fps = 0: allowed is above 0", stack.sequence, frames, fps=0)
        self.assertEqual(list(stack.sequence([])), [])


class Tables(Case):
    def test_arrays_files_and_the_effect_agree(self):
        cube = darkroom.Table.identity(5).cube ** 2
        cube[..., 0] *= 0.5
        table = darkroom.Table(cube, title="darker")
        colors = numpy.random.default_rng(3).random((13, 17, 3)).astype(numpy.float32)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "darker.cube")
            table.write(path)
            again = darkroom.Table.read(path)
            self.assertEqual(again.title, "darker")
            self.assertSame(again.cube, cube)
            looked_up = darkroom.lut(colors, lut=path, space="scene_linear")
        self.assertSame(looked_up, darkroom.lut(colors, lut=table, space="scene_linear"))
        self.assertSame(darkroom.Table.identity(2)(colors), colors)
        self.assertRaisesText("table: allowed is an array (n, n, n, 3), n in [2, 256]", darkroom.Table, colors)
        # sRGB code values, interpolated alike
        display = darkroom.lut(colors, lut=table)
        encoded = numpy.where(colors <= 0.0031308, colors * 12.92, 1.055 * colors ** (1 / 2.4) - 0.055)
        value = table(encoded)
        expected = numpy.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
        numpy.testing.assert_allclose(display, expected, atol=2e-3)


class Descriptions(Case):
    def test_every_effect_is_a_function_and_a_method(self):
        self.assertGreater(len(darkroom.effect_names()), 40)
        for name in darkroom.effect_names():
            info = darkroom.info(name)
            function = getattr(darkroom, name)
            rows = [row["name"] for row in info["parameters"]]
            self.assertEqual(list(inspect.signature(function).parameters)[1 : len(rows) + 1], rows, name)
            for row in info["parameters"]:
                self.assertEqual(inspect.signature(function).parameters[row["name"]].default, row["default"])
                self.assertIn(row["doc"], function.__doc__)
            page = (source / "effects" / name / f"{name}.md").read_text(encoding="utf-8")
            self.assertIn(page.strip(), function.__doc__, name)
            self.assertIn(info["doc"], getattr(darkroom.Stack, name).__doc__)

    def test_stubs_are_of_this_build(self):
        stub = pathlib.Path(darkroom.__file__).with_name("__init__.pyi").read_text(encoding="utf-8")
        tree = ast.parse(stub)
        defined = {node.name: node for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
        imported = {name.asname for node in tree.body if isinstance(node, ast.ImportFrom) for name in node.names}
        self.assertEqual(set(darkroom.__all__) - set(defined) - imported, set())
        methods = {node.name: node for node in defined["Stack"].body if isinstance(node, ast.FunctionDef)}

        def names(node):
            arguments = node.args
            return [one.arg for one in [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]]

        for name in darkroom.effect_names():
            self.assertEqual(names(defined[name]), list(inspect.signature(getattr(darkroom, name)).parameters), name)
        for name, method in inspect.getmembers(darkroom.Stack, inspect.isroutine):
            if name.startswith("_"):
                continue
            expected = [p.name for p in inspect.signature(method).parameters.values() if p.kind is not p.VAR_KEYWORD]
            found = names(methods[name])
            self.assertEqual(found[1:] if found[0] == "cls" else found, expected, name)
        for name in ("Camera", "Frame", "Light", "Comparison", "Table"):
            has = {node.name for node in defined[name].body if isinstance(node, ast.FunctionDef)}
            has |= {node.target.id for node in defined[name].body if isinstance(node, ast.AnnAssign)}
            public = {member for member in dir(getattr(darkroom, name)) if not member.startswith("_")}
            self.assertEqual(public - has, set(), name)


if __name__ == "__main__":
    unittest.main()
