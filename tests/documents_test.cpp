// SPDX-License-Identifier: MIT
// Documents that say what the registry, the folders and the program say, too: they are read and compared.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <darkroom/effects.hpp>
#include <darkroom/look.hpp>
#include <regex>
#include <set>

#include "core/text/param_text.hpp"
#include "tests/cli/cli_support.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

namespace fs = std::filesystem;

const fs::path source = test::source_folder;

/// Of a page, with line ends as spaces.
std::string one_line(const std::string& page) {
    std::string text = test::content(source / page);
    EXPECT_FALSE(text.empty()) << page;
    std::ranges::replace(text, '\n', ' ');
    return std::regex_replace(text, std::regex(" +"), " ");
}
/// The rows of the table of a page under this head, as the first group of `first_cell` and the rest of the line.
std::vector<std::pair<std::string, std::string>> rows_of(const std::string& page, const std::string& head,
                                                         const std::string& first_cell) {
    std::istringstream lines(test::content(source / page));
    const std::regex pattern("\\| *" + first_cell + " *\\|(.*)\\|");
    std::vector<std::pair<std::string, std::string>> rows;
    bool is_inside = false;
    for (std::string line; std::getline(lines, line);) {
        is_inside = line.starts_with(head) || (is_inside && line.starts_with('|'));
        if (std::smatch found; is_inside && std::regex_match(line, found, pattern))
            rows.emplace_back(found[1], found[2]);
    }
    return rows;
}
/// The names of a folder's files that end so, without the end.
std::set<std::string> files_of(const fs::path& folder, const std::string& end) {
    std::set<std::string> names;
    for (const auto& file : fs::directory_iterator(source / folder))
        if (const std::string name = file.path().filename().string(); name.ends_with(end))
            names.insert(name.substr(0, name.size() - end.size()));
    return names;
}
std::set<std::string> first_cells(const std::vector<std::pair<std::string, std::string>>& rows) {
    std::set<std::string> cells;
    for (const auto& [cell, rest] : rows) cells.insert(cell);
    return cells;
}

std::vector<std::string> flat_names(LookOrder order, bool only_those_on = false) {
    const auto rank = [&](const EffectInfo* effect) {
        return order == LookOrder::Documented ? effect->flat.documented : effect->flat.scene_linear;
    };
    std::vector<const EffectInfo*> effects;
    for (const EffectInfo* const effect : all_effects())
        if (rank(effect) >= 0 && !effect->flat.is_of_ui() &&
            (!only_those_on || flat_entry(*effect, order).state.enabled.on != 0))
            effects.push_back(effect);
    std::ranges::sort(effects, {}, rank);
    std::vector<std::string> names;
    for (const EffectInfo* const effect : effects) names.emplace_back(effect->name);
    return names;
}

TEST(Documents, LooksSayWhatStartsOnAndBothOrders) {
    const std::string text = one_line("docs/looks.md");
    for (const std::string& part :
         {fmt::format("| `\"documented\"` (of a table that names none) | {} |",
                      fmt::join(flat_names(LookOrder::Documented), ", ")),
          fmt::format("| `\"scene_linear\"` | {} |", fmt::join(flat_names(LookOrder::SceneLinear), ", ")),
          fmt::format("In `scene_linear` these effects start switched on: `{}`; in `documented`: `{}`.",
                      fmt::join(flat_names(LookOrder::SceneLinear, true), "`, `"),
                      fmt::join(flat_names(LookOrder::Documented, true), "`, `"))})
        EXPECT_NE(text.find(part), std::string::npos) << "docs/looks.md lacks: " << part;
}

TEST(Documents, LooksNameEveryKeyOfAnEntry) {
    const auto rows = rows_of("docs/looks.md", "| Key |", "`([a-z]+)`");
    std::set<std::string> expected{"effect", "name", "output", "input", "source", "second", "mask"};
    for (const ParamInfo& row : entry_rows.rows) {
        expected.emplace(row.name);
        const auto found = std::ranges::find(rows, row.name, [](const auto& named) { return named.first; });
        ASSERT_NE(found, rows.end()) << row.name;
        EXPECT_NE(found->second.find('`' + format(row, entry_rows.defaults) + '`'), std::string::npos) << row.name;
        for (const std::string_view choice : row.choices)
            EXPECT_TRUE(std::regex_search(found->second, std::regex(fmt::format("\\b{}\\b", choice)))) << choice;
    }
    EXPECT_EQ(first_cells(rows), expected);
}

TEST(Documents, TablesNameWhatShips) {
    EXPECT_EQ(first_cells(rows_of("docs/looks.md", "| Look |", R"(\[([a-z_]+)\.toml\]\(\.\./looks/[a-z_.]+\):[^|]+)")),
              files_of("looks", ".toml"));
    EXPECT_EQ(first_cells(rows_of("docs/scenes.md", "| Scene |", "`([a-z]+)`")), files_of("scenes", ".scene.toml"));
    std::set<std::string> effects;
    const std::string readme = one_line("README.md");
    for (const EffectInfo* const effect : all_effects()) {
        effects.emplace(effect->name);
        EXPECT_NE(readme.find(fmt::format("[`{0}`](effects/{0}/{0}.md)", effect->name)), std::string::npos)
            << effect->name << " is not in the README";
    }
    EXPECT_EQ(first_cells(rows_of("docs/effects.md", "| Effect |", R"(\[`([a-z_]+)`\]\(../effects/[a-z_/.]+\):[^|]+)")),
              effects);
}

/// The files of these folders that end so, one after the other.
std::string all_text(const std::vector<fs::path>& folders, const std::string& end) {
    std::string out;
    for (const fs::path& folder : folders)
        for (const auto& file : fs::recursive_directory_iterator(source / folder))
            if (file.is_regular_file() && file.path().filename().string().ends_with(end))
                out += test::content(file.path());
    return out;
}

