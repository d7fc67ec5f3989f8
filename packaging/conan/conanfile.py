# SPDX-License-Identifier: MIT
"""A recipe of the tree that it lies in: conan create packaging/conan (docs/packaging.md)."""

import re
from pathlib import Path

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy

TREE = Path(__file__).resolve().parents[2]


class Darkroom(ConanFile):
    name = "darkroom"
    description = "Post-processing for Vulkan"
    license = "MIT"
    package_type = "shared-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"compiler": [True, False], "looks": [True, False]}
    default_options = {"compiler": True, "looks": False, "fmt/*:header_only": True}

    def set_version(self):
        text = (TREE / "CMakeLists.txt").read_text(encoding="utf-8")
        self.version = re.search(r"project\(darkroom VERSION ([0-9.]+)", text)[1]

    def export_sources(self):
        for what in ("CMakeLists.txt", "LICENSE", "cmake/*", "include/*", "engine/*", "files/*", "edit/*",
                     "effects/*", "looks/*", "controllers/*"):
            copy(self, what, TREE, self.export_sources_folder)

    def requirements(self):
        self.requires("fmt/[>=9]")
        self.requires("tl-expected/[>=1]", transitive_headers=True)
        self.requires("vulkan-headers/[>=1.3.239]", transitive_headers=True)
        if self.options.compiler:
            self.requires("shaderc/[>=2022]")
        if self.options.looks:
            self.requires("tomlplusplus/[>=3.3]")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for part in ("APPS", "SCRIPT", "TESTS"):
            toolchain.cache_variables[f"DARKROOM_{part}"] = False
        toolchain.cache_variables["DARKROOM_COMPILER"] = bool(self.options.compiler)
        toolchain.cache_variables["DARKROOM_LOOKS"] = bool(self.options.looks)
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    # The targets are those of its own file for CMake.
    def package_info(self):
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = ["lib/cmake/Darkroom"]
        self.cpp_info.libs = ["darkroom_cpp"]
