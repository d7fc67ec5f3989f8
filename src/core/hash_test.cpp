// SPDX-License-Identifier: MIT
#include "core/hash.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <set>
#include <string>

#include "core/folders.hpp"

namespace darkroom {

namespace {

TEST(CoreHash, MatchesPublishedValues) {
    // MurmurHash3 x64 128 without a salt, as other implementations give it.
    EXPECT_EQ(content_hash("").hex(), "00000000000000000000000000000000");
    const Hash hash = content_hash("The quick brown fox jumps over the lazy dog");
    EXPECT_EQ(hash.low, 0xe34bbc7bbc071b6c);
    EXPECT_EQ(hash.high, 0x7a433ca9c49a9347);
}

TEST(CoreHash, EveryByteAndTheLengthCount) {
    std::set<std::string> seen;
    std::string text(40, 'a');
    seen.insert(content_hash(text).hex());
    for (char& character : text) {
        character = 'b';
        seen.insert(content_hash(text).hex());
        character = 'a';
    }
    for (std::size_t size = 0; size < text.size(); ++size) seen.insert(content_hash(text.substr(0, size)).hex());
    EXPECT_EQ(seen.size(), 81U);
}

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
