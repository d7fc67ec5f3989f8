// SPDX-License-Identifier: MIT
#include "compose/chain/pass_kernels.hpp"

#include <new>

#include "compose/stack/stack_program.hpp"
#include "compose/test_stacks/host.hpp"
#include "core/test_support_allocations.hpp"

namespace darkroom::compose {
namespace {

class ComposePassKernels : public darkroom::test::StackTest {};

// Who records asks for a kernel once. One whose making threw never comes, so it is asked for again.
TEST_F(ComposePassKernels, AKernelWhoseMakingThrewIsWantedNoMore) {
    if (!darkroom::test::counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
    gpu::Context& context = gpu::test::context();
    const EffectInfo& info = *find_effect("exposure");
    const auto defaults = info.parameters.defaults;
    const std::array stack{
        plan::Entry{.id = 1, .info = &info, .desc = {.name = "exposure"}, .base = {defaults.begin(), defaults.end()}}};
    const auto program = gpu::test::must(plan_stack(context, stack, {.max_extent = {16, 16}}));
    PassKernels& kernels = *program->kernels.front();
    gpu::test::must(kernels.build_complete(*context.kernels));
    const plan::Shape shape{};
    // Once made, all that may fail is ours.
    const auto& pass = program->program.passes.front();
    const auto held = gpu::test::must(context.kernels->get(gpu::test::must(plan::lean_spec(pass, shape)), pass.stage));
    int thrown = 0;
    for (std::uint64_t number = 0; kernels.find(shape, 1, 1) == nullptr; ++number) {
        ASSERT_FALSE(kernels.is_wanted(shape)) << "after failure " << number;
        kernels.set_wanted(shape);
        const darkroom::test::FailingAllocation failing(number);
        try {
            gpu::test::must(kernels.build(context, shape));
        } catch (const std::bad_alloc&) {
            ++thrown;
        }
    }
    EXPECT_FALSE(kernels.is_wanted(shape));
    EXPECT_GT(thrown, 10);
}

}  // namespace
}  // namespace darkroom::compose
