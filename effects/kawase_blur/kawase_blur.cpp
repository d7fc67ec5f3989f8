// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/kawase_blur.hpp>
#include <string>
#include <utility>

#include "kawase_blur/kawase_blur_reference.hpp"

namespace darkroom {

namespace {

constexpr auto kawase_blur_rows =
    describe(field<&KawaseBlur::mode>("Filter: dual halves the picture and brings it back, kawase works at full size.")
                 .at_compile(),
             field<&KawaseBlur::iterations>("Number of halvings for dual, of passes for kawase.", {1, 8}).at_compile(),
             field<&KawaseBlur::offset>(
                 "Distance between taps, relative to the published one; at 0 kawase has no width.", {0, 2}));

constexpr std::size_t max_iterations = 8;

const KawaseBlur& blur_of(const void* parameters) { return *static_cast<const KawaseBlur*>(parameters); }

/// Of taps half a texel, one and a half, two and a half ... from the pixel, as parts of the picture.
template <std::size_t iteration>
void corner_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const float reach = (static_cast<float>(iteration) + 0.5f) * blur_of(parameters).offset;
    out[0] = {reach / static_cast<float>(context.output_extent.width),
              reach / static_cast<float>(context.output_extent.height), 0, 0};
}
constexpr std::array corner_constants_of = []<std::size_t... i>(std::index_sequence<i...>) {
    return std::array<ConstantsFunction, sizeof...(i)>{corner_constants<i>...};
}
(std::make_index_sequence<max_iterations>());

/// The taps' distance in texels of the smaller picture, half of which the corners take.
void dual_constants(const void* parameters, const PassContext&, std::span<PassVector> out) {
    out[0] = {blur_of(parameters).offset, 0, 0, 0};
}

void build_kawase(PassBuilder& builder, std::size_t iterations) {
    PassImage image = builder.picture();
    for (std::size_t i = 0; i < iterations; ++i) {
        const std::string name = "corners " + std::to_string(i + 1);
        image = builder.add({.name = name,
                             .shader = "kawase_blur.glsl#corners",
                             .inputs = {{.name = "kawase_blur_input", .image = image}},
                             .output = builder.create({.name = name}),
                             .custom_vectors = 1,
                             .constants = corner_constants_of[i]});
    }
    builder.result(image);
}

void build_dual(PassBuilder& builder, std::uint32_t iterations) {
    const PassImage picture = builder.picture();
    PassImage image = picture;
    const auto step = [&](const std::string& name, std::string_view shader, std::uint32_t level) {
        KernelPassDesc desc{.name = name,
                            .shader = shader,
                            .inputs = {{.name = "kawase_blur_input", .image = image}},
                            .output = builder.create({.name = name, .denominator = 1u << level}),
                            .custom_vectors = 1,
                            .constants = dual_constants};
        const bool is_last = level == 0;
        if (is_last) desc.inputs.push_back({.name = "kawase_blur_picture", .image = picture});
        image = builder.add(desc);
    };
    for (std::uint32_t i = 1; i <= iterations; ++i) step("halve " + std::to_string(i), "kawase_blur.glsl#halve", i);
    for (std::uint32_t i = iterations; i-- > 1;) step("double " + std::to_string(i), "kawase_blur.glsl#double", i);
    step("result", "kawase_blur.glsl#result", 0);
    builder.result(image);
}

void build(PassBuilder& builder) {
    const KawaseBlur blur = blur_of(builder.parameters());
    if (blur.mode == KawaseBlurMode::Kawase)
        build_kawase(builder, static_cast<std::size_t>(blur.iterations));
    else
        build_dual(builder, static_cast<std::uint32_t>(blur.iterations));
}

}  // namespace

const EffectInfo& effect_info(const KawaseBlur&) {
    static const EffectInfo info{
        .name = "kawase_blur",
        .doc = "Blurs the picture widely by few taps.",
        .parameters = kawase_blur_rows.table(),
        .files = embedded_files("kawase_blur"),
        .touch = Touch::Neighbourhood,
        .accepts = Domains::all(),
        .flat = {.documented = 78, .scene_linear = 86},
        .build = build,
        .reference = kawase_blur_reference,
        .is_identity =
            [](const void* parameters) {
                const KawaseBlur& blur = blur_of(parameters);
                return blur.mode == KawaseBlurMode::Kawase && blur.offset == 0.0f;
            },
    };
    return info;
}

}  // namespace darkroom
