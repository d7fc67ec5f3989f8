// SPDX-License-Identifier: MIT
// What a farm makes is what one machine makes: chunk by chunk with the tasks alone, and on a cluster of Slurm's own
// programs where they are installed, with a task killed and a node taken down on the way.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <darkroom/effects.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "image/frame/frame_file.hpp"
#include "tests/cli/cli_support.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;
using test::content;
using test::Outcome;

class FarmFixture : public test::CliFixture {
  protected:
    /// Frames from 0 on, each another picture.
    void make_frames(int count) const {
        for (int number = 0; number < count; ++number) {
            FrameFile frame;
            frame.color = Picture(48, 32);
            for (std::size_t i = 0; i < frame.color.pixels.size(); ++i)
                frame.color.pixels[i] =
                    i % 4 == 3 ? 1.0f : static_cast<float>((i * 37 + static_cast<std::size_t>(number)) % 101) / 40.0f;
            ASSERT_TRUE(write_frame(path(in(number)), frame));
        }
        for (const char* const folder : {"one", "out"}) fs::create_directory(path(folder));
    }
    static std::string in(int number) { return fmt::format("shot.{:04}.exr", number); }
    static std::string out(const std::string& folder, int number) {
        return fmt::format("{}/shot.{:04}.png", folder, number);
    }
    [[nodiscard]] json record(const std::string& name) const {
        return json::parse(content(path("out/shot.farm/" + name + ".json")), nullptr, false);
    }
    [[nodiscard]] json status() const { return json::parse(run_lines("darkroom farm status out --json").out); }
    /// A frame that comes when it is told to: until then, who reads it waits.
    void hold_back(int number) const { write(in(number) + ".held", ""); }
    void let_come(int number) const { fs::remove(path(in(number) + ".held")); }
    inline static const std::string hold_back_library = std::string(test::binary_folder) + "/bin/darkroom_hold_back.so";
};

class CliFarm : public FarmFixture {
  protected:
    void make_files() override { make_frames(3); }
};

TEST_F(CliFarm, ATaskMakesWhatDevelopMakesAndWritesWhatItDid) {
    ASSERT_EQ(run_lines("darkroom develop 'shot.####.exr' --exposure 2 -o one/").code, 0);
    const Outcome task = run_lines("darkroom farm task 'shot.####.exr' -o out/ --frames 1-2 -- --exposure 2");
    ASSERT_EQ(task.code, 0) << task.err;
    EXPECT_FALSE(fs::exists(path(out("out", 0))));
    for (const int number : {1, 2}) EXPECT_EQ(content(path(out("out", number))), content(path(out("one", number))));
    const json did = record("1-2");
    EXPECT_EQ(did["state"], "done");
    EXPECT_EQ(did["done"], json::parse("[[1,2]]"));
    EXPECT_EQ(did["tries"], 1);
    EXPECT_EQ(did["made"], 2);
    EXPECT_NE(task.told.find("shot.0002.exr -> out/shot.0002.png"), std::string::npos) << task.told;
    EXPECT_EQ(run_lines("darkroom farm task 'shot.####.exr' -o out/ --frames 1-2 -- --exposure 2").code, 0);
    EXPECT_EQ(record("1-2")["made"], 2) << "all was there, and who made it stays written";
    EXPECT_EQ(run_lines("darkroom farm task 'shot.####.exr' -o out/ --frames 0 -q -- --exposure 2").told, "");
    EXPECT_EQ(record("0-0")["made"], 1);
    write(out("out", 1), "");
    EXPECT_EQ(status()["missing"], json::parse("[[1,1]]")) << "one that was lost since is not done";
}

// Pictures of two looks in one folder are told by nobody afterwards.
TEST_F(CliFarm, TasksThatNothingSubmittedAreHeldAgainstTheFirst) {
    const std::string task = "darkroom farm task 'shot.####.exr' --look my.toml -o out/ --frames ";
    const std::string elsewhere = "or write elsewhere with -o\n";
    write("my.toml", "[post_process]\nexposure = 1.0\n");
    ASSERT_EQ(run_lines(task + "0-1").code, 0);
    write("my.toml", "[post_process]\nexposure = 2.0\n");
    const Outcome changed = run_lines(task + "2");
    EXPECT_EQ(changed.code, 1);
    EXPECT_EQ(changed.err,
              "darkroom: out/shot.farm: my.toml has changed since its pictures were made; "
              "remove its pictures, " +
                  elsewhere);
    const Outcome other = run_lines(task + "2 -- --exposure 2");
    EXPECT_EQ(other.code, 1);
    EXPECT_EQ(other.err,
              "darkroom: out/shot.farm: its pictures were made with other arguments "
              "(shot.####.exr -o out/ --look my.toml); remove it and its pictures, " +
                  elsewhere);
    EXPECT_FALSE(fs::exists(path(out("out", 2))));
    json killed = record("0-1");
    killed["state"] = "begun";
    killed["done"] = json::array();
    write("out/shot.farm/0-1.json", killed.dump());
    EXPECT_EQ(run_lines(task + "2").err, changed.err) << "pictures that nobody wrote down count, too";
    for (const int number : {0, 1}) fs::remove(path(out("out", number)));
    EXPECT_EQ(run_lines(task + "2").code, 0) << "none of them is left";
    // Who removes the records alone has pictures of nobody knows which look.
    fs::remove_all(path("out/shot.farm"));
    const Outcome unknown = run_lines(task + "0-2 -- --exposure 3");
    EXPECT_EQ(unknown.code, 1);
    EXPECT_EQ(unknown.err,
              "darkroom: out/shot.farm: 1 picture is there, from shot.0002.png on, and no record says of which look; "
              "remove it, " +
                  elsewhere);
    EXPECT_EQ(run_lines(task + "0 -- --exposure 3").err, unknown.err) << "nor in another chunk";
    EXPECT_FALSE(fs::exists(path("out/shot.farm")));
}

