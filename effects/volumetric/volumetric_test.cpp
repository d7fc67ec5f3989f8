// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <darkroom/effects/volumetric.hpp>
#include <limits>

#include "compose/test_stacks/support.hpp"
#include "gpu/test_run.hpp"
#include "plan/text/effect_files.hpp"
#include "shared/camera.hpp"
#include "volumetric/volumetric_reference.hpp"
#include "volumetric/volumetric_test_world.hpp"

namespace darkroom {
namespace {

using test::Box;
using test::open_light;
using test::traced_light;

constexpr std::uint32_t width = 64, height = 36;
/// As in the chapter.
constexpr Volumetric published{.decay = 0.98f, .decay_form = VolumetricDecay::PerStep};
constexpr Volumetric with(Volumetric volumetric, float density, std::int32_t samples = 32) {
    volumetric.density = density;
    volumetric.samples = samples;
    return volumetric;
}

/// A picture of one distance, seen by a narrow camera that looks along -z from the origin.
struct Flat {
    explicit Flat(double distance, std::uint32_t w = width, std::uint32_t h = height)
        : picture(w, h, {0, 0, 0, 0.5}), depth(w, h, {distance, 0, 0, 1}) {}
    ReferenceImage picture, depth;
    Camera camera = test::look_at({0, 0, 0}, {0, 0, -1}, 0.2, 16.0 / 9);
    std::vector<ReferenceLight> lights{open_light({0.6, 0, -0.8})};

