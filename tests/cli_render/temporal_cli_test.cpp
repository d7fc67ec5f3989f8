// SPDX-License-Identifier: MIT
// Frames of another size than their picture.

#include "tests/cli_render/render_cli_support.hpp"

namespace darkroom {
namespace {

using test::Outcome;

class CliTemporal : public test::CliRender {};

TEST_F(CliTemporal, StoredFramesAreDevelopedIntoLargerPictures) {
    ASSERT_EQ(render({"--size", "24x16", "--save-frame", path("half.exr")}).code, 0);
    const auto develop = [&](std::vector<std::string> flags, const std::string& out) {
        flags.insert(flags.begin(), {"develop", path("half.exr"), "-o", path(out)});
        const Outcome outcome = run(flags);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return picture(out);
    };
    const Picture large = develop({"--output-size", "49x33"}, "large.png");
    EXPECT_EQ(large.width, 49U);
    EXPECT_EQ(large.height, 33U);
    const Picture reference = develop({"--output-size", "49x33", "--reference"}, "reference.png");
    double worst = 0;
    for (std::size_t i = 0; i < large.pixels.size(); ++i)
        worst = std::max(worst, double(std::abs(large.pixels[i] - reference.pixels[i])));
    EXPECT_LT(worst, 4.0 / 255);
    expect_refused({"develop", path("half.exr"), "--output-size", "0x2", "-o", path("x.png")}, 1,
                   "--output-size 0x2: expected WIDTHxHEIGHT");
    expect_refused({"develop", path("half.exr"), "--output-size", "9x9", "--keep-layers", "-o", path("x.exr")}, 1,
                   "--output-size: --keep-layers keeps");
}

}  // namespace
}  // namespace darkroom
