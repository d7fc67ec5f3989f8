// SPDX-License-Identifier: MIT
// darkroom._engine: the library as the Python package darkroom uses it, and nobody else. What users call, with its
// documentation, is in programs/python/darkroom.
#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <darkroom/version.hpp>
#include <string>

#include "parts.hpp"

namespace darkroom::python {

namespace py = pybind11;

namespace {

const char* name_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::DeviceLost:
            return "device_lost";
        case ErrorCode::OutOfMemory:
            return "out_of_memory";
        case ErrorCode::Unsupported:
            return "unsupported";
        case ErrorCode::Other:
            break;
    }
    return "other";
}

}  // namespace

void raise(const Error& error) {
    const py::object type = py::module_::import("darkroom._error").attr("Error");
    const char* const fault = error.fault == Fault::User ? "user" : "machine";
    // Paths are bytes, and need not be text.
    const py::object text = py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(error.text.data(), static_cast<py::ssize_t>(error.text.size()), "backslashreplace"));
    // Of the kind that it makes of itself by its fault.
    const py::object made = type(text, fault, name_of(error.code));
    PyErr_SetObject(py::type::of(made).ptr(), made.ptr());
    throw py::error_already_set();
}

void raise_user(std::string text) { raise({Fault::User, std::move(text)}); }

}  // namespace darkroom::python

namespace {

/// An older pybind11 looks for the types of numpy 2 at the places that those of numpy 1 have, and finds none.
void check_numpy() {
#if PYBIND11_VERSION_HEX < 0x020C0000
    const auto numpy = pybind11::module_::import("numpy").attr("__version__").cast<std::string>();
    if (!numpy.starts_with("1."))
        throw pybind11::import_error(
            fmt::format("darkroom was built with pybind11 {}.{} for numpy 1, and numpy {} is "
                        "here: pip install 'numpy<2', or build it with pybind11 2.12 or newer",
                        PYBIND11_VERSION_MAJOR, PYBIND11_VERSION_MINOR, numpy));
#endif
}

}  // namespace

PYBIND11_MODULE(_engine, module) {
    using namespace darkroom;
    check_numpy();
    module.attr("version") = fmt::format("{}.{}.{}", version_major, version_minor, version_patch);
    python::add_effects(module);
    python::add_looks(module);
    python::add_runner(module);
    python::add_tables(module);
    python::add_compare(module);
}
