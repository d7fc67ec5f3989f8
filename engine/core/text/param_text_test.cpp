// SPDX-License-Identifier: MIT
#include "core/text/param_text.hpp"
#include <fmt/format.h>
#include <darkroom/describe.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace darkroom {
namespace {

enum class Curvy : std::uint32_t { AcesNarkowicz, Hable };
struct Sample {
    float amount = 0.5f;
    std::int32_t taps = 4;
    Toggle is_sharp = false;
    Curvy curve = Curvy::Hable;
    Rgb tint{1, 1, 1};
    Vec2 offset{};
    Curve response{};
};
constexpr auto sample_rows = describe(
    field<&Sample::amount>("Amount.", {0, 16}, unit::pixels).formerly("strength"),
    field<&Sample::taps>("Taps.", {1, 64}).at_compile().also_named("r_taps"), field<&Sample::is_sharp>("Sharp."),
    field<&Sample::curve>("Curve."), field<&Sample::tint>("Tint.", {0, 10}),
    field<&Sample::offset>("Offset.", {-1, 0.1}), field<&Sample::response>("Response.", {0, 2}));
const ParamTable table = sample_rows.table();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string error_of(std::string_view name, const ParamValue& value, ParamProblem::Why why) {
    std::vector<std::uint32_t> words(table.defaults.begin(), table.defaults.end());
    const auto problem = try_assign(*table.find(name), words, value, name);
    if (!problem) return "accepted";
    EXPECT_TRUE(problem->why == why) << problem->text;
    EXPECT_TRUE(std::equal(words.begin(), words.end(), table.defaults.begin())) << "changed by a refused value";
    return problem->text;
}
std::string after(std::string_view name, const ParamValue& value) {
    std::vector<std::uint32_t> words(table.defaults.begin(), table.defaults.end());
    const Result<> done = assign(*table.find(name), words, value);
    return done ? format(*table.find(name), words) : done.error().text;
}
std::string from_text(std::string_view name, std::string_view text) {
    const Result<ParamValue> value = parse_text(*table.find(name), text);
    return value ? after(name, *value) : value.error().text;
}

struct Sized {
    float wide = 1;
    std::int32_t radius = 4;
    Vec2 amplitude{};
    Reach reach = Reach::Pixels;
};
constexpr auto sized_rows = describe(
    field<&Sized::wide>("Wide.", {0, 200}, unit::pixels).as_size_of<&Sized::reach>(),
    field<&Sized::radius>("Radius.", {0, 64}, unit::pixels).as_size_of<&Sized::reach>(),
    field<&Sized::amplitude>("Amplitude.", {-256, 256}).as_size_of<&Sized::reach>(), field<&Sized::reach>("Reach."));

// A hundredth of the height is 10.8 pixels of a picture of 1080 lines; whole numbers take the nearest.
TEST(ParamText, SizesArePixelsOrPercent) {
    const ParamTable sized = sized_rows.table();
    const auto set = [&](std::string_view name, std::string_view text) {
        std::vector<std::uint32_t> words(sized.defaults.begin(), sized.defaults.end());
        const ParamInfo& row = *sized.find(name);
        const Result<ParamValue> value = parse_text(row, text);
        if (!value) return value.error().text;
        if (const Result<> done = assign(row, words, *value); !done) return done.error().text;
        return format(row, words) + " " + format(*sized.find("reach"), words);
    };
    EXPECT_EQ(set("wide", "2.5%"), "27.0 \"height\"");
    EXPECT_EQ(set("wide", "2.5 %"), "27.0 \"height\"");
    EXPECT_EQ(set("wide", "24"), "24.0 \"pixels\"");
    EXPECT_EQ(set("wide", "24px"), "24.0 \"pixels\"");
    EXPECT_EQ(set("radius", "2%"), "22 \"height\"");
    EXPECT_EQ(set("radius", "9%"), "radius = 97: allowed is [0, 64] px");
    EXPECT_EQ(set("amplitude", "1%, -2%"), "[10.8, -21.6] \"height\"");
    for (const char* const wrong : {"%", "x%", "1%%", "1%,2%"})
        EXPECT_EQ(set("wide", wrong),
                  fmt::format("'{}' is not a number, allowed is [0, 200] px, also in % of the height", wrong));
    EXPECT_EQ(full_doc(*sized.find("radius")), "Radius. Also in % of the picture's height.");
}

TEST(ParamText, TakesValuesOfEveryKind) {
    EXPECT_EQ(after("amount", 0.04), "0.04");
    EXPECT_EQ(after("amount", std::int64_t{3}), "3.0");
    EXPECT_EQ(after("strength", 1.5), "1.5");
    EXPECT_EQ(after("taps", 8.0), "8");
    EXPECT_EQ(after("is_sharp", true), "true");
    EXPECT_EQ(after("curve", "aces_narkowicz"), "\"aces_narkowicz\"");
    EXPECT_EQ(after("tint", std::vector<double>{1, 0.5, 0.2}), "[1.0, 0.5, 0.2]");
    EXPECT_EQ(after("response", CurvePoints{{0, 0}, {1, 2}}), "[[0.0, 0.0], [1.0, 2.0]]");
    EXPECT_EQ(after("response", std::vector<double>{}), "[]");
}

TEST(ParamText, RefusesWhatIsOutOfRange) {
    using enum ParamProblem::Why;
    EXPECT_EQ(error_of("amount", std::int64_t{-1}, OutOfRange), "amount = -1: allowed is [0, 16] px");
    EXPECT_EQ(error_of("amount", 1e300, OutOfRange), "amount = 1e+300: allowed is [0, 16] px");
    EXPECT_EQ(error_of("amount", nan, OutOfRange), "amount = nan: allowed is [0, 16] px");
    EXPECT_EQ(error_of("taps", infinity, OutOfRange), "taps = inf: allowed is [1, 64]");
    EXPECT_EQ(error_of("taps", std::int64_t{65}, OutOfRange), "taps = 65: allowed is [1, 64]");
    EXPECT_EQ(error_of("curve", "habble", OutOfRange),
              "curve = \"habble\", did you mean 'hable'? allowed is aces_narkowicz or hable");
    EXPECT_EQ(error_of("tint", std::vector<double>{1, 0, nan}, OutOfRange), "tint = [1, 0, nan]: allowed is [0, 10]");
    EXPECT_NE(error_of("response", CurvePoints{{1, 0}, {1, 1}}, OutOfRange), "accepted");
    EXPECT_NE(error_of("response", CurvePoints(17), OutOfRange), "accepted");
}

TEST(ParamText, RefusesWrongKinds) {
    using enum ParamProblem::Why;
    EXPECT_EQ(error_of("amount", "1.0", WrongKind), "amount = \"1.0\": expected a number, allowed is [0, 16] px");
    EXPECT_EQ(error_of("amount", true, WrongKind), "amount = true: expected a number, allowed is [0, 16] px");
    EXPECT_EQ(error_of("taps", 2.5, WrongKind), "taps = 2.5: expected a whole number, allowed is [1, 64]");
    EXPECT_NE(error_of("is_sharp", "yes", WrongKind), "accepted");
    EXPECT_NE(error_of("is_sharp", std::int64_t{1}, WrongKind), "accepted");
    EXPECT_NE(error_of("curve", 1.0, WrongKind), "accepted");
    EXPECT_NE(error_of("tint", std::vector<double>{1, 1}, WrongKind), "accepted");
    EXPECT_NE(error_of("response", std::vector<double>{1, 1}, WrongKind), "accepted");
}

TEST(ParamText, BoundsThatNoFloatEqualsAreInside) {
    EXPECT_EQ(after("offset", std::vector<double>{-1, 0.1}), "[-1.0, 0.1]");
    const double past = std::nextafter(0.1f, 1.0f);
    EXPECT_NE(error_of("offset", std::vector<double>{0, past}, ParamProblem::Why::OutOfRange), "accepted");
}

TEST(ParamText, ChecksWords) {
    EXPECT_TRUE(check_words(*table.find("amount"), std::array{std::bit_cast<std::uint32_t>(16.0f)}));
    EXPECT_FALSE(check_words(*table.find("amount"), std::array{std::bit_cast<std::uint32_t>(16.1f)}));
    EXPECT_FALSE(check_words(*table.find("amount"), std::array{1u, 2u}));
    EXPECT_FALSE(check_words(*table.find("curve"), std::array{2u}));
    EXPECT_TRUE(check_words(*table.find("curve"), std::array{1u}));
}

TEST(ParamText, ReadsTextOfFlags) {
    EXPECT_EQ(from_text("amount", "1.25"), "1.25");
    EXPECT_EQ(from_text("amount", "+2"), "2.0");
    EXPECT_EQ(from_text("amount", "two"), "'two' is not a number, allowed is [0, 16] px");
    EXPECT_EQ(from_text("amount", "1.5x"), "'1.5x' is not a number, allowed is [0, 16] px");
    EXPECT_EQ(from_text("amount", ""), "'' is not a number, allowed is [0, 16] px");
    EXPECT_EQ(from_text("amount", "nan"), "'nan' is not a number, allowed is [0, 16] px");
    EXPECT_EQ(from_text("taps", "3"), "3");
    for (const char* const on : {"on", "true", "yes", "1"}) EXPECT_EQ(from_text("is_sharp", on), "true");
    for (const char* const off : {"off", "false", "no", "0"}) EXPECT_EQ(from_text("is_sharp", off), "false");
    EXPECT_EQ(from_text("tint", "1, 0.5,0.2"), "[1.0, 0.5, 0.2]");
    EXPECT_EQ(from_text("tint", "1,2"), "'1,2' is not 3 numbers (red, green, blue), allowed is [0, 10]");
    EXPECT_EQ(from_text("response", "0:0,1:2"), "[[0.0, 0.0], [1.0, 2.0]]");
}

struct Light {
    float gain = 1;
};
constexpr auto light_rows = describe(field<&Light::gain>("Gain.", {0, 1024}, unit::multiplier));

TEST(ParamText, MultipliersAreReadInStops) {
    const ParamInfo& gain = light_rows.rows[0];
    const auto read = [&](std::string_view text) {
        const Result<ParamValue> value = parse_text(gain, text);
        return value ? std::get<double>(*value) : std::numeric_limits<double>::quiet_NaN();
    };
    EXPECT_EQ(read("2.5"), 2.5);
    EXPECT_EQ(read("1ev"), 2);
    EXPECT_EQ(read("-2EV"), 0.25);
    EXPECT_EQ(read("+0.5ev"), std::exp2(0.5));
    EXPECT_EQ(read("0ev"), 1);
    EXPECT_EQ(read("2stops"), 4);
    EXPECT_EQ(read("1 stop"), 2);
    EXPECT_EQ(read("2x"), 2);
    const Result<ParamValue> wrong = parse_text(gain, "2evs");
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().text, "'2evs' is not a number, allowed is [0, 1024] x, also in ev, stop or stops");
    for (const char* const text : {"ev", "1evev", "nanev", "1K", "1 s", ""})
        EXPECT_TRUE(std::isnan(read(text))) << text;
    EXPECT_EQ(from_text("amount", "1ev"), "'1ev' is not a number, allowed is [0, 16] px") << "it is no multiplier";
    EXPECT_EQ(interval(gain), "[0, 1024] x");
}

