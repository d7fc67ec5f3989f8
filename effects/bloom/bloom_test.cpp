// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <darkroom/effects/bloom.hpp>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "bloom/bloom_reference.hpp"
#include "compose/test_stacks/support.hpp"
#include "gpu/test_support.hpp"
#include "image/compare/flip.hpp"

namespace darkroom {
namespace {

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

ReferenceImage impulse(std::uint32_t width, std::uint32_t height, std::uint32_t x, std::uint32_t y, double value) {
    ReferenceImage image(width, height);
    image.at(x, y) = {value, value, value, 1};
    return image;
}

double red_sum(const ReferenceImage& image) {
    return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0,
                           [](double sum, const Rgba& color) { return sum + color.r; });
}

/// The glow alone, in the additive mode: everything glows, no firefly filter.
Bloom everything_glows(std::int32_t levels) {
    return {.intensity = 1, .threshold = 0, .soft_threshold = 0, .firefly_filter = false, .levels = levels};
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
    EXPECT_EQ(recorded({1920, 1080}, {}), 9);
    EXPECT_EQ(recorded({400, 255}, {}), 7);
    EXPECT_EQ(recorded({16, 16}, {}), 1);
    EXPECT_EQ(recorded({15, 15}, {}), 0);
    EXPECT_EQ(recorded({1920, 1080}, {.levels = 2}), 3);
    EXPECT_EQ(recorded({1920, 1080}, {.levels = 1}), 1);
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
            const ReferenceImage out = bloom_reference_down(impulse(64, 64, 30 + x, 30 + y, 1), false);
            EXPECT_NEAR(out.at(16, 16).r, expected, 1e-15) << x << "," << y;
            EXPECT_NEAR(red_sum(out), .25, 1e-14) << "every source texel counts alike";
            sum += out.at(16, 16).r;
        }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    EXPECT_EQ(bloom_reference_down(impulse(64, 64, 29, 32, 1), false).at(16, 16).r, 0.0);
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
    for (const double level : {.18, 1.0, 5.0, 10.0, 50.0, 60000.0})
        for (const Rgba& color : bloom_reference_down(ReferenceImage(32, 32, {level, level, level, 1}), true).pixels)
            EXPECT_NEAR(color.r, level, level * 1e-14);
    const ReferenceImage lone = impulse(64, 64, 32, 32, 1000);
    EXPECT_LT(red_sum(bloom_reference_down(lone, true)), 0.3 * red_sum(bloom_reference_down(lone, false)));
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
                const ReferenceImage out = bloom_reference_down(impulse(width, height, x, y, 1), false);
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
            EXPECT_LT(test::worst_difference(test::reference_of(bloom, flat), flat), 1e-9) << levels << " " << scatter;
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
    const ReferenceImage a = test::reference_of(Bloom{}, square), b = test::reference_of(Bloom{}, wide);
    for (std::uint32_t y = 0; y < 256; ++y)
        for (std::uint32_t x = 0; x < 192; ++x) EXPECT_NEAR(a.at(x, y).r, b.at(x, y).r, 1e-9);
}

/// What a write may lose: of the value, and of values below 2^-14. A packed channel is rounded, a half may be cut off.
struct Write {
    double relative = 0, absolute = 0;
};
constexpr Write half{0x1p-10, 0x1p-22}, six_bits{0x1p-7, 0x1p-20}, five_bits{0x1p-6, 0x1p-19};

/// The largest excess over what rounding can explain. The longest way through the pyramid has 2 * levels - 1 writes.
/// The final sum is float: 1e-6 of the value, and of the picture under it.
double worst_excess(const Bloom& bloom, const ReferenceImage& picture, const ReferenceImage& gpu,
                    bool is_packed = false) {
    const ReferenceImage expected = test::reference_of(bloom, picture);
    if (gpu.pixels.size() != expected.pixels.size()) return 1e9;
    const double writes = 2.0 * bloom.levels - 1;
    // Every pass may lose what a filtered fetch does of all light, and the glow hands that on as it does light.
    Bloom all = bloom;
    all.threshold = all.soft_threshold = 0;
    all.firefly_filter = false;
    const ReferenceImage filtered = test::reference_of(all, test::filter_loss(picture));
    double worst = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        const Rgba &want = expected.pixels[i], &got = gpu.pixels[i], &base = picture.pixels[i];
        const Rgba& lost = filtered.pixels[i];
        const auto check = [&](double w, double g, double b, const Write& write, double loss) {
            const double kept = bloom.mode == BloomMode::Additive ? b : b * (1.0 - bloom.intensity);
            const double allowed = std::abs(w - kept) * writes * write.relative +
                                   bloom.intensity * writes * write.absolute + (std::abs(w) + std::abs(b)) * 2e-6 +
                                   writes * loss;
            worst = std::max(worst, std::isfinite(g) ? std::abs(w - g) / allowed : 1e9);
        };
        check(want.r, got.r, base.r, is_packed ? six_bits : half, lost.r);
        check(want.g, got.g, base.g, is_packed ? six_bits : half, lost.g);
        check(want.b, got.b, base.b, is_packed ? five_bits : half, lost.b);
        if (got.a != static_cast<double>(static_cast<float>(base.a))) return 1e9;
    }
    return worst;
}

