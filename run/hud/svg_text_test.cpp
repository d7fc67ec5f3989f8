// SPDX-License-Identifier: MIT
#include "hud/svg_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace darkroom {
namespace {

constexpr std::uint32_t plenty = 1000;

std::string checked(const std::string& document, std::uint32_t max_elements = plenty) {
    const auto result = check_svg(document, max_elements);
    return result ? std::string() : result.error().text;
}

std::string filled(const std::string& document, const HudValues& values) {
    const auto parsed = SvgTemplate::parse(document);
    if (!parsed) return parsed.error().text;
    const auto out = parsed->fill(values);
    return out ? *out : out.error().text;
}

TEST(HudText, PlainDocumentsPass) {
    EXPECT_EQ(
        checked("<?xml version=\"1.0\" encoding='utf-8'?>\n<!-- file:///x --><svg xmlns=\"http://www.w3.org/2000/svg\">"
                "<style>a { fill: url( '#b' ); }</style><use href='#b'/><rect fill=\"url(#b)\"/>"
                "<text>url(here), @import, a &lt; b</text><script href=\"visor.lua\"/></svg>"),
        "");
}

TEST(HudText, RefusesWhatLeadsOutOfTheDocument) {
    const std::string start = "<svg>\n";
    for (const std::string& part :
         {std::string("<use href=\"file:///etc/passwd#a\"/>"), std::string("<use xlink:href='http://host/a.svg#a'/>"),
          std::string("<use href=\"&#35;a\"/>"), std::string("<image href=\"#a\"/>"), std::string("<svg:image/>"),
          std::string("<feImage href='#a'/>"), std::string("<xi:include href='#a'/>"),
          std::string("<g xml:base='file:///'/>"), std::string("<rect fill=\"url(file:///a.svg#b)\"/>"),
          std::string("<rect style='fill:URL( &quot;http://host&quot;)'/>"),
          std::string("<style>@import 'a.css';</style>"), std::string("<style><![CDATA[a{fill:url(b)}]]></style>"),
          std::string("<?xml-stylesheet href='a.css'?>"), std::string("<!DOCTYPE svg SYSTEM 'http://host/a.dtd'>")})
        EXPECT_TRUE(checked(start + part).starts_with("2: ")) << part << ": " << checked(start + part);
    EXPECT_TRUE(checked("<?xml version='1.0' encoding='UTF-16'?><svg/>").starts_with("1: "));
    EXPECT_TRUE(checked(std::string("<svg>\0</svg>", 12)).starts_with("1: "));
}

// An attribute, or the content of <style>, as the parsers of XML and CSS read it.
TEST(HudText, RefusesReferencesBehindEntitiesAndEscapes) {
    for (const std::string& text :
         {std::string("filter:&#117;rl(data:image/svg+xml,x#f)"), std::string("filter:&#x75;&#x0072;l(data:x#f)"),
          std::string("filter:url&#40;data:x#f)"), std::string("filter:\\75rl(data:x#f)"),
          std::string("filter:\\000075 rl(data:x#f)"), std::string("filter:u\\r\\l(data:x#f)"),
          std::string("filter:&#92;75rl(data:x#f)"), std::string("filter:ur\\6c(data:x#f)"),
          std::string("filter:url(\\23 f)"), std::string("filter:url(&apos;&apos;#f)"),
          std::string("@\\69mport &quot;a.css&quot;"), std::string("&#64;import &quot;a.css&quot;")}) {
        EXPECT_TRUE(checked("<svg>\n<g style=\"" + text + "\"/></svg>").starts_with("2: ")) << text;
        EXPECT_TRUE(checked("<svg>\n<style>" + text + "</style></svg>").starts_with("2: ")) << text;
    }
    for (const std::string text :
         {"u<!-- -->rl(data:x)", "u<![CDATA[rl(data:x)]]>", "u<g/>rl(data:x)", "u<g>x</g>rl(data:x)"})
        EXPECT_TRUE(checked("<svg>\n<style>a{fill:" + text + "}</style></svg>").starts_with("2: ")) << text;
    EXPECT_EQ(
        checked("<svg><g style=\"fill:url(&quot;#a&quot;);content:'\\2014 \\(';font-family:&apos;A &amp; B&apos;\"/>"
                "<style>a{fill:url(#b)}<!-- -->.a\\:b{}</style><text>&#117;rl(x) \\75rl(x)</text></svg>"),
        "");
}

TEST(HudText, RefusesEntitiesAndTooManyElements) {
    EXPECT_EQ(checked("<!DOCTYPE svg [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]><svg>&b;</svg>"),
              "1: a document type or an entity: neither is allowed");
    EXPECT_EQ(checked("<svg><g/><g/></svg>", 3), "");
    EXPECT_EQ(checked("<svg><g/>\n<g/></svg>", 2), "2: more than 2 elements");
}

TEST(HudText, NamesTheLineOfATagThatIsNotClosed) {
    EXPECT_EQ(checked("<svg>\n<g><rect>\n</g></svg>"), "3: </g> where <rect> of line 2 is open");
    EXPECT_EQ(checked("<svg/>\n</svg>"), "2: </svg> closes nothing");
    EXPECT_EQ(checked("<svg>\n<g a='<'>"), "2: <g> is not closed");
    std::string deep, ends;
    for (int i = 0; i < 300; ++i) deep += "<g>", ends += "</g>";
    EXPECT_EQ(checked(deep + ends), "1: elements in more than 200 others");
}

TEST(HudText, EndsOnEveryCutOffDocument) {
    const std::string document =
        "<?xml version='1.0'?><!-- a --><svg a=\"b\" c='d'><style>a{fill:url(#b)}</style><![CDATA[x]]><g/></svg>";
    EXPECT_EQ(checked(document), "");
    for (std::size_t size = 0; size < document.size(); ++size) (void)checked(document.substr(0, size));
    EXPECT_NE(checked("<svg a=b>"), "");
    EXPECT_NE(checked("<svg a=\"b>"), "");
    EXPECT_NE(checked("<svg "), "");
}

TEST(HudText, FillsTextAndAttributes) {
    EXPECT_EQ(filled("<rect width=\"{{health}}\"/><text>{{ health }} of {{name}}</text>",
                     {{"health", 74.5}, {"name", "Ranger"}}),
              "<rect width=\"74.5\"/><text>74.5 of Ranger</text>");
    EXPECT_EQ(filled("{{a}}{{b}}", {{"a", 100.0}, {"b", -0.125}}), "100-0.125");
}

TEST(HudText, ValuesAreTextAndNeverTags) {
    const std::string out = filled("<text a=\"{{name}}\" b='{{name}}'>{{name}}</text>",
                                   {{"name", "\"/><image href='file:///etc/passwd'/> & {{name}} (x) \n\x01\xFF"}});
    EXPECT_EQ(out.find("<image"), std::string::npos);
    EXPECT_EQ(std::ranges::count(out, '"'), 2);
    EXPECT_EQ(std::ranges::count(out, '\''), 2);
    EXPECT_EQ(std::ranges::count(out, '\n'), 0);
    EXPECT_NE(out.find("&amp; {{name}} (x)"), std::string::npos) << out;
    EXPECT_EQ(checked(out), "");
    EXPECT_EQ(checked(filled("<text>{{name}}</text>", {{"name", "url(x), @import"}})), "") << "what the game says";
    EXPECT_NE(checked(filled("<g fill=\"{{name}}\"/>", {{"name", "url(file:///etc/passwd)"}})), "");
}

TEST(HudText, NamesTheLineOfABindingThatCannotBeFilled) {
    EXPECT_EQ(filled("<svg>\n\n{{helth}}</svg>", {{"health", 1.0}}),
              "3: {{helth}}: no value has this name, did you mean 'health'?");
    EXPECT_EQ(filled("<svg>\n{{a b}}</svg>", {}), "2: {{a b}}: allowed is a name of letters, digits, '_', '-' and '.'");
    EXPECT_EQ(filled("<svg>\n{{a\n}}</svg>", {}), "2: '{{' without '}}' on its line");
}

TEST(HudText, NumbersTakeTheFormOfTheirBinding) {
    const auto shown = [](const std::string& form, double number) {
        return filled("{{a:" + form + "}}", {{"a", number}});
    };
    EXPECT_EQ(shown("0", 81.7), "82");
    EXPECT_EQ(shown("000", 24), "024");
    EXPECT_EQ(shown("0.00", 1.005e3), "1005.00");
    EXPECT_EQ(shown("00.0", -3.26), "-03.3");
    EXPECT_EQ(shown("0", -0.4), "0") << "no sign of nothing";
    EXPECT_EQ(shown("0", 1e300), "1e+300");
    EXPECT_EQ(filled("{{ a:0 }}", {{"a", HudValue("text")}}), "text");
    for (const std::string form : {"", "1", ".0", "0.", "0.0.0", "#", "0000000000000000", "0x"})
        EXPECT_NE(shown(form, 1).find("a number's form of zeros"), std::string::npos) << form;
    // What is shown stays where only hidden decimals change.
    const auto parsed = SvgTemplate::parse("{{a:0}}");
    ASSERT_TRUE(parsed);
    const HudValue before = 81.7;
    EXPECT_FALSE(parsed->shows("a", &before, 82.4));
    EXPECT_TRUE(parsed->shows("a", &before, 82.6));
    EXPECT_TRUE(parsed->shows("a", nullptr, 81.7));
    EXPECT_FALSE(parsed->shows("b", nullptr, 1.0));
}

TEST(HudText, TellsWhatScriptsItNames) {
    SvgFacts facts;
    ASSERT_TRUE(
        check_svg("<svg><script src='a.lua'/><script xlink:href=\"b&amp;c.lua\"/><script href='a.lua'/>"
                  "<script>text</script><a href='d.lua'/></svg>",
                  plenty, &facts));
    EXPECT_EQ(facts.scripts, (std::vector<std::string>{"a.lua", "b&c.lua"}));
    std::string many = "<svg>\n";
    for (int i = 0; i < 17; ++i) many += "<script src='" + std::to_string(i) + ".lua'/>";
    facts = {};
    const auto refused = check_svg(many + "</svg>", plenty, &facts);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text, "2: more than 16 scripts");
}

