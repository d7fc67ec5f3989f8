// SPDX-License-Identifier: MIT
#include "gpu/kernel/kernel.hpp"

#include <fmt/format.h>

#include <bit>
#include <limits>

#include "gpu/test_run.hpp"

namespace darkroom::gpu {

namespace {

using test::context;
using test::must;
using test::Picture;
using test::Pixels;

constexpr VkFormat half4 = VK_FORMAT_R16G16B16A16_SFLOAT;

Pixels scene(std::uint32_t width, std::uint32_t height) {
    return test::make_pixels(width, height, [](std::uint32_t x, std::uint32_t y) {
        const float a = std::sin(static_cast<float>(x * 7 + y * 13)) * 2.0F + 2.0F;
        return std::array{a, static_cast<float>(x) * 0.01F, static_cast<float>(y) * 0.013F + a * 0.1F, 1.0F};
    });
}

KernelSpec spec_of(std::string body, VkFormat output = half4) {
    return {.name = "test",
            .images = {{.name = "scene"}},
            .outputs = {output},
            .sub_texel_bits = context().traits.sub_texel_bits,
            .body = std::move(body)};
}

const std::array bodies{
    std::string("vec4 shade(Pixel pixel) { return load(scene, pixel.texel) * 1.7; }"),
    std::string("vec4 shade(Pixel pixel) { return sample_linear(scene, pixel.uv * 0.7 + 0.21); }"),
    std::string("vec4 shade(Pixel pixel) { return load_clamped(scene, pixel.texel * 3 - 20) + vec4(pixel.uv, 0, 0); }"),
    std::string("vec4 shade(Pixel pixel) { return gather_red(scene, pixel.uv + 0.003); }"),
    std::string("vec4 shade(Pixel pixel) {\n"
                "    vec3 x = sample_linear(scene, pixel.uv).rgb * exp(-length(pixel.uv - 0.5));\n"
                "    x = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);\n"
                "    return vec4(pow(x, vec3(1.0 / 2.2)), vec2(pixel.size).x / vec2(size(scene)).x);\n"
                "}"),
};

/// Of a run on whole pictures and of one between regions, each done twice so that additive kernels add.
std::array<std::vector<std::byte>, 2> bits_of(Stage stage, const KernelSpec& spec) {
    const Region output{.offset = {5, 3}, .extent = {31, 22}, .image = {53, 37}};
    const Region input{.offset = {11, 9}, .extent = {40, 21}, .image = {67, 41}};
    const std::unique_ptr<Kernel> kernel = must(Kernel::create(context(), spec, stage));
    std::array<std::vector<std::byte>, 2> results;
    for (const bool is_region : {false, true}) {
        Picture in = test::upload(context(), scene(67, 41), half4);
        Picture out = test::blank(context(), {53, 37}, spec.outputs[0]);
        test::Run run{.inputs = {&in}, .outputs = {&out}};
        if (is_region) run.output_region = output;
        if (is_region) run.input_regions = {input};
        test::run_kernel(context(), *kernel, run);
        test::run_kernel(context(), *kernel, run);
        results[is_region ? 1 : 0] = test::download_bytes(context(), out);
    }
    return results;
}

/// Of bytes at the same place.
int largest_difference(const std::array<std::vector<std::byte>, 2>& a, const std::array<std::vector<std::byte>, 2>& b) {
    int most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < a[i].size(); ++j)
            most = std::max(most, std::abs(std::to_integer<int>(a[i][j]) - std::to_integer<int>(b[i][j])));
    return most;
}

class GpuKernelStages : public ::testing::TestWithParam<VkFormat> {};

TEST_P(GpuKernelStages, GiveTheSameBits) {
    for (const std::string& body : bodies) {
        const KernelSpec spec = spec_of(body, GetParam());
        EXPECT_EQ(bits_of(Stage::Compute, spec), bits_of(Stage::Raster, spec)) << body;
    }
}

TEST_P(GpuKernelStages, GiveTheSameBitsWhenTheyAdd) {
    KernelSpec spec = spec_of(bodies.back(), GetParam());
    if (!context().supports(GetParam(), VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT))
        GTEST_SKIP() << "this device does not blend the format";
    const std::array<std::vector<std::byte>, 2> once = bits_of(Stage::Compute, spec);
    spec.is_additive = true;
    const std::array<std::vector<std::byte>, 2> twice = bits_of(Stage::Compute, spec);
    const std::array<std::vector<std::byte>, 2> blended = bits_of(Stage::Raster, spec);
    // Hardware blends with a precision no lower than the format's (Vulkan specification, "Blending"): a code of two
    // ways to round.
    if (!test::is_lavapipe() && GetParam() == VK_FORMAT_R8G8B8A8_UNORM)
        EXPECT_LE(largest_difference(twice, blended), 1);
    else
        EXPECT_EQ(twice, blended);
    EXPECT_NE(once, twice);
}

INSTANTIATE_TEST_SUITE_P(Formats, GpuKernelStages,
                         ::testing::Values(VK_FORMAT_R32G32B32A32_SFLOAT, half4, VK_FORMAT_R8G8B8A8_UNORM));

TEST(GpuKernel, FiltersByLoadsAsTheSamplerDoes) {
    KernelSpec by_fetches = spec_of(bodies[1], VK_FORMAT_R32G32B32A32_SFLOAT), by_loads = by_fetches;
    by_fetches.images.front().is_filtered_by_loads = true;
    by_loads.images.front().storage_format = half4;
    for (const Stage stage : {Stage::Compute, Stage::Raster}) {
        const auto sampled = bits_of(stage, spec_of(bodies[1], VK_FORMAT_R32G32B32A32_SFLOAT));
        for (const KernelSpec* const spec : {&by_fetches, &by_loads}) {
            const auto loaded = bits_of(stage, *spec);
            for (std::size_t run = 0; run < sampled.size(); ++run) {
                ASSERT_EQ(sampled[run].size(), loaded[run].size());
                float worst = 0;
                for (std::size_t at = 0; at < sampled[run].size(); at += sizeof(float)) {
                    float a = 0, b = 0;
                    std::memcpy(&a, &sampled[run][at], sizeof a);
                    std::memcpy(&b, &loaded[run][at], sizeof b);
                    worst = std::max(worst, std::abs(a - b));
                }
                // The scene's neighbours are up to 4 apart.
                EXPECT_LE(worst, 1e-4 + 2 * test::filter_step() * 4) << run;
            }
        }
    }
}

TEST(GpuKernel, LoadsTheRegionsOwnTexels) {
    const Pixels pixels = scene(32, 24);
    for (const Stage stage : {Stage::Compute, Stage::Raster}) {
        Picture in = test::upload(context(), pixels, VK_FORMAT_R32G32B32A32_SFLOAT);
        Picture out = test::blank(context(), {32, 24}, VK_FORMAT_R32G32B32A32_SFLOAT);
        const KernelSpec spec = spec_of(bodies[0], VK_FORMAT_R32G32B32A32_SFLOAT);
        const std::unique_ptr<Kernel> kernel = must(Kernel::create(context(), spec, stage));
        test::run_kernel(context(), *kernel,
                         {.inputs = {&in},
                          .outputs = {&out},
                          .input_regions = {{.offset = {8, 4}, .extent = {10, 12}, .image = {32, 24}}},
                          .output_region = {.offset = {2, 3}, .extent = {10, 12}, .image = {32, 24}}});
        const Pixels result = test::download(context(), out);
        EXPECT_EQ(result.at(2, 3)[0], pixels.at(8, 4)[0] * 1.7F);
        EXPECT_EQ(result.at(11, 14)[2], pixels.at(17, 15)[2] * 1.7F);
        EXPECT_EQ(result.at(1, 3)[3], 0.0F) << "outside the region";
        EXPECT_EQ(result.at(12, 14)[3], 0.0F) << "outside the region";
        EXPECT_EQ(result.at(11, 15)[3], 0.0F) << "outside the region";
    }
}

TEST(GpuKernel, FilteringDoesNotSeeWhatLiesOutsideTheRegion) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const Pixels pixels = test::make_pixels(33, 19, [](std::uint32_t x, std::uint32_t y) {
        const bool is_inside = x >= 7 && x < 20 && y >= 4 && y < 15;
        return is_inside ? std::array{1.0F, 1.0F, 1.0F, 1.0F} : std::array{infinity, infinity, infinity, infinity};
    });
    for (const Stage stage : {Stage::Compute, Stage::Raster}) {
        for (const std::string_view call : {"sample_linear", "gather_red"}) {
            Picture in = test::upload(context(), pixels, VK_FORMAT_R32G32B32A32_SFLOAT);
            Picture out = test::blank(context(), {40, 40}, VK_FORMAT_R32G32B32A32_SFLOAT);
            const std::string body =
                fmt::format("vec4 shade(Pixel pixel) {{ return {}(scene, pixel.uv * 1.6 - 0.3); }}", call);
            const std::unique_ptr<Kernel> kernel =
                must(Kernel::create(context(), spec_of(body, VK_FORMAT_R32G32B32A32_SFLOAT), stage));
            test::run_kernel(context(), *kernel,
                             {.inputs = {&in},
                              .outputs = {&out},
                              .input_regions = {{.offset = {7, 4}, .extent = {13, 11}, .image = {33, 19}}}});
            for (const float value : test::download(context(), out).rgba) ASSERT_EQ(value, 1.0F) << call;
        }
    }
}

