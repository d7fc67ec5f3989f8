// SPDX-License-Identifier: MIT
// What is written beside the picture that was asked for: reports, frames, records. Others may have put a link, a pipe
// or a socket under its name. None is followed, none is waited for, and one line says so.
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <functional>
#include <map>
#include <regex>
#include <set>

#include "image/frame/frame_file.hpp"
#include "tests/cli/lab_support.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;
using test::Outcome;

class CliWritten : public test::WithLab<test::CliFixture> {
  protected:
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(8, 8);
        for (const char* const folder : {"out", "far", "man", "verified", "judged", "bin"})
            fs::create_directory(path(folder));
        ASSERT_TRUE(write_frame(path("a.0001.exr"), frame));
        std::ranges::fill(frame.color.pixels, 0.5F);
        ASSERT_TRUE(write_frame(path("b.exr"), frame));
        write("box.scene.toml", "[entities.box]\nbounds = { min = [-1, 0, -1], max = [1, 1, 1] }\n");
        write("bin/sbatch", "#!/bin/sh\necho 17\n");
        fs::permissions(path("bin/sbatch"), fs::perms::owner_all);
    }
    /// What a stranger may have put there, and what is said of it.
    struct Odd {
        const char* why;
        std::function<void(const std::string& name)> make;
    };
    [[nodiscard]] std::vector<Odd> odds() const {
        const auto listen = [this](const std::string& name) {
            const int number = ::socket(AF_UNIX, SOCK_STREAM, 0);
            const std::string place = path("s");  // the system takes no long ones
            sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
            ASSERT_LT(place.size(), sizeof address.sun_path);
            std::memcpy(address.sun_path, place.data(), place.size());
            EXPECT_EQ(::bind(number, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
            ::close(number);
            fs::rename(place, name);
        };
        return {{"is a link, which is not followed",
                 [this](const std::string& name) { fs::create_symlink(path("far/victim"), name); }},
                {"is a link, which is not followed",
                 [this](const std::string& name) { fs::create_symlink(path("far/nothing"), name); }},
                {"is no regular file", [](const std::string& name) { EXPECT_EQ(::mkfifo(name.c_str(), 0600), 0); }},
                {"is no regular file", listen},
                {"is a folder", [](const std::string& name) { fs::create_directory(name); }}};
    }
    /// Every kind of thing stands under the name in turn.
    void expect_refused_all(const std::string& line, const std::string& written) const {
        for (const Odd& odd : odds()) {
            write("far/victim", "precious");
            fs::remove_all(path(written));
            fs::remove_all(path("out"));
            fs::create_directory(path("out"));
            fs::create_directories(fs::path(path(written)).parent_path());
            odd.make(path(written));
            const Outcome outcome = run_lines("PATH=" + path("bin") + ":$PATH\n timeout 60 " + line);
            EXPECT_TRUE(outcome.code == 1 || outcome.code == 2) << line << ", " << odd.why << ": " << outcome.code;
            EXPECT_NE(outcome.err.find(fs::path(written).filename().string() + ": " + odd.why), std::string::npos)
                << line << ": " << outcome.err;
            EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << line << ": " << outcome.err;
            EXPECT_EQ(test::content(path("far/victim")), "precious") << line;
            EXPECT_FALSE(fs::exists(path("far/nothing"))) << line;
        }
        fs::remove_all(path(written));
        fs::remove_all(path("out"));
        fs::create_directory(path("out"));
        if (line.starts_with("darkroom verify")) return;  // takes seconds, and has a test of its own
        EXPECT_EQ(run_lines("PATH=" + path("bin") + ":$PATH\n timeout 60 " + line).code % 3, 0) << line;
        EXPECT_TRUE(fs::is_regular_file(path(written))) << line;
    }
};

TEST_F(CliWritten, ReportsFramesAndRecordsFollowNoLinkAndWaitForNothing) {
    const std::vector<std::pair<std::string, std::string>> lines{
        {"darkroom compare a.0001.exr b.exr --html page.html", "page.html"},
        {"darkroom compare a.0001.exr b.exr --diff diff.png", "diff.png"},
        {"darkroom compare a.0001.exr b.exr --sheet sheet.png", "sheet.png"},
        {"darkroom render box.scene.toml --size 8x8 -o a.png --save-frame frame.exr", "frame.exr"},
        {"darkroom verify --effect exposure --report report.json", "report.json"},
        {"darkroom verify --effect exposure -o verified", "verified/verify.json"},
        {"darkroom farm task a.####.exr -o out/ --frames 1", "out/a.farm/1-1.json"},
        {"darkroom farm slurm a.####.exr -o out/", "out/a.farm/job.sh"},
        {"darkroom man -o man", "man/darkroom-compare.1"},
    };
    for (const auto& [line, written] : lines) expect_refused_all(line, written);
    // A folder of records, too, is none where it is a link.
    fs::remove_all(path("out"));
    fs::create_directory(path("out"));
    fs::create_directory_symlink(path("far"), path("out/a.farm"));
    for (const char* const line : {"task a.####.exr -o out/ --frames 1", "slurm a.####.exr -o out/"}) {
        const Outcome outcome = run_lines("PATH=" + path("bin") + ":$PATH\n darkroom farm " + line);
        EXPECT_NE(outcome.err.find("a.farm: is a link, which is not followed"), std::string::npos) << outcome.err;
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(path("far")), {}), 1) << "the victim alone";
}

