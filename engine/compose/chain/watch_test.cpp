// SPDX-License-Identifier: MIT
// Looking into plans: what a watch shows is what a shorter stack would have made, and who watches nothing pays nothing.

#include <deque>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;

constexpr VkFormat float_format = VK_FORMAT_R32G32B32A32_SFLOAT;

ReferenceImage watched_picture(std::uint32_t number = 5) {
    return test::round_to_float(test::random_display(38, 27, number));
}

/// A host that watches: its targets are pictures of their own.
class ComposeWatch : public test::StackTest {
  protected:
    struct Target {
        Watched watched;
        gpu::test::Picture picture;
    };

    [[nodiscard]] CompileDesc desc() const {
        CompileDesc out = host.compile_desc();
        out.watches = watches;
        out.fuse = is_fused;
        out.encodes_target = false;
        return out;
    }
    void watch(std::uint32_t id, Handle entry) { watches.push_back({.id = id, .entry = entry, .target = use()}); }
    void watch(std::uint32_t id, const std::string& image, std::uint32_t mip_level = 0) {
        watches.push_back({.id = id, .image = image, .mip_level = mip_level, .target = use()});
    }
    [[nodiscard]] static ImageUse use() {
        return {float_format, gpu::test::all_usage(gpu::test::device().context(), float_format)};
    }
    /// Of every watch of the next frame; the picture is all zeros before.
    Target& want(std::uint32_t id, VkExtent2D extent, VkRect2D region = {}) {
        Target& made =
            targets.emplace_back(Target{.picture = gpu::test::blank(host.device.context(), extent, float_format)});
        made.watched = {.id = id, .region = region, .target = test::image_ref(made.picture)};
        return made;
    }
    [[nodiscard]] Frame frame() {
        wanted.clear();
        for (const Target& target : targets) wanted.push_back(target.watched);
        Frame out = host.frame();
        out.watched = wanted;
        return out;
    }
    void make_target(VkExtent2D extent) { host.target = gpu::test::blank(host.device.context(), extent, float_format); }
    void run() { test::must(host.record(composer, frame())); }
    [[nodiscard]] std::string error() {
        const Result<> recorded = host.record(composer, frame());
        return recorded ? "recorded" : recorded.error().text;
    }
    [[nodiscard]] ReferenceImage seen(const Target& target) const {
        return test::image_of(gpu::test::download(host.device.context(), target.picture));
    }

    Host host{watched_picture()};
    Composer composer{host.device};
    std::vector<Watch> watches;
    bool is_fused = true;
    std::deque<Target> targets;
    std::vector<Watched> wanted;
};

/// A stack of the kinds of entries that there are: fused, with passes, of another size, laid over, encoded.
std::vector<Handle> fill_watched(Composer& composer, std::size_t most = ~std::size_t{0}) {
    const std::vector<std::function<Handle()>> steps{
        [&] {
            return add(composer, "exposure", {{"exposure", 2}});
        },
        [&] {
            return add(composer, "bloom", {{"intensity", 0.5}, {"threshold", 0.25}});
        },
        [&] {
            return add(composer, "gaussian_blur", {{"radius", 3}}, {.opacity = 0.5f});
        },
        [&] {
            return add(composer, "negative", {}, {.scale = {1, 2}});
        },
        [&] { return add(composer, "tonemap"); },
        [&] { return add(composer, "encode"); },
        [&] { return add(composer, "dither"); }};
    std::vector<Handle> out;
    for (std::size_t i = 0; i < std::min(most, steps.size()); ++i) out.push_back(steps[i]());
    return out;
}

constexpr std::uint32_t size_of(std::size_t entry, std::uint32_t size) { return entry < 3 ? size : size / 2; }

TEST_F(ComposeWatch, OutputsAreWhatShorterStacksMake) {
    for (const bool fuses : {false, true}) {
        is_fused = fuses;
        composer.clear();
        watches.clear();
        targets.clear();
        const std::vector<Handle> entries = fill_watched(composer);
        make_target({19, 13});
        watch(100, scene_color);
        for (std::uint32_t i = 0; i < entries.size(); ++i) watch(i, entries[i]);
        test::must(composer.compile(desc()));
        for (std::uint32_t i = 0; i < entries.size(); ++i) want(i, {size_of(i, 38), size_of(i, 27)});
        want(100, {38, 27});
        run();
        EXPECT_EQ(test::worst_difference(seen(targets.back()), watched_picture()), 0);
        for (std::uint32_t i = 0; i < entries.size(); ++i) {
            EXPECT_EQ(composer.watch_state(i), WatchState::Shown) << i;
            const ReferenceImage out = seen(targets[i]);
            Host shorter_host(watched_picture());
            shorter_host.target = gpu::test::blank(host.device.context(), {out.width, out.height}, float_format);
            Composer shorter(host.device);
            fill_watched(shorter, i + 1);
            CompileDesc shorter_desc = shorter_host.compile_desc();
            shorter_desc.max_extent = {38, 27};
            shorter_desc.fuse = fuses;
            shorter_desc.encodes_target = false;
            test::must(shorter.compile(shorter_desc));
            EXPECT_LE(test::worst_difference(out, shorter_host.run(shorter)), 1e-6) << "entry " << i << fuses;
        }
    }
}

