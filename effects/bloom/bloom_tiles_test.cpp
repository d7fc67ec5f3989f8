// SPDX-License-Identifier: MIT
// Bloom in four passes with tiles in shared memory: the bits of a kernel for each level.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/bloom.hpp>
#include <string>
#include <utility>
#include <vector>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

enum class Form { Tiles, Kernels };

/// Plans as a GPU does: with packed or half floats, and with shared memory or too little of it.
class AsGpu {
  public:
    AsGpu(Form form, bool is_packed) : traits_(gpu::test::context().traits) {
        gpu::Traits& traits = gpu::test::context().traits;
        traits.is_software = false;
        traits.has_extended_storage_formats &= is_packed;
        if (form == Form::Kernels) traits.max_shared_bytes = 1024;
    }
    AsGpu(const AsGpu&) = delete;
    AsGpu& operator=(const AsGpu&) = delete;
    ~AsGpu() { gpu::test::context().traits = traits_; }

  private:
    gpu::Traits traits_;
};

bool can_pack() {
    return gpu::test::context().traits.has_extended_storage_formats &&
           gpu::test::context().supports(VK_FORMAT_B10G11R11_UFLOAT_PACK32, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
}

std::vector<std::string> names_of(const Plan& plan) {
    std::vector<std::string> out;
    for (const PlanPass& pass : plan.passes) out.push_back(pass.name);
    return out;
}

/// What each of the frames becomes, with complete kernels and, `is_lean`, with lean ones.
std::vector<ReferenceImage> developed(const test::Host& host, std::span<const Bloom> blooms,
                                      std::span<const VkRect2D> regions, bool is_lean, Form form, bool is_packed) {
    const AsGpu gpu(form, is_packed);
    Composer composer(host.device);
    const auto bloom = composer.add(blooms.front());
    const auto plan = composer.compile(host.compile_desc());
    EXPECT_TRUE(plan) << plan.error().text;
    std::vector<ReferenceImage> out;
    for (const Bloom& values : blooms)
        for (const VkRect2D& region : regions) {
            test::must(composer.set(bloom, values));
            Frame frame = host.frame();
            frame.color.region = frame.target.region = region;
            test::must(host.record(composer, frame));
            if (is_lean) {
                composer.wait_for_kernels();
                test::must(host.record(composer, frame));
            }
            out.push_back(host.read_target());
        }
    return out;
}

/// The largest difference, as a part of the value.
double worst_part(const ReferenceImage& a, const ReferenceImage& b) {
    if (a.pixels.size() != b.pixels.size()) return 1e9;
    double worst = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Rgba &p = a.pixels[i], &q = b.pixels[i];
        for (const auto& [v, w] : {std::pair{p.r, q.r}, {p.g, q.g}, {p.b, q.b}})
            worst = std::max(worst, v == w ? 0.0 : std::abs(v - w) / std::max(std::abs(w), 1e-4));
    }
    return std::isfinite(worst) ? worst : 1e9;
}

/// Lights before black, so that nothing hides the least of what glows.
ReferenceImage picture_of(VkExtent2D extent) {
    ReferenceImage picture = test::random_hdr(extent.width, extent.height, extent.width);
    for (std::uint32_t y = 0; y < extent.height; ++y)
        for (std::uint32_t x = 0; x < extent.width; ++x)
            if ((x / 29 + y / 23) % 3 != 0) picture.at(x, y) = {0, 0, 0, 1};
    return test::round_to_float(picture);
}

/// Kernels round packed floats themselves, to a step of six bits another way where a compiler contracts otherwise;
/// halves the driver, which may cut off where shared memory takes the nearest.
void expect_the_same(VkExtent2D extent, std::span<const Bloom> blooms, std::span<const VkRect2D> regions) {
    const test::Host host(picture_of(extent));
    const auto compare = [&](bool is_lean, bool is_packed) {
        const auto tiles = developed(host, blooms, regions, is_lean, Form::Tiles, is_packed),
                   kernels = developed(host, blooms, regions, is_lean, Form::Kernels, is_packed);
        ASSERT_EQ(tiles.size(), kernels.size());
        const double allowed = !is_packed ? 9 * 0x1p-10 : gpu::test::is_lavapipe() ? 0 : 0x1p-6;
        for (std::size_t i = 0; i < tiles.size(); ++i)
            EXPECT_LE(worst_part(tiles[i], kernels[i]), allowed)
                << extent.width << "x" << extent.height << ", frame " << i << (is_packed ? ", packed" : ", halves")
                << (is_lean ? ", lean" : "");
    };
    compare(true, false);
    if (!can_pack()) return;
    compare(true, true);
    compare(false, true);
}

constexpr std::array blooms{
    Bloom{.intensity = 1, .threshold = 0.2f, .reach = Reach::Pixels},
    Bloom{.intensity = 1, .threshold = 0, .firefly_filter = false, .levels = 4, .reach = Reach::Pixels},
    Bloom{.intensity = 0.7f, .mode = BloomMode::EnergyConserving, .reach = Reach::Pixels},
    Bloom{.intensity = 1, .mode = BloomMode::EnergyConserving, .scatter = 1, .levels = 3, .reach = Reach::Pixels},
    Bloom{.intensity = 1, .threshold = 0.1f, .levels = 2, .reach = Reach::Pixels},
    Bloom{.intensity = 1, .levels = 1, .reach = Reach::Pixels},
    Bloom{.intensity = 1, .threshold = 0.2f},
    Bloom{.intensity = 0.7f, .mode = BloomMode::EnergyConserving},
};

}  // namespace

