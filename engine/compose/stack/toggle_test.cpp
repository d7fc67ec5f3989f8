// SPDX-License-Identifier: MIT
// Toggles, opacity, parameters and overrides: seen by the next record, and never more than was said.

#include <bit>
#include <utility>

#include "compose/test_stacks/record_in_vain.hpp"

namespace darkroom {
namespace {

using test::add;

class ComposeToggles : public test::StackTest {};
class ComposeValues : public test::StackTest {};

constexpr std::array effects{"bloom", "exposure", "gaussian_blur", "tonemap", "grayscale", "encode", "vignette"};

void fill(Composer& composer, std::size_t without = effects.size()) {
    for (std::size_t i = 0; i < effects.size(); ++i) {
        if (i == without) continue;
        const Handle handle = add(composer, effects[i]);
        if (i == 0) test::must(composer.set(handle, "intensity", 0.5));
        if (i == 1) test::must(composer.set(handle, "exposure", 1.5));
        if (i == 4) test::must(composer.set(handle, "amount", 0.5));
    }
}
ReferenceImage bright_picture() {
    ReferenceImage picture = test::random_display(65, 43, 6);
    for (Rgba& p : picture.pixels) p = {p.r * 3, p.g * 3, p.b * 3, 1};
    return test::round_to_float(picture);
}

TEST_F(ComposeToggles, AnEntryThatIsOffIsAsIfItWereNotThere) {
    const test::Host host(bright_picture());
    Composer composer(host.device);
    fill(composer);
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage all = host.run(composer);
    for (std::size_t i = 0; i < effects.size(); ++i) {
        SCOPED_TRACE(effects[i]);
        Composer shorter(host.device);
        fill(shorter, i);
        test::must(shorter.compile(host.compile_desc()));
        const ReferenceImage expected = host.run(shorter);

        test::must(composer.set_enabled(composer.entry(i), false));
        const ReferenceImage complete = host.run(composer);
        composer.wait_for_kernels();
        const ReferenceImage lean = host.run(composer);
        EXPECT_LE(test::worst_difference(complete, expected), 1e-5);
        EXPECT_EQ(test::worst_difference(lean, complete), 0) << "the lean kernel has other bits";
        EXPECT_GT(test::worst_difference(lean, all), 1e-3) << "the toggle was not seen";
        test::must(composer.set_enabled(composer.entry(i), true));
        EXPECT_EQ(test::worst_difference(host.run(composer), all), 0) << "on again";
    }
}

TEST_F(ComposeToggles, EverythingOffIsThePicture) {
    const ReferenceImage picture = bright_picture();
    const test::Host host(picture);
    for (const bool is_fused : {true, false}) {
        Composer composer(host.device);
        fill(composer);
        CompileDesc desc = host.compile_desc();
        desc.fuse = is_fused;
        test::must(composer.compile(desc));
        for (std::size_t i = 0; i < effects.size(); ++i) test::must(composer.set_enabled(composer.entry(i), false));
        EXPECT_EQ(test::worst_difference(host.run(composer), picture), 0);
        composer.wait_for_kernels();
        EXPECT_EQ(test::worst_difference(host.run(composer), picture), 0);
    }
}

// An amount of 0 and an opacity of 0 are toggles, too: nothing is computed for them, and nothing changes.
TEST_F(ComposeToggles, NothingToDoIsOff) {
    if (gpu::test::context().traits.timestamp_valid_bits == 0) GTEST_SKIP() << "this device measures no times";
    const ReferenceImage picture = bright_picture();
    const test::Host host(picture);
    Composer composer(host.device, {.has_timers = true});
    const Handle bloom = add(composer, "bloom", {{"intensity", 1}});
    const Handle negative = add(composer, "negative");
    test::must(composer.compile(host.compile_desc()));
    (void)host.run(composer);
    EXPECT_GT(composer.times().passes.size(), 1u);
    test::must(composer.set(bloom, "intensity", 0.0));
    test::must(composer.set_opacity(negative, 0));
    EXPECT_EQ(test::worst_difference(host.run(composer), picture), 0);
    EXPECT_EQ(composer.times().passes.size(), 1u) << "the pyramid of a bloom of 0 is computed";
}

// A host's device may lack what resets queries before they are read: then a recording resets them, and it must be known
// that it has finished.
TEST_F(ComposeToggles, TimesComeLaterWhereTheHostCannotResetQueries) {
    gpu::Context& context = gpu::test::context();
    if (context.traits.timestamp_valid_bits == 0) GTEST_SKIP() << "this device measures no times";
    const test::Host host(bright_picture());
    for (const bool can_reset : {true, false}) {
        const bool could = std::exchange(context.traits.has_host_query_reset, can_reset);
        Composer composer(host.device, {.frames_in_flight = 2, .has_timers = true});
        add(composer, "negative");
        test::must(composer.compile(host.compile_desc()));
        context.traits.has_host_query_reset = could;
        EXPECT_EQ(composer.times().passes.size(), 0U);
        for (int recording = 1; recording <= 5; ++recording) {
            static_cast<void>(host.run(composer));
            EXPECT_EQ(composer.times().passes.size(), can_reset || recording > 2 ? 1U : 0U) << can_reset << recording;
        }
    }
}

// What is recorded and not yet run, if ever, has no times: those of the slot's last recording are not its own.
TEST_F(ComposeToggles, TimesAreOfARecordingThatHasRun) {
    gpu::Context& context = gpu::test::context();
    if (context.traits.timestamp_valid_bits == 0) GTEST_SKIP() << "this device measures no times";
    const test::Host host(bright_picture());
    for (const bool can_reset : {true, false}) {
        const bool could = std::exchange(context.traits.has_host_query_reset, can_reset);
        Composer composer(host.device, {.frames_in_flight = 2, .has_timers = true});
        const Handle blur = add(composer, "gaussian_blur");
        test::must(composer.compile(host.compile_desc()));
        context.traits.has_host_query_reset = could;
        Frame frame = host.frame();
        for (frame.frame_index = 1; frame.frame_index <= 5; ++frame.frame_index)
            test::must(host.record(composer, frame));
        const std::size_t passes = composer.times().passes.size();
        test::must(composer.set_enabled(blur, false));
        frame.frame_index = 99;
        test::record_in_vain(composer, host, frame);
        EXPECT_NE(composer.times().frame_index, 99u) << can_reset;
        EXPECT_EQ(composer.times().passes.size(), passes) << can_reset;
        test::must(composer.abandon());
        EXPECT_NE(composer.times().frame_index, 99u) << can_reset;
        for (frame.frame_index = 100; frame.frame_index <= 103; ++frame.frame_index)
            test::must(host.record(composer, frame));
        EXPECT_EQ(composer.times().frame_index, can_reset ? 103u : 101u);
    }
}

TEST_F(ComposeToggles, OpacityMixesInputAndResult) {
    const ReferenceImage picture = bright_picture();
    const test::Host host(picture);
    Composer composer(host.device);
    const Handle negative = add(composer, "negative");
    test::must(composer.compile(host.compile_desc()));
    for (const float opacity : {1.0f, 0.25f, 0.75f}) {
        test::must(composer.set_opacity(negative, opacity));
        for (const bool is_lean : {false, true}) {
            if (is_lean) composer.wait_for_kernels();
            const ReferenceImage out = host.run(composer);
            for (std::size_t i = 0; i < out.pixels.size(); ++i) {
                const double v = picture.pixels[i].r;
                ASSERT_NEAR(out.pixels[i].r, v * (1 - opacity) + (1 - v) * opacity, 1e-5);
            }
        }
    }
}

TEST_F(ComposeToggles, AMaskScalesOpacityPixelByPixel) {
    ReferenceImage picture(32, 8);
    for (std::uint32_t i = 0; i < picture.pixels.size(); ++i) {
        const double v = (i % 32) / 31.0;
        picture.pixels[i] = {v, v, v, 1};
    }
    picture = test::round_to_float(picture);
    const test::Host host(picture);
    for (const bool is_fused : {true, false}) {
        Composer composer(host.device);
        add(composer, "exposure", {{"exposure", 4}}, {.mask = scene_color, .opacity = 0.5f});
        CompileDesc desc = host.compile_desc();
        desc.fuse = is_fused;
        test::must(composer.compile(desc));
        const ReferenceImage out = host.run(composer);
        for (std::size_t i = 0; i < out.pixels.size(); ++i) {
            const double v = picture.pixels[i].g;
            ASSERT_NEAR(out.pixels[i].g, v + (4 * v - v) * 0.5 * v, 1e-5);
        }
    }
}

TEST_F(ComposeToggles, OpacityHasItsRules) {
    const test::Host host(bright_picture());
    Composer composer(host.device);
    const Handle exposure = add(composer, "exposure");
    const Handle plain = add(composer, "gaussian_blur");
    const Handle mixed = add(composer, "gaussian_blur", {}, {.opacity = 0.5f});
    for (const float wrong : {-0.1f, 1.5f, std::nanf("")}) {
        const auto refused = composer.set_opacity(exposure, wrong);
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.error().text.find("exposure: opacity"), std::string::npos);
        EXPECT_NE(refused.error().text.find("[0, 1]"), std::string::npos);
    }
    EXPECT_EQ(composer.desc(exposure)->opacity, 1.0f);
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage before = host.run(composer);
    const auto refused = composer.set_opacity(plain, 0.5f);
    ASSERT_FALSE(refused) << "an entry with passes of its own was planned without a mix";
    EXPECT_NE(refused.error().text.find("gaussian_blur"), std::string::npos);
    EXPECT_EQ(test::worst_difference(host.run(composer), before), 0);
    EXPECT_TRUE(composer.set_opacity(plain, 0));
    EXPECT_TRUE(composer.set_opacity(mixed, 0.25f));
    EXPECT_GT(test::worst_difference(host.run(composer), before), 1e-3);
}

TEST_F(ComposeValues, TheLastOwnerWinsAndDroppingRestores) {
    const ReferenceImage picture = bright_picture();
    const test::Host host(picture);
    Composer composer(host.device);
    const Handle exposure = add(composer, "exposure", {{"exposure", 2}});
    test::must(composer.compile(host.compile_desc()));
    const auto override_with = [&](std::string_view owner, float value) {
        const auto word = std::bit_cast<std::uint32_t>(value);
        return composer.set_override(exposure, "exposure", owner, std::span(&word, 1));
    };
    const auto scale = [&] {
        const float of_values = std::bit_cast<float>(composer.current(exposure)[0]);
        const ReferenceImage out = host.run(composer);
        EXPECT_NEAR(out.pixels[7].r / picture.pixels[7].r, of_values, 1e-5);
        EXPECT_EQ(std::bit_cast<float>(composer.words(exposure)[0]), 2.0f) << "the base was touched";
        return of_values;
    };
    EXPECT_EQ(scale(), 2.0f);
    test::must(override_with("pulse", 3));
    EXPECT_EQ(scale(), 3.0f);
    test::must(override_with("a script that has a long name", 4));
    EXPECT_EQ(scale(), 4.0f);
    test::must(override_with("pulse", 5));
    EXPECT_EQ(scale(), 5.0f) << "set again, so the last";
    composer.drop_overrides("pulse");
    EXPECT_EQ(scale(), 4.0f);
    const auto refused = override_with("pulse", -1);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("[0, 1024]"), std::string::npos) << refused.error().text;
    EXPECT_EQ(scale(), 4.0f);
    composer.drop_overrides("a script that has a long name");
    composer.drop_overrides("nobody");
    EXPECT_EQ(scale(), 2.0f);
}