TEST_F(ComposeWatch, WhoGivesNoTargetRunsNoPassAndGetsTheSamePicture) {
    if (gpu::test::context().traits.timestamp_valid_bits == 0) GTEST_SKIP() << "this device measures no times";
    composer = Composer(host.device, {.has_timers = true});
    const std::vector<Handle> entries = fill_watched(composer);
    const Plan plain = test::must(composer.compile(desc()));
    make_target({19, 13});
    const ReferenceImage expected = host.run(composer);
    const std::size_t passes = composer.times().passes.size();
    watch(0, "bloom.pyramid");
    const Plan with_image = test::must(composer.compile(desc()));
    EXPECT_EQ(with_image.passes.size(), plain.passes.size());
    EXPECT_EQ(test::worst_difference(host.run(composer), expected), 0);
    EXPECT_EQ(composer.times().passes.size(), passes);
    EXPECT_EQ(composer.watch_state(0), WatchState::NotGiven);
    want(0, {4, 4});
    run();
    EXPECT_EQ(composer.times().passes.size(), passes + 1);
    EXPECT_EQ(composer.watch_state(0), WatchState::Shown);
    // Entries that shared a kernel no longer do.
    watches[0] = {.id = 0, .entry = entries[4]};
    EXPECT_EQ(test::must(composer.plan(desc())).passes.size(), plain.passes.size() + 1);
}

/// In plans for a GPU one compute pass makes several levels.
class ComposeWatchLevels : public ComposeWatch, public ::testing::WithParamInterface<bool> {};

TEST_P(ComposeWatchLevels, EveryLevelOfAnImageIsSeen) {
    const gpu::test::PlannedFor planned(GetParam());
    host.color = gpu::test::upload(host.device.context(), test::pixels_of(test::uniform(240, 150, {2, 3, 4, 1})),
                                   float_format, VK_IMAGE_LAYOUT_GENERAL);
    make_target({240, 150});
    const Handle bloom = add(composer, "bloom", {{"intensity", 0.5}, {"threshold", 0}});
    test::set_word(composer, bloom, "reach", 0);  // pixels: all levels count, however low the picture is
    const Plan plan = test::must(composer.plan(desc()));
    const auto pyramid = std::ranges::find(plan.images, "bloom.pyramid", &PlanImage::name);
    ASSERT_NE(pyramid, plan.images.end());
    ASSERT_GE(pyramid->mip_levels, 2u);
    for (std::uint32_t level = 0; level <= pyramid->mip_levels; ++level) watch(level, "bloom.pyramid", level);
    watch(50, "bloom.nothing");
    const Plan compiled = test::must(composer.compile(desc()));
    EXPECT_EQ(std::ranges::count_if(compiled.remarks, [](const std::string& r) { return r.starts_with("watch "); }), 2);
    for (const Watch& watched : watches) want(watched.id, {5, 4});
    run();
    for (std::uint32_t level = 0; level < pyramid->mip_levels; ++level) {
        EXPECT_EQ(composer.watch_state(level), WatchState::Shown);
        const ReferenceImage out = seen(targets[level]);
        EXPECT_GT(out.at(2, 2).r, 0) << level;
        EXPECT_NEAR(out.at(2, 2).g / out.at(2, 2).r, 1.5, 0.01) << level;
    }
    EXPECT_EQ(composer.watch_state(pyramid->mip_levels), WatchState::NotInPlan);
    EXPECT_EQ(composer.watch_state(50), WatchState::NotInPlan);
    EXPECT_EQ(composer.watch_state(51), WatchState::NotInPlan);

    // Off, nothing makes it: the target keeps what it has.
    const ReferenceImage before = seen(targets[0]);
    test::must(composer.set_enabled(bloom, false));
    test::must(host.record(composer, frame()));
    EXPECT_EQ(composer.watch_state(0), WatchState::NotWritten);
    EXPECT_EQ(test::worst_difference(seen(targets[0]), before), 0);
}
INSTANTIATE_TEST_SUITE_P(Planned, ComposeWatchLevels, ::testing::Bool());

