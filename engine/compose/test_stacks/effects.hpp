// SPDX-License-Identifier: MIT
#pragma once
// For tests only: one small effect of every kind that a stack can hold, each with its reference, so that graphs of them
// reach what the shipped effects do not: domains that change with a toggle, results of another size. Not part of the
// library.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>

namespace darkroom::test {

struct Shift {
    std::int32_t pixels = 1;
};
struct Cross {
    Toggle is_wide = false;
    float amount = 1;
};
struct Glow {
    float amount = 0.5f;
};
struct Recode {
    Toggle is_encoded = true;
};
struct Absent {
    float amount = 1;
};
struct Halve {
    float amount = 1;
};

inline constexpr std::array<EffectFile, 7> test_effect_files{{
    {"shift.glsl",
     "vec4 shift(Pixel pixel, Shift parameters) {\n"
     "    return load_clamped(picture, pixel.texel + ivec2(parameters.pixels, 0));\n}\n"},
    {"cross_blur.glsl",
     "vec4 shade(Pixel pixel) {\n"
     "    Cross parameters = cross_parameters();\n"
     "    int reach = parameters.is_wide != 0u ? 2 : 1;\n"
     "    vec4 centre = load(cross_in, pixel.texel);\n"
     "    vec4 sum = load_clamped(cross_in, pixel.texel + ivec2(reach, 0)) +\n"
     "               load_clamped(cross_in, pixel.texel - ivec2(reach, 0)) +\n"
     "               load_clamped(cross_in, pixel.texel + ivec2(0, reach)) +\n"
     "               load_clamped(cross_in, pixel.texel - ivec2(0, reach));\n"
     "    return vec4(centre.rgb + parameters.amount * (0.25 * sum.rgb - centre.rgb), centre.a);\n}\n"},
    {"glow_source.glsl", "vec4 shade(Pixel pixel) { return 0.5 * load(glow_in, pixel.texel); }\n"},
    {"glow.glsl",
     "vec4 glow(vec4 color, Pixel pixel, Glow parameters) {\n"
     "    return vec4(color.rgb + parameters.amount * sample_linear(glow_side, pixel.uv).rgb, color.a);\n}\n"},
    {"recode.glsl",
     "vec4 recode(vec4 color, Pixel pixel, Recode parameters) {\n"
     "    vec3 light = clamp(color.rgb, 0.0, 1.0);\n"
     "    return vec4(parameters.is_encoded != 0u ? sqrt(light) : light * light, color.a);\n}\n"},
    {"absent.glsl", "vec4 absent(vec4 color, Pixel pixel, Absent parameters) { return vec4(0.0); }\n"},
    {"halve_down.glsl",
     "vec4 shade(Pixel pixel) {\n"
     "    vec4 color = load_clamped(halve_in, 2 * pixel.texel + 1);\n"
     "    return vec4(color.rgb * halve_parameters().amount, color.a);\n}\n"},
}};

inline ReferenceImage shift_reference(const void* parameters, const ReferenceInput& input) {
    ReferenceImage out = *input.picture;
    const auto pixels = static_cast<std::uint32_t>(static_cast<const Shift*>(parameters)->pixels);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            out.at(x, y) = input.picture->at(std::min(x + pixels, out.width - 1), y);
    return out;
}

inline ReferenceImage cross_reference(const void* parameters, const ReferenceInput& input) {
    const Cross& cross = *static_cast<const Cross*>(parameters);
    const ReferenceImage& picture = *input.picture;
    ReferenceImage out = picture;
    const int reach = cross.is_wide ? 2 : 1;
    const auto at = [&](int x, int y) {
        return picture.at(static_cast<std::uint32_t>(std::clamp(x, 0, static_cast<int>(out.width) - 1)),
                          static_cast<std::uint32_t>(std::clamp(y, 0, static_cast<int>(out.height) - 1)));
    };
    for (int y = 0; y < static_cast<int>(out.height); ++y) {
        for (int x = 0; x < static_cast<int>(out.width); ++x) {
            const std::array around{at(x + reach, y), at(x - reach, y), at(x, y + reach), at(x, y - reach)};
            Rgba& pixel = out.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
            for (double Rgba::*const channel : {&Rgba::r, &Rgba::g, &Rgba::b}) {
                double sum = 0;
                for (const Rgba& neighbour : around) sum += neighbour.*channel;
                pixel.*channel += double{cross.amount} * (0.25 * sum - pixel.*channel);
            }
        }
    }
    return out;
}

inline ReferenceImage glow_reference(const void* parameters, const ReferenceInput& input) {
    ReferenceImage out = *input.picture;
    const double amount = 0.5 * double{static_cast<const Glow*>(parameters)->amount};
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        Rgba& pixel = out.pixels[i];
        const Rgba& light = input.source->pixels[i];
        pixel = {pixel.r + amount * light.r, pixel.g + amount * light.g, pixel.b + amount * light.b, pixel.a};
    }
    return out;
}

