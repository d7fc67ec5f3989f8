// SPDX-License-Identifier: MIT
#include "c/call.hpp"

#include <darkroom/version.hpp>

static_assert(DARKROOM_VERSION == darkroom::version);

namespace darkroom::c {

namespace {

/// What a name brings that a host gave, or a file: errors are one line.
std::string without_controls(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (code < ' ' || code == 0x7f)
            out += fmt::format("\\x{:02X}", code);
        else
            out += c;
    }
    return out;
}

/// Without memory for a text, one that needs none.
thread_local std::string last_text;
thread_local const char* last = "";

}  // namespace

DarkroomResult code_of(const Error& error) {
    switch (error.code) {
        case ErrorCode::DeviceLost:
            return DARKROOM_ERROR_DEVICE_LOST;
        case ErrorCode::OutOfMemory:
            return DARKROOM_ERROR_OUT_OF_MEMORY;
        case ErrorCode::Unsupported:
            return DARKROOM_ERROR_UNSUPPORTED;
        case ErrorCode::Other:
            break;
    }
    return error.fault == Fault::User ? DARKROOM_ERROR_USER : DARKROOM_ERROR_MACHINE;
}

DarkroomResult tell(const char* function, const Error& error) noexcept {
    try {
        // Some texts begin with the name of the C++ function, with which this one's ends.
        std::string_view text = error.text;
        const std::string_view first = text.substr(0, text.find(": "));
        if (std::string_view(function).ends_with("_" + std::string(first))) text.remove_prefix(first.size() + 2);
        last_text = fmt::format("{}{}{}", function, *function == 0 ? "" : ": ", without_controls(text));
        last = last_text.c_str();
    } catch (...) {
        last = "out of memory";
    }
    return code_of(error);
}

const char* last_error() { return last; }

}  // namespace darkroom::c

uint32_t darkroom_version() { return darkroom::library_version(); }
const char* darkroom_error() { return darkroom::c::last_error(); }
