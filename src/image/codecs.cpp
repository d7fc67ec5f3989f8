// SPDX-License-Identifier: MIT
#include "image/codecs.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

namespace darkroom {
namespace {

Result<const Codecs*> load() {
    // Found by the program's run path. It stays loaded: OpenImageIO has threads and caches of its own.
    void* const module = dlopen("libdarkroom_oiio.so", RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) return machine_error(fmt::format("OpenImageIO cannot be loaded: {}", dlerror()));
    using Get = const Codecs* (*)();
    const auto get = reinterpret_cast<Get>(dlsym(module, "darkroom_oiio_codecs"));
    if (get == nullptr) return machine_error(fmt::format("OpenImageIO cannot be loaded: {}", dlerror()));
    return get();
}

}  // namespace

Result<const Codecs*> codecs() {
    static const Result<const Codecs*> loaded = load();
    return loaded;
}

}  // namespace darkroom
