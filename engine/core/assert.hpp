// SPDX-License-Identifier: MIT
#pragma once
// DARKROOM_ASSERT(condition) states what only a mistake in this library can break. It is kept in release builds: a
// wrong picture costs more than the comparison. It is not for wrong input, which is a Result.

#include <cstdio>
#include <cstdlib>

namespace darkroom {

[[noreturn]] inline void assertion_failed(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: this must hold: %s\n", file, line, condition);
    std::abort();
}

}  // namespace darkroom

#define DARKROOM_ASSERT(condition) \
    ((condition) ? static_cast<void>(0) : ::darkroom::assertion_failed(#condition, __FILE__, __LINE__))
