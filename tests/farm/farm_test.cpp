// SPDX-License-Identifier: MIT
// A farm without its machines: the script that is submitted, what is refused before, and what is told from records. No
// picture is made here, and Slurm's commands are stood in for.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

using test::content;
using test::Outcome;

class FarmFiles : public test::CliFixture {
  protected:
    void SetUp() override {
        path_before_ = std::getenv("PATH");
        CliFixture::SetUp();
    }
    void TearDown() override {
        setenv("PATH", path_before_.c_str(), 1);
        CliFixture::TearDown();
    }
    /// Frames 1 to 12; farms look at their names alone.
    void make_files() override {
        for (int number = 1; number <= 12; ++number) write(fmt::format("shot.{:04}.exr", number), "");
        fs::create_directory(path("out"));
    }
    void put_picture(int number) const { write(fmt::format("out/shot.{:04}.png", number), "made"); }
    void write_program(const std::string& name, const std::string& text) const {
        fs::create_directory(path("bin"));
        write("bin/" + name, "#!/bin/sh\n" + text + "\n");
        chmod(path("bin/" + name).c_str(), 0755);
        setenv("PATH", (path("bin") + ":" + path_before_).c_str(), 1);
    }
    /// In the folder of the test.
    [[nodiscard]] Outcome farm(const std::string& words) const { return run_lines("darkroom farm " + words); }
    void expect_farm_refuses(const std::string& words, int code, const std::string& line) const {
        const std::vector<std::string> before = files();
        const Outcome outcome = farm(words);
        EXPECT_EQ(outcome.code, code) << words;
        EXPECT_EQ(outcome.err, "darkroom: " + line + "\n") << words;
        EXPECT_EQ(files(), before) << words;
        EXPECT_EQ(fs::exists(path("out/shot.farm")), false) << words;
    }

  private:
    std::string path_before_;
};

TEST_F(FarmFiles, AScriptIsAnArrayJobOfWhatIsMissing) {
    for (const int number : {1, 6, 7, 8}) put_picture(number);
    const Outcome script = farm(
        "slurm 'shot.####.exr' -o out/ --chunk 4 --partition gpu --time 00:30:00 --gpus a100:1 --account film --cpus 8 "
        "--dry-run -- --exposure 2");
    ASSERT_EQ(script.code, 0) << script.err;
    EXPECT_EQ(script.err,
              "darkroom: warning: out/shot.farm: 4 pictures are there, and no record says of which look: they count as "
              "made\n");
    EXPECT_EQ(script.out, fmt::format("#!/bin/bash\n"
                                      "#SBATCH --job-name=darkroom\n"
                                      "#SBATCH --array=0-1\n"
                                      "#SBATCH --requeue\n"
                                      "#SBATCH --output=/dev/null\n"
                                      "#SBATCH --cpus-per-task=8\n"
                                      "#SBATCH --partition=gpu\n"
                                      "#SBATCH --time=00:30:00\n"
                                      "#SBATCH --gpus=a100:1\n"
                                      "#SBATCH --account=film\n"
                                      "set -e\n"
                                      "cd -- {}\n"
                                      "mkdir -p -- out/shot.farm\n"
                                      "chunks=(2-5 9-12)\n"
                                      "chunk=${{chunks[SLURM_ARRAY_TASK_ID]}}\n"
                                      "exec >>out/shot.farm/\"$chunk.log\" 2>&1\n"
                                      "{} farm task --frames \"$chunk\" 'shot.####.exr' -o out/ -- --exposure 2\n",
                                      fs::canonical(path(".")).string(), fs::canonical(program).string()));
    EXPECT_FALSE(fs::exists(path("out/shot.farm"))) << "a dry run writes nothing";
    EXPECT_NE(farm("slurm 'shot.####.exr' -o out/ --allow-unconfined --dry-run")
                  .out.find(" farm task --frames \"$chunk\" --allow-unconfined 'shot.####.exr' -o out/\n"),
              std::string::npos);
    const std::string container = "apptainer exec --nv --bind /mnt/shots /mnt/shots/darkroom.sif darkroom";
    const Outcome inside = farm("slurm 'shot.####.exr' -o out/ --dry-run --program '" + container + "'");
    EXPECT_NE(inside.out.find("\n" + container + " farm task "), std::string::npos) << inside.out;
}

