// SPDX-License-Identifier: MIT
// What shells offer and manual pages say is what the parser takes: every flag and every word that is offered is typed.
#include <fmt/format.h>

#include <algorithm>
#include <darkroom/effects.hpp>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "core/text/param_text.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom {
namespace {

using test::Outcome;
using Words = std::vector<std::string>;

const Words commands{"render",    "develop",     "probe",    "plan",        "effects",    "devices",
                     "compare",   "info",        "lut info", "lut convert", "lut export", "farm slurm",
                     "farm task", "farm status", "play",     "edit",        "new",        "completion",
                     "man",       "bake",        "help"};

class CliCompletion : public test::CliFixture {
  protected:
    void make_files() override {
        for (const char* const shell : {"bash", "zsh", "fish"})
            ASSERT_EQ(run_lines(fmt::format("darkroom completion {0} > {0}.sh", shell)).code, 0);
    }
    /// What bash offers for each of these lines, whose last word is the one being typed.
    [[nodiscard]] std::vector<Words> offered(const std::vector<std::string>& lines) const {
        std::string script = "source bash.sh\n";
        for (const std::string& line : lines)
            script += fmt::format(
                "COMP_WORDS=(darkroom {}{}) && COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)) && _darkroom\n"
                "echo \"${{COMPREPLY[*]}}\"\n",
                line, line.empty() || line.ends_with(' ') ? " ''" : "");
        const Outcome outcome = run_lines(script);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        std::vector<Words> out;
        std::istringstream answers(outcome.out);
        for (std::string answer; std::getline(answers, answer);) {
            std::istringstream words(answer);
            out.emplace_back(std::istream_iterator<std::string>(words), std::istream_iterator<std::string>());
        }
        EXPECT_EQ(out.size(), lines.size());
        out.resize(lines.size());
        return out;
    }
    [[nodiscard]] Words offered(const std::string& line) const { return offered(std::vector{line}).front(); }
    static bool has(const Words& words, const std::string& word) {
        return std::ranges::find(words, word) != words.end();
    }
};

TEST_F(CliCompletion, OffersCommandsFlagsAndValues) {
    EXPECT_TRUE(has(offered("dev"), "develop"));
    for (const std::string& command : commands) EXPECT_TRUE(has(offered(""), command.substr(0, command.find(' '))));
    EXPECT_EQ(offered("lut "), (Words{"info", "convert", "export", "--help"}));
    EXPECT_EQ(offered("develop --kernels "), (Words{"auto", "compute", "raster"}));
    EXPECT_EQ(offered("develop --kernels = r"), (Words{"raster"})) << "what bash makes of --kernels=r";
    EXPECT_EQ(offered("develop --look bas"), (Words{"bash.sh"}));
    EXPECT_EQ(offered("develop bas"), (Words{"bash.sh"}));
    EXPECT_EQ(offered("develop --jobs "), Words{}) << "numbers are not known";
    EXPECT_EQ(offered("new l"), (Words{"look"}));
    if (find_effect("dither") == nullptr) return;
    EXPECT_TRUE(has(offered("develop --no-d"), "--no-dither"));
    EXPECT_EQ(offered("plan --dither-enabled o"), (Words{"on", "off"}));
    EXPECT_TRUE(has(offered("effects d"), "dither"));
    EXPECT_TRUE(has(offered("develop --help d"), "dither"));
}

// Help says which names are one flag's, and what takes a value. One process holds all flags, each under one of its
// names: it complains of the first that is unknown.
TEST_F(CliCompletion, TheParserTakesWhateverIsOffered) {
    for (const std::string& command : commands) {
        Words start;
        std::istringstream words(command);
        for (std::string word; words >> word;) start.push_back(word);
        Words asked = start;
        asked.emplace_back("--help-all");
        std::istringstream help(run(asked).out);
        const Words flags = offered(command + " -");
        std::vector<Words> typed(3, start);
        std::size_t names = 0;
        for (std::string line; std::getline(help, line);) {
            if (!line.starts_with("  -")) continue;
            std::string shown = line.substr(2, line.find("  ", 2) - 2);
            Words of_one;
            for (std::smatch found; std::regex_search(shown, found, std::regex("(--?[a-z0-9-]+)( [^ ]+?)?(, |$)"));
                 shown = found.suffix())
                of_one.push_back(found[1].str() + (found[2].length() > 0 ? "=1" : ""));
            ASSERT_FALSE(of_one.empty()) << command << ": " << line;
            names += of_one.size();
            for (std::size_t i = 0; i < typed.size() && !line.starts_with("  -h"); ++i)
                if (const std::string& name = of_one[std::min(i, of_one.size() - 1)]; name != "--help-all") {
                    typed[i].push_back(name.substr(0, name.find('=')));
                    if (name.ends_with("=1")) typed[i].emplace_back("1");
                }
            for (const std::string& name : of_one)
                EXPECT_TRUE(has(flags, name.substr(0, name.find('=')))) << command << " does not offer " << name;
        }
        EXPECT_EQ(names, flags.size()) << command << " offers more than help tells";
        for (const Words& line : typed) {
            const Outcome outcome = run(line);
            for (const char* const complaint : {"unknown argument", "unknown command", "one value is needed"})
                EXPECT_EQ(outcome.err.find(complaint), std::string::npos) << command << ": " << outcome.err;
        }
    }
}

TEST_F(CliCompletion, EveryWordOfAChoiceIsAllowed) {
    // Every flag with its words, by the plan of a look, which reads them all and needs no device.
    std::map<std::string, Words> choices;
    const Words flags = offered("plan --");
    std::vector<std::string> lines;
    for (const std::string& flag : flags) lines.push_back("plan " + flag + " ");
    const std::vector<Words> values = offered(lines);
    std::size_t rounds = 0;
    for (std::size_t i = 0; i < flags.size(); ++i) {
        if (values[i].empty() || has(values[i], "bash.sh") || values[i][0].starts_with('-') || flags[i] == "--help")
            continue;
        choices[flags[i]] = values[i];
        rounds = std::max(rounds, values[i].size());
    }
    EXPECT_GT(choices.size(), 20U);
    for (std::size_t round = 0; round < rounds; ++round) {
        Words typed{"plan"};
        for (const auto& [flag, words] : choices) typed.insert(typed.end(), {flag, words[round % words.size()]});
        const Outcome outcome = run(typed);
        EXPECT_EQ(outcome.err.find("allowed"), std::string::npos) << outcome.err;
    }
    // Of commands that draw: the complaint is about the file that is missing.
    for (const std::string flag : {"--debug-mode", "--format", "--present"})
        for (const std::string command : {"render", "develop", "play"})
            for (const std::string& word : offered(command + " " + flag + " ")) {
                if (word == "bash.sh" || word == "fish.sh" || word == "zsh.sh") continue;  // it has no such flag
                Words typed{command, "none.exr", flag, word};
                if (flag == "--format") typed.insert(typed.end(), {"-o", "-"});
                const Outcome outcome = run(typed);
                EXPECT_EQ(outcome.err.find("allowed"), std::string::npos) << outcome.err;
            }
    for (const char* const shell : {"bash", "fish", "zsh"}) EXPECT_EQ(run({"completion", shell}).code, 0);
    expect_refused({"completion", "tcsh"}, 1, "completion tcsh: allowed is bash, fish or zsh");
}

TEST_F(CliCompletion, FishOffersTheSame) {
    if (run_lines("command -v fish").code != 0) GTEST_SKIP() << "there is no fish on this machine";
    const auto fish = [&](const std::string& line) {
        const Outcome outcome =
            run_lines(fmt::format("HOME=$PWD fish -c 'source fish.sh; complete -C \"{}\"' | cut -f1", line));
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        std::istringstream lines(outcome.out);
        std::set<std::string> out;
        for (std::string word; std::getline(lines, word);)
            if (!word.ends_with('=')) out.insert(word);
        return out;
    };
    const auto sorted = [](const Words& words) { return std::set<std::string>(words.begin(), words.end()); };
    for (const char* const command : {"develop", "plan", "lut export", "compare"}) {
        std::set<std::string> expected;
        for (const std::string& flag : offered(std::string(command) + " --"))
            if (flag.starts_with("--")) expected.insert(flag);
        std::set<std::string> found;
        for (const std::string& flag : fish(std::string("darkroom ") + command + " --")) found.insert(flag);
        EXPECT_EQ(found, expected) << command;
    }
    EXPECT_EQ(fish("darkroom develop --kernels "), sorted({"auto", "compute", "raster"}));
    EXPECT_EQ(fish("darkroom lut "), sorted({"info", "convert", "export"}));
    EXPECT_TRUE(fish("darkroom develop bas").contains("bash.sh"));
}

TEST_F(CliCompletion, ZshReadsItsScriptAndNamesEveryFlag) {
    if (run_lines("command -v zsh").code != 0) GTEST_SKIP() << "there is no zsh on this machine";
    const Outcome outcome = run_lines(
        "zsh -f -c 'autoload -Uz compinit && compinit -D -u && source zsh.sh && print ${+functions[_darkroom]} && "
        "print $_comps[darkroom]'");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.out, "1\n_darkroom\n");
    // Its own parser takes every line of _arguments apart.
    const Outcome flags = run_lines(
        "zsh -f -c 'zmodload zsh/zutil; autoload -Uz compinit && compinit -D -u && source zsh.sh; "
        "_arguments() { print -rl -- \"$@\" }; words=(darkroom develop -); CURRENT=3; _darkroom'");
    EXPECT_EQ(flags.code, 0) << flags.err;
    for (const std::string& flag : offered("develop --"))
        EXPECT_TRUE(flags.out.find("\n" + flag + "[") != std::string::npos ||
                    flags.out.find("\n*" + flag + "[") != std::string::npos)
            << flag;
}

