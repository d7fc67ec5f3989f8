// SPDX-License-Identifier: MIT
// The editor of looks, on any text of a look: what is spliced into it reads as
// what was edited, and where nothing was, not a byte changes. An input is four
// bytes, by which edits are chosen, and the text.

#include <fmt/format.h>

#include <cstring>

#include "edit/document.hpp"
#include "edit/follow/compare.hpp"
#include "edit/splice/splice.hpp"
#include "edit/test_random_edits.hpp"
#include "fuzz/target.hpp"

namespace darkroom::fuzz::splice_fuzz {
namespace {

using edit::test::below;

constexpr int max_edits = 6;

Result<> random_change(std::mt19937& random, Look& look) {
    // Of a look with entries of the interface alone, and without a table for
    // them, there is no value to be edited.
    const bool has_values = std::ranges::any_of(
        look.entries, [&](const LookEntry& entry) { return !entry.is_of_ui || look.ui.has_value(); });
    if (has_values && below(random, 2) == 0)
        return edit::test::apply_edit(look, edit::test::random_value_edit(random, look));
    return edit::test::random_restructuring(random, look);
}

std::string run(std::string_view input) {
    std::uint32_t seed = 0;
    if (input.size() < sizeof seed) return {};
    std::memcpy(&seed, input.data(), sizeof seed);
    std::string text(input.substr(sizeof seed));
    const LookOptions options{.reads_tables = false, .folder = "/nowhere"};
    Result<Look> first = parse_look(text, "a.toml", options);
    if (!first) return {};
    std::mt19937 random(seed);
    edit::LookDocument document(std::move(*first), options);
    Look written = document.look();
    for (int i = 0; i < max_edits; ++i) {
        const Result<std::string> same = edit::splice_look(text, written, document.look());
        if (!same || *same != text) return fmt::format("without an edit: {}", same ? *same : same.error().text);
        if (below(random, 8) == 0)
            document.undo();
        else
            (void)document.edit("Something", [&](Look& look) { return random_change(random, look); });
        const Result<std::string> spliced = edit::splice_look(text, written, document.look());
        // Lists that are no blocks, and lists with comments, keep their entries as they are.
        if (!spliced && spliced.error().text.find("moved, added or taken out") != std::string::npos)
            return wrong_error(spliced.error());
        if (!spliced) return fmt::format("nothing is spliced: {}\n{}", spliced.error().text, text);
        const Result<Look> again = parse_look(*spliced, "a.toml", options);
        if (!again) return fmt::format("refused: {}\n{}\n=====\n{}", again.error().text, text, *spliced);
        if (!edit::reads_as(*again, document.look()))
            return fmt::format("{}\n=== became\n{}\n=== and not\n{}", text, *spliced, write_look(document.look()));
        text = *spliced;
        written = document.look();
    }
    return {};
}

std::vector<std::string> seeds() {
    std::vector<std::string> texts = files("looks/*.toml");
    texts.emplace_back(
        "\xef\xbb\xbfstack = [ { effect = \"exposure\", exposure "
        "= 2 }, # one\n { effect = 'encode' } ]\n");
    texts.emplace_back(
        "post_process.exposure = 0x1_0\r\npost_process.fog_color.r = 1 # "
        "\xe2\x82\xac\r\nformat = 1");
    texts.emplace_back(
        "[[stack]] # a\neffect = \"gaussian_blur\"\noutput = "
        "\"made\"\n\n# b\n[[stack]]\neffect = \"blend\"\n"
        "source = \"made\"\nopacity = 0.5\n[[pulse]]\nevent = "
        "\"hit\"\nentry = \"blend\"\nparameter = \"opacity\"\n"
        "amount = 1\n[[layer]]\nname = \"night\"\nvalues = { "
        "\"gaussian_blur.radius\" = 3.0 }\n");
    std::vector<std::string> out;
    for (std::size_t i = 0; i < texts.size(); ++i) out.push_back(fmt::format("{:04}{}", i, texts[i]));
    return out;
}

const Registration splice({.name = "splice", .run = run, .seeds = seeds});

}  // namespace
}  // namespace darkroom::fuzz::splice_fuzz