TEST(ParamText, FloatsReadBackWithTheSameBits) {
    std::uint32_t state = 1;
    std::vector<std::uint32_t> words(table.defaults.begin(), table.defaults.end());
    const ParamInfo& row = *table.find("amount");
    for (int i = 0; i < 20000; ++i) {
        state = state * 1664525u + 1013904223u;
        words[row.word] = state >> 1;
        const auto value = std::bit_cast<float>(words[row.word]);
        if (!std::isfinite(value)) continue;
        const std::optional<double> read = parse_number(format(row, words));
        ASSERT_TRUE(read) << format(row, words);
        ASSERT_EQ(std::bit_cast<std::uint32_t>(static_cast<float>(*read)), words[row.word]) << format(row, words);
    }
    words[row.word] = std::bit_cast<std::uint32_t>(-0.0f);
    EXPECT_EQ(format(row, words), "-0.0");
}

TEST(ParamText, NamesAndSuggestions) {
    EXPECT_EQ(flat_key("bloom", "intensity"), "bloom_intensity");
    EXPECT_EQ(flat_key("exposure", "exposure"), "exposure");
    EXPECT_EQ(flag_name("bloom_soft_threshold"), "--bloom-soft-threshold");
    const std::vector<std::string> names{"bloom_threshold", "bloom_intensity", "exposure"};
    EXPECT_EQ(nearest("bloom_treshold", names), "bloom_threshold");
    EXPECT_EQ(nearest("exposuer", names), "exposure");
    EXPECT_EQ(nearest("bloom", names), "bloom_threshold") << "what goes on behind it";
    EXPECT_EQ(nearest("blo", names), "");
    EXPECT_EQ(nearest("not_a_section", names), "");
    EXPECT_EQ(nearest(std::string(100000, 'x'), names), "");
}

TEST(ParamText, NothingRawReachesTheTerminal) {
    EXPECT_EQ(printable("a\x1b[31mb\n"), "a\\x1B[31mb\\x0A");
    EXPECT_EQ(printable("caf\xc3\xa9"), "caf\xc3\xa9");
    EXPECT_EQ(printable("\xe9\xff\xfe"), "\\xE9\\xFF\\xFE");
    EXPECT_EQ(printable("\xc2\x9b"), "\\xC2\\x9B");
    EXPECT_LE(printable(std::string(5000, 'x')).size(), 210u);
}

TEST(ParamText, DocumentsEveryRow) {
    const std::string page = documentation(table, "sample");
    EXPECT_NE(page.find("| `sample_amount` | `0.5` | [0, 16] px | Amount. Formerly `sample_strength`. |"),
              std::string::npos)
        << page;
    EXPECT_NE(page.find("| Taps. A change takes full effect with the next compile. In consoles also `r_taps`. |"),
              std::string::npos)
        << page;
    EXPECT_NE(page.find("`sample_curve` | `\"hable\"` | aces_narkowicz or hable"), std::string::npos) << page;
}

}  // namespace
}  // namespace darkroom
