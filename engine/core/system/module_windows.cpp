// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <windows.h>

#include <string>
#include <system_error>

#include "core/system/module.hpp"

namespace darkroom {
namespace {

std::filesystem::path file_of(HMODULE module) {
    // As long as paths get.
    std::wstring name(32768, L'\0');
    name.resize(::GetModuleFileNameW(module, name.data(), static_cast<DWORD>(name.size())));
    return name;
}

}  // namespace

const char* const vulkan_loader_name = "vulkan-1.dll";

Result<void*> load_library(const std::filesystem::path& library) {
    // Not from the current folder, where anybody may have put one of this name.
    const DWORD where = library.is_absolute() ? LOAD_WITH_ALTERED_SEARCH_PATH : LOAD_LIBRARY_SEARCH_DEFAULT_DIRS;
    if (HMODULE const loaded = ::LoadLibraryExW(library.c_str(), nullptr, where); loaded != nullptr) return loaded;
    const std::error_code reason(static_cast<int>(::GetLastError()), std::system_category());
    return machine_error(fmt::format("{}: {}", library.string(), reason.message()), ErrorCode::Unsupported);
}

void* symbol_of(void* library, const char* name) {
    return reinterpret_cast<void*>(::GetProcAddress(static_cast<HMODULE>(library), name));
}

std::filesystem::path running_program() { return file_of(nullptr); }

std::filesystem::path own_library() {
    HMODULE own = nullptr;
    constexpr DWORD by_address = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    const bool is_known = ::GetModuleHandleExW(by_address, reinterpret_cast<LPCWSTR>(&own_library), &own) != 0;
    return is_known ? file_of(own) : std::filesystem::path();
}

}  // namespace darkroom
