// SPDX-License-Identifier: MIT
// Whole stacks against the truth: the GPU's chain beside the CPU references run one after the other, and the looks that
// are shipped.

#include <gtest/gtest.h>

#include <darkroom/effects/perturb.hpp>
#include <darkroom/look.hpp>
#include <filesystem>

#include "compose/test_stacks/host.hpp"
#include "develop/reference_chain.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

/// What is said of the stack, without what is of the device: which form of bloom pays there.
std::vector<std::string> remarks_of(const Plan& plan) {
    std::vector<std::string> out = plan.remarks;
    std::erase_if(out, [](const std::string& remark) { return remark.find("a pass for each step") != remark.npos; });
    return out;
}

using test::add;

class ChainReference : public test::StackTest {};
class ChainLooks : public test::StackTest {};

/// Light as scenes have it: dark parts, mid-tones and lights, in half floats.
ReferenceImage scene(std::uint32_t width, std::uint32_t height) {
    ReferenceImage picture = test::random_display(width, height, 21);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            Rgba& p = picture.at(x, y);
            const double shade = 0.02 + 0.9 * x / width, light = x % 31 == 5 && y % 17 == 3 ? 40 : 1;
            p = {p.r * shade * light, p.g * shade * light, p.b * shade * 0.5 * light, 1};
        }
    return test::round_to_half(picture);
}

/// Every flat effect in the documented order, or the other one, all on; but for fxaa, which compares pixels, and may
/// choose another neighbour where half floats round.
void fill_default(Composer& composer, bool is_documented) {
    std::vector<const EffectInfo*> flat;
    const auto rank = [&](const EffectInfo* info) {
        return is_documented ? info->flat.documented : info->flat.scene_linear;
    };
    for (const EffectInfo* const info : all_effects())
        if (rank(info) >= 0 && info->flat.starts_on && info->name != "fxaa") flat.push_back(info);
    std::ranges::sort(flat, {}, rank);
    for (const EffectInfo* const info : flat) composer.add(*info, nullptr, {.source = scene_color});
}

/// How many pixels beside its place a look's displacement may read where sines are no better than Vulkan asks: off by
/// 2^-11 ("Precision and Operation of SPIR-V Instructions"), and the ring has the square of a cosine.
double displacement_error(const Composer& composer) {
    double pixels = 0;
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle entry = composer.entry(i);
        if (composer.info(entry)->name != "perturb") continue;
        const void* const words = composer.words(entry).data();
        const Perturb& values = *static_cast<const Perturb*>(words);
        const float sines = std::max(std::abs(values.strength.x), std::abs(values.strength.y));
        pixels += 0x1p-11 * values.amount * (sines + 2 * std::abs(values.ring_strength));
    }
    return pixels;
}

/// What of the reference's pictures is nearest to `made`: of the picture as it is, and where the device filters less
/// precisely than the references, all between those of the picture with what a filtered fetch may lose taken off and
/// added.
ReferenceImage reference_near(const Composer& composer, const ReferenceImage& picture, const ReferenceImage& made) {
    const auto reference = [&](double sign) {
        ReferenceImage input = picture;
        const ReferenceImage loss = test::filter_loss(picture, displacement_error(composer));
        for (std::size_t i = 0; i < input.pixels.size(); ++i) {
            input.pixels[i].r += sign * loss.pixels[i].r;
            input.pixels[i].g += sign * loss.pixels[i].g;
            input.pixels[i].b += sign * loss.pixels[i].b;
        }
        return test::must(run_reference(composer, {.color = &input, .time = 2.5, .frame_index = 150})).picture;
    };
    ReferenceImage near = reference(0);
    if (gpu::test::filter_step() == 0) return near;
    const ReferenceImage less = reference(-1), more = reference(1);
    for (std::size_t i = 0; i < near.pixels.size(); ++i)
        for (double Rgba::*const c : {&Rgba::r, &Rgba::g, &Rgba::b}) {
            const auto [low, high] = std::minmax({near.pixels[i].*c, less.pixels[i].*c, more.pixels[i].*c});
            near.pixels[i].*c = std::clamp(made.pixels[i].*c, low, high);
        }
    return near;
}