TEST_F(ComposeWatch, AnEntryThatIsOffShowsItsInput) {
    for (const bool fuses : {false, true}) {
        is_fused = fuses;
        composer.clear();
        watches.clear();
        targets.clear();
        const Handle exposure = add(composer, "exposure", {{"exposure", 2}});
        const Handle blur = add(composer, "gaussian_blur", {{"radius", 3}}, {.enabled = false});
        if (find_effect("ssao") == nullptr) GTEST_SKIP() << "this build has no effect ssao";
        const Handle left_out = add(composer, "ssao");
        for (const auto& [id, entry] : {std::pair{1u, exposure}, {2u, blur}, {3u, left_out}}) watch(id, entry);
        test::must(composer.compile(desc()));
        for (const std::uint32_t id : {1u, 2u, 3u}) want(id, {38, 27});
        run();
        EXPECT_EQ(composer.watch_state(1), WatchState::Shown);
        EXPECT_EQ(composer.watch_state(2), WatchState::InputShown);
        EXPECT_EQ(composer.watch_state(3), WatchState::InputShown);
        EXPECT_NE(test::worst_difference(seen(targets[0]), watched_picture()), 0);
        EXPECT_EQ(test::worst_difference(seen(targets[0]), seen(targets[1])), 0);
        EXPECT_EQ(test::worst_difference(seen(targets[0]), seen(targets[2])), 0);
        test::must(composer.set_enabled(blur, true));
        run();
        EXPECT_EQ(composer.watch_state(2), WatchState::Shown);
        EXPECT_NE(test::worst_difference(seen(targets[0]), seen(targets[1])), 0);
    }
}

TEST_F(ComposeWatch, ARegionIsWhereThePictureIs) {
    const std::vector<Handle> entries = fill_watched(composer, 4);
    watch(0, entries[0]);
    watch(1, entries[3]);
    test::must(composer.compile(desc()));
    make_target({19, 13});
    want(0, {38, 27});
    want(1, {19, 13});
    run();
    const ReferenceImage full = seen(targets[0]), half = seen(targets[1]);
    const auto same = [](const Rgba& a, const Rgba& b) { return a.r == b.r && a.g == b.g && a.b == b.b && a.a == b.a; };
    for (const auto& [x, y] : {std::pair{0, 0}, {37, 26}, {20, 13}, {1, 25}}) {
        targets.clear();
        want(0, {1, 1}, {{x, y}, {1, 1}});
        want(1, {1, 1}, {{x, y}, {1, 1}});
        run();
        const auto at = [](const ReferenceImage& image, int px, int py) {
            return image.at(static_cast<std::uint32_t>(px), static_cast<std::uint32_t>(py));
        };
        EXPECT_TRUE(same(seen(targets[0]).at(0, 0), at(full, x, y))) << x << "," << y;
        EXPECT_TRUE(same(seen(targets[1]).at(0, 0), at(half, (2 * x + 1) * 19 / 76, (2 * y + 1) * 13 / 54)));
    }
    // A part of the target, twice as large as the part of the picture.
    targets.clear();
    want(0, {20, 20}, {{10, 5}, {4, 3}}).watched.target.region = {{2, 3}, {8, 6}};
    run();
    const ReferenceImage part = seen(targets[0]);
    for (std::uint32_t y = 0; y < 20; ++y)
        for (std::uint32_t x = 0; x < 20; ++x) {
            const bool is_inside = x >= 2 && x < 10 && y >= 3 && y < 9;
            const Rgba wanted_texel = is_inside ? full.at(10 + (x - 2) / 2, 5 + (y - 3) / 2) : Rgba{0, 0, 0, 0};
            EXPECT_TRUE(same(part.at(x, y), wanted_texel)) << x << "," << y;
        }
}

TEST_F(ComposeWatch, WrongOnesAreRefusedByName) {
    const Handle entry = add(composer, "exposure", {{"exposure", 2}});
    watch(7, entry);
    watch(7, entry);
    const auto compile_error = [&] {
        const auto made = composer.compile(desc());
        return made ? "compiled" : made.error().text;
    };
    EXPECT_EQ(compile_error(), "compile: watches[1].id = 7: watches[0] has it, too; allowed is an id of its own");
    watches[1].id = 8;
    watches[1].target.format = VK_FORMAT_D32_SFLOAT;
    EXPECT_TRUE(compile_error().starts_with("compile: watches[1].target.format = D32_SFLOAT")) << compile_error();
    watches.pop_back();
    test::must(composer.compile(desc()));
    want(7, {4, 4});
    run();
    const Watched good = targets[0].watched;
    Watched& watched = targets[0].watched;
    const auto refused = [&](const std::string& start) {
        const std::string text = error();
        EXPECT_TRUE(text.starts_with("record: frame.watched[0]" + start)) << text;
        watched = good;
    };
    watched.target.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    refused(".target.format is");
    watched.target.image = host.color.image.handle;
    refused(".target.image is that of frame.color");
    watched.region = {{37, 0}, {2, 1}};
    refused(".region, 2x1 from (37, 0)");
    watched.target.region = {{3, 0}, {2, 1}};
    refused(".target.region");
    want(7, {4, 4});
    EXPECT_TRUE(error().starts_with("record: frame.watched[1].target has the id")) << error();
    targets.pop_back();
    watched.id = 70;
    run();
    EXPECT_EQ(composer.watch_state(7), WatchState::NotGiven);
}

}  // namespace
}  // namespace darkroom