// Hardware rounds coordinates to 1/256 of a texel and less: the four texels meant must be the same with that.
TEST(GpuKernel, GathersLieInsideTheRegionHoweverTheyAreRounded) {
    constexpr double rounding = 1 / 256.0;
    Picture in = test::upload(context(), scene(33, 19), VK_FORMAT_R32G32B32A32_SFLOAT);
    Picture out = test::blank(context(), {40, 40}, VK_FORMAT_R32G32B32A32_SFLOAT);
    const KernelSpec spec =
        spec_of("vec4 shade(Pixel pixel) { return vec4(darkroom_corner_scene(pixel.uv * 1.6 - 0.3), 0.0, 0.0); }",
                VK_FORMAT_R32G32B32A32_SFLOAT);
    const std::unique_ptr<Kernel> kernel = must(Kernel::create(context(), spec, Stage::Compute));
    test::run_kernel(context(), *kernel,
                     {.inputs = {&in},
                      .outputs = {&out},
                      .input_regions = {{.offset = {7, 4}, .extent = {13, 11}, .image = {33, 19}}}});
    const Pixels places = test::download(context(), out);
    for (std::uint32_t y = 0; y < 40; ++y)
        for (std::uint32_t x = 0; x < 40; ++x) {
            const double u = double{places.at(x, y)[0]} * 33 - 0.5, v = double{places.at(x, y)[1]} * 19 - 0.5;
            EXPECT_GE(u - rounding, 7);
            EXPECT_LT(u + rounding, 19) << "the texel at 20 is outside";
            EXPECT_GE(v - rounding, 4);
            EXPECT_LT(v + rounding, 14) << "the texel at 15 is outside";
        }
}

