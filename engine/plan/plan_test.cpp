// SPDX-License-Identifier: MIT
// What the planner makes of a stack: kernels in the user's order, a reason for each boundary, and what is left out.

#include <set>
#include <string>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

/// With values that change the picture: what changes nothing is not planned to run.
Handle add(Composer& composer, std::string_view effect, std::initializer_list<test::Value> values = {},
           const EntryDesc& desc = {}) {
    const Handle handle = test::add(composer, effect, values, desc);
    if (effect == "exposure" && values.size() == 0) test::must(composer.set(handle, "exposure", 2.0));
    return handle;
}

CompileDesc hd(VkFormat target = VK_FORMAT_R8G8B8A8_UNORM) {
    return {.max_extent = {1920, 1080}, .target = {target, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}};
}

class ComposePlan : public test::StackTest {
  protected:
    Plan plan(const CompileDesc& desc = hd()) {
        auto made = composer.plan(desc);
        EXPECT_TRUE(made) << made.error().text;
        return made ? std::move(*made) : Plan{};
    }
    std::string error(const CompileDesc& desc = hd()) {
        const auto made = composer.plan(desc);
        return made ? "planned" : made.error().text;
    }
    Composer composer{gpu::test::device()};
};

/// "bloom.prefilter | exposure+tonemap"
std::string passes_of(const Plan& plan) {
    std::string out;
    for (const PlanPass& pass : plan.passes) out += (out.empty() ? "" : " | ") + pass.name;
    return out;
}
std::vector<std::string> entries_of(const Plan& plan) {
    std::vector<std::string> out;
    for (const PlanPass& pass : plan.passes) out.insert(out.end(), pass.entries.begin(), pass.entries.end());
    return out;
}
const PlanPass& pass_with(const Plan& plan, std::string_view entry) {
    for (const PlanPass& pass : plan.passes)
        if (std::ranges::find(pass.entries, entry) != pass.entries.end()) return pass;
    ADD_FAILURE() << "no kernel holds " << entry;
    return plan.passes.front();
}
const PlanImage& image_of(const Plan& plan, std::string_view name) {
    static const PlanImage none;
    const auto found = std::ranges::find(plan.images, name, &PlanImage::name);
    EXPECT_NE(found, plan.images.end()) << name << " is not in " << plan.text();
    return found == plan.images.end() ? none : *found;
}
std::size_t passes_without_entries(const Plan& plan) {
    return static_cast<std::size_t>(
        std::ranges::count_if(plan.passes, [](const PlanPass& pass) { return pass.entries.empty(); }));
}

TEST_F(ComposePlan, PointwiseEffectsAreOneKernelInTheUsersOrder) {
    const std::vector<std::string> order{"vignette", "encode",  "exposure", "dither",
                                         "negative", "tonemap", "grayscale"};
    for (const std::string& name : order) add(composer, name);
    const Plan made = plan();
    ASSERT_EQ(made.passes.size(), 1u) << passes_of(made);
    EXPECT_EQ(made.passes[0].entries, order);
    EXPECT_FALSE(made.passes[0].boundary.empty());
    EXPECT_EQ(made.extent.width, 1920u);
    EXPECT_EQ(made.passes[0].extent.height, 1080u);
    EXPECT_EQ(made.passes[0].bytes_written, 1920u * 1080 * 4);
    EXPECT_GE(made.passes[0].bytes_read, 1920u * 1080 * 8);
    EXPECT_EQ(made.bytes_written(), made.passes[0].bytes_written);
    EXPECT_EQ(made.transient_bytes, 0u);
    EXPECT_NE(made.text().find("grayscale"), std::string::npos);
    EXPECT_NE(made.json().find("grayscale"), std::string::npos);
}

