// SPDX-License-Identifier: MIT
#pragma once
// Libraries that bring many others are modules of their own, loaded when they are first needed.

#include <darkroom/result.hpp>
#include <string>

namespace darkroom {

/// What function `symbol` of the program's module `file` gives (core/program_module.hpp). The module stays loaded: such
/// libraries have threads and caches of their own. The error is the machine's and names `library`.
[[nodiscard]] Result<const void*> load_module(const char* file, const char* symbol, const char* library);

}  // namespace darkroom