void expect_is_the_reference(Composer& composer, VkFormat intermediate, double allowed_codes,
                             double allowed_unrounded = 0.5) {
    const ReferenceImage picture = scene(131, 77);
    const test::Host host(picture, VK_FORMAT_R16G16B16A16_SFLOAT);
    CompileDesc desc = host.compile_desc();
    desc.intermediate = intermediate;
    const auto plan = composer.compile(desc);
    ASSERT_TRUE(plan) << plan.error().text;
    Frame frame = host.frame();
    frame.time = 2.5;
    frame.frame_index = 150;
    test::must(host.record(composer, frame));
    const ReferenceImage expected = reference_near(composer, picture, host.read_target());
    EXPECT_LE(test::worst_codes(host.read_target(), expected), allowed_codes);
    // Not only rounded alike.
    EXPECT_LE(test::worst_difference(host.read_target(), expected), allowed_unrounded / 255);
}

TEST_F(ChainReference, TheDefaultOrders) {
    for (const bool is_documented : {true, false}) {
        SCOPED_TRACE(is_documented);
        Composer composer(gpu::test::device());
        fill_default(composer, is_documented);
        test::must(composer.set(*composer.find("bloom"), "intensity", 0.3));
        test::must(composer.set(*composer.find("exposure"), "exposure", 1.2));
        expect_is_the_reference(composer, VK_FORMAT_R16G16B16A16_SFLOAT, 1);
    }
}

/// A floor that rises to a wall with sky above it, a post before them, and a light from above that half a roof hides.
struct LitFloor {
    LitFloor() {
        camera.previous_view[12] += 0.25F;  // it goes to the side
        for (std::uint32_t y = 0; y < extent.height; ++y)
            for (std::uint32_t x = 0; x < extent.width; ++x) {
                const double v = (y + 0.5) / extent.height;
                const bool is_post = x > 30 && x < 42 && y > 16;
                const double behind = v < 0.2 ? 1e10 : v < 0.45 ? 18.0 : 3.6 / (v - 0.25);
                depth.at(x, y).r = double{static_cast<float>(is_post ? 4.5 : behind)};
            }
        // The cube of 40 m around the origin, from above: x and z go across, -y is the way of the light.
        light.light.world_to_cascade[0] = {0.05F, 0, 0, 0, 0, 0, -0.025F, 0, 0, 0.05F, 0, 0, 0, 0, 0.5F, 1};
        light.light.splits[0] = 1000;
        light.cascades = {{0, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1}};
    }
    [[nodiscard]] test::RunOptions options() const {
        return {.color = VK_FORMAT_R16G16B16A16_SFLOAT,
                .time = 2.5,
                .frame_index = 150,
                .depth = &depth,
                .camera = camera,
                .lights = {&light, 1}};
    }

    VkExtent2D extent{97, 61};
    ReferenceImage picture = scene(extent.width, extent.height), depth{extent.width, extent.height};
    Camera camera = test::look_at({0, 2, 6}, {0, 1, -4}, 1.0, 97.0 / 61);
    ReferenceLight light{.light = {.volumetric_intensity = 1}, .resolution = 4};
};

/// The references one after the other, each with all that the frame brings: bloom reads the scene in the documented
/// order, its own place's picture in the other. `swapped`: this entry and the next change places.
ReferenceImage references_in_turn(const Composer& composer, const LitFloor& floor, bool is_documented,
                                  std::size_t swapped) {
    ReferenceImage picture = floor.picture;
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const std::size_t taken = i == swapped ? i + 1 : i == swapped + 1 ? i - 1 : i;
        const Handle entry = composer.entry(taken);
        picture = composer.info(entry)->reference(composer.words(entry).data(),
                                                  {.picture = &picture,
                                                   .source = is_documented ? &floor.picture : &picture,
                                                   .depth = &floor.depth,
                                                   .lights = {&floor.light, 1},
                                                   .camera = floor.camera,
                                                   .time = 2.5,
                                                   .frame_index = 150});
    }
    return picture;
}