// Who writes against an effect's struct reads its header; what the program says comes from the effect's source.
TEST(Documents, HeadersOfEffectsSayWhatTheirMembersAre) {
    for (const EffectInfo* const effect : all_effects()) {
        const std::string page = fmt::format("effects/{0}/{0}.hpp", effect->name);
        const std::string text = std::regex_replace(one_line(page), std::regex(" /// "), " ");
        for (const ParamInfo& row : effect->parameters.rows) {
            const bool has_interval =
                row.kind != Kind::Choice && row.kind != Kind::Toggle && row.kind != Kind::Resource;
            const std::string comment = std::string(row.doc) + (has_interval ? " " + interval(row) : "");
            const std::size_t at = text.find(comment);
            ASSERT_NE(at, std::string::npos) << page << ": no comment '" << comment << "'";
            const std::string member = text.substr(at + comment.size(), text.find(';', at + comment.size()) - at);
            EXPECT_TRUE(std::regex_search(member, std::regex("^ [A-Za-z0-9_:]+ " + std::string(row.name) + "[ ={;]")))
                << page << ": '" << comment << "' stands before" << member << ", not " << row.name;
        }
    }
}

// A page, a slider and a help text show the sentence alone: it says what the value is, and asks nothing.
TEST(Documents, SentencesAreStatements) {
    std::vector<std::pair<std::string, std::string_view>> sentences;
    for (const EffectInfo* const effect : all_effects()) {
        sentences.emplace_back(effect->name, effect->doc);
        for (const ParamInfo& row : effect->parameters.rows)
            sentences.emplace_back(fmt::format("{}.{}", effect->name, row.name), row.doc);
    }
    for (const ParamTable& table : {entry_rows, pulse_rows, layer_rows, distance_rows})
        for (const ParamInfo& row : table.rows) sentences.emplace_back(row.name, row.doc);
    EXPECT_GT(sentences.size(), 200U);
    const std::regex statement(R"(`?[A-Z0-9][^?!]*[^ .?!]\.)");
    const std::regex question("(Are|Can|Do|Does|Has|How|If|Is|Of|What|When|Where|Whether|Which|Why) .*");
    for (const auto& [name, sentence] : sentences) {
        const std::string text(sentence);
        EXPECT_TRUE(std::regex_match(text, statement)) << name << ": " << text;
        EXPECT_FALSE(std::regex_match(text, question)) << name << ": " << text;
        EXPECT_GE(text.size(), 16U) << name << ": " << text;
        EXPECT_LE(text.size(), 150U) << name << ": " << text;
    }
}

TEST(Documents, EveryFlagIsRunByATest) {
    // Those of parameters are run by Cli.EveryParameterIsAFlag; the lines of recipes by CliRecipes. The first are
    // Cargo's, CMake's, pkg-config's, rustc's, GNU parallel's and xmake's.
    std::set<std::string> run{"--manifest-path", "--build", "--install", "--prefix",  "--test-dir",
                              "--cflags",        "--libs",  "--edition", "--results", "--network"};
    for (const EffectInfo* const effect : all_effects()) {
        const std::string name = flag_name(effect->name);
        run.insert({name, "--no-" + name.substr(2), name + "-enabled"});
        for (const ParamInfo& row : effect->parameters.rows) run.insert(flag_name(flat_key(effect->name, row.name)));
    }
    const std::string tests = all_text({"tests", "engine", "files", "run", "scenes", "edit", "proof"}, "_test.cpp") +
                              all_text({"tests/scripts"}, ".sh") + test::content(source / "docs/recipes.md");
    std::string pages = test::content(source / "README.md");
    for (const auto& page : fs::directory_iterator(source / "docs"))
        // Measurements tell of a program of their own.
        if (page.path().extension() == ".md" && page.path().filename() != "measurements.md")
            pages += test::content(page.path());
    const std::regex flag("[` (](--[a-z][a-z0-9-]*[a-z0-9])");
    std::size_t flags = 0;
    for (std::sregex_iterator at(pages.begin(), pages.end(), flag), end; at != end; ++at) {
        const std::string name = (*at)[1];
        if (!run.insert(name).second) continue;
        ++flags;
        EXPECT_TRUE(std::regex_search(tests, std::regex("[ \"]" + name + "[ \"=]"))) << name << " is run by no test";
    }
    EXPECT_GT(flags, 60U);
}

class CliDocuments : public test::CliFixture {
  protected:
    void SetUp() override {
        for (const char* const name : {"ssao", "bloom", "exposure", "tonemap", "encode"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "the effect " << name << " is not in this build";
        CliFixture::SetUp();
    }
};

TEST_F(CliDocuments, ThePlanIsTheOneThatIsPrinted) {
    const test::Outcome plan = run({"plan"});
    ASSERT_EQ(plan.code, 0) << plan.err;
    EXPECT_NE(test::content(source / "docs/architecture.md").find("```\n" + plan.out + "```\n"), std::string::npos)
        << "docs/architecture.md shows another plan than this:\n"
        << plan.out;
}

TEST(Documents, AHostInCIsShort) {
    std::istringstream lines(test::content(source / "examples/embed.c"));
    bool is_main = false;
    std::size_t all = 0, ours = 0;
    for (std::string line; std::getline(lines, line);) {
        is_main = is_main || line.starts_with("int main");
        if (!is_main || line.empty()) continue;
        ++all;
        if (line.find("arkroom") != std::string::npos && line.find("//") == std::string::npos) ++ours;
    }
    EXPECT_GT(ours, 10u);
    EXPECT_LE(all, 60u);
    EXPECT_LE(ours, 30u);
}

}  // namespace
}  // namespace darkroom