ReferenceImage developed(const Bloom& bloom, const ReferenceImage& picture, KernelStage kernels = KernelStage::Auto) {
    return test::develop([&](Composer& composer) { composer.add(bloom); }, picture, {.kernels = kernels});
}

TEST(BloomGpu, MatchesTheReference) {
    struct Case {
        std::uint32_t width, height;
        Bloom bloom;
    };
    const Bloom conserving{.intensity = 0.6f, .mode = BloomMode::EnergyConserving};
    for (const Case& c : {Case{256, 256, {.intensity = 0.5f}}, Case{255, 67, {.intensity = 0.5f}},
                          Case{301, 257, {.intensity = 2, .firefly_filter = false}},
                          Case{256, 300, everything_glows(2)}, Case{64, 64, everything_glows(1)},
                          Case{131, 97, conserving}, Case{16, 16, {}}, Case{15, 40, {}}, Case{15, 40, conserving}}) {
        const ReferenceImage picture = test::round_to_float(test::random_hdr(c.width, c.height, 11));
        EXPECT_LE(worst_excess(c.bloom, picture, developed(c.bloom, picture)), 1.0) << c.width << "x" << c.height;
    }
}

TEST(BloomGpu, BothStagesMatchTheReference) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(96, 70, 3));
    const Bloom bloom{.intensity = 1};
    for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster})
        EXPECT_LE(worst_excess(bloom, picture, developed(bloom, picture, kernels)), 1.0);
}

/// Lamps of several colours before a dim wall that grows brighter downward: smooth glows are where steps would show.
ReferenceImage lamps() {
    ReferenceImage out(256, 256);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const double wall = 0.02 + 0.1 * y / out.height;
            out.at(x, y) = {wall, wall * 0.9, wall * 0.8, 1};
            if (std::hypot(x - 50.0, y - 60.0) < 7) out.at(x, y) = {80, 70, 50, 1};
            if (std::hypot(x - 190.0, y - 80.0) < 7) out.at(x, y) = {40, 3, 2, 1};
            if (std::hypot(x - 110.0, y - 190.0) < 7) out.at(x, y) = {8, 10, 30, 1};
        }
    return test::round_to_float(out);
}

double flip_of(const ReferenceImage& a, const ReferenceImage& b) {
    const auto picture = [](const ReferenceImage& image) {
        Picture out(image.width, image.height);
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            const Rgba& color = image.pixels[i];
            const std::array channels{color.r, color.g, color.b, 1.0};
            for (std::size_t c = 0; c < 4; ++c) out.pixels[4 * i + c] = static_cast<float>(channels[c]);
        }
        return out;
    };
    const auto errors = flip(picture(a), picture(b), {.encoding = PictureEncoding::SceneLinear});
    return errors ? errors->mean : 1e9;
}

/// As on a device that is no software driver: by taps, in compute kernels, with a packed pyramid.
ReferenceImage developed_packed(const Bloom& bloom, const ReferenceImage& picture) {
    bool& is_software = gpu::test::context().traits.is_software;
    const bool before = std::exchange(is_software, false);
    ReferenceImage out = developed(bloom, picture);
    is_software = before;
    return out;
}

