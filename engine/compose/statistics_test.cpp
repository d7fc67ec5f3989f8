// SPDX-License-Identifier: MIT
// Kernels of plans on a device that compiles only: RADV's null one, where RADV is there.
#include <cstdlib>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using test::add;

class ComposeStatistics : public test::StackTest {
  protected:
    void SetUp() override {
        test::StackTest::SetUp();
        if (IsSkipped()) return;
        setenv("RADV_FORCE_FAMILY", "navi21", 1);
        auto made = Device::create({.select = "RADV NAVI21",
                                    .compiles_only = true,
                                    .cache_folder = ::testing::TempDir() + "darkroom_test_cache"});
        unsetenv("RADV_FORCE_FAMILY");
        if (!made) GTEST_SKIP() << "RADV (package mesa-vulkan-drivers) is not there: " << made.error().text;
        device = std::make_unique<Device>(std::move(*made));
    }
    static CompileDesc desc(KernelStage kernels = KernelStage::Auto) {
        return {.max_extent = {256, 256},
                .color = {VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_SAMPLED_BIT},
                .kernels = kernels};
    }
    std::vector<KernelStatistics> statistics(const Composer& composer, const CompileDesc& with = desc()) const {
        const auto plan = test::must(composer.plan(with));
        auto out = test::must(composer.statistics(with));
        EXPECT_EQ(out.size(), plan.passes.size());
        for (std::size_t i = 0; i < std::min(out.size(), plan.passes.size()); ++i) {
            EXPECT_EQ(out[i].name, plan.passes[i].name);
            EXPECT_GT(out[i].value("Instructions"), 0);
            EXPECT_NE(out[i].machine_code.find("s_endpgm"), std::string::npos);
        }
        return out;
    }
    std::unique_ptr<Device> device;
};

TEST_F(ComposeStatistics, EachPassOfThePlanInEitherStage) {
    Composer composer(*device);
    for (const char* const effect : {"bloom", "tonemap", "encode"}) add(composer, effect);
    const auto compute = statistics(composer, desc(KernelStage::Compute));
    const auto raster = statistics(composer, desc(KernelStage::Raster));
    EXPECT_EQ(compute.front().workgroup, (std::array{8u, 16u})) << "bloom's first, of pairs of pixels";
    EXPECT_EQ(raster.front().workgroup, (std::array{1u, 1u}));
    const auto exports = [](const KernelStatistics& kernel) {
        return kernel.machine_code.find("exp mrt0") != std::string::npos;
    };
    EXPECT_TRUE(exports(raster.front())) << "the fragment shader, not the vertex shader";
    EXPECT_FALSE(exports(compute.front()));
}

TEST_F(ComposeStatistics, PassesSideBySideHaveTheirOwn) {
    for (const char* const effect : {"ssao", "volumetric"})
        if (find_effect(effect) == nullptr) GTEST_SKIP() << "this build has no " << effect;
    Composer composer(*device);
    for (const char* const effect : {"ssao", "volumetric"}) add(composer, effect);
    CompileDesc of_a_scene = desc();
    of_a_scene.depth = {VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_SAMPLED_BIT};
    of_a_scene.has_shadows = true;
    const auto plan = test::must(composer.plan(of_a_scene));
    ASSERT_LT(plan.rounds(), plan.passes.size());
    statistics(composer, of_a_scene);
}

TEST_F(ComposeStatistics, KernelsAreThoseOfThePresentSwitches) {
    Composer composer(*device);
    for (const char* const effect : {"tonemap", "encode"}) add(composer, effect);
    const double on = statistics(composer).back().value("Instructions");
    test::must(composer.set_enabled(*composer.find("tonemap"), false));
    EXPECT_LT(statistics(composer).back().value("Instructions"), on) << "lean: what is off is not in it";
}

TEST_F(ComposeStatistics, NothingIsCompiledToBeRecorded) {
    Composer composer(*device);
    add(composer, "tonemap");
    const auto now = composer.compile(desc());
    const auto later = composer.compile_later(desc());
    ASSERT_FALSE(now || later);
    EXPECT_EQ(now.error().fault, Fault::User);
    EXPECT_NE(now.error().text.find("compiles kernels only"), std::string::npos) << now.error().text;
    EXPECT_EQ(later.error().text, now.error().text);
}

TEST_F(ComposeStatistics, OtherDevicesHaveNone) {
    const Device assumed = Device::assumed();
    Composer composer(assumed);
    add(composer, "tonemap");
    const auto refused = composer.statistics(desc());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("created with compiles_only"), std::string::npos) << refused.error().text;
}

}  // namespace
}  // namespace darkroom