TEST_F(ComposePlan, UnfusedEveryEffectIsAKernel) {
    for (const char* const name : {"exposure", "tonemap", "encode", "vignette"}) add(composer, name);
    CompileDesc desc = hd();
    desc.fuse = false;
    const Plan made = plan(desc);
    EXPECT_EQ(passes_of(made), "exposure | tonemap | encode | vignette");
    EXPECT_NE(made.passes[2].boundary.find("fusion is off"), std::string::npos) << made.passes[2].boundary;
}

TEST_F(ComposePlan, ALongStackHasKernelsAndPicturesWithinBounds) {
    const std::vector<std::string> effects{"exposure", "vignette", "grayscale", "negative"};
    for (std::size_t i = 0; i < 300; ++i) add(composer, effects[i % effects.size()]);
    const Plan made = plan();
    std::size_t entries = 0, joined = 0;
    for (const PlanPass& pass : made.passes) {
        EXPECT_LE(pass.entries.size(), 16u);
        entries += pass.entries.size();
        joined += pass.entries.size() - 1;
    }
    EXPECT_EQ(entries, 300u);
    EXPECT_EQ(joined, 96u);
    EXPECT_NE(made.passes[1].boundary.find("at most 16 entries"), std::string::npos) << made.passes[1].boundary;
    EXPECT_NE(made.passes.back().boundary.find("joins at most 96 entries"), std::string::npos);
    // Those behind kernels that may be off, and two for all others.
    EXPECT_LE(made.transient_bytes, 36u * 1920 * 1080 * 8);
}

TEST_F(ComposePlan, AnEmptyStackIsACopy) {
    const Plan made = plan();
    EXPECT_EQ(made.passes.size(), 1u);
    EXPECT_TRUE(entries_of(made).empty());
}

TEST_F(ComposePlan, ANeighbourhoodEffectSplitsTheKernels) {
    add(composer, "exposure");
    add(composer, "gaussian_blur");
    add(composer, "tonemap");
    add(composer, "encode");
    const Plan made = plan();
    EXPECT_EQ(entries_of(made), (std::vector<std::string>{"exposure", "tonemap", "encode"}));
    EXPECT_EQ(passes_without_entries(made), 2u) << passes_of(made);
    EXPECT_EQ(made.passes.front().name, "exposure");
    EXPECT_EQ(made.passes.back().name, "tonemap+encode");
    EXPECT_NE(made.passes.back().boundary.find("gaussian_blur"), std::string::npos) << made.passes.back().boundary;
    for (const PlanPass& pass : made.passes) EXPECT_FALSE(pass.boundary.empty()) << pass.name;
}

TEST_F(ComposePlan, AWarpOpensAKernel) {
    static constexpr EffectFile file{.name = "shift.glsl",
                                     .text =
                                         "vec4 shift(Pixel pixel, Shift parameters) {\n"
                                         "    return load_clamped(picture, pixel.texel + ivec2(1, 0));\n}\n"};
    static const EffectInfo shift{.name = "shift",
                                  .doc = "Moves the picture.",
                                  .parameters = {.struct_name = "Shift"},
                                  .files = {&file, 1},
                                  .touch = Touch::Warp};
    add(composer, "exposure");
    composer.add(shift, nullptr);
    add(composer, "negative");
    const Plan made = plan();
    EXPECT_EQ(passes_of(made), "exposure | shift+negative");
    EXPECT_NE(made.passes[1].boundary.find("shift reads the picture at moved coordinates"), std::string::npos);

    ReferenceImage picture = test::round_to_float(test::random_display(9, 5, 1));
    const test::Host host(picture);
    const auto compiled = composer.compile(host.compile_desc());
    ASSERT_TRUE(compiled) << compiled.error().text;
    const ReferenceImage out = host.run(composer);
    for (std::uint32_t y = 0; y < 5; ++y)
        for (std::uint32_t x = 0; x < 9; ++x) EXPECT_NEAR(out.at(x, y).g, 1 - 2 * picture.clamped(x + 1, y).g, 1e-6);
}

