// SPDX-License-Identifier: MIT
#pragma once
// Where the library's messages go: remarks, warnings, what the validation layer says. A host passes its own sink;
// without one, nothing is printed.
//
// A sink is called from whichever thread has something to say: each one that the host calls the library from, the
// library's own threads, which compile kernels in the background, and, with validation, those of the driver. For one
// Device it is called by one thread at a time. It must not throw, and it must not wait for another thread that is in a
// call of the library, which may be waiting for its turn to speak.

#include <functional>
#include <string_view>

namespace darkroom {

enum class Severity { Debug, Info, Warning, Error };
using LogSink = std::function<void(Severity, std::string_view)>;

}  // namespace darkroom