/// Mean over the pixels of their most different channel, in codes of 8 bits.
double mean_codes(const ReferenceImage& a, const ReferenceImage& b) {
    if (a.pixels.size() != b.pixels.size() || a.pixels.empty()) return 1e9;
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Rgba &p = a.pixels[i], &q = b.pixels[i];
        sum += std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)});
    }
    return 255 * sum / static_cast<double>(a.pixels.size());
}

using Names = std::vector<std::string>;
const Names documented_order{"radial_blur",
                             "chromatic_aberration",
                             "ssao",
                             "volumetric",
                             "motion_blur",
                             "bloom",
                             "exposure",
                             "color_grade",
                             "tonemap",
                             "fog",
                             "lens_distortion",
                             "encode",
                             "dither",
                             "vignette"};
const Names scene_linear_order{"ssao",
                               "volumetric",
                               "fog",
                               "motion_blur",
                               "radial_blur",
                               "chromatic_aberration",
                               "lens_distortion",
                               "exposure",
                               "bloom",
                               "color_grade",
                               "tonemap",
                               "vignette",
                               "encode",
                               "dither"};

/// The flat table with everything on at once, strong enough that each effect shows.
void fill_with_everything(Composer& composer, bool is_documented) {
    const std::string order = is_documented ? "documented" : "scene_linear";
    const auto look = parse_look("[post_process]\nfxaa_enabled = false\norder = \"" + order + R"("
radial_blur = 2
chromatic_aberration = 6
ssao_intensity = 4
ssao_radius = 1.5
volumetric_enabled = true
volumetric_density = 40
motion_blur_enabled = true
motion_blur_shutter_angle = 360
motion_blur_resolution = "full"
bloom_intensity = 1
bloom_threshold = 0.1
exposure = 1.3
fog_enabled = true
fog_density = 0.02
fog_end = 40
dither_enabled = true
dither_intensity = 0.05
vignette_enabled = true
vignette_intensity = 0.6
lens_distortion = 0.3
color_grade_temperature = 5500
color_grade_contrast = 1.3
)",
                                 "everything.toml", {.is_strict = true});
    ASSERT_TRUE(look) << look.error().text;
    test::must(apply(*look, composer));
}

class ChainEverything : public test::StackTest {
  protected:
    void SetUp() override {
        for (const std::string& name : documented_order)
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    }
};

TEST_F(ChainEverything, IsPlannedInBothOrders) {
    for (const bool is_documented : {true, false}) {
        Composer composer(gpu::test::device());
        fill_with_everything(composer, is_documented);
        const auto plan =
            composer.plan({.max_extent = {320, 200}, .depth = {VK_FORMAT_D32_SFLOAT}, .has_shadows = true});
        ASSERT_TRUE(plan) << plan.error().text;
        Names planned;
        for (const PlanPass& pass : plan->passes)
            planned.insert(planned.end(), pass.entries.begin(), pass.entries.end());
        EXPECT_EQ(planned, is_documented ? documented_order : scene_linear_order);
        EXPECT_TRUE(plan->left_out.empty()) << plan->left_out.front();
        EXPECT_EQ(remarks_of(*plan), std::vector<std::string>{});
    }
}

TEST_F(ChainEverything, IsItsReferencesInThatOrder) {
    const LitFloor floor;
    for (const bool is_documented : {true, false}) {
        SCOPED_TRACE(is_documented);
        Composer composer(gpu::test::device());
        fill_with_everything(composer, is_documented);
        const ReferenceImage made = test::develop([&](Composer& stack) { fill_with_everything(stack, is_documented); },
                                                  floor.picture, floor.options());
        // Occlusion chooses pixels to read, and may round to another one than its reference: few pixels then differ by
        // more than the half floats between kernels explain; a GPU's pyramid has fewer bits than those.
        const ReferenceImage expected = references_in_turn(composer, floor, is_documented, composer.size());
        const double error = mean_codes(made, expected);
        EXPECT_LE(error, gpu::test::filter_step() == 0 ? 0.04 : 0.08);
        EXPECT_LE(255 * test::worst_difference(made, expected), 4);
        // Only this order gives this picture, which filtering may hide in part. Volumetric light and what follows it
        // are both added, and where a lens bends light does not matter to a multiplier.
        const double clearly = gpu::test::filter_step() == 0 ? 2 : 1;
        for (std::size_t i = 0; i + 1 < composer.size(); ++i) {
            const std::string& name = composer.desc(composer.entry(i))->name;
            if (name == "volumetric" || name == "lens_distortion") continue;
            EXPECT_GT(mean_codes(made, references_in_turn(composer, floor, is_documented, i)), clearly * error)
                << name << " and what follows it";
        }
    }
}

