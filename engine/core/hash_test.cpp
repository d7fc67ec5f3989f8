// SPDX-License-Identifier: MIT
#include "core/hash.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

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

}  // namespace

}  // namespace darkroom