inline Rgba recode_reference(Rgba color, const ReferencePixel&, const Recode& recode) {
    const auto coded = [&](double value) {
        const double light = std::clamp(value, 0.0, 1.0);
        return recode.is_encoded ? std::sqrt(light) : light * light;
    };
    return {coded(color.r), coded(color.g), coded(color.b), color.a};
}

inline ReferenceImage halve_reference(const void* parameters, const ReferenceInput& input) {
    const ReferenceImage& picture = *input.picture;
    const double amount{static_cast<const Halve*>(parameters)->amount};
    ReferenceImage out(std::max(1u, picture.width / 2), std::max(1u, picture.height / 2));
    for (std::uint32_t y = 0; y < out.height; ++y) {
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const Rgba& p = picture.at(std::min(2 * x + 1, picture.width - 1), std::min(2 * y + 1, picture.height - 1));
            out.at(x, y) = {p.r * amount, p.g * amount, p.b * amount, p.a};
        }
    }
    return out;
}

inline constexpr auto shift_rows = describe(field<&Shift::pixels>("How far to look to the right.", {1, 3}));
inline constexpr auto cross_rows = describe(field<&Cross::is_wide>("Two pixels away, not one."),
                                            field<&Cross::amount>("How much of the average is seen.", {0, 1}));
inline constexpr auto glow_rows = describe(field<&Glow::amount>("How much is added.", {0, 1}));
inline constexpr auto recode_rows = describe(field<&Recode::is_encoded>("A root, else a square."));
inline constexpr auto absent_rows = describe(field<&Absent::amount>("Nothing.", {0, 1}));
inline constexpr auto halve_rows = describe(field<&Halve::amount>("How bright it gets.", {0, 1}));

/// A warp.
inline const EffectInfo shift_effect{.name = "shift",
                                     .doc = "Moves the picture.",
                                     .parameters = shift_rows.table(),
                                     .files = test_effect_files,
                                     .touch = Touch::Warp,
                                     .reference = shift_reference};
/// A result of its own, of the picture's size.
inline const EffectInfo cross_effect{
    .name = "cross",
    .doc = "Averages four neighbours.",
    .parameters = cross_rows.table(),
    .files = test_effect_files,
    .touch = Touch::Neighbourhood,
    .build =
        [](PassBuilder& builder) {
            builder.result(
                builder.add({.name = "blur",
                             .shader = "cross_blur.glsl",
                             .inputs = {{.name = "cross_in", .image = builder.picture()}},
                             .output = builder.create({.name = "blurred", .format = VK_FORMAT_R32G32B32A32_SFLOAT})}));
        },
    .reference = cross_reference};
/// A pass and a pointwise end.
inline const EffectInfo glow_effect{
    .name = "glow",
    .doc = "Adds half of its source.",
    .parameters = glow_rows.table(),
    .files = test_effect_files,
    .build =
        [](PassBuilder& builder) {
            const PassImage light =
                builder.add({.name = "source",
                             .shader = "glow_source.glsl",
                             .inputs = {{.name = "glow_in", .image = builder.source()}},
                             .output = builder.create({.name = "light", .format = VK_FORMAT_R32G32B32A32_SFLOAT})});
            builder.side("glow_side", light, {});
        },
    .reference = glow_reference,
    .is_identity = [](const void* parameters) { return static_cast<const Glow*>(parameters)->amount == 0; }};
/// Makes light encoded, or encoded light linear again.
inline const EffectInfo recode_effect{.name = "recode",
                                      .doc = "A curve that says what it made.",
                                      .parameters = recode_rows.table(),
                                      .files = test_effect_files,
                                      .makes =
                                          [](ColorState, const void* parameters) {
                                              const auto& recode = *static_cast<const Recode*>(parameters);
                                              return recode.is_encoded ? srgb_color
                                                                       : ColorState{.domain = Domain::DisplayLinear};
                                          },
                                      .reference = pointwise_reference<Recode, recode_reference>};
/// Needs what no test brings: left out, it hands on what it gets.
inline const EffectInfo absent_effect{.name = "absent",
                                      .doc = "Is never there.",
                                      .parameters = absent_rows.table(),
                                      .files = test_effect_files,
                                      .needs = {FrameImage::Ui}};
/// A result of half the size.
inline const EffectInfo halve_effect{
    .name = "halve",
    .doc = "Keeps every other pixel.",
    .parameters = halve_rows.table(),
    .files = test_effect_files,
    .touch = Touch::Neighbourhood,
    .output_scale = {1, 2},
    .build =
        [](PassBuilder& builder) {
            builder.result(builder.add(
                {.name = "down",
                 .shader = "halve_down.glsl",
                 .inputs = {{.name = "halve_in", .image = builder.picture()}},
                 .output =
                     builder.create({.name = "half", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .denominator = 2})}));
        },
    .reference = halve_reference};

}  // namespace darkroom::test
