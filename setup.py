# SPDX-License-Identifier: MIT
"""Builds the Python package: pip wheel --no-build-isolation . (docs/python.md).

CMake builds the tree's target darkroom_python_package into DARKROOM_PYTHON_BUILD (build-python/ beside this file), and
the wheel takes what that made. With DARKROOM_PYTHON_PACKAGE, a folder that holds the package already, nothing is built.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

root = pathlib.Path(__file__).resolve().parent
build = pathlib.Path(os.environ.get("DARKROOM_PYTHON_BUILD", root / "build-python"))
version = re.search(r"VERSION ([0-9.]+)", (root / "CMakeLists.txt").read_text(encoding="utf-8").split("project(")[1])


def package():
    """The folder of the built package."""
    built = os.environ.get("DARKROOM_PYTHON_PACKAGE")
    if built:
        return pathlib.Path(built)
    options = [f"-DDARKROOM_{part}=OFF" for part in ("APPS", "TESTS", "SCRIPT", "HUD", "VIEWER")]
    options += ["-DDARKROOM_PYTHON=ON", f"-DDARKROOM_PYTHON_INTERPRETER={sys.executable}", "-DCMAKE_BUILD_TYPE=Release"]
    subprocess.run(["cmake", "-S", root, "-B", build, "-G", "Ninja", *options], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "darkroom_python_package"], check=True)
    return build / "python" / "darkroom"


class BuildPackage(build_py):
    def run(self):
        to = pathlib.Path(self.build_lib) / "darkroom"
        shutil.rmtree(to, ignore_errors=True)
        shutil.copytree(package(), to, ignore=shutil.ignore_patterns("__pycache__"))


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
    install_requires=["numpy"],
    packages=["darkroom"],
    package_dir={"": "python"},
    include_package_data=False,
    distclass=HasModule,
    cmdclass={"build_py": BuildPackage},
    options={"build": {"build_base": str(build / "setuptools")}, "egg_info": {"egg_base": str(build)}},
    zip_safe=False,
)
