// SPDX-License-Identifier: MIT
// Any stack of any effects on any frame: with depth, normals and lights or without, of any size, with values at the
// ends of their ranges and with pixels that are no numbers. No message of the validation layer, no NaN, and the same
// bytes every time. What fails here names its number, which makes the same stack and frame again.

#include "compose/test_stacks/random_scene.hpp"
#include "core/test_support_small.hpp"

namespace darkroom {
namespace {

using test::below;
using test::one_in;

class ComposeAnyStack : public test::StackTest {};
class SoakAnyStack : public test::StackTest {};

constexpr VkFormat float_format = VK_FORMAT_R32G32B32A32_SFLOAT;

/// The effects that read more of the frame than its colour; each gets its turn.
const EffectInfo* scene_effect(std::uint32_t number) {
    constexpr std::array names{"ssao", "fog", "volumetric", "god_rays", "ssao", "radial_blur", "chromatic_aberration"};
    return find_effect(names[number % names.size()]);
}

VkExtent2D random_extent(std::mt19937& random) {
    constexpr std::array<VkExtent2D, 8> sizes{{{1, 1}, {1, 29}, {31, 1}, {2, 2}, {3, 5}, {37, 23}, {64, 36}, {65, 33}}};
    if (one_in(random, 3)) return {1 + below(random, 70), 1 + below(random, 50)};
    return sizes[below(random, static_cast<std::uint32_t>(sizes.size()))];
}

/// Light from -0.5 to 4, some of it much brighter; where broken, a tenth of the pixels is no light at all.
ReferenceImage random_picture(std::mt19937& random, VkExtent2D extent, bool is_broken) {
    ReferenceImage picture(extent.width, extent.height);
    for (Rgba& pixel : picture.pixels) {
        const double scale = one_in(random, 20) ? 50 : 1;
        for (double* const channel : {&pixel.r, &pixel.g, &pixel.b})
            *channel = double{is_broken && one_in(random, 10)
                                  ? test::broken_number(random)
                                  : static_cast<float>(scale * test::between(random, -0.5 / scale, 4))};
    }
    return picture;
}

/// A stack, a frame and where it is drawn, all of one number.
struct Case {
    struct Desc {
        test::Values values = test::Values::Sane;
        bool has_broken_colors = false, has_broken_scene = false;
        bool ends_encoded = false;  ///< the last entry is an sRGB encode
    };
    Case(std::uint32_t number, const Desc& desc)
        : random(number * 2654435761u + 29),
          extent(random_extent(random)),
          host(random_picture(random, extent, desc.has_broken_colors), float_format, float_format),
          scene(random, host.device,
                {.extent = extent, .is_broken = desc.has_broken_scene, .has_everything = !one_in(random, 3)}),
          composer(host.device),
          text("number " + std::to_string(number)) {
        test::fill_random(random, composer, {.values = desc.values, .always = scene_effect(number)});
        if (desc.ends_encoded) test::add(composer, "encode");
        text += scene.described() + test::described(composer);
    }

    [[nodiscard]] CompileDesc compile_desc() const {
        CompileDesc desc = host.compile_desc();
        scene.tell(desc);
        return desc;
    }
    /// Two recordings, of the same bytes.
    [[nodiscard]] ReferenceImage develop(const CompileDesc& desc) {
        const auto plan = composer.compile(desc);
        if (!plan) {
            ADD_FAILURE() << plan.error().text;
            return {};
        }
        passes = plan->passes.size();
        Frame frame = host.frame();
        scene.tell(frame);
        frame.time = 1.5;
        frame.frame_index = 90;
        frame.camera.is_cut = true;  // what lies a frame back is black, each time
        test::must(host.record(composer, frame));
        const std::vector<std::byte> first = gpu::test::download_bytes(host.device.context(), host.target);
        composer.wait_for_kernels();
        test::must(host.record(composer, frame));
        EXPECT_EQ(gpu::test::download_bytes(host.device.context(), host.target), first) << "a second frame differs";
        return host.read_target();
    }