// Slurm may begin a task before the job is written down, which the task must not do in its place.
TEST_F(CliFarm, ATaskOfSlurmWritesNoJob) {
    const std::string slurm = "SLURM_ARRAY_JOB_ID=17 SLURM_ARRAY_TASK_ID=0 ";
    EXPECT_EQ(run_lines(slurm + "darkroom farm task 'shot.####.exr' -o out/ --frames 0").code, 0);
    EXPECT_EQ(record("0-0")["job"], "17_0");
    EXPECT_FALSE(fs::exists(path("out/shot.farm/job.json")));
}

TEST_F(CliFarm, FramesWithoutInputAreTold) {
    const Outcome task = run_lines("darkroom farm task 'shot.####.exr' -o out/ --frames 2-5");
    EXPECT_EQ(task.code, 0);
    EXPECT_NE(task.err.find("--frames 2-5: no input has these numbers: 3-5\n"), std::string::npos)
        << task.err;
}

// Slurm sends the task a signal, and not what it has started; nobody can pass SIGKILL on.
TEST_F(CliFarm, WhatATaskHasStartedEndsWithIt) {
    FrameFile large;
    large.color = Picture(1500, 1500);
    ASSERT_TRUE(write_frame(path(in(0)), large));
    for (int number = 1; number < 60; ++number) {
        fs::remove(path(in(number)));
        fs::create_symlink(in(0), path(in(number)));
    }
    for (const std::string signal : {"TERM", "KILL"}) {
        fs::remove_all(path("out"));
        fs::create_directory(path("out"));
        const Outcome outcome = run_lines(
            "set +e\ndarkroom farm task 'shot.####.exr' -o out/ --frames 0-59 -q &\ntask=$!\n"
            "for i in $(seq 200); do test -e out/shot.0001.png && break; sleep 0.1; done\n"
            "child=$(grep -ls \"^PPid:[[:space:]]*$task$\" /proc/[0-9]*/status | cut -d/ -f3 | head -n 1)\ntest -n "
            "\"$child\" || echo no child\n"
            "kill -" +
            signal +
            " $task\nwait $task\n"
            "for i in $(seq 600); do kill -0 $child 2>/dev/null || break; sleep 0.05; done\n"
            "kill -0 $child 2>/dev/null && echo is running\nexit 0");
        EXPECT_EQ(outcome.out, "") << signal;
        EXPECT_FALSE(fs::exists(path(out("out", 59)))) << signal;
    }
}

TEST_F(CliFarm, AFrameThatFailsIsTriedThreeTimesMoreAndLeavesTheOthersAlone) {
    const std::string good = content(path(in(1)));
    write(in(1), "no picture");
    const Outcome task = run_lines("darkroom farm task 'shot.####.exr' -o out/ --frames 0-2");
    EXPECT_EQ(task.code, 1);
    EXPECT_TRUE(task.err.ends_with("darkroom: frame 1 failed in 4 tries: out/shot.farm/0-2.json\n")) << task.err;
    EXPECT_EQ(record("0-2")["state"], "failed");
    EXPECT_EQ(record("0-2")["done"], json::parse("[[0,0],[2,2]]"));
    const std::string told = run_lines("darkroom farm status out").out;
    EXPECT_TRUE(told.starts_with("out/shot.farm: 3 frames: 2 done, 1 failed, 0 missing\n  failed: 1 on ")) << told;
    EXPECT_NE(told.find(", 4 tries: darkroom: shot.0001.exr: is not a picture of a known format"), std::string::npos)
        << told;
    write(in(1), good);
    write(out("out", 0), "there");
    EXPECT_EQ(run_lines("darkroom farm task 'shot.####.exr' -o out/ --frames 0-2").code, 0);
    EXPECT_EQ(record("0-2")["state"], "done");
    EXPECT_EQ(record("0-2")["made"], 1);
    EXPECT_EQ(content(path(out("out", 0))), "there");
}

