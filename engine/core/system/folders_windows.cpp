// SPDX-License-Identifier: MIT
#include <windows.h>
// Needs the types above.
#include <aclapi.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <memory>

#include "core/system/folders.hpp"

namespace darkroom {
namespace {

struct FreeLocal {
    void operator()(void* memory) const { ::LocalFree(memory); }
};
using Descriptor = std::unique_ptr<void, FreeLocal>;

/// A security identifier, and room for it.
struct Identity {
    alignas(SID) std::array<std::byte, SECURITY_MAX_SID_SIZE> bytes{};
    bool is_known = false;
    [[nodiscard]] PSID sid() { return bytes.data(); }
    [[nodiscard]] bool is(PSID other) { return is_known && ::EqualSid(sid(), other) != 0; }
};

Identity well_known(WELL_KNOWN_SID_TYPE type) {
    Identity out;
    auto size = static_cast<DWORD>(out.bytes.size());
    out.is_known = ::CreateWellKnownSid(type, nullptr, out.sid(), &size) != 0;
    return out;
}

Identity user_of_this_process() {
    Identity out;
    HANDLE token = nullptr;
    if (::OpenProcessToken(::GetCurrentProcess(), TOKEN_QUERY, &token) == 0) return out;
    struct Room {
        TOKEN_USER user;
        std::array<std::byte, SECURITY_MAX_SID_SIZE> sid;
    } room{};
    DWORD size = 0;
    if (::GetTokenInformation(token, TokenUser, &room, sizeof room, &size) != 0)
        out.is_known = ::CopySid(static_cast<DWORD>(out.bytes.size()), out.sid(), room.user.User.Sid) != 0;
    ::CloseHandle(token);
    return out;
}

constexpr DWORD writing = FILE_WRITE_DATA | FILE_APPEND_DATA | FILE_DELETE_CHILD | DELETE | WRITE_DAC | WRITE_OWNER |
                          GENERIC_WRITE | GENERIC_ALL;

/// Of one entry of the list: whom it allows to write. nullptr: nobody.
PSID writer_of(ACL* list, DWORD index) {
    void* entry = nullptr;
    if (::GetAce(list, index, &entry) == 0) return nullptr;
    auto* const allowed = static_cast<ACCESS_ALLOWED_ACE*>(entry);
    const bool is_for_others = (allowed->Header.AceFlags & INHERIT_ONLY_ACE) != 0;
    if (allowed->Header.AceType != ACCESS_ALLOWED_ACE_TYPE || is_for_others) return nullptr;
    return (allowed->Mask & writing) != 0 ? &allowed->SidStart : nullptr;
}

}  // namespace

std::filesystem::path user_cache_folder() {
    const wchar_t* const local = ::_wgetenv(L"LOCALAPPDATA");
    const std::filesystem::path folder = local == nullptr ? L"" : local;
    return folder.is_absolute() ? folder / "darkroom" : std::filesystem::path();
}

bool is_of_this_user_alone(const std::filesystem::path& path) {
    PSID owner = nullptr;
    ACL* list = nullptr;
    PSECURITY_DESCRIPTOR found = nullptr;
    const DWORD failed =
        ::GetNamedSecurityInfoW(path.c_str(), SE_FILE_OBJECT, OWNER_SECURITY_INFORMATION | DACL_SECURITY_INFORMATION,
                                &owner, nullptr, &list, nullptr, &found);
    const Descriptor descriptor(found);
    // Without a list everybody may do everything.
    if (failed != ERROR_SUCCESS || owner == nullptr || list == nullptr) return false;
    Identity user = user_of_this_process();
    std::array trusted{well_known(WinBuiltinAdministratorsSid), well_known(WinLocalSystemSid),
                       well_known(WinCreatorOwnerSid)};
    // What an administrator makes belongs to all of them.
    if (!user.is(owner) && !trusted[0].is(owner)) return false;
    for (DWORD index = 0; index < list->AceCount; ++index) {
        const PSID writer = writer_of(list, index);
        if (writer == nullptr || user.is(writer)) continue;
        if (!trusted[0].is(writer) && !trusted[1].is(writer) && !trusted[2].is(writer)) return false;
    }
    return true;
}

}  // namespace darkroom