TEST_F(FarmFiles, EveryPathOfAScriptReachesItsTask) {
    const std::string folder = "it's $HOME `x` \"y\" *\n#SBATCH --array=0-9";
    fs::create_directories(path(folder + "/out & more"));
    write(folder + "/a shot.0001.exr", "");
    write(folder + "/look;.toml", "[post_process]\n");
    ASSERT_EQ(run_lines("cd ./it*\ndarkroom farm slurm 'a shot.####.exr' -o 'out & more/' --look 'look;.toml' "
                        "--program \"printf '%s\\n'\" --dry-run -- --set 'bloom.opacity=0.5' >../script.sh\n"
                        "cd /\nSLURM_ARRAY_TASK_ID=0 bash \"$OLDPWD\"/../script.sh")
                  .code,
              0);
    EXPECT_EQ(content(path(folder + "/out & more/a shot.farm/1-1.log")),
              "farm\ntask\n--frames\n1-1\na shot.####.exr\n-o\nout & more/\n--look\nlook;.toml\n--\n--set\n"
              "bloom.opacity=0.5\n");
}

TEST_F(FarmFiles, AScenesFramesAreThoseThatAreAskedFor) {
    write("scene.toml", "[scene]\n");
    write("out/a.0003.png", "made");
    const Outcome script = farm("slurm scene.toml --frames 2-9 -o 'out/a.####.png' --chunk 3 --dry-run -- --size 8x8");
    ASSERT_EQ(script.code, 0) << script.err;
    EXPECT_NE(script.out.find("\nchunks=(2-4 5-7 8-9)\n"), std::string::npos) << script.out;
    EXPECT_NE(script.out.find(" --frames \"$chunk\" scene.toml -o 'out/a.####.png' -- --size 8x8\n"), std::string::npos)
        << script.out;
    const Outcome some = farm("slurm 'shot.####.exr' --frames 3-5 -o 'out/b.####.png' --dry-run");
    EXPECT_NE(some.out.find("\nchunks=(3-5)\n"), std::string::npos) << some.out << some.err;
    expect_farm_refuses("slurm scene.toml -o 'out/a.####.png'", 1, "scene.toml: --frames A-B is needed");
    expect_farm_refuses("slurm scene.toml --frames 0-1 -o out/", 1, "-o out/: expected a name with %04d or ####");
    expect_farm_refuses("slurm scene.toml --frames 0-1 -o 'out/a.##.png' -- --keep-layers", 1,
                        "render: unknown argument '--keep-layers'");
}

TEST_F(FarmFiles, WhatTasksWouldRefuseIsRefusedOnce) {
    const std::string shot = "slurm 'shot.####.exr' -o out/ ";
    expect_farm_refuses(shot + "shot.0001.exr", 1,
                        "unexpected 'shot.0001.exr': allowed is one INPUT, and flags of develop after --");
    expect_farm_refuses(shot + "-- --exposur 2", 1,
                        "develop: unknown argument '--exposur', did you mean '--exposure'?");
    expect_farm_refuses(shot + "--ssao-samples 64", 1,
                        "farm slurm: unknown argument '--ssao-samples'; flags of develop and render stand behind --");
    expect_farm_refuses(shot + "-- --exposure 2000", 1, "--exposure = 2000: allowed is [0, 1024] x");
    expect_farm_refuses(shot + "--look none.toml", 1, "none.toml: there is no such file");
    expect_farm_refuses(shot + "--frames 20-30", 1, "--frames 20-30: none of the 12 inputs has such a number");
    expect_farm_refuses(shot + "--chunk 0", 1, "--chunk = 0: allowed is [1, 100000]");
    expect_farm_refuses(shot + "--partition 'a b'", 1, "--partition a b: allowed are letters, digits and _ - . , : @");
    expect_farm_refuses(shot + "--program $'a\\nb'", 1, "--program a\\x0Ab: holds a line break; allowed is one line");
    expect_farm_refuses("slurm shot.0001.exr -o out/", 1,
                        "shot.0001.exr: expected a sequence, shot.%04d.exr or shot.####.exr, or a scene (.toml) or a "
                        "model (.glb, .gltf)");
    expect_farm_refuses("slurm 'shot.####.exr[1-3]' -o out/", 1,
                        "shot.####.exr[1-3]: a farm takes no [A-B]; --frames A-B chooses frames");
    expect_farm_refuses("slurm 'shot.####.exr' -o none/", 1,
                        "none: no such folder, nothing can be written there; --mkdir makes it");
    expect_farm_refuses("slurm 'shot.####.exr' -o -", 1, "-o -: a farm writes files");
    expect_farm_refuses("slurm 'shot.####.exr' -o a.png", 1,
                        "-o a.png: expected a folder (--mkdir makes a new one), or a name with %04d or ####");
    expect_farm_refuses("task 'shot.####.exr' -o out/", 1, "farm task: --frames A-B is needed");
    write("scene.toml", "[scene]\n");
    expect_farm_refuses("slurm scene.toml --frames 0-1999 --chunk 1 -o 'out/a.##.png'", 1,
                        "--chunk 1: 2000 chunks, an array job holds 1000: --chunk 2 is enough");
}

