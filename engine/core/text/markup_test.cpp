// SPDX-License-Identifier: MIT
#include "core/text/markup.hpp"

#include <gtest/gtest.h>

#include <array>

namespace darkroom {
namespace {

TEST(Markup, TextCannotEndATagOrAnAttribute) {
    EXPECT_EQ(escaped("<a b=\"c\" d='e'>&lt;"), "&lt;a b=&quot;c&quot; d=&apos;e&apos;&gt;&amp;lt;");
    EXPECT_EQ(escaped("é plain"), "é plain");
}

// RFC 4648, section 10, and all bits.
TEST(Markup, Base64IsThatOfItsStandard) {
    for (const auto& [text, expected] :
         std::array<std::pair<std::string_view, std::string_view>, 7>{{{"", ""},
                                                                       {"f", "Zg=="},
                                                                       {"fo", "Zm8="},
                                                                       {"foo", "Zm9v"},
                                                                       {"foob", "Zm9vYg=="},
                                                                       {"fooba", "Zm9vYmE="},
                                                                       {"\xff\xfe\xfb\xef", "//777w=="}}})
        EXPECT_EQ(base64(std::as_bytes(std::span(text))), expected);
}

}  // namespace
}  // namespace darkroom
