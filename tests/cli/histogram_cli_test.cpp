// SPDX-License-Identifier: MIT
// `darkroom histogram`: a frame whose light was chosen, told back.
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli_support.hpp"
#include "image/exr/test_exr.hpp"

namespace darkroom {
namespace {

using nlohmann::json;
using test::Outcome;

class CliHistogram : public test::CliFixture {
  protected:
    /// Of 100 pixels 40 of middle grey, 30 two stops above, 20 black, 7 four and a half stops below, one infinite, two
    /// that are no number in a channel.
    void make_files() override {
        std::vector<float> values;
        for (std::uint32_t i = 0; i < 100; ++i)
            values.insert(values.end(), 3,
                          i < 40   ? 0.18001f
                          : i < 70 ? 0.72001f
                          : i < 90 ? 0.0f
                          : i < 99 ? 0.18f * std::exp2(-4.5f)
                                   : std::numeric_limits<float>::infinity());
        values[97 * 3] = values[98 * 3 + 1] = std::numeric_limits<float>::quiet_NaN();
        test::store_floats(path("frame.exr"), {"R", "G", "B"}, 10, values);
    }
};

TEST_F(CliHistogram, TellsTheSharesOfStopsAndWhatIsNoLight) {
    const Outcome text = run({"histogram", path("frame.exr")});
    EXPECT_EQ(text.code, 0) << text.err;
    for (const char* const line : {"   +2  30.00 % ##############################\n", "   +0  40.00 % ####",
                                   "   -5   7.00 % #######\n", "20.00 % black or below", "  2.00 % NaN in a channel",
                                   "  1.00 % infinite in a channel", "50 % +0.0", "95 % +2.0"})
        EXPECT_NE(text.out.find(line), std::string::npos) << line << text.out;
    const Outcome document = run({"histogram", path("frame.exr"), "--json"});
    const json out = json::parse(document.out);
    EXPECT_EQ(out.at("black"), 20);
    EXPECT_EQ(out.at("nan"), 2);
    EXPECT_EQ(out.at("infinite"), 1);
    EXPECT_EQ(out.at("above_white"), 0);
    EXPECT_EQ(out.at("stops").size(), 8u) << "what is no number is in no stop";
    EXPECT_EQ(out.at("stops").front(), (json{{"from", -5}, {"pixels", 7}}));
    EXPECT_NEAR(out.at("brightest").get<double>(), 0.72001, 1e-6);
    EXPECT_EQ(json::parse(run({"histogram", path("frame.exr"), path("frame.exr"), "--json"}).out).size(), 2u);
}

TEST_F(CliHistogram, NamesAFileThatIsNone) {
    const Outcome out = run({"histogram", path("none.exr")});
    EXPECT_EQ(out.code, 1);
    EXPECT_EQ(std::ranges::count(out.err, '\n'), 1) << out.err;
    EXPECT_NE(out.err.find("none.exr"), std::string::npos);
}

}  // namespace
}  // namespace darkroom
