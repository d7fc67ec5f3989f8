// SPDX-License-Identifier: MIT
// What `darkroom new` writes passes every check that there is, as it is written.
#include <darkroom/effects.hpp>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom {
namespace {

using test::content;
using test::Outcome;

class CliNew : public test::CliFixture {
  protected:
    void make_files() override {
        for (const char* const name : {"bloom", "exposure", "tonemap", "vignette", "dither", "encode"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "the effect " << name << " is not in this build";
        FrameFile frame;
        frame.color = Picture(24, 16);
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i)
            frame.color.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>((i * 37) % 101) / 60.0f;  // some of it glows
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
    }
    /// Nothing is warned of either.
    void expect_clean(const std::string& line) {
        const Outcome outcome = run_lines(line);
        EXPECT_EQ(outcome.code, 0) << line << "\n" << outcome.err;
        EXPECT_EQ(outcome.err, "") << line;
        told_ = outcome.told;
    }
    /// The command that the last one told of.
    void expect_clean_next() {
        expect_clean(told_.substr(told_.find("darkroom "), told_.find('\n') - told_.find("darkroom ")));
    }

  private:
    std::string told_;
};

TEST_F(CliNew, AnEffectDoesWhatItSays) {
    expect_clean("darkroom new effect cold_shadows");
    expect_clean_next();
    expect_clean("darkroom effects cold_shadows.glsl");
    expect_clean("darkroom develop frame.exr -o plain.png");
    expect_clean("darkroom develop frame.exr --effect cold_shadows.glsl -o tinted.png");
    expect_clean("darkroom develop frame.exr --effect cold_shadows.glsl --cold-shadows-amount 0 -o none.png");
    expect_clean("darkroom plan --effect cold_shadows.glsl --kernels raster");
    EXPECT_NE(content(path("plain.png")), content(path("tinted.png")));
    EXPECT_EQ(content(path("plain.png")), content(path("none.png")));
    write(
        "stack.toml",
        "[[stack]]\neffect = \"tonemap\"\n[[stack]]\neffect = \"cold_shadows.glsl\"\n[[stack]]\neffect = \"encode\"\n");
    expect_clean("darkroom develop frame.exr --look stack.toml --strict -o stack.png");
}

TEST_F(CliNew, ALookIsReadStrictly) {
    expect_clean("darkroom new look evening");
    expect_clean_next();
    expect_clean("darkroom develop frame.exr --look evening.toml --strict -o picture.png");
    expect_clean("darkroom info evening.toml");
    expect_clean("darkroom plan evening.toml --strict");
    EXPECT_NE(content(path("evening.toml")).find("darkroom plan evening.toml"), std::string::npos);
}

TEST_F(CliNew, ASceneIsRenderedStrictly) {
    expect_clean("darkroom new scene room");
    expect_clean_next();
    expect_clean("darkroom render room.scene.toml --strict --size 64x36 -o picture.png");
    expect_clean("darkroom info room.scene.toml");
    const Picture made = picture("picture.png");
    const auto [least, most] = std::ranges::minmax(made.pixels);
    EXPECT_LT(least, 0.3f);
    EXPECT_GT(most, 0.9f) << "something is lit";
}

// The line is one that a shell takes.
TEST_F(CliNew, TheNextCommandIsQuoted) {
    const auto told = [&](const std::string& name) { return run({"new", "scene", path(name)}).told; };
    EXPECT_NE(told("room").find("darkroom render " + path("room.scene.toml") + " -o"), std::string::npos);
    EXPECT_NE(told("my room's")
                  .find(fmt::format("darkroom render '{}/my room'\\''s.scene.toml' -o",
                                    fs::path(path("x")).parent_path().string())),
              std::string::npos)
        << told("other room");
}

TEST_F(CliNew, NothingIsOverwrittenUnasked) {
    expect_clean("darkroom new look evening");
    write("evening.toml", "mine");
    expect_refused({"new", "look", path("evening")}, 1, "evening.toml: exists already; --force replaces it");
    EXPECT_EQ(content(path("evening.toml")), "mine");
    expect_clean("darkroom new look evening.toml --force");
    EXPECT_NE(content(path("evening.toml")), "mine");
    expect_refused({"new", "effect", path("bloom")}, 1, "new effect bloom: an effect of this name is built in");
    for (const char* const name : {"Bad", "a-b", "1st", "a b", "main", "float"})
        expect_refused({"new", "effect", path(name)}, 1, std::string("new effect ") + name + ": a name is of");
    expect_refused({"new", "scene", path("none/room")}, 1, "none: no such folder, nothing can be written there");
    expect_refused({"new", "picture", "x"}, 1, "new picture: allowed is effect, look or scene");
    expect_refused({"new", "look"}, 1, "NAME");
}

}  // namespace
}  // namespace darkroom
