# SPDX-License-Identifier: MIT
"""Builds the Python package: pip install . (docs/python.md).

CMake builds the tree's target darkroom_python_package into DARKROOM_PYTHON_BUILD (build-python/ beside this file), and
the wheel takes what that made. The folder stays, so the next build compiles what changed alone. With
DARKROOM_PYTHON_PACKAGE, a folder that holds the package already, nothing is built.
"""

import contextlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import time

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

root = pathlib.Path(__file__).resolve().parent
build = pathlib.Path(os.environ.get("DARKROOM_PYTHON_BUILD", root / "build-python"))
version = re.search(r"VERSION ([0-9.]+)", (root / "CMakeLists.txt").read_text(encoding="utf-8").split("project(")[1])
built = os.environ.get("DARKROOM_PYTHON_PACKAGE")


def missing_tools():
    """The programs that build, as packages of Python, where the machine has none that will do."""
    out = [] if built or shutil.which("ninja") else ["ninja"]
    try:
        said = subprocess.run(["cmake", "--version"], capture_output=True, text=True).stdout
        is_new = tuple(map(int, re.search(r"(\d+)\.(\d+)", said).groups())) >= (3, 25)
    except OSError:
        is_new = False
    return out if built or is_new else [*out, "cmake>=3.25"]


def steps_in(said):
    """What ninja says of its steps: "[3/9] Building x.o"."""
    return re.findall(r"^\[\d+/\d+\] (.+)$", said, re.M)


class Progress:
    """How far the build is: on the terminal, which pip keeps from what it runs, else a line every ten percent."""

    def __init__(self, plan):
        # What compiles takes all the time; the rest are hundreds of small steps.
        self.left = {step: 50 if step.endswith((".o", ".gch")) else 1 for step in steps_in(plan)}
        self.all = sum(self.left.values())
        self.done, self.started, self.said = 0, time.monotonic(), 0
        try:
            self.terminal = open("/dev/tty", "w", encoding="utf-8")
        except OSError:
            self.terminal = None

    def tell(self, line):
        for step in steps_in(line):
            self.done += self.left.pop(step, 0)
        if not self.done:
            return
        percent = 100 * self.done // self.all
        seconds = (time.monotonic() - self.started) * (self.all - self.done) / self.done
        text = f"darkroom: building: {percent} %, about {seconds:.0f} s left"
        if self.terminal:
            self.terminal.write(f"\r\033[K{text}")
            self.terminal.flush()
        if percent // 10 > self.said:
            self.said = percent // 10
            print(text, file=sys.stderr, flush=True)

    def end(self):
        if self.terminal:
            with contextlib.suppress(OSError), self.terminal:
                self.terminal.write("\r\033[K")


def run(words, plan=""):
    """Runs a step of the build; its words are kept in build.log, and their end is told where it fails."""
    with open(build / "build.log", "a", encoding="utf-8") as log:
        process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
        progress, last = Progress(plan), []
        for line in process.stdout:
            log.write(line)
            last = [*last[-39:], line]
            progress.tell(line)
        progress.end()
    if process.wait() != 0:
        sys.stderr.write("".join(last))
        raise SystemExit(f"darkroom: the build failed; the lines above are the end of {log.name}")


def pybind11_headers():
    """A copy: an isolated build has them in a folder that is gone afterwards, and another path would compile anew."""
    import pybind11

    to = build / f"pybind11-{pybind11.__version__}"
    if not to.is_dir():
        shutil.copytree(pybind11.get_include(), to.with_suffix(".new"), dirs_exist_ok=True)
        to.with_suffix(".new").rename(to)
    return to


def package():
    """The folder of the built package."""
    if built:
        return pathlib.Path(built)
    options = [f"-DDARKROOM_{part}=OFF" for part in ("APPS", "TESTS", "SCRIPT", "HUD", "VIEWER")]
    options += ["-DDARKROOM_PYTHON=ON", f"-DDARKROOM_PYTHON_INTERPRETER={sys.executable}", "-DCMAKE_BUILD_TYPE=Release"]
    options += [f"-DDARKROOM_PYTHON_PYBIND11={pybind11_headers()}", f"-DCMAKE_MAKE_PROGRAM={shutil.which('ninja')}"]
    (build / "build.log").unlink(missing_ok=True)
    run(["cmake", "-S", root, "-B", build, "-G", "Ninja", *options])
    # Of build.ninja itself a dry run plans no more than to look for new files, so it reads a copy.
    target = "darkroom_python_package"
    shutil.copy(build / "build.ninja", build / ".plan.ninja")
    plan = subprocess.run(["ninja", "-C", build, "-f", ".plan.ninja", "-n", target], capture_output=True, text=True).stdout
    run(["cmake", "--build", build, "--target", target], plan)
    return build / "python" / "darkroom"


class BuildPackage(build_py):
    def run(self):
        to = pathlib.Path(self.build_lib) / "darkroom"
        # A folder that was built in before may hold the module of another interpreter, and files that are gone.
        known = {file.name for file in (root / "programs/python/darkroom").iterdir() if file.is_file()}
        known |= {"looks"} | {file.name for file in (root / "looks").iterdir()}
        known |= {"__init__.pyi", "_engine" + sysconfig.get_config_var("EXT_SUFFIX")}
        shutil.rmtree(to, ignore_errors=True)
        shutil.copytree(package(), to, ignore=lambda folder, names: set(names) - known)


class HasModule(Distribution):
    """Its wheel is of one platform and one interpreter."""

    def has_ext_modules(self):
        return True


build.mkdir(parents=True, exist_ok=True)
setup(
    name="darkroom",
    version=version[1],
    description="Post-processing for Vulkan: HDR frames into finished pictures",
    long_description="See docs/python.md.",
    license="MIT",
    python_requires=">=3.10",
    setup_requires=missing_tools(),
    install_requires=["numpy"],
    packages=["darkroom"],
    package_dir={"": "programs/python"},
    include_package_data=False,
    distclass=HasModule,
    cmdclass={"build_py": BuildPackage},
    options={"build": {"build_base": str(build / "setuptools")}, "egg_info": {"egg_base": str(build)}},
    zip_safe=False,
)