    [[nodiscard]] test::RunOptions options() const { return {.depth = &depth, .camera = camera, .lights = lights}; }
    [[nodiscard]] ReferenceImage developed(const Volumetric& volumetric) const {
        return test::develop([&](Composer& composer) { composer.add(volumetric); }, picture, options());
    }
    [[nodiscard]] ReferenceImage reference(const Volumetric& volumetric) const {
        return test::scene_reference_of(volumetric, picture, options());
    }
};

double mean_red(const ReferenceImage& image) {
    double sum = 0;
    for (const Rgba& color : image.pixels) sum += color.r;
    return sum / static_cast<double>(std::max<std::size_t>(image.pixels.size(), 1));
}

double cosine_of(const ReferenceLight& light, const Camera& camera, double u, double v) {
    const test::CameraRay ray(ReferenceCamera(camera), u, v);
    const auto& d = light.light.direction;
    return test::dot(test::normalized(ray.direction), test::normalized({double{d[0]}, double{d[1]}, double{d[2]}}));
}

TEST(EffectVolumetric, PhaseHasItsKnownValues) {
    for (const auto& [cosine, phase] :
         {std::pair{-1.0, .004912}, {-0.5, .007516}, {0.0, .013640}, {0.5, .037211}, {0.9, .320293}, {1.0, 3.580986}})
        EXPECT_NEAR(volumetric_phase(cosine), phase, 1e-6) << cosine;
    // All directions together: nothing is lost.
    double sum = 0;
    constexpr int steps = 200000;
    for (int i = 0; i < steps; ++i) sum += volumetric_phase((i + 0.5) * 2 / steps - 1) * 2 / steps * 6.283185307179586;
    EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(EffectVolumetric, UnoccludedIsTheClosedForm) {
    // The documented numbers: 32 steps, each leaving 0.98.
    double by_hand = 0, left = 1;
    for (int i = 0; i < 32; ++i, left *= 0.98) by_hand += left * 2.5 * 0.01 * 3 * volumetric_phase(0.5) * (48.0 / 32);
    EXPECT_NEAR(volumetric_unoccluded(with(published, 2.5f), 3, 0.5, 48), by_hand, by_hand * 1e-6);
    const Flat flat(48);
    for (const Volumetric& volumetric :
         {Volumetric{}, Volumetric{.density = 3, .samples = 64}, Volumetric{.samples = 256, .decay = 0.9f}, published,
          with(published, 3, 7), Volumetric{.decay = 0.5f, .decay_form = VolumetricDecay::PerStep},
          Volumetric{.decay = 1}}) {
        const Rgba got = flat.reference(volumetric).at(32, 18);
        const double cosine = cosine_of(flat.lights[0], flat.camera, 32.5 / width, 18.5 / height);
        const double expected = volumetric_unoccluded(volumetric, 1, cosine, 48);
        EXPECT_NEAR(got.r, expected, expected * 0.005) << "neighbours, whose cosines differ, are mixed in";
        EXPECT_EQ(got.a, 0.5);
    }
}

TEST(EffectVolumetric, BrightnessDoesNotDependOnTheNumberOfSamples) {
    double lowest = 1e9, highest = 0;
    for (const std::int32_t samples : {16, 24, 32, 64, 128}) {
        const double value = volumetric_unoccluded(with(published, 1, samples), 1, 0.3, 100);
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
    }
    EXPECT_LT(highest / lowest, 1.02);
}

// The light of the first two metres is the same before a near wall and before a far one: a roof shades what is behind
// them. By steps it is not, which is what that form is for.
TEST(EffectVolumetric, LightNearTheEyeDoesNotDependOnWhereTheRayEnds) {
    const std::vector<Box> roof{{{-50, 3, -300}, {50, 4, -2}}};
    const auto of_wall = [&](double distance, const Volumetric& volumetric, bool is_gpu) {
        Flat flat(distance);
        flat.lights = {traced_light(roof, {0, 1, 0}, {{{0, 0, -100}, 110, 1000}}, 512)};
        return mean_red(is_gpu ? flat.developed(volumetric) : flat.reference(volumetric));
    };
    for (const bool is_gpu : {false, true}) {
        const Volumetric metres{.density = 100, .samples = 256, .decay = 0.9f};
        Volumetric steps = metres;
        steps.decay_form = VolumetricDecay::PerStep;
        EXPECT_NEAR(of_wall(10, metres, is_gpu) / of_wall(80, metres, is_gpu), 1, 0.03);
        EXPECT_LT(of_wall(10, steps, is_gpu) / of_wall(80, steps, is_gpu), 0.9);
    }
}

TEST(EffectVolumetric, DensityAndIntensityAreFactors) {
    Flat flat(30);
    const double one = mean_red(flat.reference({}));
    EXPECT_NEAR(mean_red(flat.reference({.density = 4})), 4 * one, 1e-9);
    flat.lights[0].light.volumetric_intensity = 5;
    EXPECT_NEAR(mean_red(flat.reference({})), 5 * one, 1e-9);
    EXPECT_LT(mean_red(flat.reference({.decay = 0.9f})), 5 * one);
}

TEST(EffectVolumetric, OffWithoutDensity) {
    const Volumetric off{.density = 0}, on;
    EXPECT_TRUE(effect_info(off).is_identity(&off));
    EXPECT_FALSE(effect_info(on).is_identity(&on));
}

TEST(EffectVolumetric, GpuUnoccludedIsTheClosedForm) {
    const Flat flat(48);
    for (const std::int32_t samples : {1, 16, 32, 128, 256}) {
        const Volumetric volumetric = with(published, 10, samples);
        const ReferenceImage out = flat.developed(volumetric);
        ASSERT_EQ(out.pixels.size(), flat.picture.pixels.size());
        const double cosine = cosine_of(flat.lights[0], flat.camera, 32.5 / width, 18.5 / height);
        const double expected = volumetric_unoccluded(volumetric, 1, cosine, 48);
        EXPECT_NEAR(out.at(32, 18).r, expected, expected * 0.006) << samples;
        EXPECT_EQ(out.at(32, 18).a, 0.5);
    }
}

TEST(EffectVolumetric, GpuKeepsItsBrightnessFromSixteenToAHundredAndTwentyEightSamples) {
    const Flat flat(60);
    const double few = mean_red(flat.developed({.density = 10, .samples = 16}));
    const double many = mean_red(flat.developed({.density = 10, .samples = 128}));
    EXPECT_GT(few, 0.01);
    EXPECT_NEAR(few / many, 1, 0.02);
}

TEST(EffectVolumetric, GpuScattersForward) {
    Flat flat(40);
    const auto toward = [&](const Double3& direction) {
        flat.lights = {open_light(direction)};
        return mean_red(flat.developed({.density = 10}));
    };
    const double facing = toward({0, 0.05, -1}), perpendicular = toward({1, 0, 0}), away = toward({0, 0.05, 1});
    EXPECT_GT(facing, 10 * perpendicular);
    EXPECT_GT(perpendicular, 2 * away);
    EXPECT_GT(away, 0);
}

TEST(EffectVolumetric, GpuStopsAtTheMaxDistanceAlsoInTheSky) {
    Volumetric volumetric = with(published, 10);
    volumetric.max_distance = 50;
    const double at_fifty = mean_red(Flat(50).developed(volumetric));
    for (const double distance : {200.0, 1e10, std::numeric_limits<double>::infinity()})
        EXPECT_NEAR(mean_red(Flat(distance).developed(volumetric)) / at_fifty, 1, 0.005) << distance;
    EXPECT_NEAR(mean_red(Flat(25).developed(volumetric)) / at_fifty, 0.5, 0.005);
}

TEST(EffectVolumetric, GpuEveryLightHasItsOwnColourAndIntensity) {
    Flat flat(40);
    flat.lights = {open_light({1, 0, 0}, 2), open_light({1, 0, 0}, 0), open_light({1, 0, 0}, 3),
                   open_light({1, 0, 0}, 1)};
    flat.lights[0].light.volumetric_color = {1, 0, 0};
    flat.lights[1].light.volumetric_color = {9, 9, 9};
    flat.lights[2].light.volumetric_color = {0, 1, 0};
    flat.lights[3].light.volumetric_color = {0, 0, 0.5f};
    const Rgba out = flat.developed({.density = 10}).at(30, 20);
    EXPECT_GT(out.r, 0.01);
    EXPECT_NEAR(out.g / out.r, 1.5, 0.005);
    EXPECT_NEAR(out.b / out.r, 0.25, 0.005);
}

/// Notes the passes that `build` declares.
class PassCatcher : public PassBuilder {
  public:
    PassImage picture() override { return {0}; }
    PassImage source() override { return {0}; }
    std::uint32_t from_max_extent(std::uint32_t (*question)(VkExtent2D)) override { return question({64, 64}); }
    const void* parameters() const override { return &volumetric; }
    PassImage create(const PassImageDesc&) override { return {0}; }
    History history(const PassImageDesc&) override { return {}; }
    PassImage frame_image(FrameImage) override { return {0}; }
    bool has_frame_image(FrameImage) const override { return true; }
    bool is_depth_planar() const override { return true; }
    bool is_velocity_plain() const override { return true; }
    PassImage shadow_map(std::uint32_t) override { return {0}; }
    PassImage shared(std::string_view, PassImage (*)(PassBuilder&), ConditionFunction condition) override {
        conditions.push_back({"shared", condition, 0});
        return {0};
    }
    PassImage table(const TableDesc&) override { return {0}; }
    PassImage add(const KernelPassDesc& desc) override {
        conditions.push_back({desc.name, desc.condition, desc.argument});
        return {0};
    }
    void side(std::string, PassImage, PassVector) override {}
    void result(PassImage) override {}

    struct Condition {
        std::string name;
        ConditionFunction holds;
        std::uint32_t argument;
    };
    std::vector<Condition> conditions;
    Volumetric volumetric;
};

/// How many passes a frame with lights of these intensities runs; negative: a light that casts no shadow.
std::size_t passes_run(std::initializer_list<float> intensities) {
    PassCatcher catcher;
    effect_info(catcher.volumetric).build(catcher);
    std::vector<Light> lights;
    for (const float intensity : intensities) {
        lights.push_back({.volumetric_intensity = std::abs(intensity), .cascade_count = 1});
        if (intensity >= 0) lights.back().cascades.view = reinterpret_cast<VkImageView>(std::uintptr_t{1});
    }
    std::size_t count = 0;
    for (const auto& [name, holds, argument] : catcher.conditions)
        if (holds(&catcher.volumetric, {.lights = lights}, argument)) ++count;
    return count;
}

TEST(EffectVolumetric, OnlyWhatIsNeededRuns) {
    constexpr std::size_t fixed = 3;  // half depth, two blurs
    EXPECT_EQ(passes_run({}), 0u);
    EXPECT_EQ(passes_run({0, 0}), 0u);
    EXPECT_EQ(passes_run({-5, -3}), 0u) << "without shadows no volumetric light";
    EXPECT_EQ(passes_run({1}), fixed + 1);
    EXPECT_EQ(passes_run({-5, 1}), fixed + 1);
    EXPECT_EQ(passes_run({1, 2, 0, 0}), fixed + 2);
    EXPECT_EQ(passes_run({1, 1, 1, 1, 1}), fixed + 4) << "four lights at most";
}

TEST(EffectVolumetric, GpuWithoutAVolumetricLightThePictureStaysAsItIs) {
    Flat flat(40);
    flat.picture = test::round_to_float(test::random_hdr(width, height, 3));
    flat.lights[0].light.volumetric_intensity = 0;
    EXPECT_EQ(test::worst_difference(flat.developed({.density = 50}), flat.picture), 0);
    flat.lights[0].light.volumetric_intensity = 4;
    flat.lights[0].light.volumetric_color = {0, 0, 0};
    EXPECT_EQ(test::worst_difference(flat.developed({.density = 50}), flat.picture), 0);
    flat.lights[0].light.volumetric_color = {1, 1, 1};
    EXPECT_EQ(test::worst_difference(flat.developed({.density = 0}), flat.picture), 0);
}

TEST(EffectVolumetric, GpuWithoutShadowsItIsLeftOutAndThePlanSaysSo) {
    Flat flat(40);
    flat.lights.clear();
    EXPECT_EQ(test::worst_difference(flat.developed({.density = 50}), flat.picture), 0);
    Composer composer(gpu::test::device());
    composer.add(Volumetric{});
    const auto plan = composer.plan({.max_extent = {64, 36}, .depth = {VK_FORMAT_D32_SFLOAT}, .has_shadows = false});
    ASSERT_TRUE(plan) << plan.error().text;
    ASSERT_FALSE(plan->left_out.empty());
    EXPECT_NE(plan->left_out.front().find("shadows"), std::string::npos) << plan->left_out.front();
}

TEST(EffectVolumetric, GpuHostileValuesAreHarmless) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const auto& [w, h] : {std::pair{1u, 1u}, {2u, 1u}, {7u, 5u}, {33u, 18u}}) {
        Flat flat(40, w, h);
        flat.lights.assign(4, open_light({0.1, 0.1, -1}, 1e6f));
        flat.lights[1].light.direction = {0, 0, 0};
        const std::array distances{nan, infinity, -infinity, 0.0, -3.0, 1e10, 40.0, 1e-30};
        for (std::size_t i = 0; i < flat.depth.pixels.size(); ++i)
            flat.depth.pixels[i].r = distances[(i * 5 + w) % distances.size()];
        for (const Volumetric& volumetric :
             {Volumetric{.density = 1000, .samples = 256, .max_distance = 1e6f}, Volumetric{.samples = 1},
              Volumetric{.density = 1000, .samples = 1, .max_distance = 0.01f, .decay = 0.01f}}) {
            const ReferenceImage out = flat.developed(volumetric);
            for (const Rgba& color : out.pixels) {
                ASSERT_TRUE(std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b))
                    << w << "x" << h;
                ASSERT_GE(color.r, 0);
            }
        }
    }
}