TEST(BloomGpu, ThePackedPyramidMatchesTheReference) {
    if (!gpu::test::context().supports(VK_FORMAT_B10G11R11_UFLOAT_PACK32, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT))
        GTEST_SKIP() << "the device cannot store packed floats";
    const ReferenceImage picture = test::round_to_float(test::random_hdr(301, 257, 3));
    for (const Bloom& bloom : {Bloom{.intensity = 1}, Bloom{.intensity = 0.6f, .mode = BloomMode::EnergyConserving}})
        EXPECT_LE(worst_excess(bloom, picture, developed_packed(bloom, picture), true), 1.0);
    const ReferenceImage flat = test::uniform(256, 256, {65504, 65504, 65504, 1});
    for (const Rgba& color : developed_packed(everything_glows(5), flat).pixels)
        EXPECT_NEAR(color.b, 2 * 65504.0, 65504.0 * 9 * 0x1p-6);
}

TEST(BloomGpu, ThePackedPyramidIsHardlySeen) {
    if (!gpu::test::context().supports(VK_FORMAT_B10G11R11_UFLOAT_PACK32, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT))
        GTEST_SKIP() << "the device cannot store packed floats";
    const ReferenceImage picture = lamps();
    const Bloom bloom{.intensity = 0.3f};
    const ReferenceImage expected = test::reference_of(bloom, picture);
    const double packed = flip_of(expected, developed_packed(bloom, picture));
    EXPECT_LT(packed, 0.01);
    // Fragment kernels blend, and never pack.
    EXPECT_LT(flip_of(expected, developed(bloom, picture, KernelStage::Raster)), packed) << "half floats";
}

/// Where loads are cheap, lean kernels read the texels under the taps one by one if every level is exactly half the one
/// above; the complete kernels, and lean ones of other sizes, filter.
TEST(BloomGpu, QuadsAndTapsMatchTheReference) {
    struct Case {
        std::uint32_t width, height;
        Bloom bloom;
    };
    const Bloom conserving{.intensity = 1, .mode = BloomMode::EnergyConserving, .scatter = 1};
    for (const Case& c :
         {Case{256, 512, {.intensity = 1}}, Case{256, 256, everything_glows(5)}, Case{64, 160, conserving},
          Case{32, 34, everything_glows(2)}, Case{32, 33, everything_glows(2)}, Case{33, 32, {.intensity = 1}}}) {
        const ReferenceImage picture = test::round_to_float(test::random_hdr(c.width, c.height, 7));
        for (const bool lean : {true, false})
            for (const KernelStage kernels : {KernelStage::Compute, KernelStage::Raster}) {
                const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(c.bloom); }, picture,
                                                         {.kernels = kernels, .wait_for_lean_kernels = lean});
                EXPECT_LE(worst_excess(c.bloom, picture, out), 1.0) << c.width << "x" << c.height << " lean " << lean;
            }
    }
}

TEST(BloomGpu, LightBelowZeroTakesFromItsNeighbours) {
    // Means are cleaned, not texels: of 8 and -4 a glow of 2 is left, and of 8 and -12 none.
    for (const std::uint32_t width : {64u, 65u}) {
        ReferenceImage picture = test::uniform(width, 64, {8, 8, 8, 1});
        for (std::uint32_t y = 0; y < 64; ++y)
            for (std::uint32_t x = y % 2; x < width; x += 2) picture.at(x, y) = {-4, -12, 0, 1};
        const ReferenceImage out = developed(everything_glows(1), picture);
        EXPECT_LE(worst_excess(everything_glows(1), picture, out), 1.0) << width;
        if (width == 65 || out.pixels.empty()) continue;
        EXPECT_NEAR(out.at(33, 32).r - picture.at(33, 32).r, 2.0, 0.01);
        EXPECT_EQ(out.at(33, 32).g - picture.at(33, 32).g, 0.0);
    }
}

