// SPDX-License-Identifier: MIT
#include "image/codec/load_module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/program_module.hpp"

namespace darkroom {

Result<const void*> load_module(const char* file, const char* symbol, const char* library) {
    void* const module = dlopen(program_module(file).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) return machine_error(fmt::format("{} cannot be loaded: {}", library, dlerror()));
    using Get = const void* (*)();
    const auto get = reinterpret_cast<Get>(dlsym(module, symbol));
    if (get == nullptr) return machine_error(fmt::format("{} cannot be loaded: {}", library, dlerror()));
    return get();
}

}  // namespace darkroom