// Sides of 260 and 560 are those that take most neighbours: 37 rows of level 1, 33 of level 3.
TEST(BloomTilesGpu, MakeTheBitsOfAKernelForEachLevel) {
    constexpr std::array<VkRect2D, 1> whole{};
    constexpr std::array<VkExtent2D, 8> extents{
        {{1, 1}, {15, 40}, {33, 65}, {67, 101}, {257, 131}, {256, 256}, {261, 560}, {527, 300}}};
    for (const VkExtent2D extent : extents) expect_the_same(extent, blooms, whole);
}

// Frames of other sizes than the one that the pyramid was made for have fewer levels, and images that end inside.
TEST(BloomTilesGpu, MakeThemInRegionsOfSeveralSizes) {
    constexpr std::array<VkRect2D, 6> regions{{{{}, {300, 270}},
                                               {{3, 5}, {257, 131}},
                                               {{1, 0}, {65, 70}},
                                               {{17, 30}, {33, 40}},
                                               {{2, 2}, {7, 9}},
                                               {{0, 1}, {299, 268}}}};
    expect_the_same({300, 270}, blooms, regions);
}

// A height above 1080 has a sixth level, and one above 2160 a seventh: the wide ones are made as the fine ones are.
TEST(BloomTilesGpu, MakeTheBitsOfMoreThanFiveLevels) {
    constexpr std::array<VkRect2D, 2> regions{{{{}, {521, 1101}}, {{1, 2}, {515, 1000}}}};
    constexpr std::array by_height{Bloom{.intensity = 1, .threshold = 0.2f},
                                   Bloom{.intensity = 0.7f, .mode = BloomMode::EnergyConserving}};
    expect_the_same({521, 1101}, by_height, regions);
    constexpr std::array<VkRect2D, 1> whole{};
    expect_the_same({1024, 2170}, std::span(by_height).first(1), whole);
}

TEST(BloomTilesGpu, AreFourPassesBeforeTheJoin) {
    const AsGpu gpu(Form::Tiles, true);
    const auto plan_of = [](VkExtent2D extent, const Bloom& bloom = {}) {
        Composer composer(gpu::test::device());
        composer.add(bloom);
        const auto plan = composer.plan({.max_extent = extent});
        EXPECT_TRUE(plan) << plan.error().text;
        return names_of(*plan);
    };
    EXPECT_EQ(plan_of({1920, 1080}), (std::vector<std::string>{"bloom.prefilter", "bloom.downsample",
                                                               "bloom.wide levels", "bloom.upsample", "bloom"}));
    EXPECT_EQ(plan_of({3840, 2160}),
              (std::vector<std::string>{"bloom.prefilter", "bloom.downsample", "bloom.downsample 3",
                                        "bloom.wide levels 2", "bloom.upsample 2", "bloom.upsample", "bloom"}));
    EXPECT_EQ(plan_of({90, 70}),
              (std::vector<std::string>{"bloom.prefilter", "bloom.downsample", "bloom.upsample", "bloom"}));
    EXPECT_EQ(plan_of({40, 40}, {.reach = Reach::Pixels}),
              (std::vector<std::string>{"bloom.prefilter", "bloom.downsample 1", "bloom.upsample 0", "bloom"}));
}

TEST(BloomTilesGpu, WhereTheyDoNotPayThePlanSaysWhy) {
    const auto remarks = [](KernelStage kernels) {
        Composer composer(gpu::test::device());
        composer.add(Bloom{});
        const auto plan = composer.plan({.max_extent = {1920, 1080}, .kernels = kernels});
        EXPECT_TRUE(plan) << plan.error().text;
        EXPECT_EQ(plan->passes.size(), 10u);
        return plan->remarks.empty() ? std::string() : plan->remarks.front();
    };
    if (gpu::test::context().traits.is_software) {
        EXPECT_EQ(remarks(KernelStage::Auto),
                  "bloom has a pass for each step: shared memory does not pay on a software driver.");
    }
    {
        const AsGpu gpu(Form::Kernels, true);
        EXPECT_EQ(remarks(KernelStage::Auto),
                  "bloom has a pass for each step: it needs 11552 bytes of shared memory, and there are 1024.");
    }
    {
        const AsGpu gpu(Form::Tiles, true);
        gpu::test::context().traits.max_workgroup_invocations = 128;
        EXPECT_EQ(remarks(KernelStage::Auto),
                  "bloom has a pass for each step: it needs workgroups of 256 invocations, and 128 are allowed.");
    }
    const AsGpu gpu(Form::Tiles, true);
    EXPECT_EQ(remarks(KernelStage::Raster),
              "bloom has a pass for each step: compute kernels do not write its images here.");
}

}  // namespace darkroom
