// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/bloom.hpp>
#include <utility>
#include <vector>

#include "bloom/bloom_reference.hpp"
#include "bloom/bloom_test_pictures.hpp"
#include "compose/test_stacks/support.hpp"

namespace darkroom {
namespace {

using test::everything_glows;
using test::impulse;
using test::published;
using test::red_sum;

/// Writes down what build() declares.
class RecordingBuilder final : public PassBuilder {
  public:
    bool has_frame_image(FrameImage) const override { return false; }
    bool is_depth_planar() const override { return false; }
    bool is_velocity_plain() const override { return false; }
    PassImage shadow_map(std::uint32_t) override { return {}; }
    explicit RecordingBuilder(VkExtent2D extent) : extent_(extent) {}
    PassImage picture() override { return {0}; }
    PassImage source() override { return {1}; }
    [[nodiscard]] std::uint32_t from_max_extent(std::uint32_t (*question)(VkExtent2D)) override {
        return question(extent_);
    }
    [[nodiscard]] const void* parameters() const override { return &values_; }
    [[nodiscard]] bool is_stored(VkFormat format) const override { return format == stored; }
    PassImage create(const PassImageDesc& desc) override {
        images.push_back(desc);
        return {next_++};
    }
    History history(const PassImageDesc&) override { return {{next_++}, {next_++}}; }
    PassImage frame_image(FrameImage) override { return {next_++}; }
    PassImage shared(std::string_view, PassImage (*make)(PassBuilder&), ConditionFunction) override {
        return make(*this);
    }
    PassImage table(const TableDesc&) override { return {next_++}; }
    PassImage add(const KernelPassDesc& desc) override {
        passes.push_back(desc);
        return {next_++};
    }
    void side(std::string name, PassImage image, PassVector) override {
        side_name = std::move(name);
        side_image = image;
    }
    void result(PassImage) override {}

    VkFormat stored = VK_FORMAT_UNDEFINED;
    std::vector<PassImageDesc> images;
    std::vector<KernelPassDesc> passes;
    std::string side_name;
    PassImage side_image;

  private:
    VkExtent2D extent_;
    Bloom values_;
    std::uint32_t next_ = 2;
};

RecordingBuilder passes_of(VkExtent2D extent) {
    RecordingBuilder builder(extent);
    effect_info(Bloom{}).build(builder);
    return builder;
}

TEST(Bloom, LevelCountFollowsTheShorterSide) {
    struct Row {
        std::uint32_t width, height, levels;
    };
    for (const Row& row :
         {Row{1920, 1080, 5}, Row{1280, 720, 5}, Row{640, 360, 5}, Row{256, 256, 5}, Row{255, 255, 4}, Row{64, 64, 3},
          Row{32, 4000, 2}, Row{16, 16, 1}, Row{15, 4000, 0}, Row{1, 1, 0}, Row{0, 0, 0}, Row{16384, 16384, 5}}) {
        EXPECT_EQ(bloom_level_count({row.width, row.height}), row.levels) << row.width << "x" << row.height;
        if (row.levels > 0 && row.levels < 5) {
            const std::uint32_t last = std::min(row.width, row.height) >> row.levels;
            EXPECT_GE(last, 8u) << row.width << "x" << row.height;
        }
    }
}

TEST(Bloom, SoftThresholdFollowsTheTable) {
    constexpr std::array<std::array<double, 2>, 8> table{
        {{.5, 0}, {.75, .03125}, {1, .125}, {1.25, .28125}, {1.5, .5}, {2, 1}, {4, 3}, {10, 9}}};
    for (const auto& [brightness, expected] : table)
        EXPECT_NEAR(brightness * bloom_reference_threshold(brightness, 1, .5), expected, 2e-6) << brightness;
    EXPECT_EQ(bloom_reference_threshold(0.999, 1, 0), 0.0);
    EXPECT_NEAR(bloom_reference_threshold(3, 1, 0), 2.0 / 3, 1e-12);
    EXPECT_EQ(bloom_reference_threshold(0.25, 0, 0), 1.0);
}

TEST(Bloom, DeclaresThePyramid) {
    const RecordingBuilder full = passes_of({1920, 1080});
    ASSERT_EQ(full.images.size(), 1u);
    EXPECT_EQ(full.images[0].denominator, 2u);
    EXPECT_EQ(full.images[0].mip_levels, 5u);
    ASSERT_EQ(full.passes.size(), 9u);
    EXPECT_EQ(full.passes[0].inputs[0].image.index, 1u) << "reads the source, not the picture";
    constexpr std::array<std::uint32_t, 9> written{0, 1, 2, 3, 4, 3, 2, 1, 0};
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_EQ(full.passes[i].output_mip_level, written[i]);
        EXPECT_EQ(full.passes[i].is_additive, i > 4);
        if (i > 0) {
            EXPECT_EQ(full.passes[i].inputs[0].mip_level, written[i - 1]);
        }
    }
    EXPECT_EQ(full.side_name, "bloom_pyramid");

