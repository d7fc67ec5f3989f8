// SPDX-License-Identifier: MIT
// Loaded before a program (LD_PRELOAD): its own code can start no thread of C++, as where a user may have no more of
// them. Drivers, layers and the desktop's libraries can. For glibc and libstdc++.
#include <dlfcn.h>
#include <sys/auxv.h>

#include <system_error>

namespace {

/// std::thread::_M_start_thread, whose second argument has a destructor and so is passed by its address.
constexpr const char* start_thread =
    "_ZNSt6thread15_M_start_threadESt10unique_ptrINS_6_StateESt14default_deleteIS1_EEPFvvE";
using Start = void (*)(void* thread, void* state, void (*depend)());

bool is_of_program(const void* code) {
    Dl_info of{}, program{};
    return dladdr(code, &of) != 0 && dladdr(reinterpret_cast<const void*>(getauxval(AT_PHDR)), &program) != 0 &&
           of.dli_fbase == program.dli_fbase;
}

}  // namespace

[[gnu::visibility("default")]] void start(void* thread, void* state, void (*depend)()) asm(
    "_ZNSt6thread15_M_start_threadESt10unique_ptrINS_6_StateESt14default_deleteIS1_EEPFvvE");

void start(void* thread, void* state, void (*depend)()) {
    if (is_of_program(__builtin_return_address(0)))
        throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
    reinterpret_cast<Start>(dlsym(RTLD_NEXT, start_thread))(thread, state, depend);
}