TEST_F(ComposePlan, TheArticlesExampleReadsTheHandle) {
    const Handle blurred = add(composer, "gaussian_blur", {{"radius", 4}});
    add(composer, "negative");
    add(composer, "blend", {{"amount", 0.5}}, {.second = blurred});
    const Plan made = plan();
    EXPECT_EQ(entries_of(made), (std::vector<std::string>{"negative", "blend"})) << passes_of(made);

    const ReferenceImage picture = test::round_to_float(test::random_display(50, 31, 8));
    const test::Host host(picture);
    test::must(composer.compile(host.compile_desc()));
    const auto reference = [](std::string_view name, const std::vector<std::uint32_t>& words, const ReferenceImage& of,
                              const ReferenceImage* second = nullptr) {
        return find_effect(name)->reference(words.data(), {.picture = &of, .source = &of, .second = second});
    };
    const ReferenceImage blur = reference("gaussian_blur", composer.current(composer.entry(0)), picture);
    const ReferenceImage negative = reference("negative", composer.current(composer.entry(1)), blur);
    const ReferenceImage expected = reference("blend", composer.current(composer.entry(2)), negative, &blur);
    EXPECT_LE(test::worst_difference(host.run(composer), expected), 2e-3);
}

TEST_F(ComposePlan, APictureThatTwoReadIsStoredOnce) {
    const Handle bright = add(composer, "exposure");
    add(composer, "negative");
    add(composer, "blend", {}, {.second = bright});
    const Plan made = plan();
    EXPECT_EQ(passes_of(made), "exposure | negative+blend");
    EXPECT_NE(made.passes[1].boundary.find("blend"), std::string::npos) << made.passes[1].boundary;
}

TEST_F(ComposePlan, BloomOfTheSceneCostsNoExtraPass) {
    add(composer, "exposure");
    add(composer, "bloom", {}, {.source = scene_color});
    add(composer, "tonemap");
    const Plan of_scene = plan();
    EXPECT_EQ(entries_of(of_scene), (std::vector<std::string>{"exposure", "bloom", "tonemap"}));
    EXPECT_EQ(pass_with(of_scene, "exposure").entries.size(), 3u) << passes_of(of_scene);

    composer.clear();
    add(composer, "exposure");
    add(composer, "bloom");
    add(composer, "tonemap");
    const Plan in_place = plan();
    EXPECT_EQ(in_place.passes.size(), of_scene.passes.size() + 1) << passes_of(in_place);
    EXPECT_EQ(passes_without_entries(in_place), passes_without_entries(of_scene));
    const PlanPass& merge = pass_with(in_place, "bloom");
    EXPECT_EQ(merge.entries, (std::vector<std::string>{"bloom", "tonemap"}));
    EXPECT_NE(merge.boundary.find("bloom"), std::string::npos) << merge.boundary;
}

TEST_F(ComposePlan, TwoEntriesOfOneEffectAreTwo) {
    add(composer, "bloom", {{"intensity", 0.5}}, {.source = scene_color});
    add(composer, "bloom", {{"intensity", 0.25}, {"threshold", 0.2}}, {.source = scene_color});
    const Plan made = plan();
    EXPECT_EQ(pass_with(made, "bloom").entries, (std::vector<std::string>{"bloom", "bloom#2"})) << passes_of(made);
    EXPECT_TRUE(composer.find("bloom#2"));

    const ReferenceImage picture = test::round_to_float(test::random_display(70, 50, 5));
    const test::Host host(picture);
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage both = host.run(composer);
    test::must(composer.set_enabled(*composer.find("bloom#2"), false));
    const ReferenceImage first = host.run(composer);
    test::must(composer.set_enabled(*composer.find("bloom"), false));
    test::must(composer.set_enabled(*composer.find("bloom#2"), true));
    const ReferenceImage second = host.run(composer);
    double glow = 0;
    for (std::size_t i = 0; i < both.pixels.size(); ++i) {
        const double sum = first.pixels[i].g + second.pixels[i].g - picture.pixels[i].g;
        EXPECT_NEAR(both.pixels[i].g, sum, 1e-5);
        glow = std::max(glow, second.pixels[i].g - picture.pixels[i].g);
    }
    EXPECT_GT(glow, 0.01);
}

