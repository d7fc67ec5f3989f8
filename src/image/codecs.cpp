// SPDX-License-Identifier: MIT
#include "image/codecs.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace darkroom {
namespace {

Result<const Codecs*> load() {
    // Beside the program, in the build tree and installed. It stays loaded: OpenImageIO has threads and caches of its
    // own.
    std::error_code ignored;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const std::filesystem::path path = program.parent_path() / "../lib/darkroom/libdarkroom_oiio.so";
    void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
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
