// SPDX-License-Identifier: MIT
// What pages tell one to type is typed, in the order of the page. What opens a window is typed where there is no
// display, so it ends behind the reading of its flags and files. What asks other programs or works for minutes is run
// by tests of its own. Pictures are small: they tell as much.
#include <fmt/format.h>

#include <algorithm>
#include <darkroom/effects.hpp>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"
#include "tests/cli/cli_support.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

struct PageBlock {
    std::string kind, text;
};

std::vector<PageBlock> blocks_of_page(const std::string& page) {
    std::istringstream lines(test::content(fs::path(test::source_folder) / page));
    std::vector<PageBlock> out;
    bool is_inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("```")) {
            if (!is_inside) out.push_back({line.substr(3), ""});
            is_inside = !is_inside;
        } else if (is_inside) {
            out.back().text += line + "\n";
        }
    }
    return out;
}

/// The lines of text, those that end in a backslash joined to the next.
std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream all(text);
    std::vector<std::string> out;
    bool goes_on = false;
    for (std::string line; std::getline(all, line);) {
        if (!goes_on) out.emplace_back();
        goes_on = line.ends_with('\\');
        if (goes_on) line.pop_back();
        out.back() += line;
    }
    return out;
}
/// Without a remark, and beginning with ./ where a page may leave out the folder.
std::string command_of(const std::string& line) {
    const std::string command =
        line.find("# exit code ") != std::string::npos ? line : line.substr(0, line.find("  #"));
    return command.starts_with("darkroom ") || command.starts_with("darkroom_lab ") ? "./" + command : command;
}

std::vector<std::string> pages_of_docs() {
    std::vector<std::string> out{"README.md"};
    for (const auto& page : fs::directory_iterator(fs::path(test::source_folder) / "docs"))
        if (page.path().extension() == ".md") out.push_back("docs/" + page.path().filename().string());
    return out;
}

std::vector<std::string> pages_of_effects() {
    std::vector<std::string> out;
    for (const EffectInfo* const effect : all_effects())
        if (effect != nullptr) out.push_back(fmt::format("effects/{0}/{0}.md", effect->name));
    return out;
}

// Of a few frames, pixels and seconds, in place of those that the line asks for.
constexpr std::string_view small_program = R"(#!/usr/bin/env bash
words=()
while (($#)); do
    case $1 in
        --size) [[ ${words[0]} == render ]] && words+=(--size 64x36) || words+=("$1" "$2"); shift ;;
        --output-size) words+=("$1" 64x36) && shift ;;
        --frames | --truth-frames) words+=("$1" 0-1) && shift ;;
        --seconds) words+=("$1" 1) && shift ;;
        --device) words+=("$1" 0) && shift ;;
        *) words+=("$1") ;;
    esac
    shift
done
[[ ${words[0]} != render || " ${words[*]} " == *" --size "* ]] || words+=(--size 64x36)
[[ ${words[0]} != capture ]] || words+=(--size 64x36 --samples 2)
[[ ${words[0]} != verify || " ${words[*]} " == *" --seconds "* ]] || words+=(--seconds 1)
exec )";

class CliPages : public test::CliFixture {
  protected:
    void make_files() override {
        for (const EffectInfo* const effect : all_effects()) count_ += effect != nullptr ? 1 : 0;
        if (count_ < 49) GTEST_SKIP() << "effects are left out of this build";
        for (const char* const name : {"looks", "scenes", "hud", "controllers", "examples"})
            fs::create_symlink(fs::path(test::source_folder) / name, path(name));
        for (const std::string name : {"darkroom", "darkroom_lab"}) {
            const std::string own = (fs::path(program).parent_path() / name).string();
            write(name, std::string(small_program) + test::quoted(own) + " \"${words[@]}\"\n");
            fs::permissions(path(name), fs::perms::owner_all);
        }
        for (const char* const name : {"samples", "expected", "pictures", "folder"}) fs::create_directory(path(name));
        for (const char* const name :
             {"samples/window.exr", "a.exr", "b.exr", "a.0001.exr", "b.0001.exr", "shot.0001.exr", "shot.0002.exr"})
            write_frame_of(name, 96, 54);
        for (const char* const name : {"picture.png", "expected/room.png", "pictures/room.png"})
            ASSERT_TRUE(write_picture(path(name), grey(96, 54)));
        write("film.cube", "LUT_1D_SIZE 2\n0 0 0\n1 0.9 0.8\n");
        write("my.toml", "format = 1\n[post_process]\nexposure = 1.2\n");
    }

