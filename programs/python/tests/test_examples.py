# SPDX-License-Identifier: MIT
"""Every file of programs/python/examples, as a user runs it, in an empty folder and in this interpreter; and the code of the page."""

import contextlib
import io
import os
import re
import runpy
import sys
import tempfile
import unittest

import numpy

import darkroom
from support import Case, light, source

folder = source / "programs" / "python" / "examples"


class Examples(Case):
    def run_example(self, path):
        was, arguments, out = os.getcwd(), sys.argv, io.StringIO()
        with tempfile.TemporaryDirectory() as empty:
            try:
                os.chdir(empty)
                sys.argv = [str(path)]
                with contextlib.redirect_stdout(out):
                    runpy.run_path(str(path), run_name="__main__")
            except SystemExit as end:
                if not str(end.code).startswith("skipped: "):
                    raise
                self.skipTest(str(end.code))
            finally:
                os.chdir(was)
                sys.argv = arguments
        self.assertTrue(out.getvalue().strip(), "it says nothing")


class Page(Case):
    def test_its_code_runs(self):
        blocks = re.findall(r"^```python\n(.*?)^```", (source / "docs/python.md").read_text(encoding="utf-8"), re.M | re.S)
        self.assertGreaterEqual(len(blocks), 1)
        was = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            try:
                os.chdir(folder)
                os.mkdir("samples")
                darkroom.files.write_frame("samples/window.exr", darkroom.Frame(light()))
                for block in blocks:
                    names = {}
                    exec(compile(block, "docs/python.md", "exec"), names)
                    self.assertEqual(names["picture"].dtype, numpy.uint8)
                    self.assertEqual(names["glowing"].shape, light().shape)
            finally:
                os.chdir(was)


def _test(path):
    return lambda self: self.run_example(path)


for _path in sorted(folder.glob("*.py")):
    setattr(Examples, f"test_{_path.stem}", _test(_path))

if __name__ == "__main__":
    unittest.main()