TEST_F(CliCompletion, EveryCommandHasAPageWithEveryFlag) {
    ASSERT_EQ(run_lines("mkdir pages && darkroom man -o pages").code, 0);
    for (std::string command : commands) {
        const Words flags = offered(command + " -");
        std::ranges::replace(command, ' ', '-');
        const std::string page = test::content(path("pages/darkroom-" + command + ".1"));
        ASSERT_TRUE(page.starts_with(".TH DARKROOM-")) << command;
        for (std::string flag : flags) {
            for (std::size_t at = 0; (at = flag.find('-', at)) != std::string::npos; at += 2) flag.insert(at, "\\");
            EXPECT_NE(page.find(flag), std::string::npos) << command << " " << flag;
        }
        EXPECT_NE(page.find("\n.SH EXAMPLES\n"), std::string::npos) << command;
    }
    EXPECT_NE(test::content(path("pages/darkroom.1")).find("darkroom\\-lut\\-export"), std::string::npos);
    EXPECT_EQ(run({"man", "develop"}).out, test::content(path("pages/darkroom-develop.1")));
    if (run_lines("command -v groff").code == 0) {
        const Outcome set = run_lines("groff -man -ww -z -Tutf8 pages/*.1");
        EXPECT_EQ(set.code, 0);
        EXPECT_EQ(set.err, "");
    }
    expect_refused({"man", "devlop"}, 1, "man: no command 'devlop'");
    expect_refused({"man", "-o", path("none")}, 1, "no such folder");
}

}  // namespace
}  // namespace darkroom
