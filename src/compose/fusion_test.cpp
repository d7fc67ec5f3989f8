// SPDX-License-Identifier: MIT
// Fusion is invisible: random stacks give the same picture fused and unfused, in either stage, and every time.

#include <bit>
#include <random>

#include "compose/test_host.hpp"

namespace darkroom {
namespace {

using test::add;

class ComposeFusion : public test::StackTest {};

constexpr std::uint32_t stack_count = 10;

std::uint32_t below(std::mt19937& random, std::uint32_t limit) { return static_cast<std::uint32_t>(random() % limit); }
double between(std::mt19937& random, double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

/// Sane values: the widest ranges would make numbers that no chain of float pictures can hold.
void set_random(std::mt19937& random, Composer& composer, Handle handle) {
    for (const ParamInfo& row : composer.info(handle).parameters.rows) {
        std::array<std::uint32_t, 4> words{};
        for (std::uint32_t i = 0; i < std::min(row.words, 4u); ++i) {
            const double high = std::min(row.range.max, std::max(row.range.min * 4, 2.0));
            switch (row.kind) {
                case Kind::Toggle:
                    words[i] = below(random, 2);
                    break;
                case Kind::Choice:
                    words[i] = below(random, static_cast<std::uint32_t>(row.choices.size()));
                    break;
                case Kind::Int:
                    words[i] = static_cast<std::uint32_t>(
                        std::lround(between(random, row.range.min, std::min(row.range.max, 6.0))));
                    break;
                default:
                    words[i] = std::bit_cast<std::uint32_t>(static_cast<float>(between(random, row.range.min, high)));
            }
        }
        if (row.words <= 4) test::must(composer.set(handle, row.name, std::span(words).first(row.words)));
    }
    // Values that contradict each other are refused: take the defaults then.
    const EffectInfo& info = composer.info(handle);
    if (info.conflict == nullptr || info.conflict(composer.words(handle).data()).empty()) return;
    for (const ParamInfo& row : info.parameters.rows)
        test::must(composer.set(handle, row.name, info.parameters.defaults.subspan(row.word, row.words)));
}

/// Any of the entries before, the scene, or (default) the entry before.
Handle random_handle(std::mt19937& random, std::uint32_t entry) {
    const std::uint32_t pick = below(random, entry + 2);
    return pick == 0 ? Handle{} : pick == 1 ? scene_color : Handle{pick - 1};
}

void fill_random(std::uint32_t number, Composer& composer) {
    std::mt19937 random(number * 2654435761u + 17);
    const std::uint32_t entries = 2 + below(random, 5);
    const auto effects = all_effects();
    for (std::uint32_t i = 0; i < entries; ++i) {
        const EffectInfo& info = *effects[below(random, static_cast<std::uint32_t>(effects.size()))];
        Inputs inputs;
        if (below(random, 6) == 0) inputs.input = random_handle(random, i);
        if (below(random, 3) == 0) inputs.source = random_handle(random, i);
        if (below(random, 5) == 0) inputs.mask = random_handle(random, i);
        if (info.has_second) inputs.second = i == 0 ? scene_color : Handle{1 + below(random, i)};
        if (below(random, 3) == 0) inputs.opacity = static_cast<float>(between(random, 0, 1));
        if (below(random, 3) == 0) inputs.blend = static_cast<BlendMode>(below(random, 9));
        inputs.enabled = below(random, 8) != 0;
        set_random(random, composer, composer.add(info, nullptr, inputs));
    }
}

ReferenceImage picture_of(std::uint32_t number) {
    constexpr VkExtent2D sizes[] = {{64, 48}, {67, 41}, {1, 1}, {33, 2}, {97, 64}};
    const VkExtent2D size = sizes[number % std::size(sizes)];
    ReferenceImage picture = test::random_display(size.width, size.height, number);
    for (Rgba& pixel : picture.pixels) pixel = {pixel.r * 4.5 - 0.5, pixel.g * 4.5 - 0.5, pixel.b * 4.5 - 0.5, 1};
    return test::round_to_float(picture);
}

std::string names_of(std::uint32_t number) {
    Composer composer(gpu::test::device());
    fill_random(number, composer);
    std::string out = "stack " + std::to_string(number) + ":";
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Inputs& inputs = composer.inputs(composer.entry(i));
        const auto shown = [](Handle handle) {
            return handle == scene_color ? std::string("scene") : std::to_string(handle.id);
        };
        out += " " + inputs.name + "(in " + shown(inputs.input) + ", source " + shown(inputs.source) + ", second " +
               shown(inputs.second) + ", mask " + shown(inputs.mask) + ", opacity " + std::to_string(inputs.opacity) +
               ", blend " + std::to_string(static_cast<int>(inputs.blend)) + (inputs.enabled ? ")" : ", off)");
    }
    return out;
}

TEST_F(ComposeFusion, FusedAndUnfusedGiveTheSamePicture) {
    std::size_t fused_kernels = 0, unfused_kernels = 0;
    for (std::uint32_t number = 0; number < stack_count; ++number) {
        SCOPED_TRACE(names_of(number));
        const test::Host host(picture_of(number));
        Composer composer(host.device);
        fill_random(number, composer);
        CompileDesc desc = host.compile_desc();

        desc.kernels = KernelStage::Compute;
        const auto plan = composer.compile(desc);
        ASSERT_TRUE(plan) << plan.error().text;
        fused_kernels += plan->passes.size();
        const ReferenceImage fused = host.run(composer);
        EXPECT_EQ(test::worst_difference(host.run(composer), fused), 0) << "a second frame differs";

        desc.kernels = KernelStage::Raster;
        test::must(composer.compile(desc));
        const ReferenceImage raster = host.run(composer);
        if (host.device.info().is_software)
            EXPECT_EQ(test::worst_difference(raster, fused), 0) << "the stages differ";
        else
            EXPECT_LE(test::worst_codes(raster, fused), 1) << "the stages differ";

        desc.kernels = KernelStage::Auto;
        desc.fuse = false;
        const auto unfused_plan = composer.compile(desc);
        ASSERT_TRUE(unfused_plan) << unfused_plan.error().text;
        unfused_kernels += unfused_plan->passes.size();
        EXPECT_LE(test::worst_codes(host.run(composer), fused), 1) << "unfused differs";
    }
    EXPECT_LT(fused_kernels + 10, unfused_kernels) << "nothing was fused";
}

TEST_F(ComposeFusion, FiniteInputStaysFinite) {
    const ReferenceImage picture = test::round_to_half(test::random_hdr(45, 37, 3));
    const test::Host host(picture, VK_FORMAT_R16G16B16A16_SFLOAT);
    Composer composer(host.device);
    add(composer, "bloom", {{"intensity", 1}, {"threshold", 0}}, {.source = scene_color});
    const Handle bright = add(composer, "exposure", {{"exposure", 100}});
    add(composer, "gaussian_blur", {{"radius", 5}}, {.opacity = 0.5f});
    add(composer, "blend", {{"amount", 0.25}}, {.second = bright});
    add(composer, "tonemap");
    add(composer, "encode");
    add(composer, "dither", {{"intensity", 0.1}});
    add(composer, "vignette", {{"intensity", 1}});
    for (const bool is_fused : {true, false}) {
        CompileDesc desc = host.compile_desc();
        desc.intermediate = VK_FORMAT_R16G16B16A16_SFLOAT;
        desc.fuse = is_fused;
        test::must(composer.compile(desc));
        for (const Rgba& p : host.run(composer).pixels)
            ASSERT_TRUE(p.r >= 0 && p.r <= 1 && p.g >= 0 && p.g <= 1 && p.b >= 0 && p.b <= 1)
                << p.r << " " << p.g << " " << p.b;
    }
}

}  // namespace
}  // namespace darkroom