TEST(HudText, ElementsGetAndLoseClasses) {
    const std::string document =
        "<svg id='root'><g class=\"a  low\" id=\"health\"/><g id='b&amp;c'/><text class='low' id='other'/></svg>";
    SvgFacts facts;
    ASSERT_TRUE(check_svg(document, plenty, &facts));
    EXPECT_EQ(with_classes(document, facts, {}), document);
    EXPECT_EQ(with_classes(document, facts,
                           {{{"b&c", "x"}, true},
                            {{"health", "low"}, false},
                            {{"health", "on"}, true},
                            {{"none", "x"}, true},
                            {{"root", "y"}, true},
                            {{"root", "z"}, false}}),
              "<svg class=\"  y \" id='root'><g class=\" a  on \" id=\"health\"/><g class=\"  x \" id='b&amp;c'/>"
              "<text class='low' id='other'/></svg>");
    // What is there is not there twice.
    EXPECT_EQ(with_classes("<g id='a' class='x x'/>",
                           [] {
                               SvgFacts one;
                               EXPECT_TRUE(check_svg("<g id='a' class='x x'/>", plenty, &one));
                               return one;
                           }(),
                           {{{"a", "x"}, true}}),
              "<g id='a' class=' x '/>");
}

TEST(HudText, UnitsFollowTheReferenceHeightOrTheScale) {
    const auto sized = [](const std::string& document, double scale) {
        SvgFacts facts;
        EXPECT_TRUE(check_svg(document, plenty, &facts)) << document;
        return at_size(document, facts, 1920, 1080, scale);
    };
    EXPECT_EQ(sized("<svg data-reference-height='540'/>", 3),
              "<svg viewBox=\"0 0 960 540\" data-reference-height='540'/>");
    EXPECT_EQ(sized("<svg/>", 1), "<svg/>");
    EXPECT_EQ(sized("<svg/>", 2), "<svg viewBox=\"0 0 960 540\"/>");
    EXPECT_EQ(sized("<svg viewBox='0 0 4 3'/>", 2), "<svg viewBox='0 0 4 3'/>");
    EXPECT_EQ(sized("<svg><g data-reference-height='540'/></svg>", 1), "<svg><g data-reference-height='540'/></svg>");
    for (const std::string height : {"0", "-1", "nan", "inf", "1e9", "", "540px"})
        EXPECT_EQ(checked("<svg data-reference-height='" + height + "'/>"),
                  "1: data-reference-height=\"" + height + "\": allowed is a number in [1, 65536]");
    EXPECT_EQ(checked("<svg data-reference-height='9' viewBox='0 0 1 1'/>"),
              "1: data-reference-height beside viewBox: one of them says how large a unit is");
}

}  // namespace
}  // namespace darkroom
