// SPDX-License-Identifier: MIT
#include "image/codec/load_module.hpp"

#include <fmt/format.h>

#include "core/program_module.hpp"
#include "core/system/module.hpp"

namespace darkroom {

Result<const void*> load_module(const char* file, const char* symbol, const char* library) {
    const Result<void*> module = load_library(program_module(file));
    if (!module) return machine_error(fmt::format("{} cannot be loaded: {}", library, module.error().text));
    using Get = const void* (*)();
    const auto get = reinterpret_cast<Get>(symbol_of(*module, symbol));
    if (get == nullptr) return machine_error(fmt::format("{} cannot be loaded: {} has no {}", library, file, symbol));
    return get();
}

}  // namespace darkroom
