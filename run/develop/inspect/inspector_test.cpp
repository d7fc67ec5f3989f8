// SPDX-License-Identifier: MIT
// What an Inspector says of pixels is what stacks cut short behind each entry make.

#include "develop/inspect/inspector.hpp"

#include <darkroom/custom_effect.hpp>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using test::add;

constexpr VkExtent2D extent{41, 30};

/// Not finite in one column, and left out of nothing.
constexpr std::string_view breaker = R"(// @effect breaker: Makes a value that is not a number, in one place.
// @param int column = 20 in [0, 100]: Where.

vec4 breaker(vec4 color, Pixel pixel, Breaker parameters) {
    if (pixel.texel == ivec2(parameters.column, 12)) color.g = sqrt(-1.0 - abs(color.g));
    return color;
}
)";

/// Reads two pixels to the left and one above, whatever stands there.
constexpr std::string_view mover = R"(// @effect mover: Moves the picture.
// @touch warp

vec4 mover(Pixel pixel, Mover parameters) { return load_clamped(picture, pixel.texel - ivec2(2, 1)); }
)";

class ComposeInspector : public test::StackTest {
  protected:
    ComposeInspector() {
        const gpu::test::Pixels made = test::pixels_of(test::random_display(extent.width, extent.height, 9));
        pixels = made.rgba;
        input.extent = extent;
        input.color = pixels;
    }
    [[nodiscard]] Inspection probe(std::initializer_list<VkOffset2D> at) {
        const std::vector<VkOffset2D> places(at);
        auto made = prober.probe(composer, input, places);
        EXPECT_TRUE(made) << made.error().text;
        return made ? std::move(*made) : Inspection{};
    }
    /// Of the whole stack, as it is: every entry a pass, in floats.
    [[nodiscard]] ReferenceImage output() {
        test::Host host(test::image_of({extent.width, extent.height, pixels}));
        CompileDesc desc = host.compile_desc();
        desc.fuse = false;
        desc.encodes_target = false;
        test::must(composer.compile(desc));
        return host.run(composer);
    }

    Device& device = gpu::test::device();
    Composer composer{device};
    Prober prober{device, {}, 3};
    std::vector<float> pixels;
    DevelopInput input;
};

bool is_same(const PixelValue& value, const Rgba& pixel) {
    return value == PixelValue{static_cast<float>(pixel.r), static_cast<float>(pixel.g), static_cast<float>(pixel.b),
                               static_cast<float>(pixel.a)};
}

TEST_F(ComposeInspector, ValuesAreThoseOfShorterStacks) {
    const std::vector<std::function<void()>> steps{
        [&] {
            add(composer, "exposure", {{"exposure", 2}});
        },
        [&] {
            add(composer, "bloom", {{"intensity", 0.5}, {"threshold", 0.25}});
        },
        [&] {
            add(composer, "gaussian_blur", {{"radius", 3}}, {.opacity = 0.5f});
        },
        [&] { add(composer, "negative", {}, {.input = scene_color, .name = "side"}); },
        [&] {
            add(composer, "vignette", {{"intensity", 0.5}});
        },
        [&] { add(composer, "tonemap"); },
        [&] { add(composer, "encode"); },
        [&] { add(composer, "dither"); }};
    std::vector<ReferenceImage> outputs;
    for (const auto& step : steps) {
        step();
        outputs.push_back(output());
    }
    const Inspection seen = probe({{0, 0}, {40, 29}, {17, 12}});
    ASSERT_EQ(seen.pixels.size(), 3u);
    for (const InspectedPixel& pixel : seen.pixels) {
        const auto x = static_cast<std::uint32_t>(pixel.at.x), y = static_cast<std::uint32_t>(pixel.at.y);
        const PixelValue scene{pixels[(y * extent.width + x) * 4], pixels[(y * extent.width + x) * 4 + 1],
                               pixels[(y * extent.width + x) * 4 + 2], pixels[(y * extent.width + x) * 4 + 3]};
        EXPECT_EQ(pixel.scene, scene);
        ASSERT_EQ(pixel.entries.size(), steps.size());
        EXPECT_FALSE(pixel.born);
        for (std::size_t i = 0; i < steps.size(); ++i) {
            const InspectedEntry& entry = pixel.entries[i];
            EXPECT_TRUE(is_same(entry.after, outputs[i].at(x, y))) << entry.name << " at " << x << "," << y;
            const PixelValue before = i == 0 || entry.name == "side" ? scene : pixel.entries[i - 1].after;
            EXPECT_EQ(entry.before, before) << entry.name;
            double change = 0;
            for (std::size_t c = 0; c < 4; ++c)
                change = std::max(change, std::abs(double{entry.after[c]} - double{before[c]}));
            EXPECT_EQ(entry.change, change) << entry.name;
            EXPECT_EQ(entry.presence, EntryPresence::On) << entry.why;
        }
        EXPECT_EQ(pixel.entries[0].relative_change, 1) << "exposure doubles";
        EXPECT_EQ(pixel.entries[3].input, "scene");
        EXPECT_EQ(pixel.entries[4].input, "side");
        EXPECT_TRUE(pixel.entries[1].has_neighbours && pixel.entries[2].has_neighbours);
        EXPECT_FALSE(pixel.entries[0].has_neighbours || pixel.entries[4].has_neighbours);
        EXPECT_EQ(pixel.entries[4].domain, Domain::SceneLinear);
        EXPECT_EQ(pixel.entries[5].domain, Domain::DisplayLinear);
        EXPECT_EQ(pixel.entries[6].domain, Domain::Encoded);
    }
}

