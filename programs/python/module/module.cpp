// SPDX-License-Identifier: MIT
// darkroom._engine: the library as the Python package darkroom uses it, and nobody else. What users call, with its
// documentation, is in programs/python/darkroom.
#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <darkroom/version.hpp>

#include "parts.hpp"

PYBIND11_MODULE(_engine, module) {
    using namespace darkroom;
    module.attr("version") = fmt::format("{}.{}.{}", version_major, version_minor, version_patch);
    python::add_effects(module);
    python::add_looks(module);
    python::add_runner(module);
    python::add_tables(module);
    python::add_compare(module);
}