TEST_F(ChainReference, WiresOpacityMasksAndModes) {
    Composer composer(gpu::test::device());
    const Handle exposed = add(composer, "exposure", {{"exposure", 1.5}});
    const Handle blurred =
        add(composer, "gaussian_blur", {{"radius", 3}}, {.opacity = 0.75f, .blend = BlendMode::Lighten});
    add(composer, "tonemap", {}, {.input = exposed});
    add(composer, "grayscale", {}, {.mask = blurred, .opacity = 0.5f});
    add(composer, "blend", {{"amount", 0.25}}, {.second = blurred, .blend = BlendMode::Screen});
    const Handle off = add(composer, "negative");
    test::must(composer.set_enabled(off, false));
    add(composer, "encode");
    expect_is_the_reference(composer, VK_FORMAT_R32G32B32A32_SFLOAT, 1);
}

// What a later entry reads must be the picture at that place, though the kernel could have gone on.
TEST_F(ChainReference, APictureInTheMiddleIsReadAsItWasThere) {
    for (const std::string_view wire : {"input", "source", "second", "mask"}) {
        SCOPED_TRACE(wire);
        Composer composer(gpu::test::device());
        const Handle middle = add(composer, "exposure", {{"exposure", 0.5}});
        add(composer, "negative");
        add(composer, "vignette", {{"intensity", 1}});
        if (wire == "input") add(composer, "grayscale", {}, {.input = middle});
        if (wire == "source") add(composer, "bloom", {{"intensity", 1}, {"threshold", 0.1}}, {.source = middle});
        if (wire == "second") add(composer, "blend", {}, {.second = middle});
        if (wire == "mask") add(composer, "grayscale", {}, {.mask = middle});
        add(composer, "encode");
        expect_is_the_reference(composer, VK_FORMAT_R32G32B32A32_SFLOAT, 1);
    }
}

TEST_F(ChainReference, AnEmptyStackIsEncoded) {
    const ReferenceImage picture = scene(40, 30);
    const test::Host host(picture, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R8G8B8A8_UNORM);
    Composer composer(host.device);
    test::must(composer.compile(host.compile_desc()));
    const auto expected = run_reference(composer, {.color = &picture});
    ASSERT_TRUE(expected);
    EXPECT_LE(test::worst_codes(host.run(composer), expected->picture), 1);
}

std::vector<std::filesystem::path> shipped_looks() {
    std::vector<std::filesystem::path> out;
    for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(test::source_folder) / "looks"))
        if (file.path().extension() == ".toml") out.push_back(file.path());
    std::ranges::sort(out);
    return out;
}

TEST_F(ChainLooks, EveryShippedLookDevelopsAsItsReference) {
    ASSERT_FALSE(shipped_looks().empty());
    for (const std::filesystem::path& path : shipped_looks()) {
        SCOPED_TRACE(path.filename());
        auto look = read_look(path, {.is_strict = true});
        ASSERT_TRUE(look) << look.error().text;
        // They follow an edge or do not, by less than kernels round, and have tests of their own.
        for (LookEntry& entry : look->entries)
            if (entry.effect->name == "fxaa" || entry.effect->name == "smaa") entry.state.enabled = false;
        Composer composer(gpu::test::device());
        test::must(apply(*look, composer));
        // A picture laid over its own negative has the error of its encoding twice: 0.503 codes.
        const bool is_twice = path.filename() == "composer_article.toml";
        expect_is_the_reference(composer, VK_FORMAT_R32G32B32A32_SFLOAT, 1, is_twice ? 0.6 : 0.5);
    }
}