// What the test of a cluster relies on.
TEST_F(CliFarm, AFrameThatIsHeldBackIsWaitedFor) {
    if (!fs::exists(hold_back_library)) GTEST_SKIP() << hold_back_library << " is not built";
    hold_back(1);
    const std::string task = "env LD_PRELOAD=" + test::quoted(hold_back_library) +
                             " darkroom farm task 'shot.####.exr' -o out/ --frames 0-1 -q";
    EXPECT_EQ(run_lines("timeout 5 " + task).code, 124);
    EXPECT_TRUE(fs::exists(path(out("out", 0))));
    EXPECT_FALSE(fs::exists(path(out("out", 1))));
    let_come(1);
    EXPECT_EQ(run_lines(task).code, 0);
    EXPECT_TRUE(fs::exists(path(out("out", 1))));
}

TEST_F(CliFarm, AScenesFramesAreThoseOfRender) {
    write("box.scene.toml", "[entities.box]\nbounds = { min = [-1, 0, -1], max = [1, 1, 1] }\n");
    ASSERT_EQ(run_lines("darkroom render box.scene.toml --frames 3-4 --size 32x18 --yaw 30 -o 'one/box.##.png'").code,
              0);
    const Outcome task =
        run_lines("darkroom farm task box.scene.toml -o 'out/box.##.png' --frames 3-4 -- --size 32x18 --yaw 30");
    ASSERT_EQ(task.code, 0) << task.err;
    for (const char* const name : {"box.03.png", "box.04.png"})
        EXPECT_EQ(content(path(std::string("out/") + name)), content(path(std::string("one/") + name)));
    EXPECT_TRUE(fs::exists(path("out/box.farm/3-4.json")));
}

class SoakFarm : public FarmFixture {
  protected:
    static constexpr int count = 24;