TEST_F(FarmFiles, ValuesOfFlagsAreRefusedAsTheCommandRefusesThem) {
    write("scene.toml", "[environment]\n");
    const auto expect_alike = [&](const std::string& command, const std::string& work, const std::string& flags) {
        const Outcome refused = run_lines("darkroom " + command + " " + work + " " + flags);
        ASSERT_EQ(refused.code, 1) << flags;
        ASSERT_TRUE(refused.err.starts_with("darkroom: --")) << refused.err;
        expect_farm_refuses("slurm " + work + " -- " + flags, 1, refused.err.substr(10, refused.err.size() - 11));
    };
    for (const char* const flags : {"--size 0x4", "--bits 9", "--kernels gpu", "--jobs 0", "--time -1", "--quality 0",
                                    "--keep-layers", "--format y4m", "--exposure 2000"})
        expect_alike("develop", "'shot.####.exr' --frames 3-5 -o out/", flags);
    for (const char* const flags : {"--size 0x4", "--bits 9", "--kernels gpu", "--jobs 0", "--fps 0", "--seed -1",
                                    "--exposure 2000", "--no-postprocess --timings", "--save-frame a.exr"})
        expect_alike("render", "scene.toml --frames 0-1 -o 'out/a.##.png'", flags);
}

TEST_F(FarmFiles, EffectsOfFilesAreRefusedUnlessAllowed) {
    ASSERT_EQ(run({"new", "effect", path("tinted")}).code, 0);
    write("my.toml", "[[stack]]\neffect = \"tinted.glsl\"\n");
    expect_farm_refuses(
        "slurm 'shot.####.exr' -o out/ --look my.toml", 1,
        "my.toml:2:10: effect = \"tinted.glsl\": the effect of a file is code, which is not allowed for "
        "this look");
    expect_farm_refuses("slurm 'shot.####.exr' -o out/ -- --effect tinted.glsl", 1,
                        "--effect: such a file is code, --allow-custom-effects lets it run");
    const Outcome allowed = farm("slurm 'shot.####.exr' -o out/ --look my.toml --allow-custom-effects --dry-run");
    EXPECT_EQ(allowed.code, 0) << allowed.err;
    EXPECT_NE(allowed.out.find(" --look my.toml --allow-custom-effects\n"), std::string::npos) << allowed.out;
    const Outcome flag = farm(
        "slurm 'shot.####.exr' -o out/ --allow-custom-effects --dry-run -- --effect tinted.glsl --tinted-reach 0.5");
    EXPECT_EQ(flag.code, 0) << flag.err;
}

TEST_F(FarmFiles, WithoutSlurmTheMachineIsAtFault) {
    setenv("PATH", path("bin").c_str(), 1);
    const Outcome outcome = run({"farm", "slurm", path("shot.####.exr"), "-o", path("out")});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(
        outcome.err,
        "darkroom: sbatch: cannot be run: No such file or directory: Slurm's commands are needed; --dry-run works "
        "without them\n");
    write_program("sbatch", "echo 'sbatch: warning: hm' >&2; echo 'sbatch: error: Invalid partition name' >&2; exit 1");
    expect_farm_refuses("slurm 'shot.####.exr' -o out/ --partition x", 2, "sbatch: error: Invalid partition name");
}

