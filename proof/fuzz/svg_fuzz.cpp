// SPDX-License-Identifier: MIT
// Documents of the interface: values are text and never tags, and what is
// written into a document that was checked leaves one that passes the same
// check.

#include <fmt/format.h>

#include <algorithm>

#include "fuzz/target.hpp"
#include "hud/svg_text.hpp"

namespace darkroom::fuzz::svg_fuzz {
namespace {

constexpr std::uint32_t max_elements = 20'000;
constexpr std::string_view hostile = "\"><image href='x'/>]]>&amp;{{health}}\n\xff";

/// What stands in the class of the elements that are called so.
std::string wrong_classes(std::string_view document, const SvgFacts& facts, const HudClasses& classes) {
    for (const SvgFacts::Element& element : facts.elements)
        for (const auto& [key, is_on] : classes) {
            if (key.first != element.id) continue;
            std::string words = fmt::format(" {} ", document.substr(element.class_begin, element.class_size));
            std::ranges::replace_if(
                words, [](char c) { return c == '\t' || c == '\r' || c == '\n'; }, ' ');
            const bool has =
                element.class_begin > 0 && words.find(fmt::format(" {} ", key.second)) != std::string::npos;
            if (has != is_on) return fmt::format("{} is {}of class {}", key.first, has ? "" : "not ", key.second);
        }
    return {};
}

std::string wrong_filled(const std::string& filled, const SvgFacts& facts) {
    const HudClasses classes{{{"health", "low"}, true}, {{"health", "full"}, false}, {{"a", "b"}, true}};
    const std::string classed = with_classes(filled, facts, classes);
    SvgFacts of_classed, of_sized;
    if (const Result<> checked = check_svg(classed, max_elements, &of_classed); !checked)
        return "with classes it is refused: " + checked.error().text;
    if (std::string wrong = wrong_classes(classed, of_classed, classes); !wrong.empty()) return wrong;
    if (of_classed.elements.size() != facts.elements.size()) return "classes change the elements";
    const std::string sized = at_size(classed, facts, 1920, 1080, 1.5);
    if (facts.reference_height > 0 || facts.root_at == 0) return {};
    const Result<> checked = check_svg(sized, max_elements, &of_sized);
    if (!checked) return "at a size it is refused: " + checked.error().text;
    return of_sized.has_view_box ? std::string() : "at a size it has no viewBox";
}

std::string run(std::string_view input) {
    SvgFacts facts;
    const Result<> checked = check_svg(input, max_elements, &facts);
    const Result<SvgTemplate> parsed = SvgTemplate::parse(std::string(input));
    if (!checked)
        if (std::string wrong = wrong_error(checked.error()); !wrong.empty()) return wrong;
    if (!parsed) return wrong_error(parsed.error());
    const Result<std::string> filled =
        parsed->fill({{"health", 12.5}, {"ammo", std::string(hostile)}, {"a", -1e300}, {"name", std::string(hostile)}});
    if (!filled) return wrong_error(filled.error());
    for (const char mark : {'<', '>', '"'})
        if (std::ranges::count(*filled, mark) != std::ranges::count(input, mark))
            return fmt::format("a value brings a {} of its own:\n{}", mark, *filled);
    if (!checked) return {};
    const Result<> checked_again = check_svg(*filled, max_elements, &facts);
    return checked_again ? wrong_filled(*filled, facts) : wrong_error(checked_again.error());
}

std::vector<std::string> seeds() {
    std::vector<std::string> out = files("hud/*.svg");
    out.emplace_back(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?><svg "
        "data-reference-height=\"1080\"><g id=\"health\" class=\"full x\">"
        "<text x='{{a:00.0}}'>{{ health }}</text></g><script "
        "src=\"a.lua\"/></svg>");
    out.emplace_back(
        "<svg viewBox='0 0 9 9'><style>#a { fill: url(#\\62) } "
        "<![CDATA[ .b {} ]]></style><!-- {{ammo}} -->"
        "<rect id=\"a\" fill=\"url( '#b' )\"/><use href=\"#a\" "
        "xlink:href='#a'/><a href=\"x\">&#x41;{{name}}</a></svg>");
    return out;
}

const Registration svg({.name = "svg", .run = run, .seeds = seeds, .longest = 8192});

}  // namespace
}  // namespace darkroom::fuzz::svg_fuzz