    /// Runs the page's lines of sh that begin with the program; `lines` of them, at least.
    void try_page(const std::string& page, std::size_t lines) const {
        std::size_t run = 0;
        for (const auto& [kind, text] : blocks_of_page(page)) {
            if (kind == "toml" && text.starts_with("format = 1")) write("my.toml", text);
            if (kind != "sh") continue;
            std::string chosen;
            for (const std::string& line : lines_of(text)) {
                const std::string command = command_of(line);
                if (!command.starts_with("./darkroom") || is_left_out(command)) continue;
                chosen += command + "\n";
                ++run;
            }
            if (chosen.empty()) continue;
            write_frame_of("frame.exr", 642, 362);
            // What it is compared with was made by the same line before.
            for (const char* const name : {"expected.png", "reference.png"})
                fs::copy_file(path("picture.png"), path(name), fs::copy_options::overwrite_existing);
            const test::Outcome outcome = run_lines(chosen);
            EXPECT_EQ(outcome.code, 0) << page << ":\n" << chosen << outcome.err;
        }
        EXPECT_GE(run, lines) << page;
    }

  private:
    static bool is_left_out(const std::string& line) {
        for (const char* const part : {"|", "~", ".3dl", ".glb"})
            if (line.find(part) != std::string::npos) return true;
        for (const char* const command : {"play", "edit", "bake", "farm"})
            if (line.starts_with(std::string("./darkroom ") + command + " ")) return true;
        return false;
    }
    static Picture grey(std::uint32_t width, std::uint32_t height) {
        Picture out(width, height);
        for (std::size_t i = 0; i < out.pixels.size(); ++i)
            out.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>((i * 37) % 101) / 101.0f;
        return out;
    }
    void write_frame_of(const std::string& name, std::uint32_t width, std::uint32_t height) const {
        FrameFile frame;
        frame.color = grey(width, height);
        frame.depth = Plane<1>(width, height);
        std::ranges::fill(frame.depth->values, 4.0f);
        ASSERT_TRUE(write_frame(path(name), frame));
    }
    std::size_t count_ = 0;
};