// Neutral images are of one texel: around it lies poison.
TEST(EffectVolumetric, NothingIsReadBeyondNeutralImages) {
    gpu::Context& context = gpu::test::context();
    std::string text;
    for (const EffectFile& file : shared_files())
        if (file.name == "shared/planar_distance.glsl") text += file.text;
    text += plan::own_text(effect_info(Volumetric{}), "volumetric.glsl").glsl;
    text.erase(text.find("#include"), text.find('\n', text.find("#include")) - text.find("#include"));
    for (const gpu::Stage stage : {gpu::Stage::Compute, gpu::Stage::Raster})
        for (const VkFormat storage : {VK_FORMAT_UNDEFINED, VK_FORMAT_R32G32B32A32_SFLOAT}) {
            const auto kernel = gpu::test::must(gpu::Kernel::create(
                context,
                {.name = "neutral",
                 .images = {{.name = "volumetric_depth", .storage_format = storage},
                            {.name = "volumetric_shafts", .storage_format = storage}},
                 .outputs = {VK_FORMAT_R32G32B32A32_SFLOAT},
                 .body = "struct Volumetric { float max_distance; };\n"
                         "vec4 volumetric_custom(int i) { return i == 0 ? vec4(1, 0, 0, 1) : vec4(1e10); }\n" +
                         text +
                         "\nvec4 shade(Pixel pixel) { return volumetric(vec4(0.5), pixel, Volumetric(100.0)); }\n"},
                stage));
            const auto poisoned = [&](const std::array<float, 4>& neutral) {
                return gpu::test::upload(
                    context,
                    gpu::test::make_pixels(width, height,
                                           [&](std::uint32_t x, std::uint32_t y) {
                                               return x == 0 && y == 0 ? neutral : std::array{7.0F, 7.0F, 7.0F, 7.0F};
                                           }),
                    VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_LAYOUT_GENERAL);
            };
            gpu::test::Picture depth = poisoned({7.0F, 0, 0, 0}), shafts = poisoned({0, 0, 0, 0});
            gpu::test::Picture out = gpu::test::blank(context, {width, height}, VK_FORMAT_R32G32B32A32_SFLOAT);
            const gpu::Region one{{}, {1, 1}, {width, height}};
            gpu::test::run_kernel(context, *kernel,
                                  {.inputs = {&depth, &shafts},
                                   .outputs = {&out},
                                   .input_regions = {{{}, {width, height}, {width, height}}, one}});
            for (const float value : gpu::test::download(context, out).rgba) ASSERT_EQ(value, 0.5F);
        }
}

