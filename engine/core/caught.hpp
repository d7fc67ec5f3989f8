// SPDX-License-Identifier: MIT
#pragma once
// What a public function makes of an exception that memory, threads, files or a caller's own function threw into it:
// an error, because no exception may pass through a host's frame loop.

#include <exception>
#include <new>
#include <string>

#include "core/try.hpp"

namespace darkroom {

/// In a handler alone: the exception as an error of the machine, `what` being what was tried. Where there is no memory
/// even for that, the text is short.
[[nodiscard]] inline Failure caught(const char* what) noexcept {
    try {
        try {
            throw;
        } catch (const std::bad_alloc&) {
            return machine_error(std::string(what) + ": out of memory", ErrorCode::OutOfMemory);
        } catch (const std::exception& exception) {
            return machine_error(std::string(what) + ": " + exception.what());
        } catch (...) {
            return machine_error(std::string(what) + ": an unknown exception");
        }
    } catch (...) {
        return machine_error("out of memory", ErrorCode::OutOfMemory);  // no longer than a string holds in place
    }
}

}  // namespace darkroom