TEST_F(CliWritten, CachesFollowNoLink) {
    write("far/victim", "precious");
    write("encode.toml", "[[stack]]\neffect = \"encode\"\n");
    // The driver's own cache follows links.
    const std::string develop =
        "MESA_SHADER_CACHE_DISABLE=true DARKROOM_SHADER_CACHE= XDG_CACHE_HOME=" + path("cache") +
        " darkroom develop a.0001.exr --look encode.toml -o out/a.png";
    ASSERT_EQ(run_lines(develop).code, 0);
    std::vector<fs::path> kept;
    for (const auto& entry : fs::recursive_directory_iterator(path("cache/darkroom")))
        if (entry.is_regular_file()) kept.push_back(entry.path());
    ASSERT_FALSE(kept.empty());
    fs::permissions(path("far/victim"), fs::perms::all);
    for (const Odd& odd : odds()) {
        for (const fs::path& file : kept) {
            fs::remove_all(file);
            odd.make(file.string());
        }
        const Outcome outcome = run_lines("timeout 60 bash -c " + test::quoted(develop));
        EXPECT_EQ(outcome.code, 0) << odd.why << ": " << outcome.err;
        EXPECT_EQ(test::content(path("far/victim")), "precious");
        EXPECT_EQ(fs::status(path("far/victim")).permissions(), fs::perms::all);
        EXPECT_FALSE(fs::exists(path("far/nothing")));
    }
}

// Everything else is written by write_own_file: whoever writes through links is named here.
TEST(FilesWritten, ThroughLinksByFewAlone) {
    const std::regex through(R"((^|[^_\w.:])(darkroom::)?write_file\()");
    const fs::path source = test::source_folder;
    std::set<std::string> found;
    for (const char* const folder : {"engine", "files", "run", "scenes", "edit", "proof/graph_check", "proof/verify",
                                     "proof/verifier", "proof/lab", "programs/darkroom"})
        for (const auto& entry : fs::recursive_directory_iterator(source / folder)) {
            const std::string name = entry.path().lexically_relative(source).string();
            if (!name.ends_with(".cpp") || name.find("test") != std::string::npos) continue;
            if (std::regex_search(test::content(entry.path()), through)) found.insert(name);
        }
    EXPECT_EQ(found, (std::set<std::string>{
                         "edit/edit/document_file.cpp",            // the look that is saved
                         "edit/viewer/panels/panel_layout.cpp",    // settings in the user's own folder
                         "engine/core/files.cpp",                  //
                         "files/image/exr/write.cpp",              // pictures: -o
                         "files/image/picture/write.cpp",          //
                         "programs/darkroom/bake/bake.cpp",        // -o
                         "programs/darkroom/help/completion.cpp",  // -o
                         "programs/darkroom/lut/lut.cpp",          // -o
                         "programs/darkroom/new/new.cpp",          // the name that was asked for
                         "run/script/console.cpp",                 // settings in the user's own folder
                     }));
}

}  // namespace
}  // namespace darkroom
