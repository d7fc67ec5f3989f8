// SPDX-License-Identifier: MIT
// What is opened by a name is a regular file. A pipe that nobody writes into and a device without an end are given
// where every argument, every flag and every key takes a file, and each has to be refused in one line, at once.
#include <sys/stat.h>

#include <regex>
#include <set>

#include "image/frame/frame_file.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom {
namespace {

using test::Outcome;
using Words = std::vector<std::string>;

class CliOpen : public test::CliFixture {
  protected:
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(8, 8);
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
        std::filesystem::create_directory(path("out"));
        write("box.scene.toml", "[entities.box]\nbounds = { min = [-1, 0, -1], max = [1, 1, 1] }\n");
        ::setenv("XDG_STATE_HOME", path("state").c_str(), 1);
    }
    /// A pipe, or a link to the device, under a name with this ending, where kinds of files are told by it.
    [[nodiscard]] std::string odd(bool is_pipe, const std::string& extension) const {
        const std::string name = path((is_pipe ? "pipe" : "zero") + extension);
        std::filesystem::remove(name);
        if (is_pipe)
            EXPECT_EQ(::mkfifo(name.c_str(), 0600), 0);
        else
            std::filesystem::create_symlink("/dev/zero", name);
        return name;
    }
#if defined(__SANITIZE_ADDRESS__)
    static constexpr const char* limit = "";  // it maps terabytes
#else
    static constexpr const char* limit = "ulimit -v 8000000 || true\n";
#endif
    void expect_said(const Words& typed, const std::string& file, int code) const {
        std::string line = "timeout 20 darkroom";
        for (const std::string& word : typed) line += " " + test::quoted(word);
        const Outcome outcome = run_lines(std::string(limit) + line);
        // The window comes before what it shows.
        if (outcome.err.find("no window can be opened") != std::string::npos) return;
        EXPECT_EQ(outcome.code, code) << line << ": " << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << line << ": " << outcome.err;
        const std::string expected = std::filesystem::path(file).filename().string() + ": is a " +
                                     (file.find("pipe") == std::string::npos ? "device" : "pipe") +
                                     ", a regular file is needed";
        EXPECT_NE(outcome.err.find(expected), std::string::npos) << line << ": " << outcome.err;
    }
    void expect_refused_both(const Words& typed, const std::string& extension, int code = 1) const {
        for (const bool is_pipe : {true, false}) {
            const std::string file = odd(is_pipe, extension);
            Words words = typed;
            for (std::string& word : words)
                if (const std::size_t at = word.find('@'); at != std::string::npos) word.replace(at, 1, file);
            expect_said(words, file, code);
        }
    }
};

TEST_F(CliOpen, ArgumentsOfAllCommands) {
    const std::string frame = path("frame.exr"), out = path("out.png");
    for (const std::string extension : {".exr", ".png", ".hdr"}) {
        expect_refused_both({"develop", "@", "-o", out}, extension);
        expect_refused_both({"compare", frame, "@"}, extension);
        expect_refused_both({"compare", "@", frame}, extension);
        expect_refused_both({"probe", "@", "--at", "1,1"}, extension);
        expect_refused_both({"plan", "--input", "@"}, extension);
        expect_refused_both({"lut", "convert", "@", "-o", path("out.cube")}, extension);
    }
    for (const std::string extension : {".exr", ".png", ".glb", ".cube", ".clf", ".toml", ".scene.toml"}) {
        expect_refused_both({"info", "@"}, extension);
        expect_refused_both({"lut", "info", "@"}, extension);
    }
    for (const std::string extension : {".scene.toml", ".toml", ".glb", ".gltf"})
        expect_refused_both({"render", "@", "--size", "8x8", "-o", out}, extension);
    for (const std::string extension : {".cube", ".3dl", ".spi1d", ".spi3d", ".csp", ".clf"})
        expect_refused_both({"lut", "convert", "@", "-o", path("out.cube")}, extension);
    for (const std::string extension : {".toml", ".scene.toml"}) {
        expect_refused_both({"plan", "@"}, extension);
        expect_refused_both({"lut", "export", "@", "-o", path("out.cube")}, extension);
    }
    expect_refused_both({"effects", "@"}, ".glsl");
    for (const std::string command : {"play", "edit"})
        for (const std::string extension : {".scene.toml", ".glb", ".exr"})
            expect_refused_both({command, "@", "--frames", "1"}, extension);
}

