// SPDX-License-Identifier: MIT
// Whole stacks against the truth: the GPU's chain beside the CPU references run one after the other, and the looks that
// are shipped.

#include <gtest/gtest.h>

#include <darkroom/look.hpp>
#include <filesystem>

#include "compose/reference_chain.hpp"
#include "compose/test_host.hpp"

namespace darkroom {
namespace {

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

/// Every flat effect in the documented order, or the other one, all on.
void fill_default(Composer& composer, bool is_documented) {
    std::vector<const EffectInfo*> flat;
    const auto rank = [&](const EffectInfo* info) {
        return is_documented ? info->flat.documented : info->flat.scene_linear;
    };
    for (const EffectInfo* const info : all_effects())
        if (rank(info) >= 0) flat.push_back(info);
    std::ranges::sort(flat, {}, rank);
    for (const EffectInfo* const info : flat) composer.add(*info, nullptr, {.source = scene_color});
}

void expect_is_the_reference(Composer& composer, VkFormat intermediate, double allowed_codes) {
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
    const auto expected = run_reference(composer, {.color = &picture, .time = 2.5, .frame_index = 150});
    ASSERT_TRUE(expected) << expected.error().text;
    EXPECT_LE(test::worst_codes(host.read_target(), expected->picture), allowed_codes);
    // Not only rounded alike.
    EXPECT_LE(test::worst_difference(host.read_target(), expected->picture), 0.5 / 255);
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
    for (const auto& file :
         std::filesystem::directory_iterator(std::filesystem::path(DARKROOM_SOURCE_FOLDER) / "looks"))
        if (file.path().extension() == ".toml") out.push_back(file.path());
    std::ranges::sort(out);
    return out;
}

TEST_F(ChainLooks, EveryShippedLookDevelopsAsItsReference) {
    ASSERT_FALSE(shipped_looks().empty());
    for (const std::filesystem::path& path : shipped_looks()) {
        SCOPED_TRACE(path.filename());
        const auto look = read_look(path, {.is_strict = true});
        ASSERT_TRUE(look) << look.error().text;
        Composer composer(gpu::test::device());
        test::must(apply(*look, composer));
        expect_is_the_reference(composer, VK_FORMAT_R32G32B32A32_SFLOAT, 1);
    }
}

TEST_F(ChainLooks, TheShippedOrdersGiveNoRemark) {
    for (const char* const order : {"documented", "scene_linear"}) {
        const auto look = parse_look(
            "[post_process]\norder = \"" + std::string(order) + "\"\nvignette_enabled = true\ndither_enabled = true\n",
            "a.toml", {.is_strict = true});
        ASSERT_TRUE(look) << look.error().text;
        Composer composer(gpu::test::device());
        test::must(apply(*look, composer));
        const auto plan = composer.plan({.max_extent = {320, 200}});
        ASSERT_TRUE(plan) << plan.error().text;
        EXPECT_TRUE(plan->remarks.empty()) << order << ": " << plan->remarks.front();
    }
}

}  // namespace
}  // namespace darkroom
