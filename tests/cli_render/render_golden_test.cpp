// SPDX-License-Identifier: MIT
// The shipped scenes and looks against pictures that make_goldens.sh made.
#include <algorithm>
#include <set>
#include <string>

#include "image/compare/flip.hpp"
#include "tests/cli/cli_support.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

const std::string source = test::source_folder;

/// The share of pixels that a viewer would see to be others. Light that is rounded once more on its way (unfused
/// kernels: a code of 8 bits here and there) reaches a FLIP error of 0.055, and what breaks in an effect goes far
/// beyond at some pixels. The mean would not tell the two apart: it is 0.011 for that rounding, and 0.004 for a
/// showcase without occlusion.
double share_of_other_pixels(const std::filesystem::path& golden, const std::filesystem::path& made) {
    const Result<ComparablePicture> a = read_comparable(golden), b = read_comparable(made);
    EXPECT_TRUE(a && b) << golden << ", " << made;
    if (!a || !b) return 1;
    const Result<FlipErrors> found = flip(a->picture, b->picture, {.encoding = a->encoding});
    EXPECT_TRUE(found) << golden;
    if (!found) return 1;
    const auto others = std::ranges::count_if(found->errors, [](float error) { return error > 0.07F; });
    return static_cast<double>(others) / static_cast<double>(found->errors.size());
}
/// Half of what the least of the breakages below changes. Goldens are of one driver, on which nothing changes.
constexpr double allowed_share = 0.003;

class CliRenderGolden : public test::CliFixture {
  protected:
    [[nodiscard]] static std::filesystem::path golden(const std::string& name) {
        return source + "/proof/goldens/" + name + ".png";
    }
    /// Of pictures that are no more as they were, for whoever looks at what a build server kept of the build folder.
    [[nodiscard]] std::string page_of_differences(const std::string& expected, const std::string& made,
                                                  const std::string& page) const {
        const test::Outcome outcome = run({"compare", expected, made, "--html", page});
        return outcome.code == 0 || outcome.code == 3 ? "before and after: " + page : outcome.err;
    }
};

TEST_F(CliRenderGolden, ScenesAndLooksAreAsTheyWere) {
    const std::string log = path("log");
    const std::string make = "bash " + test::quoted(source + "/tests/scripts/make_goldens.sh") + ' ' +
                             test::quoted(program) + ' ' + test::quoted(path("")) + " >" + test::quoted(log) + " 2>&1";
    ASSERT_EQ(std::system(make.c_str()), 0) << test::content(log);
    std::filesystem::remove(log);
    std::set<std::string> kept;
    for (const auto& file : std::filesystem::directory_iterator(source + "/proof/goldens"))
        kept.insert(file.path().filename().string());
    const std::vector<std::string> made = files();
    EXPECT_EQ(kept, std::set<std::string>(made.begin(), made.end()));
    const std::string page = std::string(test::binary_folder) + "/goldens.html";
    std::filesystem::remove(page);
    for (const std::string& name : made)
        EXPECT_LE(share_of_other_pixels(source + "/proof/goldens/" + name, path(name)), allowed_share) << name;
    if (HasFailure()) ADD_FAILURE() << page_of_differences(source + "/proof/goldens", path(""), page);
}

TEST_F(CliRenderGolden, WhatDiffersIsOnAPage) {
    for (const char* const folder : {"expected", "made"}) {
        std::filesystem::create_directory(path(folder));
        for (const char* const name : {"film.look", "noir.look"})
            std::filesystem::copy_file(golden(name), path(folder) + '/' + name + ".png");
    }
    std::filesystem::copy_file(golden("night.look"), path("made/noir.look.png"),
                               std::filesystem::copy_options::overwrite_existing);
    const std::string told = page_of_differences(path("expected"), path("made"), path("page.html"));
    EXPECT_EQ(told, "before and after: " + path("page.html"));
    const std::string page = test::content(path("page.html"));
    EXPECT_NE(page.find("<h2>noir.look.png"), std::string::npos);
    EXPECT_EQ(page.find("<h2>film.look.png"), std::string::npos);
}

// What the bound is worth: occlusion, of all that is seen the least, is missed in every picture, as is a small change
// of it; rounding is not. What nobody sees (dither, the courtyard's bloom of a code here and there) is left to the
// tests of effects.
class SoakRenderGolden : public CliRenderGolden {};

TEST_F(SoakRenderGolden, ABreakageIsSeenAndRoundingIsNot) {
    struct Case {
        std::string picture;
        std::vector<std::string> flags;
        bool is_other = true;
    };
    const std::vector<std::string> no_occlusion{"--ssao-enabled", "off"};
    for (const auto& [name, flags, is_other] :
         {Case{"dungeon.finished", no_occlusion}, Case{"forge.finished", no_occlusion},
          Case{"courtyard.finished", no_occlusion}, Case{"showcase.finished", no_occlusion},
          Case{"showcase.finished", {"--ssao-radius", "0.25"}}, Case{"documented.look", no_occlusion},
          Case{"plain_bloom.look", {"--exposure", "0.95"}}, Case{"courtyard.finished", {"--no-fuse"}, false},
          Case{"bright.look", {"--no-fuse"}, false}}) {
        const std::string file = name.substr(0, name.find('.'));
        std::vector<std::string> arguments{"render", source + "/scenes/" + file + ".scene.toml", "--size", "320x180"};
        if (name.ends_with(".look"))
            arguments = {"develop", source + "/samples/window.exr",
                         "--look",  source + "/looks/" + file + ".toml",
                         "--size",  "192x108"};
        arguments.insert(arguments.end(), {"--device", "llvmpipe", "-o", path("x.png")});
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const test::Outcome outcome = run(arguments);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const double share = share_of_other_pixels(golden(name), path("x.png"));
        EXPECT_EQ(share > allowed_share, is_other) << name << ' ' << flags[0] << ": " << share;
    }
}

}  // namespace
}  // namespace darkroom
