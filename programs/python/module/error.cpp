// SPDX-License-Identifier: MIT
#include "error.hpp"

#include <pybind11/pybind11.h>

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
