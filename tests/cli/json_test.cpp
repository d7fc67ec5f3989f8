// SPDX-License-Identifier: MIT
// The value that documents and records are made of: what is written of it, and what of a text is read.
#include "programs/darkroom/run/json.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace app {
namespace {

TEST(Json, ListsAreObjectsWhereAllAreNamed) {
    const Json json{{"size", {640, 360}}, {"name", "a"}, {"none", nullptr}};
    EXPECT_EQ(json.dump(), R"({"size":[640,360],"name":"a","none":null})");
    EXPECT_EQ((Json{{"a", 1}, {2, 3}}).dump(), R"([["a",1],[2,3]])");
    EXPECT_EQ((Json{std::string("a")}).dump(), R"(["a"])");
}

TEST(Json, NumbersKeepWhatTheyAre) {
    EXPECT_EQ(Json(std::size_t{7}).dump(), "7");
    EXPECT_EQ(Json(-1).dump(), "-1");
    EXPECT_EQ(Json(1.0).dump(), "1.0");
    EXPECT_EQ(Json(0.1F).dump(), "0.10000000149011612");
    EXPECT_EQ(Json(true).dump(), "true");
    EXPECT_EQ(json_number(std::numeric_limits<double>::infinity()).dump(), "\"inf\"");
    EXPECT_EQ(Json(std::vector<std::array<long long, 2>>{{0, 6}, {9, 9}}).dump(), "[[0,6],[9,9]]");
}

TEST(Json, MembersKeepTheirOrderAndAreReplaced) {
    Json json{{"b", 1}, {"a", 2}};
    json.update({{"b", 3}, {"c", 4}});
    json["list"].push_back("x");
    EXPECT_EQ(json.dump(), R"({"b":3,"a":2,"c":4,"list":["x"]})");
    EXPECT_EQ(json.dump(1), "{\n \"b\": 3,\n \"a\": 2,\n \"c\": 4,\n \"list\": [\n  \"x\"\n ]\n}");
}

TEST(Json, ReadsWhatItWrites) {
    const std::string text = R"({"a":[1,-2,1.5,true,null,"x"],"b":{"c":9223372036854775807}})";
    const std::optional<Json> json = Json::parse(text);
    ASSERT_TRUE(json);
    EXPECT_EQ(json->dump(), text);
    ASSERT_NE(json->find("b"), nullptr);
    EXPECT_EQ(json->find("b")->find("c")->whole(), std::numeric_limits<std::int64_t>::max());
    EXPECT_EQ(json->find("c"), nullptr);
    const std::optional<Json> large = Json::parse("18446744073709551615");
    ASSERT_TRUE(large);
    EXPECT_FALSE(large->is_whole());
}

TEST(Json, RefusesWhatIsNone) {
    EXPECT_FALSE(Json::parse("{"));
    EXPECT_EQ(Json::value_or_text("inf").dump(), "\"inf\"");
    const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    EXPECT_TRUE(Json::parse(nested(64)));
    EXPECT_FALSE(Json::parse(nested(1'000'000)));
}

TEST(Json, WritesASignForWhatIsNoText) { EXPECT_EQ(Json("a\xff").dump(), "\"a\xEF\xBF\xBD\""); }

}  // namespace
}  // namespace app
