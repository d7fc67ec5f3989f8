// SPDX-License-Identifier: MIT
// Another device for a Composer that goes on: all that the host gave it is there, and a rebind that failed changed
// nothing.

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;

class ComposeRebind : public test::StackTest {
  protected:
    void SetUp() override {
        StackTest::SetUp();
        if (find_effect("lut") == nullptr) GTEST_SKIP() << "this build has no effect lut";
    }
};

Device another_device() {
    return test::must(Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"}));
}
ReferenceImage graded_picture() { return test::round_to_float(test::random_display(24, 17, 5)); }

/// Blends in a picture, then looks colours up in a table: both are the host's.
void fill_graded(Composer& composer) {
    ResourceImage image{.width = 24, .height = 17, .rgba = std::vector<float>(std::size_t{4} * 24 * 17, 0.25f)};
    const Resource picture = test::must(composer.define(std::move(image)));
    add(composer, "blend", {}, {.second = Composer::picture_of(picture), .opacity = 0.5f});
    ColorTable table{.size = 2, .cube = {}};
    for (int i = 0; i < 8; ++i)
        for (int channel = 0; channel < 3; ++channel) table.cube.push_back((i >> channel & 1) != 0 ? 0.125f : 0.75f);
    const Resource colors = test::must(composer.define(std::move(table)));
    test::set_word(composer, add(composer, "lut"), "lut", colors.id);
}

TEST_F(ComposeRebind, KeepsTablesAndPictures) {
    Device other = another_device();
    const Host host(graded_picture());
    const Host there(graded_picture(), VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, other);
    Composer composer(host.device);
    fill_graded(composer);
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage expected = host.run(composer);
    EXPECT_GT(test::worst_difference(expected, graded_picture()), 0.1);
    const auto plan = composer.rebind(other);
    ASSERT_TRUE(plan) << plan.error().text;
    EXPECT_EQ(composer.resources().size(), 2U);
    EXPECT_EQ(test::worst_difference(there.run(composer), expected), 0);
    test::must(composer.rebind(host.device));
    EXPECT_EQ(test::worst_difference(host.run(composer), expected), 0);
}

TEST_F(ComposeRebind, OneThatFailedCanBeTriedAgainAndChangedNothing) {
    Device other = another_device();
    const Host host(graded_picture());
    const Host there(graded_picture(), VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, other);
    Composer composer(host.device);
    fill_graded(composer);
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage expected = host.run(composer);
    const std::size_t entries = composer.size();
    for (int i = 0; i < 2; ++i) {
        const auto refused = composer.rebind(Device::assumed());
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.error().text.find("assumed device"), std::string::npos) << refused.error().text;
    }
    EXPECT_EQ(composer.size(), entries);
    EXPECT_EQ(test::worst_difference(host.run(composer), expected), 0) << "the plan there was is gone";
    test::must(composer.rebind(other));
    EXPECT_EQ(test::worst_difference(there.run(composer), expected), 0);
}

TEST_F(ComposeRebind, TakesTheLastDescriptionThoughNoRecordHasTakenItsPlan) {
    Device other = another_device();
    const Host host(graded_picture());
    // Without a thread the plan is ready when compile_later() returns, and waits for a record.
    for (const std::uint32_t threads : {0U, 1U}) {
        Composer composer(host.device, {.max_threads = threads});
        fill_graded(composer);
        CompileDesc desc = host.compile_desc();
        test::must(composer.compile(desc));
        desc.max_extent = {128, 96};
        test::must(composer.compile_later(desc));
        const auto plan = composer.rebind(other);
        ASSERT_TRUE(plan) << plan.error().text;
        EXPECT_EQ(plan->extent.width, 128U) << threads << " threads";
        EXPECT_FALSE(composer.pending().is_pending);
    }
    // A description alone will do.
    Composer never_recorded(host.device, {.max_threads = 0});
    fill_graded(never_recorded);
    test::must(never_recorded.compile_later(host.compile_desc()));
    EXPECT_TRUE(never_recorded.rebind(other));
}

}  // namespace
}  // namespace darkroom