TEST_F(CliPages, TomlAndGlslAreRead) {
    fs::create_directories(path("own/tables"));
    fs::copy_file(path("film.cube"), path("own/tables/film.cube"));
    fs::copy_file(path("my.toml"), path("own/cave.toml"));
    fs::copy_file(fs::path(test::source_folder) / "examples/duotone.glsl", path("own/duotone.glsl"));
    std::size_t looks = 0, events = 0, effects = 0;
    std::vector<std::string> pages = pages_of_effects();
    for (const char* const page : {"README.md", "docs/tutorial.md", "docs/looks.md", "docs/interface.md",
                                   "docs/custom_effects.md", "docs/embedding.md"})
        pages.emplace_back(page);
    for (const std::string& page : pages)
        for (const auto& [kind, text] : blocks_of_page(page)) {
            test::Outcome outcome{.code = 0};
            if (kind == "toml" && text.starts_with("[[event]]")) {
                // They move the look before them.
                ++events;
                write("own/events.toml", text);
                outcome = run({"develop", path("a.exr"), "--look", path("own/look.toml"), "--events",
                               path("own/events.toml"), "-o", path("moved.png")});
            } else if (kind == "toml") {
                ++looks;
                write("own/look.toml", (text.starts_with("format") ? "" : "format = 1\n") + text);
                outcome = run({"plan", path("own/look.toml"), "--strict"});
            } else if (kind == "glsl" && text.starts_with("// @effect") && text.find("...") == std::string::npos) {
                ++effects;
                outcome = run({"effects", write("page.glsl", text)});
            } else if (kind == "glsl" && text.starts_with("// @table")) {
                // A description without what it describes.
                ++effects;
                outcome = run({"effects", write("page.glsl", "// @effect page: Shows a table.\n" + text +
                                                                 "vec4 page(vec4 color, Pixel pixel, Page parameters) "
                                                                 "{ return color * load(weights, ivec2(0)).r; }\n")});
            }
            EXPECT_EQ(outcome.code, 0) << page << ":\n" << text << outcome.err;
        }
    EXPECT_GE(looks, 10U);
    EXPECT_GE(events, 2U);
    EXPECT_GE(effects, 3U);
    // Blocks add to one scene; one that begins with a table that is there already begins another.
    std::vector<std::string> scenes(1);
    for (const auto& [kind, text] : blocks_of_page("docs/scenes.md")) {
        if (kind != "toml") continue;
        if (scenes.back().find(text.substr(0, text.find('\n') + 1)) != std::string::npos) scenes.emplace_back();
        scenes.back() += text;
    }
    for (const std::string& scene : scenes)
        EXPECT_EQ(run({"render", write("page.scene.toml", scene), "--size", "64x36", "-o", path("scene.png")}).err, "")
            << scene;
}
TEST_F(CliPages, Readme) { try_page("README.md", 2); }
TEST_F(CliPages, Tutorial) { try_page("docs/tutorial.md", 10); }
TEST_F(CliPages, Jobs) { try_page("docs/jobs.md", 2); }
TEST_F(CliPages, Interface) { try_page("docs/interface.md", 1); }
TEST_F(CliPages, CustomEffects) { try_page("docs/custom_effects.md", 2); }
TEST_F(CliPages, LooksScenesAndProbing) {
    try_page("docs/looks.md", 1);
    try_page("docs/scenes.md", 2);
    try_page("docs/probe.md", 2);
}
TEST_F(CliPages, Effects) {
    for (const auto& [kind, text] : blocks_of_page("effects/upscale/upscale.md"))
        if (kind == "toml") write("sharp.toml", "format = 1\n" + text);
    for (const std::string& page : pages_of_effects()) try_page(page, 0);
    EXPECT_TRUE(fs::exists(path("lens.png")));
}
TEST_F(CliPages, Verify) {
    if (!fs::exists(fs::path(program).parent_path().parent_path() / "lib/darkroom/darkroom_verifier"))
        GTEST_SKIP() << "darkroom_verifier is not built";
    // A folder as a finding would leave it: there is none on a driver that is right.
    const fs::path finding = path("verified/01_ssao_compute_lean");
    fs::create_directories(finding);
    fs::copy_file(path("a.exr"), finding / "frame.0002.exr");
    write("verified/01_ssao_compute_lean/look.toml", "format = 1\n[[stack]]\neffect = \"ssao\"\n");
    try_page("docs/verify.md", 4);
    for (const char* const name : {"verified/verify.json", "ssao.json", "made.exr"})
        EXPECT_TRUE(fs::exists(path(name))) << name;
}
TEST_F(CliPages, WhatTheySayIsPrinted) {
    const auto shown = [](const std::string& page, std::string_view part) {
        for (const PageBlock& block : blocks_of_page(page))
            if (block.text.starts_with("darkroom: ") && block.text.find(part) != std::string::npos) return block.text;
        ADD_FAILURE() << page << " shows no " << part;
        return std::string();
    };
    write("my.toml", "format = 1\n\n[post_process]\nbloom_intensity = -1\n");
    const std::string refused = run_lines("darkroom plan my.toml --strict").err;
    EXPECT_EQ(shown("docs/errors.md", "my.toml"), refused);
    EXPECT_EQ(shown("docs/troubleshooting.md", "my.toml"), refused);
    write("my.toml", "[post_process]\nbloom_intensty = 0.1\nexposure = -2\n");
    EXPECT_EQ(shown("docs/looks.md", "unknown key"), run_lines("darkroom plan my.toml").err);
}
// Lines that no test types, such as those for another machine, at least have no flag that their command does not know,
// and name no file of the tree that is not there.
TEST_F(CliPages, FlagsAndFilesAreThere) {
    std::map<std::string, std::string> help;
    std::size_t flags = 0, named = 0;
    const std::regex command("(?:^|[ /])(darkroom(?:_lab)? (?:farm |lut )?[a-z]+) ([^|>#]*)"), quoted("'[^']*'");
    const std::regex flag("--[a-z][a-z-]*"), file(R"((?:looks|scenes|hud|controllers|examples)/[a-z_.]+\.[a-z]+)");
    for (const std::string& page : pages_of_docs())
        for (const auto& [kind, text] : blocks_of_page(page)) {
            if (kind != "sh") continue;
            for (const std::string& line : lines_of(text)) {
                const std::string bare = std::regex_replace(line, quoted, "");
                std::smatch found;
                if (!std::regex_search(bare, found, command)) continue;
                const std::string name = found[1], words = found[2];
                std::string& known = help[name];
                if (known.empty()) known = run_lines(name + " --help-all").out;
                // Those of an effect's file are its own; those behind -- are another command's.
                const std::string own = words.substr(0, std::min(words.find(" -- "), words.find("--effect ")));
                for (std::sregex_iterator at(own.begin(), own.end(), flag), end; at != end; ++at, ++flags)
                    EXPECT_TRUE(std::regex_search(known, std::regex("\\s" + at->str() + "[\\s,\\[]")))
                        << page << ": " << name << " has no flag " << at->str();
                for (std::sregex_iterator at(words.begin(), words.end(), file), end; at != end; ++at, ++named)
                    EXPECT_TRUE(fs::exists(path(at->str()))) << page << ": " << at->str();
            }
        }
    EXPECT_GT(help.size(), 15U);
    EXPECT_GT(flags, 100U);
    EXPECT_GT(named, 20U);
}
// What it says of the look that is there without one.
TEST_F(CliPages, DevelopWithoutALookIsTheDefaultLessWhatFramesHave) {
    std::string row;
    for (const std::string& line : lines_of(test::content(fs::path(test::source_folder) / "docs/looks.md")))
        if (line.starts_with("| [default.toml]")) row = line;
    std::string flags;
    const std::regex code("`([a-z_]+)`");
    for (std::sregex_iterator at(row.begin(), row.end(), code), end; at != end; ++at)
        if (find_effect(at->str(1)) != nullptr)
            flags += " --no-" + std::regex_replace(at->str(1), std::regex("_"), "-");
    const test::Outcome outcome =
        run_lines("./darkroom develop a.exr -o plain.png\n./darkroom develop a.exr --look default" + flags +
                  " -o less.png\n./darkroom compare plain.png less.png --fail-max 0");
    EXPECT_EQ(outcome.code, 0) << row << flags << outcome.out << outcome.err;
    EXPECT_EQ(std::ranges::count(flags, ' '), 3);
}
TEST_F(CliPages, DocumentsControllersAndCameras) {
    const auto first = [](const std::string& page, const std::string& kind) {
        for (const PageBlock& block : blocks_of_page(page))
            if (block.kind == kind) return block.text;
        ADD_FAILURE() << page << " has no " << kind;
        return std::string();
    };
    write("page.svg", first("docs/hud.md", "xml"));
    write("page.lua", first("docs/controllers.md", "lua"));
    write("page.toml", first("docs/conventions.md", "toml"));
    write("my.toml", "format = 1\n[post_process]\n[ui]\ndocument = \"page.svg\"\ncontrollers = [\"page.lua\"]\n");
    const test::Outcome outcome = run_lines(
        "darkroom develop a.exr --look my.toml --camera page.toml --game health=20 --game name=Ann "
        "--game has_quad=true -o a.png");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "");
}
TEST_F(CliPages, TemporalLab) {
    // A look for what has two sizes.
    write("my.toml", "format = 1\n[[stack]]\neffect = \"taa\"\n");
    try_page("docs/temporal_lab.md", 3);
    EXPECT_TRUE(fs::exists(path("judgement/judge.json")));
}
TEST_F(CliPages, Bindings) {
    fs::create_symlink(fs::path(test::source_folder) / "programs", path("programs"));
    fs::create_symlink(test::binary_folder, path("build"));
    fs::create_directory(path("FOLDER"));
    std::size_t run = 0;
    for (const auto& [kind, text] : blocks_of_page("docs/bindings.md")) {
        // Lines that build are PageBuilds' matter.
        if (kind != "sh" || text.starts_with("cmake --build ")) continue;
        ++run;
        const test::Outcome outcome = run_lines("export PYTHONDONTWRITEBYTECODE=1\n" + text);
        EXPECT_EQ(outcome.code, 0) << text << outcome.err;
    }
    EXPECT_EQ(run, 1U);
    EXPECT_TRUE(fs::exists(path("FOLDER/darkroom.rs")));
}
/// The lines behind "- run: " of a workflow.
std::vector<std::string> steps_of(const std::string& yaml) {
    constexpr std::string_view run = "- run: ";
    std::vector<std::string> out;
    for (const std::string& line : lines_of(yaml))
        if (const std::size_t at = line.find(run); at != std::string::npos) out.push_back(line.substr(at + run.size()));
    return out;
}
// What PBS does with a job array, one task after the other.
constexpr std::string_view qsub = R"(qsub() {
    local range first last step
    range=$(sed -nE 's/^#PBS -J ([0-9]+)-([0-9]+):([0-9]+)$/\1 \2 \3/p' "$1")
    read -r first last step <<<"$range"
    for index in $(seq "$first" "$step" "$last"); do
        (cd / && PBS_O_WORKDIR=$OLDPWD PBS_ARRAY_INDEX=$index bash "$OLDPWD/$1")
    done
}
)";
TEST_F(CliPages, Farm) {
    // Nothing is submitted: the lines that ask for progress tell of what a task has made, and one picture is missing.
    write("shot.0002.exr", "no frame");
    ASSERT_EQ(run_lines("darkroom farm task 'shot.####.exr' --look my.toml -o out/ --mkdir --frames 1-2").code, 1);
    fs::remove(path("out/shot.farm/job.json"));  // each line is a job of its own
    std::size_t run = 0;
    for (const char* const page : {"docs/farm.md", "docs/command_line.md"})
        for (const auto& [kind, text] : blocks_of_page(page)) {
            if (kind != "sh" || text.find("parallel") != std::string::npos) continue;
            for (std::string line : lines_of(text)) {
                if (!line.starts_with("darkroom farm ") || line.find("$first") != std::string::npos) continue;
                ++run;
                const bool submits = line.starts_with("darkroom farm slurm ");
                if (submits && line.find(" --dry-run") == std::string::npos) line += " --dry-run";
                const test::Outcome outcome = run_lines(line);
                EXPECT_EQ(outcome.code, 0) << page << ": " << line << "\n" << outcome.err;
                EXPECT_EQ(outcome.out.find("#SBATCH") != std::string::npos, submits) << outcome.out;
            }
        }
    EXPECT_GE(run, 7U);
}
TEST_F(CliPages, FarmsWithoutSlurm) {
    // The page's frames and its look, small.
    for (const char* const made : {"shot.0001.exr", "shot.0002.exr"}) fs::remove(path(made));
    for (const PageBlock& block : blocks_of_page("docs/farm.md")) {
        if (block.text.find("darkroom render ") == std::string::npos) continue;
        std::string lines = std::regex_replace(block.text, std::regex("sudo .*\n"), "");
        lines = std::regex_replace(lines, std::regex("--size \\w+"), "--size 64x36");
        ASSERT_EQ(run_lines(lines).code, 0) << lines;
    }
    ASSERT_EQ(run_lines("darkroom develop 'shot.####.exr' --look farm.toml -o alone/ --mkdir").code, 0);
    const auto expect_all = [&](const std::string& lines) {
        fs::remove_all(path("out"));
        const test::Outcome outcome = run_lines(lines + "darkroom farm status out/\n");
        EXPECT_EQ(outcome.code, 0) << lines << outcome.out << outcome.err;
        EXPECT_NE(outcome.out.find("out/shot.farm: 12 frames: 12 done"), std::string::npos) << outcome.out;
        for (int number = 1; number <= 12; ++number) {
            const std::string name = fmt::format("/shot.{:04}.png", number);
            EXPECT_EQ(test::content(path("out" + name)), test::content(path("alone" + name))) << lines;
        }
    };
    std::size_t farms = 0;
    for (const auto& [kind, text] : blocks_of_page("docs/farm.md")) {
        if (kind == "sh" && text.find("| parallel ") != std::string::npos) {
            ++farms;
            if (run_lines("command -v parallel").code == 0) expect_all(text);
        } else if (kind == "sh" && text.find("#PBS") != std::string::npos) {
            ++farms;
            expect_all(std::string(qsub) + text);
        } else if (kind == "yaml") {
            ++farms;
            std::smatch chunks;
            ASSERT_TRUE(std::regex_search(text, chunks, std::regex(R"(frames: \[(.*)\])")));
            const std::string list = chunks[1], frames = "${{ matrix.frames }}";
            std::string lines;
            for (std::string step : steps_of(text)) {
                if (step.starts_with("darkroom/darkroom ")) continue;
                const std::size_t at = step.find(frames);
                if (at == std::string::npos) {
                    lines += step + "\n";
                    continue;
                }
                step.replace(at, frames.size(), "\"$frames\"");
                lines +=
                    "for frames in " + std::regex_replace(list, std::regex(","), " ") + "; do " + step + "; done\n";
            }
            expect_all(lines);
        }
    }
    EXPECT_EQ(farms, 3U);
}
// A job begins on a machine without Darkroom.
TEST_F(CliPages, WorkflowsInstallDarkroom) {
    const std::string installs = "cmake --install darkroom/build";
    std::size_t jobs = 0;
    for (const std::string& page : pages_of_docs())
        for (const auto& [kind, text] : blocks_of_page(page)) {
            if (kind != "yaml") continue;
            bool is_there = false;
            for (const std::string& step : steps_of(text)) {
                is_there = is_there || (step.starts_with("darkroom/darkroom --yes ") && step.ends_with(installs));
                if (!step.starts_with("darkroom ")) continue;
                ++jobs;
                EXPECT_TRUE(is_there) << page << ": " << step;
            }
        }
    EXPECT_GE(jobs, 3U);
}
TEST_F(CliPages, Windows) {
    if (!fs::exists(fs::path(program).parent_path().parent_path() / "lib/darkroom/darkroom_viewer"))
        GTEST_SKIP() << "darkroom_viewer is not built";
    std::size_t run = 0;
    for (const std::string& page : pages_of_docs())
        for (const auto& [kind, text] : blocks_of_page(page)) {
            if (kind != "sh") continue;
            for (const std::string& line : lines_of(text)) {
                const std::string command = command_of(line);
                if (!command.starts_with("./darkroom play ") && !command.starts_with("./darkroom edit ")) continue;
                ++run;
                const test::Outcome outcome = run_lines("unset DISPLAY WAYLAND_DISPLAY\n" + command);
                EXPECT_EQ(outcome.code, 2) << page << ": " << command << "\n" << outcome.err;
                EXPECT_NE(outcome.err.find("no window can be opened"), std::string::npos)
                    << page << ": " << outcome.err;
            }
        }
    EXPECT_GE(run, 9U);
}
TEST_F(CliPages, CommandLine) { try_page("docs/command_line.md", 24); }

}  // namespace
}  // namespace darkroom