    const RecordingBuilder tiny = passes_of({15, 400});
    EXPECT_TRUE(tiny.images.empty());
    EXPECT_TRUE(tiny.passes.empty());
    EXPECT_EQ(tiny.side_name, "bloom_pyramid");
    EXPECT_EQ(tiny.side_image.index, PassImage{}.index);
}

TEST(Bloom, ThePyramidIsPackedWhereKernelsStoreIt) {
    EXPECT_EQ(passes_of({1920, 1080}).images[0].format, VK_FORMAT_R16G16B16A16_SFLOAT);
    RecordingBuilder builder({1920, 1080});
    builder.stored = VK_FORMAT_B10G11R11_UFLOAT_PACK32;
    effect_info(Bloom{}).build(builder);
    EXPECT_EQ(builder.images[0].format, VK_FORMAT_B10G11R11_UFLOAT_PACK32);
}

TEST(Bloom, SmallerFramesAndFewerLevelsSkipPasses) {
    const RecordingBuilder builder = passes_of({1920, 1080});
    const auto recorded = [&](VkExtent2D extent, const Bloom& bloom) {
        const PassContext context{.frame_extent = extent, .output_extent = extent};
        return std::count_if(builder.passes.begin(), builder.passes.end(), [&](const KernelPassDesc& pass) {
            return pass.condition(&bloom, context, pass.argument);
        });
    };
    EXPECT_EQ(recorded({1920, 1080}, published()), 9);
    EXPECT_EQ(recorded({400, 255}, published()), 7);
    EXPECT_EQ(recorded({16, 16}, published()), 1);
    EXPECT_EQ(recorded({15, 15}, published()), 0);
    EXPECT_EQ(recorded({1920, 1080}, published({.levels = 2})), 3);
    EXPECT_EQ(recorded({1920, 1080}, published({.levels = 1})), 1);
    EXPECT_EQ(recorded({1920, 1080}, {}), 9);
    EXPECT_EQ(recorded({960, 540}, {}), 7) << "half the height, a level less";
}

TEST(Bloom, AddedLevelsStayFiniteInHalfPrecision) {
    const RecordingBuilder builder = passes_of({1920, 1080});
    for (const BloomMode mode : {BloomMode::Additive, BloomMode::EnergyConserving})
        for (const std::int32_t levels : {1, 2, 3, 4, 5}) {
            const Bloom bloom{.mode = mode, .scatter = 1, .levels = levels};
            std::array<PassVector, 2> vectors{};
            builder.passes[0].constants(&bloom, {.frame_extent = {1920, 1080}}, vectors);
            // A flat field: what a level holds is rounded, and so is each sum; up, where a driver may choose.
            const auto written = [](double value) {
                return std::ldexp(std::ceil(std::ldexp(value, 10 - std::ilogb(value))), std::ilogb(value) - 10);
            };
            const double level = double{vectors[0][2]} * double{vectors[0][3]};
            double sum = 0;
            for (std::int32_t added = 0; added < levels; ++added) sum = written(written(level) + sum);
            EXPECT_LE(sum, 65504) << levels;
            EXPECT_GE(level * levels, 65504 * (1 - 0x1p-8)) << levels;
        }
}

TEST(Bloom, DownsampleHasTheCanonicalImpulseResponse) {
    // The 13 taps as the 36 texels they read: half a 4x4 box, half the product of (1 1 2 2 1 1) / 8 with itself.
    constexpr std::array<double, 6> box{0, .25, .25, .25, .25, 0}, wide{.125, .125, .25, .25, .125, .125};
    double sum = 0;
    for (std::uint32_t y = 0; y < 6; ++y)
        for (std::uint32_t x = 0; x < 6; ++x) {
            const double expected = .5 * box[x] * box[y] + .5 * wide[x] * wide[y];
            // Texel (16, 16) of the output covers 32 and 33 of the source.
            const ReferenceImage out = bloom_reference_down(impulse(64, 64, 30 + x, 30 + y, 1));
            EXPECT_NEAR(out.at(16, 16).r, expected, 1e-15) << x << "," << y;
            EXPECT_NEAR(red_sum(out), .25, 1e-14) << "every source texel counts alike";
            sum += out.at(16, 16).r;
        }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    EXPECT_EQ(bloom_reference_down(impulse(64, 64, 29, 32, 1)).at(16, 16).r, 0.0);
}

TEST(Bloom, UpsampleHasTheTentsImpulseResponse) {
    // At a quarter of a texel from the centre, three taps of weight 1 2 1 read four texels with 3 7 5 1 sixteenths.
    constexpr std::array<double, 8> expected{1, 3, 5, 7, 7, 5, 3, 1};
    ReferenceImage fine(32, 32);
    bloom_reference_add_up(fine, impulse(16, 16, 8, 8, 1), 1);
    for (std::uint32_t y = 0; y < 8; ++y)
        for (std::uint32_t x = 0; x < 8; ++x)
            EXPECT_NEAR(fine.at(13 + x, 13 + y).r, expected[x] * expected[y] / 256, 1e-15) << x << "," << y;
    EXPECT_NEAR(red_sum(fine), 4.0, 1e-14);

    ReferenceImage flat(31, 17, {2, 2, 2, 1});
    bloom_reference_add_up(flat, ReferenceImage(15, 8, {3, 3, 3, 1}), 0.5);
    for (const Rgba& color : flat.pixels) EXPECT_NEAR(color.r, 3.5, 1e-14);
}

TEST(Bloom, FireflyFilterKeepsFlatFieldsAndTamesLonePixels) {
    const auto kept = [](const Rgba& color) { return color; };
    for (const double level : {.18, 1.0, 5.0, 10.0, 50.0, 60000.0})
        for (const Rgba& color :
             bloom_reference_first(ReferenceImage(32, 32, {level, level, level, 1}), true, kept).pixels)
            EXPECT_NEAR(color.r, level, level * 1e-14);
    const ReferenceImage lone = impulse(64, 64, 32, 32, 1000);
    EXPECT_LT(red_sum(bloom_reference_first(lone, true, kept)),
              0.3 * red_sum(bloom_reference_first(lone, false, kept)));
}

TEST(Bloom, OddSizesKeepTheEnergy) {
    // The taps of all outputs form an even grid. Its step is a texel, or n / (n - 1) texels along an odd side: what a
    // texel counts for varies by 1 / (n - 1) with its place.
    constexpr std::array<std::array<std::uint32_t, 2>, 8> sizes{
        {{255, 255}, {255, 254}, {64, 255}, {63, 31}, {31, 31}, {17, 17}, {17, 30}, {16, 19}}};
    for (const auto& [width, height] : sizes) {
        const double scale = static_cast<double>(width) * height / ((width / 2) * static_cast<double>(height / 2));
        const double a = (width & 1) / (width - 1.0), b = (height & 1) / (height - 1.0);
        for (std::uint32_t y = height / 2 - 1; y < height / 2 + 2; ++y)
            for (std::uint32_t x = width / 2 - 2; x < width / 2 + 3; ++x) {
                const ReferenceImage out = bloom_reference_down(impulse(width, height, x, y, 1));
                EXPECT_NEAR(red_sum(out) * scale, 1.0, a + b + a * b + 1e-12)
                    << width << "x" << height << " " << x << "," << y;
            }
    }
}

TEST(Bloom, AdditiveGrowsByALevelEachAndTheOtherModeKeepsFlatFields) {
    const ReferenceImage flat = test::uniform(256, 256, {2, 1, .5, 1});
    for (const std::int32_t levels : {1, 3, 5}) {
        const ReferenceImage added = test::reference_of(everything_glows(levels), flat);
        EXPECT_NEAR(added.at(100, 7).r, 2.0 * (1 + levels), 1e-9);
        for (const float scatter : {0.0f, 0.7f, 1.0f}) {
            const Bloom bloom{
                .intensity = 0.5f, .mode = BloomMode::EnergyConserving, .scatter = scatter, .levels = levels};
            for (const Bloom& any : {bloom, published(bloom)})
                EXPECT_LT(test::worst_difference(test::reference_of(any, flat), flat), 1e-9)
                    << levels << " " << scatter;
        }
    }
}

TEST(Bloom, TheConservingModeKeepsTheLightOfALonePixel) {
    const Bloom bloom{.intensity = 1, .firefly_filter = true, .mode = BloomMode::EnergyConserving, .levels = 3};
    const ReferenceImage lone = impulse(256, 256, 128, 120, 500);
    EXPECT_NEAR(red_sum(test::reference_of(bloom, lone)), 500, 1e-6);
}

TEST(Bloom, GlowDoesNotDependOnTheAspectRatio) {
    ReferenceImage square = impulse(256, 256, 128, 128, 500), wide = impulse(512, 256, 128, 128, 500);
    const ReferenceImage a = test::reference_of(published(), square), b = test::reference_of(published(), wide);
    for (std::uint32_t y = 0; y < 256; ++y)
        for (std::uint32_t x = 0; x < 192; ++x) EXPECT_NEAR(a.at(x, y).r, b.at(x, y).r, 1e-9);
}

}  // namespace
}  // namespace darkroom
