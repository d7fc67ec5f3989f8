// SPDX-License-Identifier: MIT
// Verifying finds nothing on a driver that is right, and what is planted into kernels on their way to the driver.

#include "verify/verify.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <darkroom/effects.hpp>
#include <filesystem>

#include "gpu/device/context.hpp"
#include "verify/runner.hpp"
#include "verify/test_planted/module.hpp"

namespace darkroom::verify {
namespace {

/// A device whose driver compiles with a mistake. One at a time: the entry of the dispatch table has no other place for
/// what it is to plant.
class PlantedDevice {
  public:
    /// Kernels are those of a GPU, whichever the device is, or those of the device.
    explicit PlantedDevice(const test::Mistake& mistake, bool is_planned_for_gpu = false) {
        // A cache of its own: what is compiled wrongly stays out of the user's.
        Result<Device> made = Device::create(
            {.cache_folder = (std::filesystem::path(::testing::TempDir()) / "darkroom_planted").string()});
        EXPECT_TRUE(made) << made.error().text;
        if (!made) return;
        device_.emplace(std::move(*made));
        gpu::Context& context = device_->context();
        if (is_planned_for_gpu) context.traits.is_software = false;
        real = context.vk.CreateShaderModule;
        planted = &mistake;
        places = 0;
        context.vk.CreateShaderModule = create;
    }
    PlantedDevice(const PlantedDevice&) = delete;
    PlantedDevice& operator=(const PlantedDevice&) = delete;
    ~PlantedDevice() { planted = nullptr; }

    [[nodiscard]] Device& device() { return *device_; }
    /// Modules that it was planted into.
    [[nodiscard]] static std::size_t place_count() { return places; }

  private:
    static VkResult VKAPI_CALL create(VkDevice device, const VkShaderModuleCreateInfo* info,
                                      const VkAllocationCallbacks* allocator, VkShaderModule* out) {
        test::Module module(std::span(info->pCode, info->codeSize / sizeof(std::uint32_t)));
        if (!planted->plant(module)) return real(device, info, allocator, out);
        ++places;
        const std::vector<std::uint32_t> words = module.words();
        VkShaderModuleCreateInfo changed = *info;
        changed.codeSize = words.size() * sizeof(std::uint32_t);
        changed.pCode = words.data();
        return real(device, &changed, allocator, out);
    }

