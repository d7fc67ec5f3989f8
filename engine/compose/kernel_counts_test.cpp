// SPDX-License-Identifier: MIT
// Kernels are what they do and nothing else: how many pipelines and compiler calls compiling, resizing and editing
// take. Every test has a device of its own, whose store begins empty.

#include <fmt/format.h>

#include "compose/test_stacks/host.hpp"
#include "gpu/kernel/kernel_store.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom {
namespace {

using test::add;

class ComposeKernelCounts : public test::StackTest {
  protected:
    void SetUp() override {
        test::StackTest::SetUp();
        if (IsSkipped()) return;
        auto made = Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"});
        ASSERT_TRUE(made) << made.error().text;
        device = std::make_unique<Device>(std::move(*made));
    }
    /// Pipelines and compiler calls that `work` takes.
    template <class Work>
    std::uint64_t made_by(const Work& work) {
        const auto count = [&] {
            gpu::Context& context = device->context();
            return context.pipelines_created + context.shaders->compiled + context.shaders->from_cache;
        };
        const std::uint64_t before = count();
        work();
        return count() - before;
    }
    std::uint64_t pipelines_of(const std::function<void()>& work) {
        const std::uint64_t before = device->context().kernels->counters().built;
        work();
        return device->context().kernels->counters().built - before;
    }
    static CompileDesc desc(VkExtent2D extent = {256, 256}) {
        return {.max_extent = extent, .color = {VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_SAMPLED_BIT}};
    }
    static void fill(Composer& composer) {
        add(composer, "bloom", {}, {.source = scene_color});
        for (const char* const effect : {"exposure", "tonemap", "encode", "dither", "vignette"}) add(composer, effect);
    }
    void compile(Composer& composer, const CompileDesc& with = desc()) const { test::must(composer.compile(with)); }

    std::unique_ptr<Device> device;
};

TEST_F(ComposeKernelCounts, CompilingAgainAndResizingMakeNothing) {
    Composer composer(*device);
    fill(composer);
    compile(composer);
    EXPECT_EQ(made_by([&] { compile(composer); }), 0u);
    EXPECT_EQ(made_by([&] { compile(composer, desc({512, 512})); }), 0u);
    EXPECT_EQ(made_by([&] { compile(composer); }), 0u);
}

TEST_F(ComposeKernelCounts, ASecondComposerWithTheSameStackMakesNothing) {
    Composer first(*device), second(*device);
    fill(first);
    fill(second);
    compile(first);
    EXPECT_EQ(made_by([&] { compile(second); }), 0u);
}

// Its passes are nine; the shapes of whole images make each shader twice, complete and lean.
TEST_F(ComposeKernelCounts, BloomHasFourShadersAndItsJoin) {
    Composer composer(*device);
    const Handle bloom = add(composer, "bloom", {}, {.source = scene_color});
    test::set_word(composer, bloom, "reach", 0);  // pixels: all levels count, however low the picture is
    std::size_t passes = 0;
    EXPECT_EQ(pipelines_of([&] { passes = composer.compile(desc()).value().passes.size(); }), 2u * (4 + 1));
    EXPECT_GE(passes, gpu::test::context().traits.is_software ? 8U : 5U) << "a GPU makes several levels in one";
}

TEST_F(ComposeKernelCounts, AnEffectInFrontMakesItsOwnKernelsAndTheTail) {
    Composer composer(*device);
    fill(composer);
    compile(composer);
    Handle blur;
    const std::uint64_t with_blur = pipelines_of([&] {
        const EffectInfo& info = *find_effect("gaussian_blur");
        blur = test::must(composer.insert(composer.entry(0), info, nullptr, {.name = "first"}));
        compile(composer);
    });
    EXPECT_LE(with_blur, 2u * (2 + 1)) << "two passes of the blur, and the kernel that takes its picture";
    EXPECT_EQ(made_by([&] {
                  test::must(composer.remove(blur));
                  compile(composer);
              }),
              0u)
        << "undone, all is there";
    const std::uint64_t moved = pipelines_of([&] {
        test::must(composer.move(composer.entry(5), composer.entry(1)));
        compile(composer);
    });
    EXPECT_LE(moved, 2u) << "the tail has another order, and nothing else changed";
}

TEST_F(ComposeKernelCounts, RemovingAnEntryTouchesTheKernelThatHeldItAlone) {
    Composer composer(*device);
    fill(composer);
    compile(composer);
    EXPECT_LE(pipelines_of([&] {
                  test::must(composer.remove(*composer.find("dither")));
                  compile(composer);
              }),
              2u);
}

// bloom.firefly_filter goes to the GPU as a number that the CPU computes: no text names it.
TEST_F(ComposeKernelCounts, AChoiceThatOnlyTheCpuReadsMakesNothing) {
    Composer composer(*device);
    fill(composer);
    compile(composer);
    composer.wait_for_kernels();
    EXPECT_EQ(made_by([&] {
                  test::set_word(composer, *composer.find("bloom"), "firefly_filter", 0);
                  composer.wait_for_kernels();
              }),
              0u);
    EXPECT_GT(made_by([&] {
                  test::set_word(composer, *composer.find("tonemap"), "curve", 1);
                  composer.wait_for_kernels();
              }),
              0u)
        << "this one is a literal of the lean kernel";
}

TEST_F(ComposeKernelCounts, FailuresAreRememberedAndUnusedKernelsGo) {
    gpu::Context& context = device->context();
    gpu::KernelStore store(context, 4);
    const auto spec = [](int number) {
        return gpu::KernelSpec{.name = "test",
                               .outputs = {VK_FORMAT_R8G8B8A8_UNORM},
                               .body = fmt::format("vec4 shade(Pixel pixel) {{ return vec4({}.0); }}", number)};
    };
    for (int i = 0; i < 20; ++i) EXPECT_TRUE(store.get(spec(i), gpu::Stage::Compute));
    EXPECT_LE(store.counters().held, 5u);
    EXPECT_TRUE(store.get(spec(19), gpu::Stage::Compute));
    EXPECT_EQ(store.counters().built, 20u) << "the one used last is still there";
    EXPECT_TRUE(store.get(spec(0), gpu::Stage::Compute));
    EXPECT_EQ(store.counters().built, 21u) << "the one used first is not";

    gpu::KernelSpec broken = spec(0);
    broken.body = "vec4 shade(Pixel pixel) { return oops; }";
    const auto first = store.get(broken, gpu::Stage::Compute);
    ASSERT_FALSE(first);
    const std::uint64_t calls = context.shaders->compiled;
    const auto again = store.get(broken, gpu::Stage::Compute);
    ASSERT_FALSE(again);
    EXPECT_EQ(again.error().text, first.error().text);
    EXPECT_EQ(context.shaders->compiled, calls) << "the same text was compiled again";
}

}  // namespace
}  // namespace darkroom
