// SPDX-License-Identifier: MIT
// Layers and pulses: what they make of every kind of value, at any frame rate, and that the base stays what it was.

#include <bit>

#include <darkroom/describe.hpp>
#include "compose/test_stacks/host.hpp"
#include "develop/reference_chain.hpp"

namespace darkroom {
namespace {

enum class Tone : std::uint32_t { Cold, Warm };

/// A value of every kind.
struct Kinds {
    float plain = 1;
    float stops = 1;
    std::int32_t count = 2;
    Toggle on = false;
    Tone tone = Tone::Cold;
    Vec2 place;
    Rgb tint{1, 1, 1};
    Curve curve{2, {0, 1}, {0, 1}};
    Resource table;
};
constexpr auto kinds_rows =
    describe(field<&Kinds::plain>("Plain.", {0, 10}), field<&Kinds::stops>("Logarithmic.", {0.01, 100, Scale::Log}),
             field<&Kinds::count>("Whole.", {0, 100}), field<&Kinds::on>("Switch."), field<&Kinds::tone>("Choice."),
             field<&Kinds::place>("Two.", {-1, 1}), field<&Kinds::tint>("Colour.", {0, 4}),
             field<&Kinds::curve>("Curve.", {0, 1}), field<&Kinds::table>("Resource."));
const EffectInfo kinds_effect{.name = "kinds",
                              .doc = "Holds values.",
                              .parameters = kinds_rows.table(),
                              .touch = Touch::Pointwise,
                              .accepts = Domains::all()};

template <class Struct>
std::vector<std::uint32_t> words_of(const Struct& value) {
    const auto words = std::bit_cast<std::array<std::uint32_t, sizeof(Struct) / 4>>(value);
    return {words.begin(), words.end()};
}

class ComposeModulation : public testing::Test {
  protected:
    [[nodiscard]] Kinds at(double time = 0, const Camera& camera = {}) const {
        const std::vector<std::uint32_t> words = composer.values_at(entry, time, camera).words;
        std::array<std::uint32_t, sizeof(Kinds) / 4> copy{};
        std::ranges::copy(words, copy.begin());
        return std::bit_cast<Kinds>(copy);
    }
    Result<> add_pulse(std::string_view parameter, float amount, Envelope shape = Envelope::Linear,
                       double duration = 0.5) {
        return composer.add_pulse({.event = "hit",
                                   .entry = entry,
                                   .parameter = std::string(parameter),
                                   .amount = {amount, amount, amount, amount},
                                   .envelope = shape,
                                   .duration = duration});
    }
    Result<> add_layer(std::string name, std::string parameter, std::vector<std::uint32_t> words,
                       std::optional<LayerDistance> distance = std::nullopt) {
        return composer.add_layer({.name = std::move(name),
                                   .distance = distance,
                                   .values = {{entry, std::move(parameter), std::move(words)}}});
    }
    Composer composer{Device::assumed()};
    Handle entry = composer.add(kinds_effect, nullptr);
};

TEST(Modulation, EnvelopesBeginEndAndPassWhereTheyShould) {
    for (const Envelope shape : {Envelope::Linear, Envelope::Exponential, Envelope::Spring}) {
        const auto value = [&](double age) { return envelope(shape, age, 0.4); };
        EXPECT_EQ(value(-1e-9), 0);
        EXPECT_EQ(value(0.4), 0);
        EXPECT_NEAR(value(0.4 - 1e-9), 0, 1e-6) << "it ends without a step";
        EXPECT_EQ(value(0), shape == Envelope::Spring ? 0 : 1);
    }
    EXPECT_NEAR(envelope(Envelope::Linear, 0.1, 0.4), 0.75, 1e-15);
    EXPECT_NEAR(envelope(Envelope::Exponential, 0.2, 0.4), (std::exp(-2.5) - std::exp(-5.0)) / (1 - std::exp(-5.0)),
                1e-15);
    EXPECT_NEAR(envelope(Envelope::Spring, 0.04, 0.4), 1 - std::exp(-9.0), 1e-15) << "its peak";
    EXPECT_LT(envelope(Envelope::Spring, 0.035, 0.4), envelope(Envelope::Spring, 0.04, 0.4));
    EXPECT_GT(envelope(Envelope::Spring, 0.04, 0.4), envelope(Envelope::Spring, 0.045, 0.4));
}

TEST_F(ComposeModulation, PulsesAddToTheBaseAndLeaveIt) {
    test::must(add_pulse("plain", 4));
    EXPECT_EQ(at(1).plain, 1) << "nothing has fired it";
    EXPECT_EQ(composer.fire("miss", 1.0), 0u);
    EXPECT_EQ(composer.fire("hit", 1.0), 1u);
    EXPECT_EQ(at(0.99).plain, 1) << "before";
    EXPECT_FLOAT_EQ(at(1).plain, 5);
    EXPECT_FLOAT_EQ(at(1.25).plain, 3);
    EXPECT_EQ(at(1.5).plain, 1);
    EXPECT_EQ(composer.words(entry)[0], std::bit_cast<std::uint32_t>(1.0f)) << "the base is untouched";
    // A second event starts it anew; the base may move under it.
    composer.fire("hit", 1.25);
    EXPECT_FLOAT_EQ(at(1.25).plain, 5);
    test::must(composer.set(entry, "plain", 2.0));
    EXPECT_FLOAT_EQ(at(1.5).plain, 4);
    // Another one adds to it, and the sum ends at the row's range.
    test::must(add_pulse("plain", 7));
    composer.fire("hit", 2.0);
    EXPECT_EQ(at(2).plain, 10);
    EXPECT_FLOAT_EQ(at(2.4).plain, 2 + 0.2f * 11);
    composer.remove_pulses();
    EXPECT_EQ(at(2).plain, 2);
}

TEST_F(ComposeModulation, PulsesStayWithAnEntryThatIsReplacedByItsOwnEffect) {
    test::must(add_pulse("plain", 4));
    composer.fire("hit", 1.0);
    const Kinds other{.plain = 2};
    test::must(composer.replace(entry, kinds_effect, &other));
    EXPECT_FLOAT_EQ(at(1.25).plain, 4) << "it goes on";
    EXPECT_EQ(composer.fire("hit", 3.0), 1U);
    EXPECT_FLOAT_EQ(at(3).plain, 6);
    const EffectInfo alike = kinds_effect;
    test::must(composer.replace(entry, alike, &other));
    EXPECT_EQ(composer.fire("hit", 4.0), 0U) << "another effect has rows of its own";
    EXPECT_EQ(at(4).plain, 2);
    test::must(composer.replace(entry, kinds_effect, nullptr));
}

TEST_F(ComposeModulation, PulsesAreOfEveryKindOfNumbers) {
    for (const char* const parameter : {"count", "place", "tint", "stops"}) test::must(add_pulse(parameter, -0.5f));
    test::must(add_pulse("count", 7.6f));
    composer.fire("hit", 0.0);
    const Kinds kinds = at(0.25);
    EXPECT_EQ(kinds.count, 6) << "2 + (7.6 - 0.5) / 2 is 5.55";
    EXPECT_FLOAT_EQ(kinds.place.y, -0.25f);
    EXPECT_FLOAT_EQ(kinds.tint.b, 0.75f);
    EXPECT_FLOAT_EQ(kinds.stops, 0.75f);
    EXPECT_EQ(at(0).count, 9);
}

TEST_F(ComposeModulation, LayersBlendEveryKindByItsNature) {
    const std::vector<std::pair<std::string, std::vector<std::uint32_t>>> values{
        {"plain", words_of(3.0f)},
        {"stops", words_of(100.0f)},
        {"count", {9}},
        {"on", {1}},
        {"tone", {1}},
        {"place", words_of(Vec2{0.5f, -1})},
        {"tint", words_of(Rgb{0, 1, 3})},
        {"curve", words_of(Curve{2, {0.5f, 1}, {1, 0}})},
        {"table", {4}},
        {"enabled", {0}},
        {"opacity", words_of(0.5f)}};
    LayerDesc desc{.name = "cave"};
    for (const auto& [parameter, words] : values) desc.values.push_back({entry, parameter, words});
    test::must(composer.add_layer(desc));
    EXPECT_EQ(at().plain, 1) << "a weight of 0";
    test::must(composer.set_layer_weight("cave", 0.25f));
    Kinds kinds = at();
    EXPECT_FLOAT_EQ(kinds.plain, 1.5f);
    EXPECT_NEAR(kinds.stops, std::pow(100, 0.25), 1e-5) << "in its logarithm";
    EXPECT_EQ(kinds.count, 4) << "3.75";
    EXPECT_FLOAT_EQ(kinds.place.y, -0.25f);
    EXPECT_FLOAT_EQ(kinds.tint.r, 0.75f);
    EXPECT_FLOAT_EQ(kinds.tint.b, 1.5f);
    EXPECT_FLOAT_EQ(kinds.curve.x[0], 0.125f);
    EXPECT_FLOAT_EQ(kinds.curve.y[1], 0.75f);
    EXPECT_FALSE(kinds.on);
    EXPECT_EQ(kinds.tone, Tone::Cold);
    EXPECT_TRUE(composer.values_at(entry, 0, {}).is_enabled);
    EXPECT_FLOAT_EQ(composer.values_at(entry, 0, {}).opacity, 0.875f);
    test::must(composer.set_layer_weight("cave", 0.5f));
    EXPECT_TRUE(at().on);
    EXPECT_EQ(at().tone, Tone::Warm);
    EXPECT_FALSE(composer.values_at(entry, 0, {}).is_enabled);
    test::must(composer.set_layer_weight("cave", 1));
    kinds = at();
    EXPECT_EQ(kinds.plain, 3);
    EXPECT_EQ(kinds.stops, 100);
    EXPECT_EQ(kinds.count, 9);
    EXPECT_EQ(kinds.tint.b, 3);
    EXPECT_EQ(kinds.table.id, 0u) << "a plan has the tables of the base";
    composer.remove_layer("cave");
    EXPECT_EQ(at().plain, 1);
}

TEST_F(ComposeModulation, CurvesOfOtherPointsSwitchAtTheHalf) {
    test::must(add_layer("bent", "curve", words_of(Curve{3, {0, 0.5f, 1}, {0, 1, 0}})));
    test::must(composer.set_layer_weight("bent", 0.4f));
    EXPECT_EQ(at().curve.count, 2u);
    test::must(composer.set_layer_weight("bent", 0.6f));
    EXPECT_EQ(at().curve.count, 3u);
    EXPECT_EQ(at().curve.y[1], 1);
}

TEST_F(ComposeModulation, BaseLayersPulsesOverrides) {
    test::must(add_layer("first", "plain", words_of(3.0f)));
    test::must(add_layer("second", "plain", words_of(9.0f)));
    test::must(add_pulse("plain", 1));
    test::must(composer.set_layer_weight("first", 0.5f));
    test::must(composer.set_layer_weight("second", 0.5f));
    composer.fire("hit", 0.0);
    EXPECT_FLOAT_EQ(at().plain, 6.5f) << "1 and 3 give 2, with 9 it is 5.5, and 1 comes to it";
    test::must(composer.set_override(entry, "plain", "script", words_of(7.5f)));
    EXPECT_EQ(at().plain, 7.5f);
    composer.drop_overrides("script");
    EXPECT_FLOAT_EQ(at().plain, 6.5f);
}

TEST_F(ComposeModulation, ADistanceIsThatOfTheCamerasEye) {
    test::must(add_layer("cave", "plain", words_of(3.0f), LayerDistance{.near = 2, .far = 6, .point = {1, 2, 3}}));
    test::must(composer.set_layer_weight("cave", 1));
    const auto seen_from = [&](double x) { return at(0, test::look_at({1 + x, 2, 3}, {0, 5, -7}, 1, 1)).plain; };
    EXPECT_FLOAT_EQ(seen_from(1), 3);
    EXPECT_NEAR(seen_from(4), 2, 1e-5);
    EXPECT_NEAR(seen_from(5), 1.5, 1e-5);
    EXPECT_EQ(seen_from(6.001), 1);
    test::must(composer.set_layer_weight("cave", 0.5f));
    EXPECT_NEAR(seen_from(1), 2, 1e-5) << "the weight scales it";
}

TEST_F(ComposeModulation, WhatCannotBeIsRefused) {
    const auto error = [](const Result<>& result) { return result ? std::string("done") : result.error().text; };
    EXPECT_EQ(error(add_pulse("on", 1)),
              "pulse 'hit' of kinds.on: the parameter takes a boolean; allowed is a parameter of numbers");
    EXPECT_EQ(error(add_pulse("plan", 1)), "kinds has no parameter 'plan', did you mean 'plain'?");
    EXPECT_EQ(error(add_pulse("plain", 1, Envelope::Linear, 0)),
              "pulse 'hit' of kinds.plain: duration = 0: allowed is (0, 3600] s");
    EXPECT_NE(error(add_pulse("plain", std::numeric_limits<float>::quiet_NaN())), "done");
    EXPECT_NE(error(add_layer("a", "plain", words_of(11.0f))), "done");
    EXPECT_EQ(error(add_layer("a", "opacity", words_of(2.0f))), "layer 'a': kinds.opacity: allowed is [0, 1]");
    EXPECT_EQ(error(composer.add_layer({.name = "a"})), "layer 'a': it has no values");
    EXPECT_NE(error(add_layer("a", "plain", words_of(1.0f), LayerDistance{.near = 3, .far = 3})), "done");
    EXPECT_TRUE(composer.layer_names().empty()) << "what is refused leaves nothing";
    test::must(add_layer("cave", "plain", words_of(3.0f)));
    EXPECT_EQ(error(add_layer("cave", "plain", words_of(3.0f))), "layer 'cave': there is one of this name");
    EXPECT_EQ(error(composer.set_layer_weight("cav", 1)),
              "layer 'cav': there is no layer of this name, did you mean 'cave'?");
    EXPECT_EQ(error(composer.set_layer_weight("cave", 1.5f)), "layer 'cave': weight = 1.5: allowed is [0, 1]");
    EXPECT_EQ(error(composer.add_pulse({.event = "hit", .entry = {}, .parameter = "plain"})),
              error(composer.check({})));
}

class ComposeModulatedFrames : public test::StackTest {};

/// The brightness of the frame nearest to each of these times, where an event happens at a time of its own.
std::vector<double> fight(double rate, std::span<const double> hits, std::span<const double> looks) {
    const test::Host host(test::uniform(4, 4, {0.125, 0.125, 0.125, 1}));
    Composer composer(host.device);
    const Handle exposure = test::add(composer, "exposure");
    for (const Envelope shape : {Envelope::Linear, Envelope::Exponential, Envelope::Spring})
        test::must(composer.add_pulse({.event = "hit",
                                       .entry = exposure,
                                       .parameter = "exposure",
                                       .amount = {1},
                                       .envelope = shape,
                                       .duration = 0.4}));
    CompileDesc desc = host.compile_desc();
    desc.target_domain = Domain::SceneLinear;
    test::must(composer.compile(desc));
    std::vector<double> seen;
    std::size_t hit = 0;
    for (std::uint32_t i = 0; seen.size() < looks.size(); ++i) {
        Frame frame = host.frame();
        frame.time = i / rate;
        for (; hit < hits.size() && hits[hit] <= frame.time; ++hit) composer.fire("hit", hits[hit]);
        test::must(host.record(composer, frame));
        if (frame.time >= looks[seen.size()] - 1e-9) seen.push_back(host.read_target().at(1, 1).g / 0.125);
    }
    return seen;
}

TEST_F(ComposeModulatedFrames, AFightLooksTheSameAtEveryFrameRate) {
    constexpr std::array hits{0.11, 0.29, 0.73};
    constexpr std::array looks{0.0, 1.0 / 6, 1.0 / 3, 0.5, 5.0 / 6, 1.0};  // frames of all three rates
    std::vector<double> expected;
    for (const double time : looks) {
        double sum = 1, last = -1;
        for (const double hit : hits)
            if (hit <= time) last = hit;
        for (const Envelope shape : {Envelope::Linear, Envelope::Exponential, Envelope::Spring})
            sum += last < 0 ? 0 : envelope(shape, time - last, 0.4);
        expected.push_back(sum);
    }
    for (const double rate : {30.0, 60.0, 144.0}) {
        const std::vector<double> seen = fight(rate, hits, looks);
        for (std::size_t i = 0; i < looks.size(); ++i)
            EXPECT_NEAR(seen[i], expected[i], 1e-5) << rate << " frames a second, " << looks[i] << " s";
    }
}

TEST_F(ComposeModulatedFrames, WhatIsFiredWithoutATimeBeginsWithTheNextRecord) {
    const test::Host host(test::uniform(4, 4, {0.125, 0.125, 0.125, 1}));
    Composer composer(host.device);
    const Handle exposure = test::add(composer, "exposure");
    test::must(composer.add_pulse({.event = "hit", .entry = exposure, .parameter = "exposure", .amount = {1}}));
    CompileDesc desc = host.compile_desc();
    desc.target_domain = Domain::SceneLinear;
    test::must(composer.compile(desc));
    const auto light_at = [&](double time) {
        Frame frame = host.frame();
        frame.time = time;
        test::must(host.record(composer, frame));
        return host.read_target().at(0, 0).r;
    };
    EXPECT_EQ(light_at(5), 0.125);
    composer.fire("hit");
    EXPECT_EQ(light_at(5.05), 0.25);
    EXPECT_NEAR(light_at(5.2), 0.125 * 1.5, 1e-6);
    EXPECT_EQ(light_at(5.4), 0.125);
}

// Until the stack is compiled again nobody lays the entry's result over its input, and the Composer says so.
TEST_F(ComposeModulatedFrames, AnOpacityThatThePlanCannotShowIsToldAsItIs) {
    const test::Host host(test::random_display(16, 16, 3));
    Composer composer(host.device);
    const Handle blur = test::add(composer, "gaussian_blur", {{"radius", 4}});
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage blurred = host.run(composer);
    test::must(composer.add_layer({.name = "fade", .weight = 0.5f, .values = {{blur, "opacity", words_of(0.0f)}}}));
    EXPECT_EQ(test::worst_difference(host.run(composer), blurred), 0);
    EXPECT_EQ(composer.values_at(blur, 0, {}).opacity, 1);
    test::must(composer.compile(host.compile_desc()));
    EXPECT_GT(test::worst_difference(host.run(composer), blurred), 0.01);
    EXPECT_EQ(composer.values_at(blur, 0, {}).opacity, 0.5f);
}

// A layer that changes an entry's opacity and another one's switch, against the references, with kernels of both forms.
TEST_F(ComposeModulatedFrames, LayersMoveOpacityAndSwitchesAsTheReferencesDo) {
    const ReferenceImage picture = test::round_to_float(test::random_display(31, 17, 8));
    const test::Host host(picture);
    Composer composer(host.device);
    const Handle blur = test::add(composer, "gaussian_blur", {{"radius", 3}});
    const Handle negative = test::add(composer, "negative");
    const Handle grayscale = test::add(composer, "grayscale", {{"amount", 0.25}});
    test::must(composer.add_layer(
        {.name = "soft",
         .values = {
             {blur, "opacity", words_of(0.25f)}, {negative, "enabled", {0}}, {grayscale, "amount", words_of(0.75f)}}}));
    const auto plan = composer.compile(host.compile_desc());
    ASSERT_TRUE(plan) << plan.error().text;
    std::vector<ReferenceImage> pictures;
    for (const float weight : {0.0f, 0.4f, 0.8f}) {
        test::must(composer.set_layer_weight("soft", weight));
        const ReferenceImage seen = host.run(composer);
        composer.wait_for_kernels();
        EXPECT_LE(test::worst_difference(host.run(composer), seen), gpu::test::code_between_kernels()) << weight;
        const auto expected = run_reference(composer, {.color = &picture, .encodes_target = false});
        ASSERT_TRUE(expected) << expected.error().text;
        // The blur writes two images in half precision, of values below 1, and filters along one axis for each.
        EXPECT_LE(test::worst_difference(seen, expected->picture), 2 * (0x1p-11 + gpu::test::filter_step())) << weight;
        for (const ReferenceImage& other : pictures) EXPECT_GT(test::worst_difference(other, seen), 0.02) << weight;
        pictures.push_back(seen);
    }
}

}  // namespace
}  // namespace darkroom