// At all places in a quad: what pixels tell each other must not make more of it than filtering does.
TEST(BloomGpu, WhatIsNoNumberGlowsAsInTheReference) {
    const Bloom bloom = everything_glows(1);
    for (const double bad : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
        for (std::uint32_t i = 0; i < 16; ++i) {
            const std::uint32_t bad_x = 30 + i % 4, bad_y = 30 + i / 4;
            ReferenceImage picture = test::uniform(64, 64, {0.5, 2, 8, 1});
            picture.at(bad_x, bad_y).r = picture.at(bad_x, bad_y).g = bad;
            const ReferenceImage want = test::reference_of(bloom, picture);
            const ReferenceImage out = test::develop([&](Composer& composer) { composer.add(bloom); }, picture,
                                                     {.wait_for_lean_kernels = true});
            ASSERT_EQ(out.pixels.size(), want.pixels.size());
            for (std::uint32_t y = 0; y < 64; ++y)
                for (std::uint32_t x = 0; x < 64; ++x) {
                    if (x == bad_x && y == bad_y) continue;
                    EXPECT_NEAR(out.at(x, y).r / want.at(x, y).r, 1, 2e-3) << bad << ": " << x << "," << y;
                    EXPECT_NEAR(out.at(x, y).b / want.at(x, y).b, 1, 2e-3) << bad << ": " << x << "," << y;
                }
        }
}

TEST(BloomGpu, TheConservingModeKeepsTheLightOfALonePixel) {
    const Bloom bloom{.intensity = 1, .firefly_filter = true, .mode = BloomMode::EnergyConserving, .levels = 3};
    // Halves that are cut off at each of five writes.
    EXPECT_NEAR(red_sum(developed(bloom, impulse(256, 256, 128, 120, 500))), 500, 500 * 5 * 0x1p-10);
}

TEST(BloomGpu, IntensityZeroChangesNothing) {
    const ReferenceImage picture = test::round_to_float(test::random_hdr(64, 48, 5));
    EXPECT_EQ(test::worst_difference(developed({.intensity = 0}, picture), picture), 0.0);
}

TEST(BloomGpu, SymmetricPicturesStaySymmetric) {
    ReferenceImage picture(128, 128);
    for (const std::uint32_t x : {40u, 87u})
        for (const std::uint32_t y : {40u, 87u}) picture.at(x, y) = {300, 30, 3, 1};
    const ReferenceImage out = developed({.intensity = 1}, picture);
    ASSERT_EQ(out.pixels.size(), picture.pixels.size());
    // Sums in another order differ in the last bit before a store cuts off: one half step a write.
    for (std::uint32_t y = 0; y < 128; ++y)
        for (std::uint32_t x = 0; x < 128; ++x) {
            EXPECT_NEAR(out.at(x, y).r, out.at(127 - x, y).r, out.at(x, y).r * 7 * 0x1p-10);
            EXPECT_NEAR(out.at(x, y).r, out.at(x, 127 - y).r, out.at(x, y).r * 7 * 0x1p-10);
        }
}

TEST(BloomGpu, NanAndInfinityStayContained) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const std::uint32_t side : {256u, 255u}) {
        ReferenceImage picture = test::round_to_float(test::random_display(side, side, 9)), broken = picture;
        picture.at(100, 100) = {0, 0, 0, 1};
        broken.at(100, 100) = {nan, nan, nan, 1};
        const Bloom bloom = everything_glows(1);
        const ReferenceImage clean = developed(bloom, picture), out = developed(bloom, broken);
        ASSERT_EQ(out.pixels.size(), picture.pixels.size());
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x) {
                if (x == 100 && y == 100) continue;
                EXPECT_TRUE(std::isfinite(out.at(x, y).r)) << x << "," << y << " of " << side;
                // Three source texels of the filter, and two of the bilinear read of level 0.
                if (std::max(std::abs(int(x) - 100), std::abs(int(y) - 100)) > 6) {
                    EXPECT_EQ(out.at(x, y).r, clean.at(x, y).r);
                }
            }

        const ReferenceImage black = test::uniform(side, side, {0, 0, 0, 1});
        ReferenceImage bright = black;
        bright.at(100, 100) = {infinity, -infinity, 0, 1};
        for (const Bloom& values : {Bloom{}, everything_glows(4)}) {
            const ReferenceImage glow = developed(values, bright);
            ASSERT_EQ(glow.pixels.size(), black.pixels.size());
            for (std::uint32_t y = 0; y < side; ++y)
                for (std::uint32_t x = 0; x < side; ++x)
                    if (x != 100 || y != 100) {
                        EXPECT_TRUE(std::isfinite(glow.at(x, y).r) && glow.at(x, y).g == 0.0) << x << "," << y;
                    }
        }
    }
}

TEST(BloomGpu, HugeFieldsStayFinite) {
    const ReferenceImage flat = test::uniform(256, 256, {65504, 65504, 65504, 1});
    const ReferenceImage out = developed(everything_glows(5), flat);
    ASSERT_EQ(out.pixels.size(), flat.pixels.size());
    for (const Rgba& color : out.pixels) EXPECT_NEAR(color.r, 2 * 65504.0, 65504.0 * 9 * 0x1p-10);
}

}  // namespace
}  // namespace darkroom