TEST_F(ComposeValues, OverridesOfOneParameterLeaveTheOthers) {
    Composer composer(gpu::test::device());
    const Handle vignette = add(composer, "vignette", {{"intensity", 0.25}, {"smoothness", 3}});
    const auto word = std::bit_cast<std::uint32_t>(0.75f);
    test::must(composer.set_override(vignette, "intensity", "pulse", std::span(&word, 1)));
    test::must(composer.set(vignette, "smoothness", 4.0));
    EXPECT_EQ(std::bit_cast<float>(composer.current(vignette)[0]), 0.75f);
    EXPECT_EQ(std::bit_cast<float>(composer.current(vignette)[1]), 4.0f);
    test::must(composer.set(vignette, "intensity", 0.5));
    EXPECT_EQ(std::bit_cast<float>(composer.current(vignette)[0]), 0.75f) << "the override lies over a new base";
    composer.drop_overrides("pulse");
    EXPECT_EQ(std::bit_cast<float>(composer.current(vignette)[0]), 0.5f);
}

TEST_F(ComposeValues, WrongValuesAreRefusedWithTheInterval) {
    Composer composer(gpu::test::device());
    const Handle vignette = add(composer, "vignette");
    const Handle blur = add(composer, "gaussian_blur");
    const Handle encode = add(composer, "encode");
    const std::vector<std::uint32_t> before(composer.words(vignette).begin(), composer.words(vignette).end());
    for (const double wrong : {-0.5, 1.5, 1.00001, std::nan(""), HUGE_VAL}) {
        const auto refused = composer.set(vignette, "intensity", wrong);
        ASSERT_FALSE(refused) << wrong;
        EXPECT_NE(refused.error().text.find("vignette.intensity"), std::string::npos) << refused.error().text;
        EXPECT_NE(refused.error().text.find("[0, 1]"), std::string::npos) << refused.error().text;
        const auto word = std::bit_cast<std::uint32_t>(static_cast<float>(wrong));
        EXPECT_FALSE(composer.set(vignette, "intensity", std::span(&word, 1))) << wrong;
    }
    EXPECT_FALSE(composer.set(blur, "radius", 65.0));
    EXPECT_FALSE(composer.set(blur, "radius", 2.5));
    EXPECT_TRUE(composer.set(blur, "radius", 64.0));
    EXPECT_EQ(composer.words(blur)[0], 64u);
    const std::uint32_t none = 99;
    EXPECT_FALSE(composer.set(encode, "transfer", std::span(&none, 1)));
    const std::array<std::uint32_t, 2> two{};
    EXPECT_FALSE(composer.set(vignette, "intensity", two));
    const auto unknown = composer.set(vignette, "intensty", 0.5);
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().text.find("did you mean 'intensity'"), std::string::npos) << unknown.error().text;
    EXPECT_TRUE(std::ranges::equal(composer.words(vignette), before));
}