// Every flag whose value help calls a file; one that is not in this table fails the test.
TEST_F(CliOpen, FlagsOfAllCommands) {
    const std::map<std::string, Words> endings{{"--look", {".toml", ".scene.toml"}},
                                               {"--layer", {".toml"}},
                                               {"--ui", {".png", ".svg"}},
                                               {"--events", {".toml"}},
                                               {"--camera", {".toml"}},
                                               {"--effect", {".glsl"}},
                                               {"--input", {".exr"}},
                                               {"--ocio", {".ocio"}},
                                               {"--lut", {".cube", ".clf", ".png"}},
                                               {"--lut-fade-to", {".cube"}},
                                               {"--arena-grade-table", {".cube", ".png"}},
                                               {"--lens-dirt-dirt", {".png"}},
                                               {"--auto-exposure-metering-mask", {".png"}},
                                               {"--perturb-distortion", {".png"}}};
    const std::string frame = path("frame.exr"), scene = path("box.scene.toml");
    const std::map<std::string, Words> commands{
        {"develop", {frame, "-o", path("out.png")}},
        {"render", {scene, "--size", "8x8", "-o", path("out.png")}},
        {"probe", {frame, "--at", "1,1"}},
        {"plan", {}},
        {"lut export", {"-o", path("out.cube")}},
        {"play", {frame, "--frames", "1"}},
        {"edit", {frame, "--frames", "1"}},
        {"farm task", {path("a.####.exr"), "-o", path("out/"), "--frames", "1"}},
        {"farm slurm", {path("a.####.exr"), "-o", path("out/"), "--dry-run"}},
    };
    ASSERT_TRUE(write_frame(path("a.0001.exr"), [] {
        FrameFile one;
        one.color = Picture(4, 4);
        return one;
    }()));
    const std::regex flag("\n  (?:-\\w \\S+, )?(--[\\w-]+) (?:FILE|FRAME)");
    for (const auto& [command, rest] : commands) {
        const std::string help = run_lines("darkroom " + command + " --help-all").out;
        std::set<std::string> flags;
        for (auto found = std::sregex_iterator(help.begin(), help.end(), flag); found != std::sregex_iterator();
             ++found)
            flags.insert((*found)[1]);
        EXPECT_FALSE(flags.empty()) << command;
        for (const std::string& name : flags) {
            ASSERT_TRUE(endings.contains(name)) << command << " " << name << " takes a file";
            Words typed;
            std::istringstream words(command);
            for (std::string word; words >> word;) typed.push_back(word);
            typed.insert(typed.end(), rest.begin(), rest.end());
            typed.insert(typed.end(), {name, "@"});
            // A plan needs no interface, only where it comes in.
            if (name == "--ui" && (command == "plan" || command == "lut export")) continue;
            for (const std::string& ending : endings.at(name)) expect_refused_both(typed, ending);
        }
    }
}

TEST_F(CliOpen, FilesThatLooksName) {
    struct Case {
        std::string text, extension;
    };
    const std::string encode = "[[stack]]\neffect = \"encode\"\n";
    const std::vector<Case> cases{
        {"[[stack]]\neffect = \"lut\"\nlut = \"@\"\n" + encode, ".cube"},
        {"[[stack]]\neffect = \"lut\"\nlut = \"@\"\n" + encode, ".clf"},
        {"[[stack]]\neffect = \"vignette\"\nmask = \"@\"\n" + encode, ".png"},
        {"[[stack]]\neffect = \"@\"\n" + encode, ".glsl"},
        {encode + "[ui]\ndocument = \"@\"\n", ".svg"},
        {encode + "[ui]\ndocument = \"@\"\n", ".png"},
        {encode + "[ui]\ncontrollers = [\"@\"]\n", ".lua"},
    };
    for (const Case& one : cases)
        for (const bool is_pipe : {true, false}) {
            const std::string file = odd(is_pipe, one.extension);
            std::string text = one.text;
            text.replace(text.find('@'), 1, std::filesystem::path(file).filename().string());
            const std::string look = write("a.toml", text);
            for (const Words& typed :
                 {Words{"develop", path("frame.exr"), "--look", look, "-o", path("out.png")},
                  Words{"render", path("box.scene.toml"), "--size", "8x8", "--look", look, "-o", path("out.png")},
                  Words{"plan", look}, Words{"info", look}}) {
                // What they do not need they need not open.
                const bool may_pass = typed[0] == "plan" || typed[0] == "info";
                if (!may_pass || run_lines("timeout 20 darkroom " + typed[0] + " " + test::quoted(look)).code != 0)
                    expect_said(typed, file, 1);
            }
        }
}