TEST_F(FarmFiles, ASecondSubmissionHasOnlyWhatIsMissing) {
    const std::string shot = "slurm 'shot.####.exr' -o out/ --chunk 4";
    write_program("sbatch", "cp \"$2\" " + path("script.sh") + "; echo '17;cluster'");
    write_program("squeue", "exit 1");
    const Outcome first = farm(shot);
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_EQ(first.out, "job 17: 12 of 12 pictures in 3 chunks; darkroom farm status out/shot.farm\n");
    EXPECT_EQ(content(path("script.sh")), content(path("out/shot.farm/job.sh")));
    EXPECT_EQ(farm("status out").out, "out/shot.farm: 12 frames: 0 done, 0 failed, 12 missing\n  missing: 1-12\n");
    write_program("squeue", "echo 17_1");
    const Outcome queued = farm(shot);
    EXPECT_EQ(queued.code, 1);
    EXPECT_EQ(queued.err, "darkroom: out/shot.farm: job 17 is not over; wait for it, or end it with `scancel 17`\n");
    write_program("squeue", "exit 0");
    const Outcome other = farm(shot + " -- --exposure 2");
    EXPECT_EQ(other.code, 1);
    EXPECT_EQ(
        other.err,
        "darkroom: out/shot.farm: its pictures were made with other arguments (shot.####.exr -o out/); remove it and "
        "its pictures, or write elsewhere with -o\n");
    for (const int number : {1, 2, 3, 4, 5, 7, 8, 9, 10, 11}) put_picture(number);
    write("out/shot.0009.png", "");
    const Outcome second = farm(shot);
    EXPECT_EQ(second.out, "job 17: 3 of 12 pictures in 2 chunks; darkroom farm status out/shot.farm\n") << second.err;
    EXPECT_NE(content(path("script.sh")).find("\nchunks=(6-9 12-12)\n"), std::string::npos);
    for (const int number : {6, 9, 12}) put_picture(number);
    EXPECT_EQ(farm("status out").out, "out/shot.farm: 12 frames: 12 done, 0 failed, 0 missing\n");
    EXPECT_EQ(farm(shot).out, "all 12 pictures are there, nothing is submitted\n");
}

TEST_F(FarmFiles, StatusFindsPicturesOfNumbersBelowZeroByEitherName) {
    write_program("sbatch", "echo 17");
    for (const char* const name : {"neg.-0002", "neg.-001", "neg.0000"}) write(std::string(name) + ".exr", "");
    ASSERT_EQ(farm("slurm 'neg.####.exr' -o out/").code, 0);
    EXPECT_EQ(farm("status out/neg.farm").out,
              "out/neg.farm: 3 frames: 0 done, 0 failed, 3 missing\n  missing: -2-0\n");
    for (const char* const name : {"neg.-0002", "neg.-001", "neg.0000"})
        write(std::string("out/") + name + ".png", "made");
    EXPECT_EQ(farm("status out/neg.farm").out, "out/neg.farm: 3 frames: 3 done, 0 failed, 0 missing\n");
}

TEST_F(FarmFiles, AFolderIsMadeWhereAsked) {
    EXPECT_EQ(farm("slurm 'shot.####.exr' -o new/a/ --mkdir --dry-run").code, 0);
    EXPECT_TRUE(fs::is_directory(path("new/a")));
}

TEST_F(FarmFiles, AChangedInputIsNoticed) {
    write_program("sbatch", "echo 17");
    write_program("squeue", "exit 1");
    fs::create_directory(path("looks"));
    write("looks/film.cube", "LUT_1D_SIZE 2\n0 0 0\n1 0.9 0.8\n");
    write("looks/shot.toml",
          "[post_process]\nlut = \"film.cube\"\nlut_strength = 1.0\n[ui]\ndocument = "
          "\"lens.svg\"\ncontrollers = [\"move.lua\"]\n");
    write("over.toml", "[post_process]\nexposure = 1.0\n");
    write("looks/move.lua", "");
    write("looks/lens.svg", "<svg xmlns='http://www.w3.org/2000/svg'/>");
    write("beat.toml", "[[event]]\ntime = 0.5\nset = { exposure = 2.0 }\n");
    const std::string work = " 'shot.####.exr' --look looks/shot.toml -o out/",
                      more = " -- --layer over.toml --events beat.toml";
    ASSERT_EQ(farm("slurm" + work + more).code, 0) << farm("slurm" + work + more).err;
    for (int number = 1; number <= 12; ++number) put_picture(number);
    EXPECT_EQ(farm("slurm" + work + more).out, "all 12 pictures are there, nothing is submitted\n");
    for (const char* const name :
         {"looks/shot.toml", "looks/film.cube", "looks/lens.svg", "looks/move.lua", "over.toml", "beat.toml"}) {
        const std::string before = content(path(name));
        write(name, before + "\n");
        const std::string line = fmt::format(
            "darkroom: out/shot.farm: {} has changed since job 17 was submitted; remove its pictures, or write "
            "elsewhere "
            "with -o\n",
            name);
        for (const std::string& command : {"slurm" + work, "task --frames 1-2" + work}) {
            const Outcome outcome = farm(command + more);
            EXPECT_EQ(outcome.code, 1) << command;
            EXPECT_EQ(outcome.err, line) << command;
        }
        write(name, before);
    }
    EXPECT_EQ(farm("slurm" + work + more).code, 0) << "as it was";
    write("over.toml", "[post_process]\nexposure = 2.0\n");
    for (int number = 1; number <= 12; ++number) fs::remove(path(fmt::format("out/shot.{:04}.png", number)));
    EXPECT_EQ(farm("slurm" + work + more).out,
              "job 17: 12 of 12 pictures in 2 chunks; darkroom farm status out/shot.farm\n");
}

