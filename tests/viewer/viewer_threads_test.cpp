// SPDX-License-Identifier: MIT
// edit where no further thread can be started: it says so once, reads and writes while its window waits, and goes on.
#include <fmt/format.h>

#include "tests/places.hpp"
#include "viewer_support.hpp"

namespace darkroom::test {

namespace {

class CliViewerThreads : public ViewerFixture {
  protected:
    std::string frame(const std::string& name, const char* yaw) {
        EXPECT_EQ(run({"render", scenes_folder + "dungeon.scene.toml", "--size", "96x54", "--yaw", yaw, "-o",
                       path("r.png"), "--frame", path(name)})
                      .code,
                  0);
        return path(name);
    }
    [[nodiscard]] std::size_t complaints(const std::string& line) const {
        const std::string text = complained();
        std::size_t found = 0;
        for (std::size_t at = text.find(line); at != std::string::npos; at = text.find(line, at + 1)) ++found;
        return found;
    }
};

TEST_F(CliViewerThreads, WhereNoneCanBeStartedItGoesOnWithoutThem) {
    const std::string library = std::string(test::binary_folder) + "/bin/darkroom_refuse_threads.so";
    if (!std::filesystem::exists(library)) GTEST_SKIP() << "sanitizers want to be first";
    for (const int number : {1, 2, 3}) frame(fmt::format("shot.{:04}.exr", number), number == 2 ? "40" : "0");
    write("ui.svg",
          "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 96 54\">"
          "<rect width=\"20\" height=\"20\" fill=\"#ff00ff\"/></svg>");
    const std::string look = write("my.toml", "[post_process]\n\n[ui]\ndocument = \"ui.svg\"\n");
    start({"edit", path("shot.####.exr"), "--look", look, "--fps", "24", "--paused", "--size", "1280x720"},
          {"env", "LD_PRELOAD=" + library});
    EXPECT_EQ(complaints("no further thread can be started: the window waits while frames are read"), 1U)
        << complained();
    const Picture first = shot();
    EXPECT_GT(first.at(2, 2)[0], 0.9F) << "the interface is drawn";
    press("period", "frame 2 of 3: shot.0002.exr");
    EXPECT_GT(difference(first, shot()), 0.02) << "the next frame is read";
    EXPECT_EQ(complaints("no further thread can be started: the window waits while files are read and written"), 1U)
        << "once for two pictures: " << complained();
    click("stack/add");
    EXPECT_TRUE(wait_until(
        [&] { return complaints("no further thread can be started: effects are offered without pictures") == 1; }, 60))
        << complained();
    press("Escape");
    EXPECT_EQ(difference(shot(), shot()), 0) << "it goes on";
    press("alt+F4");
    EXPECT_EQ(viewer().wait(std::chrono::seconds(60)), 0) << said() << complained();
}

}  // namespace

}  // namespace darkroom::test
