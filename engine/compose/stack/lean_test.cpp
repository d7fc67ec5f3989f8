// SPDX-License-Identifier: MIT
// Lean kernels: a pass has one for every shape that frames ask for, however long the Composer runs and however long the
// stack is.

#include <algorithm>
#include <random>

#include "compose/test_stacks/host.hpp"
#include "compose/test_stacks/random_stack.hpp"
#include "gpu/kernel/kernel_store.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;

class ComposeLean : public test::StackTest {};

/// Kernels that this device's store was asked for.
std::uint64_t lean_requests() { return gpu::test::context().kernels->counters().requests; }

/// Has the present shape a kernel of its own, that a frame finds? One that is not found would be asked for again.
bool has_lean_kernel(const Host& host, Composer& composer) {
    static_cast<void>(host.run(composer));
    composer.wait_for_kernels();
    static_cast<void>(host.run(composer));
    const std::uint64_t before = lean_requests();
    composer.wait_for_kernels();
    return lean_requests() == before;
}

void switch_by(Composer& composer, std::uint32_t bits) {
    for (std::size_t i = 0; i < composer.size(); ++i)
        test::must(composer.set_enabled(composer.entry(i), (bits >> i & 1) != 0));
}

TEST_F(ComposeLean, TheyComeAfterAResizeThoughManyShapesWereSeen) {
    const Host host(test::random_display(8, 8, 2));
    Composer composer(host.device, {.frames_in_flight = 1, .max_threads = 0});
    for (int i = 0; i < 7; ++i) add(composer, "negative");
    CompileDesc desc = host.compile_desc();
    test::must(composer.compile(desc));
    constexpr std::uint32_t kept = 64;  // shapes that a pass remembers
    for (std::uint32_t shape = 1; shape < kept + 8; ++shape) {
        switch_by(composer, shape);
        EXPECT_TRUE(has_lean_kernel(host, composer)) << "shape " << shape;
    }
    desc.max_extent = {16, 16};
    test::must(composer.compile(desc));
    for (std::uint32_t shape = kept + 8; shape < kept + 12; ++shape) {
        switch_by(composer, shape);
        EXPECT_TRUE(has_lean_kernel(host, composer)) << "shape " << shape << " after the resize";
    }
}

// All in one command buffer: a kernel that made room for another shape would be gone before it runs.
TEST_F(ComposeLean, ThoseOfFramesInFlightStayHoweverManyShapesThereAre) {
    const ReferenceImage picture = test::round_to_float(test::random_display(4, 4, 2));
    const Host host(picture);
    constexpr std::uint32_t shapes = 70;  // of which a pass remembers 64
    const std::uint64_t messages = host.device.validation_messages();
    Composer composer(host.device, {.frames_in_flight = 2 * shapes + 1, .max_threads = 0});
    for (int i = 0; i < 7; ++i) add(composer, "negative");
    test::must(composer.compile(host.compile_desc()));
    test::must(gpu::submit_and_wait(host.device.context(), "test frames", [&](VkCommandBuffer commands) {
        for (std::uint32_t shape = 1; shape <= shapes; ++shape) {
            switch_by(composer, shape);
            test::must(composer.record(commands, host.frame()));
            composer.wait_for_kernels();
            test::must(composer.record(commands, host.frame()));
        }
        // The first one's is among those that are in flight.
        switch_by(composer, 1);
        test::must(composer.record(commands, host.frame()));
        const std::uint64_t before = lean_requests();
        composer.wait_for_kernels();
        EXPECT_EQ(lean_requests(), before) << "its place was given to another shape";
    }));
    EXPECT_EQ(host.device.validation_messages(), messages);
    EXPECT_NEAR(host.read_target().at(1, 2).g, 1 - picture.at(1, 2).g, 1e-6);
}

TEST_F(ComposeLean, LongKernelsHaveThemToo) {
    const ReferenceImage picture = test::round_to_float(test::random_display(8, 8, 2));
    const Host host(picture);
    for (const std::size_t length : {30U, 129U}) {
        SCOPED_TRACE(length);
        Composer composer(host.device, {.max_threads = 0});
        for (std::size_t i = 0; i < length; ++i) add(composer, "exposure", {{"exposure", i % 2 == 0 ? 2.0 : 0.5}});
        test::must(composer.compile(host.compile_desc()));
        const std::uint64_t before = lean_requests();
        test::must(composer.set_enabled(composer.entry(length - 1), false));
        test::must(composer.set_enabled(composer.entry(0), false));
        const ReferenceImage complete = host.run(composer);
        composer.wait_for_kernels();
        EXPECT_GT(lean_requests(), before) << "no kernel of the present shape was asked for";
        EXPECT_EQ(test::worst_difference(host.run(composer), complete), 0);
        const double scale = length % 2 == 0 ? 1 : 0.5;
        EXPECT_NEAR(complete.at(3, 3).g, picture.at(3, 3).g * scale, 1e-6);
    }
}

// A driver may compute a place otherwise where a branch is gone, and an odd bit of a place moves what is read.
TEST_F(ComposeLean, PlacesAreThoseOfTheCompleteKernels) {
    const std::array<std::vector<const char*>, 6> stacks{{{"ui_warp"},
                                                          {"ui_warp", "ui_warp"},
                                                          {"ui_warp", "ui_chroma", "ui_echo"},
                                                          {"chromatic_aberration", "ui_warp"},
                                                          {"lens_distortion", "exposure"},
                                                          {"perturb", "exposure"}}};
    const Host host(test::round_to_float(test::random_display(24, 16, 2)));
    std::mt19937 random(4);
    for (const std::vector<const char*>& stack : stacks) {
        if (!std::ranges::all_of(stack, [](const char* name) { return find_effect(name) != nullptr; })) continue;
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            Composer composer(host.device, {.max_threads = 0});
            for (const char* const name : stack) add(composer, name);
            CompileDesc desc = host.compile_desc();
            desc.kernels = stage;
            test::must(composer.compile(desc));
            std::vector<ReferenceImage> complete;
            const auto values = random;
            for (int round = 0; round < 2; ++round) {
                random = values;
                for (std::size_t i = 0; i < 40; ++i) {
                    for (std::size_t entry = 0; entry < composer.size(); ++entry)
                        test::set_random(random, composer, composer.entry(entry), test::Values::Sane);
                    if (round == 0) {
                        complete.push_back(host.run(composer));
                    } else {
                        composer.wait_for_kernels();
                        // Compilers that contract otherwise put a sample into the next division of a texel.
                        EXPECT_LE(test::worst_difference(host.run(composer), complete[i]), 2 * gpu::test::filter_step())
                            << stack.front() << " and " << stack.size() - 1 << " more, values " << i;
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace darkroom