// The constants of the passes and the reference come from cameras of their own.
TEST(EffectVolumetric, TheProductsCameraAgreesWithTheReferences) {
    std::vector<Camera> cameras{test::look_at({1, 2, 6}, {0, 1, -4}, 1.1, 1.6),
                                test::look_at({0, 9, 1}, {2, 0, 0}, 0.3, 0.7)};
    cameras[0].projection[8] = 0.07F;
    cameras[0].projection[9] = -0.03F;
    Camera flat = cameras[1];
    flat.projection = {0.2F, 0, 0, 0, 0, -0.3F, 0, 0, 0, 0, -0.01F, 0, 0.05F, -0.1F, 0, 1};
    cameras.push_back(flat);
    for (std::size_t i = 0; i < 3; ++i) {
        Camera up = cameras[i];
        up.is_y_down = false;
        up.projection[5] = -up.projection[5];
        up.projection[9] = -up.projection[9];
        up.projection[13] = -up.projection[13];
        cameras.push_back(up);
    }
    for (const Camera& camera : cameras) {
        const SolvedCamera product(camera);
        const ReferenceCamera reference(camera);
        EXPECT_EQ(product.is_perspective(), camera.projection[11] != 0);
        const auto expect_same = [](const auto& a, const auto& b) {
            for (std::size_t axis = 0; axis < a.size(); ++axis)
                EXPECT_NEAR(a[axis], b[axis], 1e-9 * std::max(1.0, std::abs(b[axis])));
        };
        expect_same(product.eye, reference.eye);
        for (const double planar : {0.5, 3.0, 800.0})
            for (const auto& [u, v] : {std::pair{0.5, 0.5}, {0.0, 0.0}, {0.9, 0.2}, {-0.5, 1.5}}) {
                const Vector3 view = product.view_position(u, v, planar);
                expect_same(view, reference.view_position(u, v, planar));
                expect_same(product.uv(view), std::array{u, v});
                expect_same(product.uv(view), reference.uv(view));
                expect_same(product.world_direction(view), reference.world_direction(view));
                expect_same(product.view_direction(view), reference.view_direction(view));
            }
    }
}

}  // namespace
}  // namespace darkroom
