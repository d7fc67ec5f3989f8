// SPDX-License-Identifier: MIT
// An opacity that is accepted is seen, by whichever plan the next recordings use.

#include <random>

#include "compose/test_stacks/host.hpp"
#include "compose/test_stacks/random_stack.hpp"
#include "develop/reference_chain.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;

class ComposeOpacity : public test::StackTest {};

/// Black beside white: a blur makes it grey along the edge.
ReferenceImage black_beside_white() {
    ReferenceImage out = test::uniform(32, 8, {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 16; x < out.width; ++x) out.at(x, y) = {1, 1, 1, 1};
    return out;
}

TEST_F(ComposeOpacity, IsRefusedWhereThePlanThatIsOnItsWayCannotMix) {
    const Host host(black_beside_white());
    for (const std::uint32_t threads : {0U, 1U}) {
        SCOPED_TRACE(threads);
        Composer composer(host.device, {.max_threads = threads});
        const Handle blur = add(composer, "gaussian_blur", {{"radius", 6}}, {.opacity = 0.5f});
        const Handle negative = add(composer, "negative");
        test::must(composer.compile(host.compile_desc()));
        test::must(composer.set_opacity(blur, 1));
        test::must(composer.compile_later(host.compile_desc()));
        const auto set = composer.set_opacity(blur, 0.25f);
        EXPECT_FALSE(set) << "accepted";
        if (!set) {
            EXPECT_NE(set.error().text.find("passes of its own"), std::string::npos) << set.error().text;
        }
        EXPECT_EQ(composer.desc(blur)->opacity, 1);
        // What always can be mixed is not refused.
        test::must(composer.set_opacity(negative, 0.25f));
        test::must(composer.set_opacity(blur, 0));
        test::must(composer.set_opacity(blur, 1));
        test::must(composer.compile(host.compile_desc()));
        EXPECT_FALSE(composer.set_opacity(blur, 0.25f)) << "the new plan cannot mix either";
    }
}

// A warp moves where the kernel reads its picture; laid over, it reads it at both places.
TEST_F(ComposeOpacity, OfAWarpThatWasCompiledWithoutIsSeen) {
    const ReferenceImage picture = test::round_to_float(test::random_display(24, 16, 4));
    const Host host(picture);
    for (const char* const warp : {"lens_distortion", "chromatic_aberration", "radial_blur"}) {
        if (find_effect(warp) == nullptr) continue;
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            Composer composer(host.device, {.max_threads = 0});
            add(composer, "exposure", {{"exposure", 0.5}});
            const Handle handle = add(composer, warp);
            std::mt19937 random(5);
            test::set_random(random, composer, handle, test::Values::Sane);
            add(composer, "negative");
            CompileDesc desc = host.compile_desc();
            desc.kernels = stage;
            test::must(composer.compile(desc));
            const ReferenceImage whole = host.run(composer);
            test::must(composer.set_opacity(handle, 0.25f));
            const auto expected = run_reference(composer, {.color = &picture, .encodes_target = false});
            ASSERT_TRUE(expected) << expected.error().text;
            for (const bool is_lean : {false, true}) {
                if (is_lean) composer.wait_for_kernels();
                const ReferenceImage mixed = host.run(composer);
                EXPECT_LE(test::worst_difference(mixed, expected->picture), 2 * (0x1p-11 + gpu::test::filter_step()))
                    << warp << is_lean;
                EXPECT_GT(test::worst_difference(mixed, whole), 0.02) << warp << is_lean;
            }
        }
    }
}

}  // namespace
}  // namespace darkroom
