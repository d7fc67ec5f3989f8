// SPDX-License-Identifier: MIT
// Looks of several branches, as people build them of passes: each pass atomic, each rendering what it was told. The
// planner makes fewer of them, and the picture stays what the passes one by one, and the references, say it is.

#include <gtest/gtest.h>

#include <darkroom/look.hpp>

#include "compose/test_stacks/host.hpp"
#include "develop/reference_chain.hpp"

namespace darkroom {
namespace {

struct Branches {
    const char* name;
    std::size_t passes;   ///< that the planner makes
    std::size_t unfused;  ///< one by one
    const char* stack;
};

constexpr std::string_view tail = R"(
[[stack]]
effect = "exposure"
exposure = 1.5
[[stack]]
effect = "tonemap"
[[stack]]
effect = "encode"
)";

const Branches branched_stacks[] = {
    {"the article's example", 3, 7, R"(
[[stack]]
effect = "gaussian_blur"
radius = 4
output = "blurred"
[[stack]]
effect = "negative"
[[stack]]
effect = "blend"
second = "blurred"
)"},
    {"a bloom of plain passes", 4, 7, R"(
[[stack]]
effect = "high_pass"
threshold = 0.5
[[stack]]
effect = "gaussian_blur"
radius = 4
output = "glow"
[[stack]]
effect = "blend"
input = "scene"
second = "glow"
mode = "add"
)"},
    {"soft focus through the lights", 4, 8, R"(
[[stack]]
effect = "gaussian_blur"
radius = 3
output = "soft"
[[stack]]
effect = "high_pass"
input = "scene"
threshold = 0.3
output = "lights"
[[stack]]
effect = "grayscale"
input = "scene"
[[stack]]
effect = "blend"
second = "soft"
mode = "lighten"
mask = "lights"
)"},
    {"what the alpha marks glows", 4, 8, R"(
[[stack]]
effect = "exposure"
exposure = 4.0
mask = "alpha"
output = "lit"
[[stack]]
effect = "gaussian_blur"
input = "alpha"
radius = 4
output = "halo"
[[stack]]
effect = "blend"
input = "lit"
second = "halo"
mode = "screen"
)"},
    {"an unsharp mask", 4, 8, R"(
[[stack]]
effect = "gaussian_blur"
radius = 2
output = "soft"
[[stack]]
effect = "blend"
input = "scene"
second = "soft"
mode = "difference"
amount = 1.0
output = "detail"
[[stack]]
effect = "blend"
input = "scene"
second = "detail"
mode = "add"
[[stack]]
effect = "vignette"
intensity = 0.4
)"},
    {"three exposures of one scene", 2, 7, R"(
[[stack]]
effect = "exposure"
input = "scene"
exposure = 0.25
output = "dark"
[[stack]]
effect = "exposure"
input = "scene"
exposure = 4.0
output = "bright"
[[stack]]
effect = "blend"
input = "dark"
second = "bright"
mode = "mix"
amount = 0.5
[[stack]]
effect = "blend"
second = "scene"
mode = "lighten"
)"},
    {"a quarter of the picture over the whole", 4, 8, R"(
[[stack]]
effect = "gaussian_blur"
radius = 2
scale = 0.25
output = "small"
[[stack]]
effect = "negative"
input = "scene"
amount = 0.25
[[stack]]
effect = "blend"
second = "small"
mode = "soft_light"
)"},
};

class ChainBranches : public test::StackTest {};

ReferenceImage branch_picture(std::uint32_t width, std::uint32_t height) {
    ReferenceImage out = test::random_display(width, height, 5);
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        Rgba& p = out.pixels[i];
        p = {p.r * 2, p.g, p.b * 0.5, i % 5 == 0 ? 1.0 : 0.0};
    }
    return test::round_to_half(out);
}

TEST_F(ChainBranches, PassesAreSavedAndThePictureStays) {
    const ReferenceImage picture = branch_picture(52, 36);
    const test::Host host(picture, VK_FORMAT_R16G16B16A16_SFLOAT);
    for (const Branches& branches : branched_stacks) {
        SCOPED_TRACE(branches.name);
        const auto look = parse_look(branches.stack + std::string(tail), branches.name, {.is_strict = true});
        ASSERT_TRUE(look) << look.error().text;
        Composer composer(gpu::test::device());
        test::must(apply(*look, composer));
        CompileDesc desc = host.compile_desc();
        const auto made = [&](bool is_fused, std::size_t passes) {
            desc.fuse = is_fused;
            const auto plan = composer.compile(desc);
            EXPECT_TRUE(plan) << plan.error().text;
            EXPECT_EQ(plan->passes.size(), passes) << plan->text();
            return host.run(composer);
        };
        const ReferenceImage fused = made(true, branches.passes), one_by_one = made(false, branches.unfused);
        EXPECT_LT(branches.passes, branches.unfused);
        EXPECT_LE(test::worst_codes(fused, one_by_one), 1);
        const auto reference = run_reference(composer, {.color = &picture});
        ASSERT_TRUE(reference) << reference.error().text;
        EXPECT_LE(test::worst_codes(fused, reference->picture), 1);
    }
}

}  // namespace
}  // namespace darkroom
