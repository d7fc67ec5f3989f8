// SPDX-License-Identifier: MIT
// Runs that begin in the middle: with the pre-roll that the effects state they give the picture of an unbroken run.

#include <bit>
#include <limits>

#include <darkroom/describe.hpp>
#include "compose/test_stacks/host.hpp"
#include "plan/program.hpp"

namespace darkroom {
namespace {

using test::Host;
using test::must;

constexpr double half_a_code = 0.5 / 255;

struct Linger {
    float keep = 0.8f;
};
constexpr auto linger_rows = describe(field<&Linger::keep>("Weight of the last frame.", {0, 0.9}));
constexpr EffectFile linger_files[] = {
    {"linger.glsl",
     "vec4 shade(Pixel pixel) {\n"
     "    return mix(load(linger_in, pixel.texel), load(linger_before, pixel.texel), linger_parameters().keep);\n}\n"},
};
/// The frames before weigh keep, keep^2 ... in the picture.
std::uint32_t linger_pre_roll(const void* parameters, double /*delta_time*/ = 0) {
    const double keep = static_cast<double>(static_cast<const Linger*>(parameters)->keep);
    std::uint32_t frames = 0;
    for (double missing = keep; missing > half_a_code; missing *= keep) ++frames;
    return frames;
}
/// An exponential average over the frames.
const EffectInfo& linger() {
    static const EffectInfo info{
        .name = "linger",
        .doc = "Averages frames.",
        .parameters = linger_rows.table(),
        .files = linger_files,
        .touch = Touch::History,
        .build =
            [](PassBuilder& builder) {
                const auto history = builder.history({.name = "kept", .format = VK_FORMAT_R32G32B32A32_SFLOAT});
                builder.result(builder.add({.name = "linger",
                                            .shader = "linger.glsl",
                                            .inputs = {{.name = "linger_in", .image = builder.picture()},
                                                       {.name = "linger_before", .image = history.previous}},
                                            .output = history.current}));
            },
        .is_identity = [](const void* parameters) { return static_cast<const Linger*>(parameters)->keep == 0; },
        .pre_roll = linger_pre_roll};
    return info;
}

class ComposePreRoll : public testing::Test {
  protected:
    ComposePreRoll() : host_(test::random_display(8, 6, 0)) {
        for (std::uint32_t number = 0; number < 7; ++number)
            pictures_.push_back(gpu::test::upload(host_.device.context(),
                                                  test::pixels_of(test::random_display(8, 6, number)),
                                                  VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL));
    }
    /// Frame `last` of a sequence, by a run that begins at frame `first`.
    [[nodiscard]] ReferenceImage run(std::uint32_t entries, std::uint32_t first, std::uint32_t last) const {
        Composer composer(host_.device);
        for (std::uint32_t i = 0; i < entries; ++i) composer.add(linger(), nullptr);
        must(composer.compile(host_.compile_desc()));
        for (std::uint32_t number = first; number <= last; ++number) {
            Frame frame = host_.frame();
            frame.color = test::image_ref(pictures_[number % pictures_.size()]);
            frame.frame_index = number;
            must(host_.record(composer, frame));
        }
        return host_.read_target();
    }

