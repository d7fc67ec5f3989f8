// SPDX-License-Identifier: MIT
#pragma once
// Where the library's messages go: remarks, warnings, what the validation layer says. A host passes its own sink;
// without one, nothing is printed.

#include <functional>
#include <string_view>

namespace darkroom {

enum class Severity { Debug, Info, Warning, Error };
using LogSink = std::function<void(Severity, std::string_view)>;

}  // namespace darkroom
