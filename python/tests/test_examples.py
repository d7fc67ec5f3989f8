# SPDX-License-Identifier: MIT
"""Every file of python/examples, as a user runs it, in an empty folder and in this interpreter."""

import contextlib
import io
import os
import runpy
import sys
import tempfile
import unittest

from support import Case, source

folder = source / "python" / "examples"


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


def _test(path):
    return lambda self: self.run_example(path)


for _path in sorted(folder.glob("*.py")):
    setattr(Examples, f"test_{_path.stem}", _test(_path))

if __name__ == "__main__":
    unittest.main()
