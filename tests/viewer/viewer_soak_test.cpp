// SPDX-License-Identifier: MIT
// A window that is open for hours: keys, files that change on disk and sizes come round and round while frames are
// shown, and nothing may stay behind.
#include <fmt/format.h>

#include <array>
#include <random>

#include "edit/document.hpp"
#include "image/frame/frame_file.hpp"
#include "tests/places.hpp"
#include "viewer_support.hpp"

namespace darkroom::test {

namespace {

constexpr std::uint64_t all_frames = 300'000;
/// The console keeps its last 500 lines, and each round brings two: then there are all that it ever has, and what
/// allocator and driver keep, too.
constexpr std::uint64_t warm_up_rounds = 250, all_rounds = 300;
/// Under the validation layer, which itself keeps 60 to 430 bytes a frame.
constexpr std::uint64_t validated_frames = 2'000;
/// How much more the viewer's own code may hold at the end than after the warm-up, in bytes: what is shown is the same
/// at both. One byte a frame, left behind in each, is more, and so are 400 a round.
constexpr std::int64_t max_own_growth = 16 << 10;
/// The same of drivers and libraries. A round leaves more behind if it forgets a single image of 160 by 90 (115 KiB,
/// and some 15 at each of the other sizes).
constexpr std::int64_t max_other_growth = 2 << 20;

constexpr std::string_view scene_text = R"(format = 1
[scene]
name = "Small"
[camera]
position = [0, 2, 8]
target = [0, 1, 0]
[entities.sun.light]
direction = [0.6, 1, 0.4]
intensity = 2.6
[entities.ground]
bounds = { min = [-7, -0.2, -4], max = [7, 0, 4] }
[entities.box]
bounds = { min = [-1, 0, -1], max = [1, 2, 1] }
)";
constexpr std::string_view look_text = "[post_process]\nbloom_enabled = true\nbloom_intensity = 0.2\n";

class SoakViewer : public ViewerFixture {
  protected:
    /// As editors do: the file is never seen half.
    void replace(const std::string& name, std::string_view text) const {
        std::filesystem::rename(write(name + ".new", std::string(text)), path(name));
    }
    void reload(const std::string& name, std::string_view text) {
        const std::string line = "read " + name + " again";
        const std::size_t before = count(line);
        replace(name, text);
        EXPECT_TRUE(wait_until([&] { return count(line) > before; }, 60)) << complained();
    }
    /// Waits for the one line that says what is wrong, and puts the file right.
    void break_and_mend(const std::string& name, std::string_view good) {
        ++broken_;
        replace(name, "[post_process]\nbloom_intensity = = 3\n");
        EXPECT_TRUE(wait_until([&] { return complaints() == broken_; }, 60)) << name << ": " << complained();
        replace(name, good);
    }
    [[nodiscard]] std::size_t complaints() const {
        const std::string text = complained();
        return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    }
    void resize(std::uint32_t width, std::uint32_t height) const {
        ASSERT_EQ(shell(fmt::format("xdotool windowsize --sync {} {} {}", window(), width, height)), 0);
    }
    /// The number of the frame that is on the screen, from a stored one.
    [[nodiscard]] std::uint64_t frame_number() {
        press("ctrl+c", "stored frame-0001.exr");
        const Result<FrameFile> frame = read_frame(path("frame-0001.exr"));
        std::filesystem::remove(path("frame-0001.exr"));
        EXPECT_TRUE(frame && frame->frame_index);
        return frame ? frame->frame_index.value_or(0) : 0;
    }
    /// KiB of the viewer's that are in memory.
    [[nodiscard]] long resident() {
        const std::string status = content(fmt::format("/proc/{}/status", viewer().id()));
        const std::size_t at = status.find("VmRSS:");
        return at == std::string::npos ? 0 : std::strtol(status.c_str() + at + 6, nullptr, 10);
    }
    /// Every toggle is a step of undo: as many as are kept, so that those to come replace others.
    void fill_undo() {
        constexpr std::size_t steps = edit::LookDocument::max_steps;
        ASSERT_EQ(shell(fmt::format("xdotool key --delay 10 --repeat {} F9", steps)), 0);
        EXPECT_TRUE(wait_until([&] { return count("F9 dither") == steps; }, 60)) << count("F9 dither");
    }
    /// Bytes that the viewer's own code holds, and all others in its process (count_memory.cpp), while nothing is being
    /// read or compiled: the least of a second.
    using Live = std::array<std::int64_t, 2>;
    [[nodiscard]] Live live() const {
        constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
        Live least{most, most};
        for (int i = 0; i < 20; ++i) {
            Live now{};
            std::ifstream(path("live")).read(reinterpret_cast<char*>(now.data()), sizeof now);
            for (std::size_t of = 0; of < now.size(); ++of) least[of] = std::min(least[of], now[of]);
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        return least;
    }
    void start_in(std::vector<std::string> environment) {
        write("my.toml", std::string(look_text));
        write("small.scene.toml", std::string(scene_text));
        environment.insert(environment.begin(), "env");
        start({"play", "small.scene.toml", "--look", "my.toml", "--size", "160x90", "--present", "immediate"},
              std::move(environment));
    }
    /// Nothing was said but what was wrong with the broken files.
    void leave_in_silence() {
        press("alt+F4");
        EXPECT_EQ(viewer().wait(std::chrono::seconds(60)), 0) << complained();
        EXPECT_EQ(complaints(), broken_) << complained();
    }
    /// All that happens, once; the window then shows what it did before.
    void round() {
        for (const std::string_view view : {"wireframe", "normals", "depth", "uv", "unlit", "metal-rough", "none"})
            press("F1", fmt::format("F1 debug view: {}", view));
        for (int i = 0; i < 2; ++i)
            for (const int key : {4, 5, 6, 7, 8, 9, 10}) press(fmt::format("F{}", key), fmt::format("F{} ", key));
        press("F12", "stored darkroom-0001.png");
        std::filesystem::remove(path("darkroom-0001.png"));
        reload("my.toml", fmt::format("{}fog_density = {:.3f}\n", look_text, 0.001 * random(50, 150)));
        break_and_mend("my.toml", look_text);
        reload("small.scene.toml",
               fmt::format("{}material = {{ color = [0.8, 0.1, 0.{}] }}\n", scene_text, random(0, 9)));
        break_and_mend("small.scene.toml", scene_text);
        // Sizes that come again: what a new one asks for is kept, and would hide what is left behind.
        for (int i = 0; i < 8; ++i, ++resizes_) resize(100 + 17 * (resizes_ % sizes), 60 + 11 * (5 * resizes_ % sizes));
        resize(160, 90);
    }

  private:
    static constexpr std::uint32_t sizes = 12;

    [[nodiscard]] std::uint32_t random(std::uint32_t least, std::uint32_t most) {
        return std::uniform_int_distribution(least, most)(random_);
    }

    std::mt19937 random_{13};
    std::size_t broken_ = 0;
    std::uint32_t resizes_ = 0;
};

TEST_F(SoakViewer, SaysNothingInManyFrames) {
    start_in({"DARKROOM_VALIDATE=1"});
    if (HasFatalFailure()) return;
    while (frame_number() < validated_frames && !HasFailure()) round();
    leave_in_silence();
}

TEST_F(SoakViewer, LeavesNothingBehindInManyFrames) {
    start_in({"DARKROOM_VALIDATE=0", "LD_PRELOAD=" + std::string(test::binary_folder) + "/bin/darkroom_count_memory.so",
              "DARKROOM_LIVE_BYTES=" + path("live")});
    if (HasFatalFailure()) return;
    fill_undo();
    std::uint64_t frame = 0;
    Live first{};
    long first_resident = 0;
    for (std::uint64_t rounds = 1; (frame < all_frames || rounds <= all_rounds) && !HasFailure(); ++rounds) {
        round();
        frame = frame_number();
        const Live now = live();
        if (rounds == warm_up_rounds) {
            first = now;
            first_resident = resident();
        }
        fmt::print("frame {}: {} bytes its own, {} of others, {} KiB resident\n", frame, now[0], now[1], resident());
        std::fflush(stdout);
    }
    const Live last = live();
    RecordProperty("frames", fmt::format("{}", frame));
    RecordProperty("own_growth_bytes", fmt::format("{}", last[0] - first[0]));
    RecordProperty("other_growth_bytes", fmt::format("{}", last[1] - first[1]));
    RecordProperty("resident_growth_kib", fmt::format("{}", resident() - first_resident));
    EXPECT_GT(first[0], 0) << "nothing is counted";
    EXPECT_LE(last[0] - first[0], max_own_growth) << "from " << first[0];
    EXPECT_LE(last[1] - first[1], max_other_growth) << "from " << first[1];
    leave_in_silence();
}

}  // namespace

}  // namespace darkroom::test