    Host host_;
    std::vector<gpu::test::Picture> pictures_;
};

TEST_F(ComposePreRoll, GivesThePictureOfAnUnbrokenRun) {
    constexpr std::uint32_t last = 150;
    const Linger usual;
    for (const std::uint32_t entries : {1U, 2U}) {
        Composer composer(host_.device);
        for (std::uint32_t i = 0; i < entries; ++i) composer.add(linger(), nullptr);
        const std::uint32_t pre_roll = composer.pre_roll();
        EXPECT_EQ(pre_roll, entries * linger_pre_roll(&usual));
        ASSERT_LT(2 * pre_roll, last);
        const ReferenceImage unbroken = run(entries, 0, last);
        const auto difference = [&](std::uint32_t frames) {
            return test::worst_difference(run(entries, last - frames, last), unbroken);
        };
        EXPECT_LE(difference(pre_roll), half_a_code);
        EXPECT_GT(difference(pre_roll / 2), half_a_code) << "for two entries: the larger one's alone";
        EXPECT_GT(difference(0), 100 * half_a_code);
    }
}

bool has_history(const EffectInfo& info, const std::vector<std::uint32_t>& words) {
    constexpr ImageUse any{VK_FORMAT_R32G32B32A32_SFLOAT};
    const plan::Entry entry{
        .id = 1, .info = &info, .desc = {.second = scene_color, .name = std::string(info.name)}, .base = words};
    const auto program = plan::plan_program(
        {&entry, 1}, {.max_extent = {64, 64}, .depth = any, .normals = any, .velocity = any, .ui = any},
        {.stage_of = [](const gpu::KernelSpec&) -> Result<gpu::Stage> { return gpu::Stage::Raster; }});
    EXPECT_TRUE(program) << info.name << ": " << program.error().text;
    return program && !program->history_entries.empty();
}

// Of all that ship, with every toggle that is read at compile off and on: who keeps something from frame to frame says
// for how long it counts.
TEST(ComposeHistory, WhoeverDeclaresOneStatesItsPreRoll) {
    for (const EffectInfo* const info : all_effects()) {
        std::vector<std::vector<std::uint32_t>> tried{
            {info->parameters.defaults.begin(), info->parameters.defaults.end()}};
        for (const ParamInfo& row : info->parameters.rows)
            if (row.kind == Kind::Toggle && row.is_at_compile) {
                tried.push_back(tried.front());
                tried.back()[row.word] ^= 1;
            }
        bool has_any = false;
        for (const std::vector<std::uint32_t>& words : tried) {
            const bool has_one = has_history(*info, words);
            has_any |= has_one;
            EXPECT_TRUE(has_one || info->touch != Touch::History) << info->name;
            if (info->pre_roll == nullptr) continue;
            const auto frames = [&](double delta_time) { return info->pre_roll(words.data(), delta_time); };
            EXPECT_EQ(frames(1.0 / 60) > 0u, has_one) << info->name;
            EXPECT_GE(frames(1.0 / 144), frames(1.0 / 30)) << info->name;
            EXPECT_LT(frames(1.0 / 144), 10'000u) << info->name;
        }
        EXPECT_EQ(has_any, info->pre_roll != nullptr) << info->name;
    }
}

TEST_F(ComposePreRoll, IsThatOfTheEntriesThatAreOnWithTheirCurrentValues) {
    EffectInfo endless = linger();
    endless.pre_roll = [](const void*, double) { return std::numeric_limits<std::uint32_t>::max(); };
    Composer composer(Device::assumed());
    EXPECT_EQ(composer.pre_roll(), 0u);
    const Linger usual, brief{.keep = 0.5f};
    const Handle first = composer.add(linger(), &usual), second = composer.add(linger(), &brief);
    const std::uint32_t of_usual = linger_pre_roll(&usual), of_brief = linger_pre_roll(&brief);
    EXPECT_GT(of_usual, of_brief);
    EXPECT_EQ(composer.pre_roll(), of_usual + of_brief);
    EXPECT_EQ(composer.pre_roll(1.0 / 60), of_usual + of_brief) << "what 0, left out, means";
    for (const double none : {-1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_EQ(composer.pre_roll(none), 0u) << "every frame begins anew";
    must(composer.set_enabled(first, false));
    EXPECT_EQ(composer.pre_roll(), of_brief);
    must(composer.set_opacity(second, 0));
    EXPECT_EQ(composer.pre_roll(), 0u);
    must(composer.set_opacity(second, 0.5f));
    const auto keep = std::bit_cast<std::uint32_t>(0.8f);
    must(composer.set_override(second, "keep", "a pulse", {&keep, 1}));
    EXPECT_EQ(composer.pre_roll(), of_usual);
    must(composer.set(first, "keep", 0.0));
    must(composer.set_enabled(first, true));
    EXPECT_EQ(composer.pre_roll(), of_usual) << "of what changes nothing there is none";

    composer.add(endless, nullptr);
    EXPECT_EQ(composer.pre_roll(), std::numeric_limits<std::uint32_t>::max());
}

}  // namespace
}  // namespace darkroom
