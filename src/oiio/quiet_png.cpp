// SPDX-License-Identifier: MIT
// OpenImageIO keeps what libpng tells it and returns, whereupon libpng prints the same to standard error, which is not
// its own. A module's names are looked up before those of the libraries that it brings (dlopen(3), RTLD_LOCAL), so
// OpenImageIO gets this function, whose errors do not return, as libpng's contract has it. Where it does not get it, a
// line more is printed.
#include <dlfcn.h>

#include <atomic>
#include <string_view>

#include "core/program_module.hpp"

namespace {

using Say = void (*)(void* png, const char* text);
using SetErrors = void (*)(void* png, void* user, Say error, Say warning);

// OpenImageIO's own, the same for all its files.
std::atomic<Say> keep_error{nullptr};

void leave(void* png, const char* text) {
    static const auto jump = reinterpret_cast<void (*)(void*, int)>(::dlsym(RTLD_NEXT, "png_longjmp"));
    if (const Say keep = keep_error; keep != nullptr) keep(png, text);
    if (jump != nullptr) jump(png, 1);
}

bool is_of_openimageio(void* place) {
    Dl_info info{};
    return ::dladdr(place, &info) != 0 && info.dli_fname != nullptr &&
           std::string_view(info.dli_fname).find("libOpenImageIO") != std::string_view::npos;
}

}  // namespace

extern "C" DARKROOM_MODULE_EXPORT void png_set_error_fn(void* png, void* user, Say error, Say warning) {
    static const auto set = reinterpret_cast<SetErrors>(::dlsym(RTLD_NEXT, "png_set_error_fn"));
    if (set == nullptr) return;
    // Others that are brought along have functions of their own.
    if (error == nullptr || !is_of_openimageio(__builtin_return_address(0))) return set(png, user, error, warning);
    keep_error = error;
    set(png, user, leave, warning);
}