TEST_F(ComposeInspector, EditsAreFollowed) {
    const Handle exposure = add(composer, "exposure", {{"exposure", 2}});
    const Handle blur = add(composer, "gaussian_blur", {{"radius", 3}});
    add(composer, "dither");
    const VkOffset2D at{17, 12};
    const auto expect_last = [&](const char* what) {
        const InspectedPixel pixel = probe({at}).pixels.at(0);
        EXPECT_TRUE(is_same(pixel.entries.at(composer.size() - 1).after, output().at(17, 12))) << what;
        return pixel;
    };
    expect_last("as it was added");
    test::must(composer.set(exposure, "exposure", 3));
    expect_last("another value");
    test::must(composer.set_override(exposure, "exposure", "a test", std::vector{std::bit_cast<std::uint32_t>(5.0F)}));
    EXPECT_NEAR(expect_last("an override").entries[0].relative_change, 4, 1e-6);
    test::must(composer.set_enabled(exposure, false));
    EXPECT_EQ(expect_last("switched off").entries[0].why, "switched off");
    test::must(composer.set_enabled(exposure, true));
    test::must(composer.set_opacity(exposure, 0));
    EXPECT_EQ(expect_last("opacity 0").entries[0].why, "its opacity is 0");
    test::must(composer.set_opacity(exposure, 0.25F));
    expect_last("opacity");
    // One that has passes of its own, so that its opacity needs a compile.
    test::must(
        composer.add_layer({.name = "half", .values = {{blur, "opacity", {std::bit_cast<std::uint32_t>(0.5F)}}}}));
    expect_last("opacity that may move");
    test::must(composer.set_layer_weight("half", 1));
    expect_last("opacity that moves");
    composer.remove_layer("half");
    test::must(composer.move(blur, exposure));
    EXPECT_EQ(expect_last("another order").entries[0].name, "gaussian_blur");
    test::must(composer.remove(blur));
    EXPECT_EQ(expect_last("one less").entries.size(), 2u);
    if (find_effect("ssao") == nullptr) return;
    composer.add(*find_effect("ssao"), nullptr);
    const InspectedPixel pixel = expect_last("one that is left out");
    EXPECT_EQ(pixel.entries[2].presence, EntryPresence::LeftOut);
    EXPECT_TRUE(pixel.entries[2].why.starts_with("needs depth")) << pixel.entries[2].why;
    EXPECT_EQ(pixel.entries[2].change, 0);
}

TEST_F(ComposeInspector, WhatIsNotFiniteIsFoundWhereItIsBorn) {
    const CustomEffect broken = test::must(CustomEffect::parse(breaker, "breaker.glsl"));
    add(composer, "exposure", {{"exposure", 2}});
    composer.add(broken.info(), nullptr);
    add(composer, "vignette", {{"intensity", 0.5}});
    const InspectedPixel hit = probe({{20, 12}}).pixels.at(0);
    ASSERT_TRUE(hit.born);
    EXPECT_EQ(hit.entries[*hit.born].name, "breaker");
    EXPECT_TRUE(std::isinf(hit.entries[1].change));
    EXPECT_FALSE(probe({{21, 12}}).pixels.at(0).born);
    EXPECT_EQ(test::must(prober.find_birth(composer, input, {21, 12}))->entry, 1u);

    // What reads other pixels brings it there, where it looks as if that had made it.
    const CustomEffect moving = test::must(CustomEffect::parse(mover, "mover.glsl"));
    composer.add(moving.info(), nullptr);
    const InspectedPixel near = probe({{22, 13}}).pixels.at(0);
    ASSERT_TRUE(near.born);
    EXPECT_EQ(near.entries[*near.born].name, "mover");
    EXPECT_TRUE(near.entries[*near.born].has_neighbours);
    const auto birth = test::must(prober.find_birth(composer, input, {22, 13}));
    ASSERT_TRUE(birth && birth->entry);
    EXPECT_EQ(near.entries[*birth->entry].name, "breaker");
    EXPECT_EQ(birth->at.x, 20);
    EXPECT_EQ(birth->at.y, 12);
    EXPECT_EQ(birth->pixels, 1u);

    test::must(composer.set(*composer.find("breaker"), "column", 100));
    EXPECT_FALSE(probe({{22, 13}}).pixels.at(0).born);
    EXPECT_FALSE(test::must(prober.find_birth(composer, input, {22, 13})));
}