    std::mt19937 random;
    VkExtent2D extent;
    test::Host host;
    test::RandomScene scene;
    Composer composer;
    std::string text;
    std::size_t passes = 0;
};

std::size_t count_of(const ReferenceImage& picture, bool (*is_bad)(double)) {
    std::size_t bad = 0;
    for (const Rgba& p : picture.pixels)
        for (const double value : {p.r, p.g, p.b, p.a}) bad += is_bad(value) ? 1 : 0;
    return bad;
}

/// The kernels saved by fusing.
std::size_t expect_fusion_is_invisible(std::uint32_t number) {
    Case one(number, {});
    SCOPED_TRACE(one.text);
    CompileDesc desc = one.compile_desc();
    desc.kernels = KernelStage::Compute;
    const ReferenceImage fused = one.develop(desc);
    const std::size_t fused_passes = one.passes;
    desc.kernels = KernelStage::Auto;
    desc.fuse = false;
    EXPECT_LE(test::worst_codes(one.develop(desc), fused), 1) << "unfused differs";
    EXPECT_EQ(count_of(fused, [](double value) { return !std::isfinite(value); }), 0u);
    return one.passes - fused_passes;
}

void expect_light_stays_finite(std::uint32_t number) {
    Case one(number, {.has_broken_scene = true});
    SCOPED_TRACE(one.text);
    CompileDesc desc = one.compile_desc();
    desc.target_domain = Domain::SceneLinear;
    EXPECT_EQ(count_of(one.develop(desc), [](double value) { return !std::isfinite(value); }), 0u);
}

void expect_codes_are_numbers(std::uint32_t number) {
    Case one(number,
             {.values = test::Values::Any, .has_broken_colors = true, .has_broken_scene = true, .ends_encoded = true});
    SCOPED_TRACE(one.text);
    ReferenceImage out = one.develop(one.compile_desc());
    // A ghost may cover more than all: its alpha is that of the picture times its strength.
    for (Rgba& pixel : out.pixels) pixel.a = std::min(pixel.a, 1.0);
    EXPECT_EQ(count_of(out, [](double value) { return !(value >= 0 && value <= 1); }), 0u);
}

const std::uint32_t broken_scenes = test::is_small() ? 3 : 10;

TEST_F(ComposeAnyStack, FusionIsInvisibleInScenes) {
    std::size_t saved = 0;
    const std::uint32_t stacks = test::is_small() ? 8 : 24;
    for (std::uint32_t number = 0; number < stacks; ++number) saved += expect_fusion_is_invisible(number);
    EXPECT_GE(saved, stacks / 3) << "nothing was fused";
}

TEST_F(ComposeAnyStack, BrokenScenesDoNotBreakLight) {
    for (std::uint32_t number = 0; number < broken_scenes; ++number) expect_light_stays_finite(number);
}

TEST_F(ComposeAnyStack, NothingMakesACodeThatIsNoNumber) {
    for (std::uint32_t number = 0; number < broken_scenes; ++number) expect_codes_are_numbers(number);
}

constexpr std::uint32_t soak_first = 100, soak_end = 140;

TEST_F(SoakAnyStack, FusionIsInvisibleInScenes) {
    for (std::uint32_t number = soak_first; number < soak_end; ++number) expect_fusion_is_invisible(number);
}

TEST_F(SoakAnyStack, BrokenScenesDoNotBreakLight) {
    for (std::uint32_t number = soak_first; number < soak_end; ++number) expect_light_stays_finite(number);
}

TEST_F(SoakAnyStack, NothingMakesACodeThatIsNoNumber) {
    for (std::uint32_t number = soak_first; number < soak_end; ++number) expect_codes_are_numbers(number);
}

}  // namespace
}  // namespace darkroom
