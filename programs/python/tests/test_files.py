# SPDX-License-Identifier: MIT
"""Files, and that the package does what the program does, bit for bit."""

import os
import pathlib
import tempfile
import unittest

import numpy

try:
    import resource
except ImportError:
    resource = None

import darkroom
from darkroom import files
from support import Case, light, source

sample = source / "samples" / "window.exr"


class Files(Case):
    def setUp(self):
        super().setUp()
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def read_png(self, path):
        """The bytes of a picture that the program wrote."""
        words = ["--look", self.unchanged(), "-o", "-", "--format", "rgb24", "--quiet"]
        return numpy.frombuffer(files.run("develop", path, *words), numpy.uint8)

    def unchanged(self):
        path = self.folder / "unchanged.toml"
        path.write_text('[[stack]]\neffect = "exposure"\nexposure = 1.0\n', encoding="utf-8")
        return path

    def test_a_stored_frame_is_developed_as_the_program_does(self):
        frame = files.read_frame(sample)
        self.assertEqual(frame["color"].dtype, numpy.float16)
        small = {name: frame[name][::6, ::6] for name in ("color", "depth", "normals", "velocity")}
        files.write_frame(self.folder / "small.exr", {**small, "camera": frame["camera"]})
        stored = files.read_frame(self.folder / "small.exr")
        for name, layer in small.items():
            self.assertSame(stored[name], numpy.ascontiguousarray(layer))
        numpy.testing.assert_array_equal(stored["camera"].view, frame["camera"].view)
        look = self.folder / "own.toml"
        darkroom.Stack().fog(density=0.02).bloom(intensity=0.2).tonemap().vignette().save(look)
        for words, picture in (
            ([], darkroom.develop(stored)),
            (["--look", look], darkroom.develop(stored, look)),
        ):
            made = files.run("develop", self.folder / "small.exr", *words, "-o", "-", "--format", "rgb24", "--quiet")
            self.assertSame(numpy.frombuffer(made, numpy.uint8).reshape(*picture.shape[:2], 3), picture[..., :3])

    def test_pictures_are_written_and_read(self):
        picture = darkroom.develop(light())
        files.write(self.folder / "picture.png", picture)
        self.assertSame(self.read_png(self.folder / "picture.png").reshape(picture.shape), picture)
        self.assertEqual(files.info(self.folder / "picture.png")["size"], [48, 27])
        read = files.read(self.folder / "picture.png")
        self.assertSame(darkroom.Stack().exposure(exposure=1.0).develop(read[..., :3]), picture)
        files.write(self.folder / "light.exr", light())
        self.assertSame(files.read_frame(self.folder / "light.exr")["color"], light())
        self.assertSame(files.read(self.folder / "light.exr")[..., :3], light())
        with self.assertRaisesRegex(darkroom.Error, "allowed are .png and .exr; `darkroom develop` writes other formats"):
            files.write(self.folder / "picture.jpg", picture)
        other = picture.copy()
        other[0, 0] = 255 - other[0, 0]
        files.write(self.folder / "other.png", other)
        told = files.compare(self.folder / "picture.png", self.folder / "other.png")
        here = darkroom.compare(picture, other)
        self.assertAlmostEqual(told["layers"][0]["flip"]["mean"], here.flip_mean, places=5)
        self.assertAlmostEqual(told["layers"][0]["psnr"], here.psnr, places=3)

    def test_a_scene_is_a_dictionary_of_layers(self):
        layers = files.render(source / "scenes" / "courtyard.scene.toml", size=(48, 27))
        self.assertLessEqual({"color", "depth", "normals", "velocity", "camera", "picture", "time"}, set(layers))
        self.assertEqual(layers["picture"].shape, (27, 48, 3))
        self.assertEqual(layers["normals"].shape, (27, 48, 3))
        hit = layers["depth"] < 1e9
        self.assertGreater(hit.mean(), 0.3)
        lengths = numpy.linalg.norm(layers["normals"][hit].astype(numpy.float32), axis=-1)
        self.assertGreater((numpy.abs(lengths - 1) < 0.01).mean(), 0.9)
        self.assertSame(darkroom.develop(layers), darkroom.develop({**layers}))

    def test_light_in_the_air_of_a_stored_frame(self):
        stored, look = self.folder / "frame.exr", self.folder / "air.toml"
        darkroom.Stack().volumetric(density=0.2).tonemap().save(look)
        scene = source / "scenes" / "courtyard.scene.toml"
        files.run("render", scene, "--size", "48x27", "--save-frame", stored, "-o", self.folder / "x.png", "--quiet")
        layers = files.read_frame(stored)
        self.assertTrue(any(len(light.cascades) == 3 for light in layers["lights"]))
        made = files.run("develop", stored, "--look", look, "-o", "-", "--format", "rgb24", "--quiet")
        picture = darkroom.develop(layers, look)
        self.assertSame(numpy.frombuffer(made, numpy.uint8).reshape(27, 48, 3), picture[..., :3])
        layers["lights"] = []
        self.assertGreater(darkroom.compare(picture, darkroom.develop(layers, look)).flip_mean, 0.01)
        self.assertRaisesText("lights[0]: 1 cascades, 0 matrices, 0 splits: allowed are equal numbers, up to 4",
                              darkroom.develop, light(), lights=[darkroom.Light((0, 1, 0), cascades=[light()[..., 0]])])  # fmt: skip
        wide = darkroom.Light((0, 1, 0), cascades=[light()[..., 0]], world_to_cascade=[numpy.eye(4)], splits=[9])
        self.assertRaisesText("lights[0].cascades: shapes [(27, 48)]: allowed are squares of one size",
                              darkroom.develop, light(), lights=[wide])  # fmt: skip

    def test_tables_of_other_formats(self):
        path = self.folder / "half.spi1d"
        path.write_text("Version 1\nFrom 0.0 1.0\nLength 2\nComponents 1\n{\n0.0\n0.6\n}\n", encoding="utf-8")
        table = files.table(path)
        numpy.testing.assert_allclose(table(numpy.float32([[0.5, 1.0, 0.0]])), [[0.3, 0.6, 0.0]], atol=1e-6)
        white = numpy.full((2, 2, 3), 255, numpy.uint8)
        self.assertSame(darkroom.lut(white, lut=path), numpy.full((2, 2, 3), 153, numpy.uint8))

    @unittest.skipUnless(resource, "a limit of what a file may have is of POSIX")
    def test_what_was_there_stays_where_nothing_can_be_written(self):
        paths = [self.folder / name for name in ("a.png", "a.exr", "a.toml")]
        picture = darkroom.develop(light())
        write = [lambda p: files.write(p, picture), lambda p: files.write(p, light()), darkroom.Stack().bloom().save]
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        for path, one in zip(paths, write):
            path.write_bytes(b"precious")
            resource.setrlimit(resource.RLIMIT_FSIZE, (16, limits[1]))
            try:
                with self.assertRaises(darkroom.Error) as raised:
                    one(path)
            finally:
                resource.setrlimit(resource.RLIMIT_FSIZE, limits)
            self.assertEqual(str(raised.exception), f"{path}: File too large")
            self.assertEqual(path.read_bytes(), b"precious")
        self.assertEqual(sorted(self.folder.iterdir()), sorted(paths))
        (self.folder / "link.toml").symlink_to("a.toml")
        darkroom.Stack().bloom().save(self.folder / "link.toml")
        self.assertIn("bloom", (self.folder / "a.toml").read_text(encoding="utf-8"))
        self.assertTrue((self.folder / "link.toml").is_symlink())

    def test_what_is_wrong_is_said(self):
        self.assertEqual(self.assertRaisesText(f"{self.folder}/no.exr: No such file or directory", files.read_frame,
                                               self.folder / "no.exr").fault, "user")  # fmt: skip
        (self.folder / "no.exr").write_bytes(b"no")
        self.assertRaisesText(f"{self.folder}/no.exr: the file ends too early", files.read_frame, self.folder / "no.exr")
        whole = sample.read_bytes()
        for size in range(0, 4000, 37):
            (self.folder / "cut.exr").write_bytes(whole[:size])
            with self.assertRaises(darkroom.Error):
                files.read_frame(self.folder / "cut.exr")
        with self.assertRaisesRegex(FileNotFoundError, "nosuch.exr"):
            files.read(self.folder / "nosuch.exr")
        # Frames of a sequence are there, though no file has this name.
        (self.folder / "a.0001.exr").write_bytes(b"no")
        with self.assertRaises(darkroom.Error) as raised:
            files.read(self.folder / "a.####.exr")
        self.assertNotIsInstance(raised.exception, FileNotFoundError)
        was = os.environ.get("DARKROOM_PROGRAM")
        os.environ["DARKROOM_PROGRAM"] = "/nowhere/darkroom"
        try:
            error = self.assertRaisesText("darkroom.files: DARKROOM_PROGRAM = /nowhere/darkroom: no program 'darkroom' "
                                          "there: docs/install.md installs it", files.info, sample)  # fmt: skip
            self.assertEqual(error.fault, "machine")
        finally:
            if was is None:
                del os.environ["DARKROOM_PROGRAM"]
            else:
                os.environ["DARKROOM_PROGRAM"] = was


if __name__ == "__main__":
    unittest.main()
