// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "core/system/folders.hpp"

namespace darkroom {

namespace {

/// Puts an environment variable back as it was.
class KeepVariable {
  public:
    explicit KeepVariable(const char* name) : name_(name) {
        if (const char* value = std::getenv(name); value != nullptr) value_ = value;
    }
    KeepVariable(const KeepVariable&) = delete;
    KeepVariable& operator=(const KeepVariable&) = delete;
    ~KeepVariable() { value_ ? setenv(name_, value_->c_str(), 1) : unsetenv(name_); }

  private:
    const char* name_;
    std::optional<std::string> value_;
};

TEST(CoreFolders, FollowTheEnvironment) {
    const KeepVariable cache("XDG_CACHE_HOME");
    const KeepVariable home("HOME");
    ASSERT_EQ(setenv("XDG_CACHE_HOME", "/somewhere", 1), 0);
    EXPECT_EQ(user_cache_folder(), "/somewhere/darkroom");
    ASSERT_EQ(setenv("XDG_CACHE_HOME", "relative", 1), 0);
    ASSERT_EQ(setenv("HOME", "/home/of/me", 1), 0);
    EXPECT_EQ(user_cache_folder(), "/home/of/me/.cache/darkroom");
    ASSERT_EQ(unsetenv("HOME"), 0);
    EXPECT_TRUE(user_cache_folder().empty());
}

}  // namespace

}  // namespace darkroom