// Files that are read when frames are, and not with the flags.
TEST_F(FarmFiles, AChangedPrefabOrCameraIsNoticed) {
    write_program("sbatch", "echo 17");
    write_program("squeue", "exit 1");
    fs::create_directory(path("prefabs"));
    write("prefabs/lamp.prefab.toml", "[entities.a.bounds]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n");
    write("a.scene.toml", "[prefabs.lamp]\ntemplate = \"lamp\"\n");
    write("view.toml", "camera_to_world = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\nfov = 40\n");
    const std::string scene = "slurm a.scene.toml --frames 1-12 -o 'out/shot.####.png'";
    const std::string frames = "slurm 'shot.####.exr' -o out/ -- --camera view.toml";
    for (const auto& [work, name] : {std::pair(scene, "prefabs/lamp.prefab.toml"), std::pair(frames, "view.toml"),
                                     std::pair(scene, "a.scene.toml")}) {
        fs::remove_all(path("out"));
        fs::create_directory(path("out"));
        ASSERT_EQ(farm(work).code, 0) << farm(work).err;
        for (int number = 1; number <= 12; ++number) put_picture(number);
        EXPECT_EQ(farm(work).out, "all 12 pictures are there, nothing is submitted\n");
        write(name, content(path(name)) + "\n");
        EXPECT_EQ(farm(work).err, fmt::format("darkroom: out/shot.farm: {} has changed since job 17 was submitted; "
                                              "remove its pictures, or write elsewhere with -o\n",
                                              name));
    }
    fs::remove_all(path("out/shot.farm"));
    write("view.toml", "fov = 1000\n");
    EXPECT_NE(farm(frames).err.find("view.toml"), std::string::npos) << "what is wrong is told at once";
}

