// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <windows.h>
// Needs the types above.
#include <aclapi.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "core/system/folders.hpp"

namespace darkroom {

namespace {

TEST(WindowsFolders, FollowTheEnvironment) {
    const wchar_t* const set = ::_wgetenv(L"LOCALAPPDATA");
    const std::wstring before = set == nullptr ? L"" : set;
    ASSERT_EQ(::_wputenv_s(L"LOCALAPPDATA", L"C:\\users\\größer\\Local"), 0);
    EXPECT_EQ(user_cache_folder(), std::filesystem::path(L"C:\\users\\größer\\Local\\darkroom"));
    ASSERT_EQ(::_wputenv_s(L"LOCALAPPDATA", L"relative"), 0);
    EXPECT_TRUE(user_cache_folder().empty());
    // So it is removed.
    ASSERT_EQ(::_wputenv_s(L"LOCALAPPDATA", L""), 0);
    EXPECT_TRUE(user_cache_folder().empty());
    ::_wputenv_s(L"LOCALAPPDATA", before.c_str());
}

/// Allows everybody this, beside what was allowed.
void allow_everybody(std::filesystem::path path, DWORD what) {
    EXPLICIT_ACCESSW entry{};
    entry.grfAccessPermissions = what;
    entry.grfAccessMode = GRANT_ACCESS;
    entry.Trustee.TrusteeForm = TRUSTEE_IS_NAME;
    std::wstring everybody = L"EVERYONE";
    entry.Trustee.ptstrName = everybody.data();
    ACL* before = nullptr;
    ACL* after = nullptr;
    PSECURITY_DESCRIPTOR descriptor = nullptr;
    ASSERT_EQ(::GetNamedSecurityInfoW(path.c_str(), SE_FILE_OBJECT, DACL_SECURITY_INFORMATION, nullptr, nullptr,
                                      &before, nullptr, &descriptor),
              DWORD{ERROR_SUCCESS});
    ASSERT_EQ(::SetEntriesInAclW(1, &entry, before, &after), DWORD{ERROR_SUCCESS});
    std::wstring name = path.native();
    EXPECT_EQ(::SetNamedSecurityInfoW(name.data(), SE_FILE_OBJECT, DACL_SECURITY_INFORMATION, nullptr, nullptr, after,
                                      nullptr),
              DWORD{ERROR_SUCCESS});
    ::LocalFree(after);
    ::LocalFree(descriptor);
}

TEST(WindowsFolders, WhoMayWriteCounts) {
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "darkroom_who_may_write";
    EXPECT_FALSE(is_of_this_user_alone(path)) << "there is none";
    std::ofstream(path) << "x";
    EXPECT_TRUE(is_of_this_user_alone(path));
    allow_everybody(path, GENERIC_READ);
    EXPECT_TRUE(is_of_this_user_alone(path)) << "others may read it";
    allow_everybody(path, GENERIC_READ | GENERIC_WRITE);
    EXPECT_FALSE(is_of_this_user_alone(path)) << "others may write it";
    std::filesystem::remove(path);
}

}  // namespace

}  // namespace darkroom
