// SPDX-License-Identifier: MIT
#pragma once
// Tests of the command line run the built program and look at its exit code, its standard error and its files. A
// fixture has a folder of its own, gone with it.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "image/compare/compare.hpp"
#include "image/picture/display_picture.hpp"
#include "tests/places.hpp"

namespace darkroom::test {

struct Outcome {
    int code = -1;  ///< 128 and more: ended by a signal
    std::string out;
    std::string err;   ///< of standard error its errors and warnings
    std::string told;  ///< and what was done by the way
};

inline std::string quoted(const std::string& text) {
    std::string out(1, '\'');
    for (const char c : text) {
        if (c == '\'')
            out += "'\\''";
        else
            out += c;
    }
    out += '\'';
    return out;
}

inline std::string content(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

inline std::string with_exit_codes(const std::string& lines) {
    static const std::regex remark("^(.*[^ ]) +# exit code ([0-9]+)$");
    std::istringstream all(lines);
    std::string out;
    for (std::string line; std::getline(all, line);) {
        std::smatch found;
        if (std::regex_match(line, found, remark))
            line = "code=0; " + found.str(1) + " || code=$?; [[ $code == " + found.str(2) +
                   " ]] || { echo \"exit code $code in place of " + found.str(2) + "\" >&2; exit 99; }";
        out += line + "\n";
    }
    return out;
}

class CliFixture : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(std::filesystem::exists(program)) << program << " is not built";
        std::string name = (std::filesystem::temp_directory_path() / "darkroom_cli_XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
        make_files();
    }
    void TearDown() override {
        if (!folder_.empty()) std::filesystem::remove_all(folder_);
    }
    /// What every test of the fixture finds in the folder.
    virtual void make_files() {}

    [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
        return path(name);
    }
    [[nodiscard]] std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& file : std::filesystem::directory_iterator(folder_))
            names.push_back(file.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }
    [[nodiscard]] Outcome run(const std::vector<std::string>& arguments) const {
        std::string command = quoted(program);
        for (const std::string& argument : arguments) command.append(1, ' ').append(quoted(argument));
        return run_command(command);
    }
    /// Lines as one types them, run by bash in the folder of the test; the first that fails ends them. One with the
    /// remark "# exit code 3" fails where it ends with another.
    [[nodiscard]] Outcome run_lines(const std::string& lines) const {
        const std::string script = folder_.string() + ".sh";
        std::ofstream(script) << "set -eo pipefail\ncd " << quoted(folder_.string())
                              << "\nPATH=" << quoted(std::filesystem::path(program).parent_path().string())
                              << ":$PATH\n"
                              << with_exit_codes(lines) << '\n';
        const Outcome outcome = run_command("bash " + quoted(script));
        std::filesystem::remove(script);
        return outcome;
    }
    /// Refused: the code, one line that names the program and `part`, and no new file.
    void expect_refused(const std::vector<std::string>& arguments, int code, const std::string& part) const {
        const std::vector<std::string> before = files();
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, code) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_TRUE(outcome.err.starts_with("darkroom: ")) << outcome.err;
        EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " is not in " << outcome.err;
        EXPECT_EQ(files(), before);
    }
    [[nodiscard]] Picture picture(const std::string& name) const {
        const Result<ComparablePicture> read = read_comparable(path(name));
        EXPECT_TRUE(read) << read.error().text;
        return read ? read->picture : Picture{};
    }

    inline static const std::string program = std::string(test::binary_folder) + "/bin/darkroom";

  private:
    [[nodiscard]] Outcome run_command(const std::string& command) const {
        const std::filesystem::path out = folder_.string() + ".out", err = folder_.string() + ".err";
        const int status =
            std::system((command + " >" + quoted(out.string()) + " 2>" + quoted(err.string()) + " </dev/null").c_str());
        Outcome outcome{.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128, .out = content(out)};
        std::ifstream lines(err);
        for (std::string line; std::getline(lines, line);)
            (line.starts_with("darkroom: ") ? outcome.err : outcome.told).append(line).append(1, '\n');
        // Of other programs.
        if (outcome.code != 0 && outcome.err.empty()) outcome.err = outcome.told;
        std::filesystem::remove(out);
        std::filesystem::remove(err);
        return outcome;
    }

    std::filesystem::path folder_;
};

}  // namespace darkroom::test