TEST_F(ComposePlan, WhatNobodyReadsIsCulled) {
    add(composer, "gaussian_blur");
    add(composer, "exposure", {}, {.input = scene_color});
    EXPECT_EQ(passes_of(plan()), "exposure");
}

TEST_F(ComposePlan, MissingInputsLeaveAnEffectOut) {
    static constexpr EffectFile file{.name = "deep.glsl",
                                     .text = "vec4 deep(vec4 color, Pixel pixel, Deep parameters) { return color; }\n"};
    static const EffectInfo deep{.name = "deep",
                                 .doc = "Reads depth.",
                                 .parameters = {.struct_name = "Deep"},
                                 .files = {&file, 1},
                                 .needs = {FrameImage::Depth, FrameImage::Velocity}};
    add(composer, "exposure");
    composer.add(deep, nullptr);
    CompileDesc desc = hd();
    desc.velocity.format = VK_FORMAT_R16G16_SFLOAT;
    const Plan made = plan(desc);
    ASSERT_EQ(made.left_out.size(), 1u);
    EXPECT_NE(made.left_out[0].find("deep: needs depth"), std::string::npos) << made.left_out[0];
    EXPECT_EQ(made.left_out[0].find("velocity"), std::string::npos) << made.left_out[0];
    EXPECT_EQ(entries_of(made), std::vector<std::string>{"exposure"});
}

TEST_F(ComposePlan, LinearFloatTargetsSkipTheLastSteps) {
    for (const char* const name : {"exposure", "tonemap", "encode", "dither"}) add(composer, name);
    const Plan made = plan(hd(VK_FORMAT_R16G16B16A16_SFLOAT));
    EXPECT_EQ(made.left_out.size(), 2u);
    EXPECT_EQ(entries_of(made), (std::vector<std::string>{"exposure", "tonemap"}));
    CompileDesc encoded = hd(VK_FORMAT_R16G16B16A16_SFLOAT);
    encoded.target_domain = Domain::Encoded;
    EXPECT_EQ(entries_of(plan(encoded)).size(), 4u);
}

/// Without what is said of the device, which has a pass for each step of bloom.
std::vector<std::string> without_fall_backs(std::vector<std::string> remarks) {
    std::erase_if(remarks,
                  [](const std::string& remark) { return remark.find("a pass for each step") != remark.npos; });
    return remarks;
}

TEST_F(ComposePlan, AnEntryInAWrongDomainIsToldAndReordersNothing) {
    for (const char* const name : {"tonemap", "bloom", "encode"}) add(composer, name);
    const Plan made = plan();
    EXPECT_EQ(made.misplaced,
              std::vector<std::string>{"bloom expects a picture that is scene_linear; this one is display_linear."});
    EXPECT_EQ(without_fall_backs(made.remarks), std::vector<std::string>{});
    EXPECT_EQ(entries_of(made), (std::vector<std::string>{"tonemap", "bloom", "encode"}));
}

TEST_F(ComposePlan, BothShippedOrdersGiveNoRemark) {
    for (const bool is_documented : {true, false}) {
        std::vector<const EffectInfo*> flat;
        const auto rank = [&](const EffectInfo* info) {
            return is_documented ? info->flat.documented : info->flat.scene_linear;
        };
        for (const EffectInfo* const info : all_effects())
            if (rank(info) >= 0 && !info->flat.is_of_ui()) flat.push_back(info);
        std::ranges::sort(flat, {}, rank);
        composer.clear();
        for (const EffectInfo* const info : flat) composer.add(*info, nullptr, {.source = scene_color});
        CompileDesc desc = hd();
        desc.depth.format = VK_FORMAT_D32_SFLOAT;
        desc.has_shadows = true;
        const Plan made = plan(desc);
        EXPECT_EQ(made.misplaced, std::vector<std::string>{}) << (is_documented ? "documented" : "scene_linear");
        EXPECT_EQ(without_fall_backs(made.remarks), std::vector<std::string>{})
            << (is_documented ? "documented" : "scene_linear");
        EXPECT_TRUE(made.left_out.empty()) << made.left_out.front();
    }
}