TEST_F(ComposeInspector, TablesOfTheStackAreCopied) {
    if (find_effect("lut") == nullptr) GTEST_SKIP() << "this build has no effect lut";
    ColorTable table{.size = 2};
    for (int i = 0; i < 8; ++i)
        for (int c = 0; c < 3; ++c) table.cube.push_back((i >> c & 1) != 0 ? 0.5F : 0.25F);
    const Resource resource = test::must(composer.define(table));
    const Handle lut = add(composer, "lut");
    for (const ParamInfo& row : composer.info(lut)->parameters.rows)
        if (row.kind == Kind::Resource) test::set_word(composer, lut, row.name, resource.id);
    const InspectedEntry entry = probe({{3, 4}}).pixels.at(0).entries.at(0);
    EXPECT_TRUE(is_same(entry.after, output().at(3, 4)));
    EXPECT_NE(entry.change, 0);
}

TEST_F(ComposeInspector, PicturesOfTheFrameBeforeBeginWithTheInspector) {
    add(composer, "exposure", {{"exposure", 2}});
    const Handle mix = composer.add(*find_effect("blend"), nullptr, {.name = "mix"});
    EntryDesc wires = *composer.desc(mix);
    wires.second = mix.previous();
    test::must(composer.rewire(mix, wires));
    std::vector<float> values;
    for (int frame = 0; frame < 3; ++frame) values.push_back(probe({{5, 5}}).pixels.at(0).entries.at(1).after[0]);
    EXPECT_NE(values[0], values[1]);
    // Looking for a birth runs the frame again: histories do not go on by that.
    EXPECT_FALSE(test::must(prober.find_birth(composer, input, {5, 5})));
    Prober other(device, {}, 1);
    const std::array<VkOffset2D, 1> at{{{5, 5}}};
    for (int frame = 0; frame < 4; ++frame)
        values.push_back(test::must(other.probe(composer, input, at)).pixels.at(0).entries.at(1).after[0]);
    EXPECT_EQ(probe({{5, 5}}).pixels.at(0).entries.at(1).after[0], values.back());
}

TEST_F(ComposeInspector, RecordingsInFlightHaveResultsOfTheirOwn) {
    test::Host host(test::image_of({extent.width, extent.height, pixels}));
    const Handle exposure = add(composer, "exposure", {{"exposure", 2}});
    Inspector inspector(device, {.frames_in_flight = 2, .view = host.compile_desc().target});
    test::must(inspector.update(composer, host.compile_desc(), host.frame()));
    test::must(inspector.wait());
    const std::array<VkOffset2D, 1> at{{{3, 2}}};
    std::vector<std::uint64_t> numbers;
    const InspectorView view{.entry = exposure, .target = test::image_ref(host.target)};
    for (const float value : {2.0F, 3.0F, 4.0F}) {
        test::must(composer.set(exposure, "exposure", double{value}));
        test::must(gpu::submit_and_wait(device.context(), "a test frame", [&](VkCommandBuffer commands) {
            Frame frame = host.frame();
            frame.frame_index = static_cast<std::uint64_t>(value);
            numbers.push_back(test::must(inspector.record(commands, composer, frame, at, {&view, 1})));
        }));
    }
    EXPECT_FALSE(inspector.result(0));
    EXPECT_FALSE(inspector.result(numbers[0]));
    for (const std::size_t i : {1u, 2u}) {
        const std::optional<Inspection> seen = inspector.result(numbers[i]);
        ASSERT_TRUE(seen);
        EXPECT_EQ(seen->frame_index, i + 2);
        EXPECT_NEAR(seen->pixels.at(0).entries.at(0).relative_change, static_cast<double>(i) + 1, 1e-6);
    }
    EXPECT_TRUE(is_same(inspector.result(numbers[2])->pixels[0].entries[0].after, host.read_target().at(3, 2)));
    EXPECT_FALSE(inspector.error());
}

}  // namespace
}  // namespace darkroom