std::filesystem::path shipped(const std::string& name) {
    return std::filesystem::path(test::source_folder) / "looks" / (name + ".toml");
}
/// By the references alone.
ReferenceImage developed(const Look& look, const ReferenceImage& picture, double time = 0.5) {
    Composer composer(gpu::test::device());
    test::must(apply(look, composer));
    return test::must(run_reference(composer, {.color = &picture, .time = time})).picture;
}

TEST_F(ChainLooks, DazeShimmerAndBlastWaveMoveThePictureThatIsThere) {
    const auto base = read_look(shipped("bright"), {.is_strict = true});
    ASSERT_TRUE(base) << base.error().text;
    const ReferenceImage picture = scene(131, 77), still = developed(*base, picture);
    for (const char* const name : {"daze", "heat_shimmer", "blast_wave"}) {
        SCOPED_TRACE(name);
        Look moved = *base;
        const Result<> laid = lay_over(moved, shipped(name), {.is_strict = true});
        ASSERT_TRUE(laid) << laid.error().text;
        const ReferenceImage out = developed(moved, picture);
        EXPECT_GT(test::worst_codes(out, still), 20);
        // It is the same picture, elsewhere: as bright, and with the glow of the look beneath.
        const auto mean = [](const ReferenceImage& of) {
            double sum = 0;
            for (const Rgba& p : of.pixels) sum += (p.r + p.g + p.b) / 3;
            return sum / static_cast<double>(of.pixels.size());
        };
        EXPECT_NEAR(mean(out), mean(still), 0.05 * mean(still));
        EXPECT_NE(test::worst_codes(out, developed(moved, picture, 0.7)), 0) << "it moves";
    }
}

/// Black but for a square of this light.
ReferenceImage spot(std::uint32_t x, std::uint32_t y, double light) {
    ReferenceImage out = test::uniform(480, 270, {0, 0, 0, 1});
    for (std::uint32_t i = 0; i < 64; ++i) out.at(x + i % 8, y + i / 8) = {light, light, light, 1};
    return out;
}

TEST_F(ChainLooks, ComposedRaysRunThroughTheLightsPlace) {
    const auto look = read_look(shipped("composed_rays"), {.is_strict = true});
    ASSERT_TRUE(look) << look.error().text;
    // To the right of the light's place, (240, 81), and as high.
    const ReferenceImage out = developed(*look, spot(356, 77, 50));
    const auto row = [&](std::uint32_t y, std::uint32_t first, std::uint32_t last) {
        double sum = 0;
        for (std::uint32_t x = first; x < last; ++x) sum += out.at(x, y).r;
        return sum / (last - first);
    };
    EXPECT_GT(row(81, 390, 430), 0.1) << "beyond it";
    EXPECT_GT(row(81, 310, 340), 0.1) << "before it";
    for (const std::uint32_t y : {30U, 51U, 111U, 150U}) EXPECT_LT(row(y, 310, 430), 0.01) << "beside it, line " << y;
    EXPECT_EQ(developed(*look, spot(356, 77, 0.4)).at(400, 81).r, 0) << "what is not bright throws none";
}

TEST_F(ChainLooks, PlainBloomIsBlackBelowItsThreshold) {
    const auto look = read_look(shipped("plain_bloom"), {.is_strict = true});
    ASSERT_TRUE(look) << look.error().text;
    const auto beside = [&](double light) { return developed(*look, spot(240, 120, light)).at(256, 124).r; };
    EXPECT_EQ(beside(0.99), 0);
    EXPECT_GT(beside(1.01), 0);
}

TEST_F(ChainLooks, TheShippedOrdersGiveNoRemark) {
    for (const char* const order : {"documented", "scene_linear"}) {
        const auto look = parse_look("[post_process]\norder = \"" + std::string(order) +
                                         "\"\nvignette_enabled = true\ndither_enabled = true\nfxaa_enabled = true\n",
                                     "a.toml", {.is_strict = true});
        ASSERT_TRUE(look) << look.error().text;
        Composer composer(gpu::test::device());
        test::must(apply(*look, composer));
        const auto plan = composer.plan({.max_extent = {320, 200}});
        ASSERT_TRUE(plan) << plan.error().text;
        EXPECT_EQ(remarks_of(*plan), std::vector<std::string>{}) << order;
    }
}

}  // namespace
}  // namespace darkroom