    static inline PFN_vkCreateShaderModule real = nullptr;
    static inline const test::Mistake* planted = nullptr;
    static inline std::atomic<std::size_t> places = 0;  ///< several threads build kernels
    std::optional<Device> device_;
};

Options quick(std::vector<std::string> effects, bool has_values = false) {
    return {.subjects = {.effects = std::move(effects), .has_choices = has_values, .random_sets = has_values ? 1U : 0U},
            .sizes = {{67, 41}},
            .makes_smaller = false};
}

class VerifyGpu : public ::testing::Test {
  protected:
    void SetUp() override {
        for (const char* const name : {"exposure", "negative", "sharpen"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    }
    static Report verified(Device& device, const Options& options) {
        Result<Report> report = run(device, options);
        EXPECT_TRUE(report) << report.error().text;
        return report ? std::move(*report) : Report{};
    }
    static const test::Mistake& mistake(std::string_view name) {
        return *std::ranges::find(test::mistakes(), name, &test::Mistake::name);
    }
};

TEST_F(VerifyGpu, FindsNothingWhereKernelsAreRight) {
    Result<Device> device = Device::create();
    ASSERT_TRUE(device) << device.error().text;
    Options options = quick({"exposure", "sharpen"});
    options.subjects.random_sets = 1;
    options.sizes.push_back({5, 3});
    for (const bool is_planned_for_gpu : {false, true}) {
        if (is_planned_for_gpu) device->context().traits.is_software = false;
        const Report report = verified(*device, options);
        for (const Finding& finding : report.findings) ADD_FAILURE() << text_of(finding);
        // Two effects as they are and with random values, and once more at the other size; two stages, complete and
        // lean.
        EXPECT_EQ(report.pictures, (4 + 2) * 4U);
        EXPECT_TRUE(is_planned_for_gpu || report.kernels >= 8);
        EXPECT_TRUE(report.not_tried.empty());
        EXPECT_TRUE(report.unchanged.empty());
    }
}

TEST_F(VerifyGpu, NamesKernelPixelAndTheLeastThatShowsIt) {
    PlantedDevice planted(mistake("half for float"));
    Options options = quick({"exposure"});
    options.makes_smaller = true;
    const Report report = verified(planted.device(), options);
    ASSERT_EQ(report.findings.size(), 4U) << "both stages, complete and lean";
    const Finding& finding = report.findings[0];
    EXPECT_EQ(finding.subject.name, "exposure");
    EXPECT_FALSE(finding.kernels.empty());
    EXPECT_EQ(finding.smallest_extent.width * finding.smallest_extent.height, 1U);
    EXPECT_GT(finding.worst.excess, 2);
    const std::string text = text_of(finding);
    for (const char* const part :
         {"exposure, compute, complete, 67x41: pixel (", "the reference says", "of 2747 pixels"})
        EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST_F(VerifyGpu, SaysWhatThereWasNoTimeFor) {
    Result<Device> device = Device::create();
    ASSERT_TRUE(device) << device.error().text;
    Options options = quick({"negative", "exposure"});
    options.seconds = 1e-9;
    const Report report = verified(*device, options);
    EXPECT_EQ(report.pictures, 0U);
    EXPECT_EQ(report.not_tried.size(), 4U) << "two effects in two stages";
}

TEST_F(VerifyGpu, ADeviceOfAHostIsRefused) {
    Device assumed = Device::assumed();
    EXPECT_FALSE(run(assumed, quick({"exposure"})));
}

// On a driver of the processor also in the kernels that a GPU gets, which lack its forms.
TEST_F(VerifyGpu, TwentyPlantedMistakesAreFoundByName) {
    ASSERT_EQ(test::mistakes().size(), 20U);
    const Result<Device> device = Device::create();
    ASSERT_TRUE(device) << device.error().text;
    for (const bool is_planned_for_gpu : {false, true}) {
        if (is_planned_for_gpu && !device->info().is_software) continue;
        std::size_t found = 0;
        for (const test::Mistake& mistake : test::mistakes()) {
            if (find_effect(mistake.effect) == nullptr) GTEST_SKIP() << "this build has no effect " << mistake.effect;
            SCOPED_TRACE(mistake.name);
            PlantedDevice planted(mistake, is_planned_for_gpu);
            Options options = quick({mistake.effect}, true);
            options.sizes = {mistake.extent};
            const Report report = verified(planted.device(), options);
            EXPECT_GT(PlantedDevice::place_count(), 0U) << "no kernel of " << mistake.effect << " has a place for it";
            const bool is_found =
                !report.findings.empty() && report.findings[0].subject.steps[0].info == find_effect(mistake.effect);
            found += is_found;
            std::printf("%s  %s: %s\n", is_found ? "found " : "MISSED", mistake.name,
                        is_found ? text_of(report.findings[0]).c_str() : mistake.effect);
        }
        EXPECT_GE(found, 19U) << (is_planned_for_gpu ? "of a GPU's kernels" : "of the device's kernels");
    }
}

// What is allowed follows from what may be rounded: little where floats are all there is, as much as the picture
// changes where a step of it is near.
TEST(VerifyExpectation, AllowsWhatRoundingMayMake) {
    const EffectInfo *const exposure = find_effect("exposure"), *const posterize = find_effect("posterize");
    if (exposure == nullptr || posterize == nullptr) GTEST_SKIP() << "this build lacks one of the two effects";
    const std::vector<SceneFrame> frames{SceneFrame({33, 21}, 0)};
    const auto expected = [&](const EffectInfo& info, const Precision& precision) {
        Subject subject{.name = "subject", .steps = {}};
        std::vector<std::uint32_t> words(info.parameters.defaults.begin(), info.parameters.defaults.end());
        if (info.name == "exposure") words[0] = std::bit_cast<std::uint32_t>(2.0F);
        subject.steps.push_back({&info, std::move(words)});
        Result<Expectation> made = expect(subject, frames, precision);
        EXPECT_TRUE(made);
        return std::move(*made);
    };
    const auto most = [](const Expectation& made) {
        double out = 0;
        for (std::size_t i = 0; i < made.picture.pixels.size(); ++i)
            out = std::max(out, made.allowance.pixels[i].g / (std::abs(made.picture.pixels[i].g) + 1));
        return out;
    };
    Expectation floats = expected(*exposure, {});
    EXPECT_EQ(floats.picture.at(3, 4).g, 2 * frames[0].color().at(3, 4).g);
    EXPECT_LT(floats.allowance.at(3, 4).g, 2e-3);
    const double of_halves = most(expected(*exposure, {.image_step = 0x1p-11, .passes = 2}));
    EXPECT_GT(of_halves, 8 * most(floats));
    EXPECT_GT(most(expected(*posterize, {.image_step = 0x1p-11, .passes = 1})), 0.1) << "a step is near somewhere";

    ReferenceImage made = floats.picture;
    EXPECT_EQ(difference(made, floats).pixels, 0U);
    made.at(7, 5).b *= 1.01;
    const Difference worst = difference(made, floats);
    EXPECT_EQ(worst.pixels, 1U);
    EXPECT_EQ(worst.x, 7U);
    EXPECT_EQ(worst.y, 5U);
    EXPECT_EQ(worst.channel, 2U);
    made.at(1, 1).r = std::nan("");
    EXPECT_EQ(difference(made, floats).pixels, 2U) << "no number is no picture";
}

TEST(VerifySubjects, HoldEveryEffectAndEveryChoice) {
    const std::vector<Subject> all = subjects();
    for (const EffectInfo* const info : all_effects()) {
        const auto of_effect = [&](const Subject& subject) {
            return std::ranges::any_of(subject.steps, [&](const Step& step) { return step.info == info; });
        };
        EXPECT_GE(std::ranges::count_if(all, of_effect), 1) << info->name;
    }
    const std::vector<Subject> again = subjects();
    ASSERT_EQ(all.size(), again.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].name, again[i].name);
        for (std::size_t step = 0; step < all[i].steps.size(); ++step)
            EXPECT_EQ(all[i].steps[step].words, again[i].steps[step].words) << all[i].name;
    }
}

TEST(VerifySubjects, AnotherSeedHasOtherValuesAtRandom) {
    const std::vector<Subject> first = subjects(), second = subjects({.seed = 2});
    ASSERT_EQ(first.size(), second.size());
    std::size_t random = 0, same = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
        if (first[i].name.find("[random ") == std::string::npos) continue;
        ASSERT_EQ(first[i].name, second[i].name);
        ++random;
        same += first[i].steps[0].words == second[i].steps[0].words ? 1U : 0U;
    }
    EXPECT_GT(random, 20U);
    EXPECT_LT(same, random / 4) << "effects with few values may draw the same";
}

}  // namespace
}  // namespace darkroom::verify
