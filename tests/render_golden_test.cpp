// SPDX-License-Identifier: MIT
// The shipped scenes as the renderer draws them, without post-processing, against pictures that make_goldens.sh made.
#include <string>

#include "cli_support.hpp"

namespace darkroom {
namespace {

class CliRenderGolden : public test::CliFixture {};

TEST_F(CliRenderGolden, TheScenesLookAsTheyDid) {
    const std::string source = DARKROOM_SOURCE_FOLDER;
    for (const std::string scene : {"dungeon", "forge", "courtyard", "showcase"}) {
        SCOPED_TRACE(scene);
        const test::Outcome outcome = run({"render", source + "/scenes/" + scene + ".scene.toml", "--no-postprocess",
                                           "--msaa", "4", "--size", "192x108", "-o", path(scene + ".png")});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const Result<ComparablePicture> golden = read_comparable(source + "/tests/goldens/" + scene + ".png");
        ASSERT_TRUE(golden) << golden.error().text;
        const Result<Comparison> found =
            compare(golden->picture, picture(scene + ".png"), {.encoding = golden->encoding});
        ASSERT_TRUE(found) << found.error().text;
        // Another driver places edges otherwise: a hundredth of the pixels may be of another surface.
        EXPECT_LE(found->flip_mean, 0.01);
    }
}

}  // namespace
}  // namespace darkroom