TEST_F(ComposePlan, EveryImageThatIsReadCounts) {
    if (find_effect("ssao") == nullptr) GTEST_SKIP() << "this build has no effect that reads depth";
    add(composer, "ssao");
    for (const VkFormat format : {VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D32_SFLOAT,
                                  VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT}) {
        if (!gpu::test::context().supports(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)) continue;
        CompileDesc desc = hd();
        desc.depth.format = format;
        const Plan made = plan(desc);
        const auto pass = std::ranges::find(made.passes, "ssao.half depth", &PlanPass::name);
        ASSERT_NE(pass, made.passes.end()) << passes_of(made);
        const std::uint64_t bytes = gpu::format_traits(format).bits / 8;
        EXPECT_GE(bytes, 2u);
        EXPECT_EQ(pass->bytes_read, bytes * 1920 * 1080) << format;
    }
}

/// How many passes of a plan make the distances of half the size.
std::size_t half_distances(const Plan& made) {
    return static_cast<std::size_t>(std::ranges::count_if(made.passes, [](const PlanPass& pass) {
        return pass.name.find("half depth") != pass.name.npos ||
               pass.name.find("half surface distance") != pass.name.npos;
    }));
}

TEST_F(ComposePlan, WhatReadsHalfTheDepthSharesOnePass) {
    for (const char* const name : {"ssao", "volumetric", "motion_blur"})
        if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no " << name;
    CompileDesc desc = hd(VK_FORMAT_R16G16B16A16_SFLOAT);
    desc.depth.format = VK_FORMAT_D32_SFLOAT;
    desc.has_shadows = true;
    const auto bytes_of = [](const Plan& made, std::string_view name) {
        const auto pass = std::ranges::find(made.passes, name, &PlanPass::name);
        return pass == made.passes.end() ? 0 : pass->bytes_read;
    };
    constexpr std::uint64_t depth = 4 * 1920 * 1080, half = depth / 4;
    for (const VkFormat normals : {VK_FORMAT_UNDEFINED, VK_FORMAT_R16G16B16A16_SFLOAT}) {
        desc.normals.format = normals;
        composer.clear();
        const Handle blur = add(composer, "motion_blur");
        const Plan alone = plan(desc);
        EXPECT_EQ(half_distances(alone), 0u) << "reading the depth itself costs no more: " << passes_of(alone);
        EXPECT_EQ(bytes_of(alone, "motion_blur.motion of the camera"), depth);
        EXPECT_TRUE(composer.remove(blur));
        add(composer, "ssao");
        add(composer, "volumetric");
        add(composer, "motion_blur");
        const Plan together = plan(desc);
        EXPECT_EQ(half_distances(together), 1u) << passes_of(together);
        EXPECT_EQ(bytes_of(together, "motion_blur.motion of the camera"), half);
    }
}