// A scene is drawn without what it lacks, with a warning.
TEST_F(CliOpen, FilesThatScenesName) {
    struct Case {
        std::string text, extension;
        int code;
    };
    const std::vector<Case> cases{
        {"[entities.box.model]\nasset = \"@\"\n", ".glb", 0},
        {"[entities.box.sprite]\ntexture = \"@\"\n", ".png", 0},
        {"[entities.box]\nbounds = { min = [-1, 0, -1], max = [1, 1, 1] }\n[entities.box.material]\ntexture = \"@\"\n",
         ".png", 0},
        {"[entities.box]\nbounds = { min = [-1, 0, -1], max = [1, 1, 1] }\n[environment]\nskybox = \"@\"\n", ".hdr", 0},
        {"[prefabs.a]\ntemplate = \"@\"\n", ".prefab.toml", 1},
    };
    for (const Case& one : cases)
        for (const bool is_pipe : {true, false}) {
            const std::string file = odd(is_pipe, one.extension);
            std::string text = one.text;
            text.replace(text.find('@'), 1, std::filesystem::path(file).filename().string());
            expect_said({"render", write("a.scene.toml", text), "--size", "8x8", "-q", "-o", path("out.png")}, file,
                        one.code);
        }
}

TEST_F(CliOpen, FilesThatModelsName) {
    for (const bool is_pipe : {true, false}) {
        const std::string file = odd(is_pipe, ".bin");
        const std::string model =
            write("a.gltf", "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"" +
                                std::filesystem::path(file).filename().string() +
                                "\",\"byteLength\":36}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
                                "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
                                "\"min\":[0,0,0],\"max\":[1,1,1]}],"
                                "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
                                "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0}");
        expect_said({"render", model, "--size", "8x8", "-o", path("out.png")}, file, 1);
        expect_said({"info", model}, file, 1);
    }
}

// A new way to open a file would be a way around all of the above. What the system has for it is used by core/files.cpp
// alone; Lua's and the font's are given names of their own.
// What makes a file that must not be there yet reads none, and /dev/null holds nothing.
TEST(FilesOpened, ByOneFunctionAlone) {
    const std::regex opener(
        R"(ifstream|\bfopen\(|[^\w.>]::open(at)?\((?![^;]*(O_EXCL|"/dev/null"))|\bOpenFile\b|_wsopen|CreateFileW|)"
        R"(AddFontFromFileTTF|luaL_(load|do)file)");
    const std::filesystem::path source = test::source_folder;
    std::set<std::string> found;
    for (const char* const folder : {"engine", "files", "run", "scenes", "edit", "proof/graph_check", "proof/verify",
                                     "proof/verifier", "programs/darkroom", "include"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(source / folder)) {
            const std::string name = entry.path().lexically_relative(source).string();
            const bool is_source = name.ends_with(".cpp") || name.ends_with(".hpp");
            if (!is_source || name.find("test") != std::string::npos) continue;
            if (std::regex_search(test::content(entry.path()), opener)) found.insert(name);
        }
    EXPECT_EQ(found, (std::set<std::string>{"engine/core/files.cpp", "engine/core/system/file.hpp",
                                            "engine/core/system/file_posix.cpp", "engine/core/system/file_windows.cpp",
                                            "edit/panels/widgets/theme.cpp"}));
}

}  // namespace
}  // namespace darkroom