TEST_F(ComposeValues, NamesTellEntriesApart) {
    const auto error = [](std::string_view first, std::string_view second) {
        Composer composer(gpu::test::device());
        add(composer, "exposure", {}, {.name = std::string(first)});
        add(composer, "negative", {}, {.name = std::string(second)});
        const auto plan = composer.plan({.max_extent = {8, 8}});
        return plan ? std::string() : plan.error().text;
    };
    EXPECT_EQ(error("a \"quoted\" name",
                    "\xc3\xa9"
                    "clat"),
              "");
    EXPECT_EQ(error("gain", "gain"),
              "stack entries 1 and 2: both are named 'gain'; allowed is a name of their own for each");
    const std::string refused = error("gain", "a\nline");
    EXPECT_NE(refused.find("stack entry 2"), std::string::npos) << refused;
    EXPECT_NE(refused.find("0x0a"), std::string::npos) << refused;
    EXPECT_EQ(refused.find('\n'), std::string::npos);
}

TEST_F(ComposeValues, NamesAndHandlesFindEntries) {
    Composer composer(gpu::test::device());
    const Handle first = add(composer, "exposure"), second = add(composer, "exposure"),
                 named = add(composer, "exposure", {}, {.name = "gain"});
    EXPECT_EQ(composer.find("exposure"), first);
    EXPECT_EQ(composer.find("exposure#2"), second);
    EXPECT_EQ(composer.find("gain"), named);
    EXPECT_FALSE(composer.find("exposure#3"));
    EXPECT_EQ(composer.entry(2), named);
    EXPECT_EQ(composer.size(), 3u);
    EXPECT_EQ(composer.info(named)->name, "exposure");
}

}  // namespace
}  // namespace darkroom