TEST_F(ComposePlan, PassesThatThePresentValuesSwitchOffAreNotListed) {
    if (find_effect("ssao") == nullptr) GTEST_SKIP() << "this build has no effect with two ways to run";
    const Handle ssao = add(composer, "ssao"), blur = add(composer, "gaussian_blur", {{"radius", 5}});
    add(composer, "exposure");
    CompileDesc desc = hd();
    desc.depth.format = VK_FORMAT_D32_SFLOAT;
    const auto names = [&](std::string_view resolution) {
        const auto& choices = composer.info(ssao)->parameters.find("resolution")->choices;
        const auto at = std::ranges::find(choices, resolution) - choices.begin();
        test::set_word(composer, ssao, "resolution", static_cast<std::uint32_t>(at));
        return passes_of(plan(desc));
    };
    const std::string halved = names("half"), full = names("full");
    EXPECT_NE(halved.find("ssao.occlusion |"), std::string::npos) << halved;
    EXPECT_EQ(halved.find("full size"), std::string::npos) << halved;
    EXPECT_NE(full.find("ssao.occlusion full size"), std::string::npos) << full;
    EXPECT_EQ(full.find("upsample"), std::string::npos) << full;
    EXPECT_NE(full.find("gaussian_blur"), std::string::npos) << full;
    test::must(composer.set_enabled(blur, false));
    EXPECT_EQ(passes_of(plan(desc)).find("gaussian_blur"), std::string::npos) << passes_of(plan(desc));
}

// What depends on the frame is planned for one that brings what it may.
TEST_F(ComposePlan, PassesThatWaitForALightAreListed) {
    for (const char* const name : {"volumetric", "god_rays"})
        if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    add(composer, "volumetric");
    add(composer, "god_rays");
    CompileDesc desc = hd();
    desc.depth.format = VK_FORMAT_D32_SFLOAT;
    desc.has_shadows = true;
    const std::string names = passes_of(plan(desc));
    EXPECT_NE(names.find("volumetric.march 3"), std::string::npos) << names;
    EXPECT_NE(names.find("god_rays.march"), std::string::npos) << names;
}

TEST_F(ComposePlan, HandlesMustNameEarlierEntries) {
    add(composer, "exposure", {}, {.input = Handle{12345}});
    add(composer, "negative");
    EXPECT_NE(error().find("'exposure': its input"), std::string::npos) << error();
    composer.clear();
    const Handle own = add(composer, "exposure");
    test::must(composer.rewire(own, {.mask = own}));
    EXPECT_NE(error().find("mask"), std::string::npos) << error();
    composer.clear();
    add(composer, "blend");
    EXPECT_NE(error().find("second"), std::string::npos) << error();
}

TEST_F(ComposePlan, TheDefaultStackNeedsItsPyramidAndNothingElse) {
    add(composer, "bloom", {}, {.source = scene_color});
    for (const char* const name : {"exposure", "tonemap", "encode", "dither", "vignette"}) add(composer, name);
    const Plan fused = plan();
    const std::uint64_t texel = gpu::format_traits(image_of(fused, "bloom.pyramid").format).bits / 8;
    EXPECT_LE(texel, 8u);
    std::uint64_t pyramid = 0;  // five levels
    for (std::uint32_t level = 1; level <= 5; ++level) pyramid += texel * (1920 >> level) * (1080 >> level);
    EXPECT_GE(fused.transient_bytes, pyramid);
    EXPECT_LE(fused.transient_bytes, pyramid + (pyramid / 2)) << "more than the pyramid and the driver's padding";
    EXPECT_EQ(fused.transient_bytes, fused.transient_bytes_unaliased);

    CompileDesc desc = hd();
    desc.fuse = false;
    const Plan unfused = plan(desc);
    EXPECT_LE(static_cast<double>(unfused.transient_bytes),
              0.45 * static_cast<double>(unfused.transient_bytes_unaliased));
}