TEST(GpuKernel, ReadsMembersCustomVectorsAndStorageImages) {
    const KernelSpec spec{.name = "members",
                          .images = {{.name = "scene", .storage_format = half4}},
                          .outputs = {half4, VK_FORMAT_R8G8B8A8_UNORM},
                          .members = {{BlockMember::Type::Float, "gain"},
                                      {BlockMember::Type::Int, "count"},
                                      {BlockMember::Type::Vec4, "pair"},
                                      {BlockMember::Type::Uint, "flag"}},
                          .custom_vectors = 2,
                          .body =
                              "void shade(Pixel pixel, out vec4 result[2]) {\n"
                              "    result[0] = load(scene, pixel.texel) * gain + custom[1];\n"
                              "    result[1] = vec4(0.1 * float(count), pair.yz, flag == 7u ? 1.0 : 0.0);\n"
                              "}"};
    const auto word = [](float value) { return std::bit_cast<std::uint32_t>(value); };
    const std::vector<std::uint32_t> words{word(2.0F), 4, 0, 0, word(-1.0F), word(0.2F), word(0.6F), word(-1.0F), 7};
    for (const Stage stage : {Stage::Compute, Stage::Raster}) {
        Picture in = test::upload(context(),
                                  test::make_pixels(8, 8,
                                                    [](auto, auto) {
                                                        return std::array{1.0F, 2.0F, 3.0F, 4.0F};
                                                    }),
                                  half4);
        Picture first = test::blank(context(), {8, 8}, half4);
        Picture second = test::blank(context(), {8, 8}, VK_FORMAT_R8G8B8A8_UNORM);
        const std::unique_ptr<Kernel> kernel = must(Kernel::create(context(), spec, stage));
        test::run_kernel(context(), *kernel,
                         {.inputs = {&in},
                          .outputs = {&first, &second},
                          .custom = {{0, 0, 0, 0}, {10, 20, 30, 40}},
                          .words = words});
        EXPECT_EQ(test::download(context(), first).at(7, 7), (std::array{12.0F, 24.0F, 36.0F, 48.0F}));
        const std::array<float, 4> expected{0.4F, 0.2F, 0.6F, 1.0F};
        const std::array<float, 4> result = test::download(context(), second).at(3, 5);
        for (std::size_t channel = 0; channel < 4; ++channel) {
            EXPECT_NEAR(result[channel], expected[channel], 0.5 / 255.0 + 1e-5);
        }
    }
}