TEST_F(FarmFiles, StatusIsToldFromRecordsAndPictures) {
    const auto record = [&](const std::string& name, const std::string& state, const std::string& done,
                            const std::string& job) {
        std::string frames = name;
        std::ranges::replace(frames, '-', ',');
        write("out/shot.farm/" + name + ".json",
              fmt::format(R"({{"format":1,"chunk":"{}","state":"{}","frames":[[{}]],"done":{},"made":2,"tries":4,)"
                          R"("seconds":3,"begun":"2026-01-02T03:04:05Z","node":"n1","job":"{}",)"
                          R"("errors":["darkroom: frame: is empty"],"input":"shot.####.exr","output":"out/",)"
                          R"("output_is_folder":true}})",
                          name, state, frames, done, job));
    };
    fs::create_directory(path("out/shot.farm"));
    write("out/shot.farm/job.json",
          R"({"format":1,"job":"17","frames":[[1,24]],"done":[[1,1]],"arguments":["shot.####.exr"],)"
          R"("input":"shot.####.exr","output":"out/","output_is_folder":true})");
    for (int number = 1; number <= 15; ++number)
        if (number != 12 && number != 14) put_picture(number);
    record("2-9", "done", "[[2,9]]", "17_0");
    record("10-14", "failed", "[[10,11],[13,13]]", "17_1");
    record("15-20", "begun", "[[15,15]]", "17_2");
    record("21-22", "done", "[[21,22]]", "16_3");
    const Outcome text = farm("status out");
    EXPECT_EQ(text.code, 3) << "pictures are missing";
    EXPECT_EQ(text.err, "");
    EXPECT_EQ(text.out,
              "out/shot.farm: 24 frames: 13 done, 2 failed, 9 missing\n"
              "  failed: 12, 14 on n1, 4 tries: darkroom: frame: is empty\n"
              "  begun: 16-20 on n1 at 2026-01-02T03:04:05Z, not ended\n"
              "  missing: 16-24\n"
              "  6 pictures in 9.0 s of task time, 1.50 s each\n");
    const auto told = nlohmann::json::parse(farm("status out/shot.farm/ --json").out);
    EXPECT_EQ(told["failed"], nlohmann::json::parse("[[12,12],[14,14]]"));
    EXPECT_EQ(told["missing"], nlohmann::json::parse("[[16,24]]"));
    EXPECT_EQ(told["chunks"].size(), 3U) << "what an earlier job did counts for nothing";
    record("12-14", "done", "[[12,14]]", "");
    for (const int number : {12, 14}) put_picture(number);
    EXPECT_EQ(farm("status out").out.substr(0, 54), "out/shot.farm: 24 frames: 15 done, 0 failed, 9 missing");
    // Of the task that was killed: two that it could not write down, and one that is no picture yet.
    put_picture(16);
    put_picture(17);
    write("out/shot.0018.png", "");
    const Outcome killed = farm("status out");
    EXPECT_EQ(killed.out.substr(0, 54), "out/shot.farm: 24 frames: 17 done, 0 failed, 7 missing") << killed.out;
    EXPECT_NE(killed.out.find("  begun: 18-20 on n1"), std::string::npos) << killed.out;
    // A picture that was taken away is missing, whatever was written down.
    fs::remove(path("out/shot.0003.png"));
    EXPECT_NE(farm("status out").out.find("  missing: 3, 18-24\n"), std::string::npos);
    for (int number = 1; number <= 24; ++number) put_picture(number);
    const Outcome all = farm("status out");
    EXPECT_EQ(all.code, 0);
    EXPECT_EQ(all.out.substr(0, 55), "out/shot.farm: 24 frames: 24 done, 0 failed, 0 missing\n") << all.out;
}

TEST_F(FarmFiles, OtherDigitsOfNamesAreNoNumberOfAFrame) {
    for (const char* const frames : {"1-2", "11-12"}) {
        const Outcome outcome =
            farm(std::string("slurm 'shot.####.exr' -o 'out/a2.####_1080p.png' --dry-run --frames ") + frames);
        EXPECT_NE(outcome.out.find("mkdir -p -- out/a2.farm\n"), std::string::npos) << outcome.out << outcome.err;
    }
}

TEST_F(FarmFiles, AFileThatIsNoRecordIsAWarning) {
    fs::create_directory(path("shot.farm"));
    const std::string rest = R"(,"made":2,"tries":4,"seconds":3,"begun":"","node":"","job":"","errors":[])";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"{", "is not JSON"},
        {std::string(100'000, '['), "is not JSON"},
        {"[]", "allowed is format = 1"},
        {R"({"format":2})", "allowed is format = 1"},
        {R"({"format":1})", "chunk is missing"},
        {R"({"format":1,"chunk":3})", "chunk is of another kind"},
        {R"({"format":1,"chunk":"","frames":[[0,99999999]])" + rest + "}",
         "frames: allowed are [first, last] in order, 100000 frames at most"},
        {R"({"format":1,"chunk":"","frames":[[-9999999999,3]])" + rest + "}",
         "frames: allowed are [first, last] in order, 100000 frames at most"},
        {R"({"format":1,"chunk":"","frames":[[1]])" + rest + "}", "frames are no pairs of frames"},
        {R"({"format":1,"chunk":"","frames":[[0,5],[0,5]])" + rest + "}",
         "frames: allowed are [first, last] in order, 100000 frames at most"},
        {R"({"format":1,"chunk":"","frames":[],"done":[],"state":"x")" + rest + "}",
         "state: allowed is begun, done or failed"}};
    for (const auto& [text, problem] : cases) {
        write("shot.farm/1-2.json", text);
        const Outcome outcome = farm("status shot.farm");
        EXPECT_EQ(outcome.code, 0);
        EXPECT_EQ(outcome.err, "darkroom: warning: shot.farm/1-2.json: " + problem + "\n");
    }
    write("shot.farm/job.json", "{");
    const Outcome outcome = farm("status .");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.err, "darkroom: shot.farm/job.json: is not JSON\n");
    expect_farm_refuses("status out", 1, "out: holds no folder NAME.farm, so nothing was submitted from it");
    expect_farm_refuses("status none.farm", 1, "none.farm: cannot be listed: No such file or directory");
    expect_farm_refuses("status none", 1, "none: cannot be listed: No such file or directory");
}

}  // namespace
}  // namespace darkroom