/// What the lifetimes of a plan's images must be, whatever the stack.
void expect_sound_images(const Plan& plan) {
    std::set<std::string> names;
    for (const PlanImage& image : plan.images) EXPECT_TRUE(names.insert(image.name).second) << image.name;
    std::vector<bool> is_written(plan.images.size());
    for (std::size_t i = 0; i < plan.images.size(); ++i)
        is_written[i] = plan.images[i].kind == PlanImage::Kind::Host && plan.images[i].name != "target";
    for (std::uint32_t i = 0; i < plan.passes.size(); ++i) {
        const auto check = [&](const PlanUse& use) {
            const PlanImage& image = plan.images.at(use.image);
            EXPECT_LT(use.mip_level, image.mip_levels) << image.name;
            EXPECT_TRUE(image.first_pass <= i && i <= image.last_pass) << image.name;
        };
        for (const PlanUse& read : plan.passes[i].reads) {
            check(read);
            EXPECT_TRUE(is_written[read.image] || read.is_previous) << plan.images[read.image].name;
        }
        check(plan.passes[i].writes);
        is_written[plan.passes[i].writes.image] = true;
    }
    for (const PlanImage& a : plan.images) {
        if (a.kind != PlanImage::Kind::Transient) continue;
        EXPECT_LE(a.offset + a.bytes, plan.transient_bytes) << a.name;
        for (const PlanImage& b : plan.images) {
            if (&a == &b || b.kind != PlanImage::Kind::Transient) continue;
            const bool is_apart = a.offset + a.bytes <= b.offset || b.offset + b.bytes <= a.offset;
            EXPECT_TRUE(is_apart || a.last_pass < b.first_pass || b.last_pass < a.first_pass) << a.name << b.name;
        }
    }
}

TEST_F(ComposePlan, ImagesHaveNamesPlacesAndLifetimes) {
    if (find_effect("frame_blend") == nullptr) GTEST_SKIP() << "this build has no effect frame_blend";
    const gpu::test::PlannedFor planned(true);
    add(composer, "bloom");
    add(composer, "gaussian_blur");
    add(composer, "frame_blend");
    add(composer, "encode");
    const Plan made = plan();
    expect_sound_images(made);
    EXPECT_EQ(image_of(made, "color").kind, PlanImage::Kind::Host);
    EXPECT_EQ(image_of(made, "color").first_pass, 0u);
    EXPECT_EQ(image_of(made, "target").last_pass, made.passes.size() - 1);
    EXPECT_EQ(image_of(made, "target").bytes, 1920u * 1080 * 4);
    const PlanImage& pyramid = image_of(made, "bloom.pyramid");
    EXPECT_EQ(pyramid.kind, PlanImage::Kind::Transient);
    EXPECT_EQ(pyramid.extent.width, 960u);
    EXPECT_EQ(pyramid.mip_levels, 5u);
    EXPECT_EQ(made.passes[pyramid.first_pass].name, "bloom.prefilter");
    const auto is_previous = [](const PlanUse& use) { return use.is_previous; };
    EXPECT_TRUE(std::ranges::any_of(
        made.passes, [&](const PlanPass& pass) { return std::ranges::any_of(pass.reads, is_previous); }));
    const std::string shown(gpu::format_name(pyramid.format));
    EXPECT_NE(made.text().find("bloom.pyramid  (transient, " + shown + ", 960 x 540, 5 mip levels"), std::string::npos)
        << made.text();
    EXPECT_NE(made.json().find("\"name\": \"bloom.pyramid\", \"kind\": \"transient\""), std::string::npos);
}

TEST_F(ComposePlan, ImagesOfWhatIsOffHaveNoPass) {
    const Handle first = add(composer, "gaussian_blur");
    add(composer, "gaussian_blur");
    test::must(composer.set_enabled(first, false));
    const Plan made = plan();
    expect_sound_images(made);
    const auto is_of_first = [](const PlanImage& image) { return image.name.starts_with("gaussian_blur."); };
    EXPECT_EQ(std::ranges::count_if(made.images, is_of_first),
              std::ranges::count_if(made.images,
                                    [](const PlanImage& image) { return image.name.starts_with("gaussian_blur#2."); }));
    for (const PlanImage& image : made.images) {
        if (is_of_first(image)) {
            EXPECT_EQ(image.first_pass, PlanImage::never) << image.name;
        }
    }
}

}  // namespace
}  // namespace darkroom