TEST(GpuKernel, ErrorsNameFileAndLineOfTheBody) {
    const KernelSpec spec =
        spec_of("#line 40 \"effects/bloom/bloom.glsl\"\nvec4 shade(Pixel pixel) {\n    return oops;\n}");
    const Result<std::unique_ptr<Kernel>> kernel = Kernel::create(context(), spec, Stage::Compute);
    ASSERT_FALSE(kernel);
    EXPECT_TRUE(kernel.error().text.starts_with("effects/bloom/bloom.glsl:41: 'oops'")) << kernel.error().text;
}

TEST(GpuKernel, PrefersTheMeasuredStageOnTheSoftwareDriver) {
    if (!context().traits.is_software) GTEST_SKIP() << "not the software driver";
    KernelSpec spec = spec_of(bodies[0], VK_FORMAT_R8G8B8A8_UNORM);
    EXPECT_EQ(preferred_stage(context(), spec), Stage::Raster);
    spec = {.name = "srgb", .outputs = {VK_FORMAT_R8G8B8A8_SRGB}};
    EXPECT_EQ(preferred_stage(context(), spec), Stage::Raster);
}

TEST(GpuKernel, UsableNamesTheFormatThatIsNot) {
    KernelSpec spec{.name = "store", .outputs = {VK_FORMAT_R8G8B8A8_SRGB}};
    const Result<> stored = usable(context(), spec, Stage::Compute);
    ASSERT_FALSE(stored);
    EXPECT_NE(stored.error().text.find("output 0 of format R8G8B8A8_SRGB"), std::string::npos) << stored.error().text;
    spec.outputs = {VK_FORMAT_R8G8B8A8_UNORM};
    EXPECT_TRUE(usable(context(), spec, Stage::Compute));
    spec.images = {{.name = "scene", .storage_format = VK_FORMAT_B8G8R8A8_UNORM}};
    const Result<> loaded = usable(context(), spec, Stage::Raster);
    ASSERT_FALSE(loaded);
    EXPECT_NE(loaded.error().text.find("\"scene\" of format B8G8R8A8_UNORM"), std::string::npos) << loaded.error().text;
}

/// Formats that a device writes by no storage image without a format, for the test below.
VkFormat& not_without_format() {
    static VkFormat format = VK_FORMAT_UNDEFINED;
    return format;
}

TEST(GpuKernel, AFormatThatIsNotWrittenWithoutItsNameIsRasterised) {
    if (!context().traits.has_storage_write_without_format) GTEST_SKIP() << "no format is";
    Dispatch& vk = context().vk;
    const auto real = vk.GetPhysicalDeviceFormatProperties2;
    vk.GetPhysicalDeviceFormatProperties2 = [](VkPhysicalDevice, VkFormat format, VkFormatProperties2* out) {
        auto* const own = static_cast<VkFormatProperties3*>(out->pNext);
        own->optimalTilingFeatures = VK_FORMAT_FEATURE_2_STORAGE_IMAGE_BIT;
        if (format != not_without_format())
            own->optimalTilingFeatures |= VK_FORMAT_FEATURE_2_STORAGE_WRITE_WITHOUT_FORMAT_BIT;
    };
    const KernelSpec spec = spec_of(bodies[0], VK_FORMAT_B8G8R8A8_UNORM);
    const bool is_storage = context().supports(VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
    EXPECT_EQ(usable(context(), spec, Stage::Compute).has_value(), is_storage);
    not_without_format() = VK_FORMAT_B8G8R8A8_UNORM;
    const Result<> refused = usable(context(), spec, Stage::Compute);
    EXPECT_EQ(preferred_stage(context(), spec), Stage::Raster);
    EXPECT_TRUE(usable(context(), spec_of(bodies[0], VK_FORMAT_R8G8B8A8_UNORM), Stage::Compute)) << "it has a name";
    vk.GetPhysicalDeviceFormatProperties2 = real;
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("B8G8R8A8_UNORM"), std::string::npos) << refused.error().text;
    EXPECT_NE(refused.error().text.find("without a format"), std::string::npos) << refused.error().text;
}

}  // namespace

}  // namespace darkroom::gpu