    void SetUp() override {
        for (const char* const name : {"munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol"})
            if (std::system(fmt::format("PATH=$PATH:/usr/sbin command -v {} >/dev/null", name).c_str()) != 0)
                GTEST_SKIP() << name << " is not installed: slurmctld, slurmd, slurm-client and munge are needed";
        FarmFixture::SetUp();
        if (!fs::exists(hold_back_library)) GTEST_SKIP() << hold_back_library << " is not built";
        setenv("SLURM_CONF", path("cluster/slurm.conf").c_str(), 1);
        const Outcome started = run_lines(cluster("start"));
        ASSERT_EQ(started.code, 0) << started.err;
    }
    void TearDown() override {
        if (fs::exists(path("cluster")))
            std::ignore = run_lines("scancel --state=PENDING,RUNNING -u $(id -un) || true\n" + cluster("stop"));
        unsetenv("SLURM_CONF");
        FarmFixture::TearDown();
    }
    void make_files() override { make_frames(count); }
    static std::string cluster(const std::string& command) {
        return fmt::format("bash {}/tests/farm/slurm_cluster.sh {} cluster", test::quoted(test::source_folder),
                           command);
    }
    static bool wait_until(const std::function<bool()>& is_so) {
        for (int i = 0; i < 1200; ++i) {
            if (is_so()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        return false;
    }
    [[nodiscard]] bool is_over() const { return run_lines("squeue -h").out.empty(); }
    [[nodiscard]] bool are_there(const std::vector<int>& numbers) const {
        return std::ranges::all_of(numbers, [&](int number) { return fs::exists(path(out("out", number))); });
    }
    /// Ends processes whose command line ends the one, and whose environment says the other.
    void kill_processes(const std::string& words, const std::string& variable) const {
        const auto lines = [](std::string text) {
            std::ranges::replace(text, '\0', '\n');
            return "\n" + text;
        };
        const std::string mine = "\nSLURM_CONF=" + path("cluster/slurm.conf") + "\n";
        std::error_code error;
        for (const auto& entry : fs::directory_iterator("/proc", error)) {
            const std::string name = entry.path().filename().string();
            if (name.find_first_not_of("0123456789") != std::string::npos) continue;
            const std::string typed = lines(content(entry.path() / "cmdline"));
            const std::string environment = lines(content(entry.path() / "environ"));
            if (typed.find("\n" + words + "\n") == std::string::npos || environment.find(mine) == std::string::npos ||
                environment.find("\n" + variable + "\n") == std::string::npos)
                continue;
            kill(std::stoi(name), SIGKILL);
        }
    }
};

TEST_F(SoakFarm, WhatSurvivesAKilledTaskAndALostNodeIsByteForByteThatOfOneMachine) {
    ASSERT_EQ(run_lines("darkroom develop 'shot.####.exr' -o one/ -q").code, 0);
    const std::string submit =
        "LD_PRELOAD=" + test::quoted(hold_back_library) + " darkroom farm slurm 'shot.####.exr' -o out/ --chunk 4";
    for (const int number : {2, 6, 10}) hold_back(number);
    ASSERT_EQ(run_lines(submit).out, "job 1: 24 of 24 pictures in 6 chunks; darkroom farm status out/shot.farm\n");
    ASSERT_TRUE(wait_until([&] { return are_there({0, 1, 4, 5}); })) << "two tasks run, each half-way";
    const bool is_first_on_n1 = record("0-3")["node"] == "n1";
    EXPECT_EQ(record("4-7")["node"], is_first_on_n1 ? "n2" : "n1");
    EXPECT_EQ(status()["done"], json::array()) << "a record is of what has ended";

    // The first task is killed with all that it started; Slurm does not begin it anew.
    EXPECT_EQ(run_lines("scancel --signal=KILL --full 1_0").code, 0);
    // The node of the second one is gone, without a word. Slurm puts its task back into the queue.
    const std::string lost = is_first_on_n1 ? "n2" : "n1";
    EXPECT_EQ(run_lines(fmt::format("kill -9 $(cat cluster/slurmd.{0}.pid)\n"
                                    "scontrol update nodename={0} state=down reason=lost",
                                    lost))
                  .code,
              0);
    kill_processes("farm", "SLURMD_NODENAME=" + lost);
    kill_processes("develop", "SLURMD_NODENAME=" + lost);
    for (const int number : {2, 6}) let_come(number);
    // Of the third one what does the work is killed; the task begins it anew.
    ASSERT_TRUE(wait_until([&] { return are_there({8, 9}); }));
    kill_processes("develop", "SLURM_ARRAY_TASK_ID=2");
    let_come(10);

    ASSERT_TRUE(wait_until([&] { return is_over(); })) << run_lines("squeue; scontrol show nodes").out;
    EXPECT_EQ(record("0-3")["state"], "begun");
    EXPECT_EQ(record("4-7")["state"], "done");
    EXPECT_EQ(record("4-7")["node"], is_first_on_n1 ? "n1" : "n2") << "the node that is left";
    EXPECT_EQ(record("8-11")["tries"], 2);
    EXPECT_EQ(status()["missing"], json::parse("[[0,3]]"));
    EXPECT_EQ(status()["failed"], json::array());
    EXPECT_FALSE(are_there({2}));

    const Outcome again = run_lines(submit);
    EXPECT_EQ(again.out.substr(again.out.find(':')),
              ": 2 of 24 pictures in 1 chunks; darkroom farm status out/shot.farm\n")
        << again.err;
    ASSERT_TRUE(wait_until([&] { return is_over(); }));
    EXPECT_EQ(status()["done"], json::parse("[[0,23]]"));
    EXPECT_EQ(status()["missing"], json::array());
    for (int number = 0; number < count; ++number)
        EXPECT_EQ(content(path(out("out", number))), content(path(out("one", number)))) << number;
    EXPECT_EQ(run_lines(submit).out, "all 24 pictures are there, nothing is submitted\n");
}

TEST_F(SoakFarm, WithHistoryPicturesAreWithinACode) {
    for (const char* const name : {"recursive_blend", "frame_blend", "tonemap"})
        if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    write("trails.toml",
          "format = 1\n"
          "[[stack]]\neffect = \"tonemap\"\ncurve = \"linear\"\n"
          "[[stack]]\neffect = \"recursive_blend\"\nweight = 0.6\n"
          "[[stack]]\neffect = \"frame_blend\"\n");
    ASSERT_EQ(run_lines("darkroom develop 'shot.####.exr' --look trails.toml --fps 24 -o one/ -q").code, 0);
    const Outcome submitted =
        run_lines("darkroom farm slurm 'shot.####.exr' --look trails.toml -o out/ --chunk 5 -- --fps 24");
    ASSERT_EQ(submitted.code, 0) << submitted.err;
    ASSERT_TRUE(wait_until([&] { return is_over(); }));
    EXPECT_EQ(status()["done"], json::parse("[[0,23]]"));
    for (int number = 0; number < count; ++number) {
        const Picture farmed = picture(out("out", number)), whole = picture(out("one", number));
        ASSERT_EQ(farmed.pixels.size(), whole.pixels.size());
        float worst = 0;
        for (std::size_t i = 0; i < whole.pixels.size(); ++i)
            worst = std::max(worst, std::abs(farmed.pixels[i] - whole.pixels[i]));
        EXPECT_LE(worst, 1.001f / 255) << number;
    }
}

}  // namespace
}  // namespace darkroom
